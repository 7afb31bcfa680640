//! Common pairs of terms in the sums of a graph.
//!
//! In: a [`Graph`]. Out: the same graph, in which each pair of terms that several sums have up to a factor is a sum of
//! its own; the order of the cores no longer is children first.
//! Method: greedy elimination (`greedy`).

use rustc_hash::FxHashMap;

use super::graph::{Core, Graph, ONE, Value};
use super::greedy::{Elimination, LONGEST, Seen, eliminate};
use super::statics::Statics;
use crate::expr::Id;

/// Two cores, ascending, with the coefficients that they have in the pair.
type Pair = (u32, u32, Id, Id);

/// A sum that is being rewritten, terms sorted by core.
struct Sum {
    core: u32,
    terms: Vec<Value>,
}

struct Sums<'g, 's, 'p> {
    graph: &'g mut Graph,
    statics: &'s mut Statics<'p>,
    all: Vec<Sum>,
    seen: Seen<Pair>,
    /// How many sums contain this coefficient's magnitude times this core.
    scaled: FxHashMap<(Id, u32), i64>,
}

/// A pair in one sum.
struct Occurrence {
    sum: usize,
    factor: Id,
    first: Value,
    second: Value,
}

/// Makes sums of the pairs of terms that occur in several of the sums under the roots.
pub(super) fn share_addends(statics: &mut Statics, graph: &mut Graph, roots: &[Value]) {
    let order = graph.post_order(roots);
    let mut sums = Vec::new();
    for core in order {
        if let Core::Sum(terms) = &graph.cores[core] {
            sums.push(Sum { core, terms: terms.clone() });
        }
    }
    let members = sums.iter().flat_map(|sum| &sum.terms).map(|term| term.core);
    let seen = Seen::new(members, graph.cores.len());
    let mut search = Sums { graph, statics, all: sums, seen, scaled: FxHashMap::default() };
    let found = search.pairs();
    eliminate(&mut search, found);
    for Sum { core, terms } in search.all {
        search.graph.cores[core] = Core::Sum(terms);
    }
}

impl Elimination for Sums<'_, '_, '_> {
    type Pair = Pair;
    type Occurrence = Occurrence;

    fn places(&mut self, pair: Pair) -> Vec<Occurrence> {
        let mut places = Vec::new();
        for sum in self.seen.lines(pair) {
            let terms = &self.all[sum].terms;
            let term = |core| terms.binary_search_by_key(&core, |term: &Value| term.core).ok().map(|at| terms[at]);
            let (Some(first), Some(second)) = (term(pair.0), term(pair.1)) else { continue };
            for (found, factor) in pairs(self.statics, first, second).into_iter().flatten() {
                if found == pair {
                    places.push(Occurrence { sum, factor, first, second });
                }
            }
        }
        places
    }

    fn saving(&mut self, pair: Pair, places: &[Occurrence]) -> i64 {
        let Some(count) = i64::try_from(places.len()).ok().filter(|&count| count > 1) else { return 0 };
        let inner = [(pair.2, pair.0), (pair.3, pair.1)];
        let mut before = Vec::new();
        let mut after = Vec::new();
        for place in places {
            for term in [place.first, place.second] {
                before.extend(self.scaled_term(term.coefficient, term.core));
            }
            after.extend(self.scaled_term(place.factor, u32::MAX));
        }
        let mut freed = 0;
        before.sort_unstable();
        for run in before.chunk_by(|left, right| left == right) {
            let others = self.scaled.get(&run[0]).copied().unwrap_or(0) - i64::try_from(run.len()).unwrap_or(0);
            freed += i64::from(others <= 0);
        }
        after.sort_unstable();
        after.dedup();
        for (coefficient, core) in inner {
            if let Some(key) = self.scaled_term(coefficient, core) {
                let runs = before.iter().filter(|other| **other == key).count();
                let others = self.scaled.get(&key).copied().unwrap_or(0) - i64::try_from(runs).unwrap_or(0);
                freed -= i64::from(others <= 0);
            }
        }
        count - 1 + freed - i64::try_from(after.len()).unwrap_or(0)
    }

    fn replace(&mut self, pair: Pair, places: &[Occurrence]) -> Vec<Pair> {
        let terms = [Value { coefficient: pair.2, core: pair.0 }, Value { coefficient: pair.3, core: pair.1 }];
        let inner = self.graph.sum(self.statics, terms.to_vec());
        if let Core::Sum(terms) = self.graph.cores[inner.core].clone() {
            terms.into_iter().for_each(|term| self.count(term, 1));
        }
        self.seen.add_lines(inner.core, places.len());
        let mut found = Vec::new();
        for place in places {
            if self.all[place.sum].core == inner.core {
                continue;
            }
            self.count(place.first, -1);
            self.count(place.second, -1);
            let coefficient = self.statics.times(place.factor, inner.coefficient);
            self.exchange(place, Value { coefficient, core: inner.core }, &mut found);
        }
        found
    }
}

impl Sums<'_, '_, '_> {
    fn pairs(&mut self) -> Vec<Pair> {
        let mut found = Vec::new();
        for sum in 0..self.all.len() {
            let terms = self.all[sum].terms.clone();
            for (at, &first) in terms.iter().enumerate() {
                self.count(first, 1);
                for &second in terms[at + 1..].iter().take(LONGEST) {
                    self.note(sum, first, second, &mut found);
                }
            }
        }
        found
    }

    /// Notes the pair of these terms; `found` gets it when it occurs a second time or more.
    fn note(&mut self, sum: usize, first: Value, second: Value, found: &mut Vec<Pair>) {
        if self.seen.is_single(first.core) || self.seen.is_single(second.core) {
            return;
        }
        for (pair, _) in pairs(self.statics, first, second).into_iter().flatten() {
            if self.seen.note(pair, sum) > 1 {
                found.push(pair);
            }
        }
    }

    /// The magnitude of a coefficient and its core, if that is a multiplication.
    fn scaled_term(&mut self, coefficient: Id, core: u32) -> Option<(Id, u32)> {
        if core == ONE || self.statics.is_unit(coefficient) {
            return None;
        }
        Some((self.statics.magnitude(coefficient).1, core))
    }

    fn count(&mut self, term: Value, change: i64) {
        if let Some(key) = self.scaled_term(term.coefficient, term.core) {
            *self.scaled.entry(key).or_insert(0) += change;
        }
    }

    fn exchange(&mut self, place: &Occurrence, mut new: Value, found: &mut Vec<Pair>) {
        let terms = &mut self.all[place.sum].terms;
        terms.retain(|term| term.core != place.first.core && term.core != place.second.core);
        let at = terms.partition_point(|term| term.core < new.core);
        if terms.get(at).is_some_and(|term| term.core == new.core) {
            let old = terms.remove(at);
            self.count(old, -1);
            new.coefficient = self.statics.pool.add(old.coefficient, new.coefficient);
        }
        self.count(new, 1);
        let terms = &mut self.all[place.sum].terms;
        let near = at.saturating_sub(LONGEST)..(at + LONGEST).min(terms.len());
        let neighbours = terms[near].to_vec();
        terms.insert(at, new);
        for other in neighbours {
            let (first, second) = if other.core < new.core { (other, new) } else { (new, other) };
            self.note(place.sum, first, second, found);
        }
    }
}

/// The pairs that two terms are a multiple of, with the factor: as they stand, and without their common factor.
fn pairs(statics: &mut Statics, first: Value, second: Value) -> [Option<(Pair, Id)>; 2] {
    let pair = |left, right| (first.core, second.core, left, right);
    if first.coefficient == statics.one {
        return [Some((pair(statics.one, second.coefficient), statics.one)), None];
    }
    let common = statics.common(first.coefficient, second.coefficient);
    let reduced = Some((pair(common.first, common.second), common.factor));
    let plain = statics.is_unit(common.factor) || statics.is_unit(common.first) || statics.is_unit(common.second);
    if plain {
        return [reduced, None];
    }
    let (negative, left) = statics.magnitude(first.coefficient);
    let right = statics.signed(negative, second.coefficient);
    let sign = statics.signed(negative, statics.one);
    [reduced, Some((pair(left, right), sign))]
}
