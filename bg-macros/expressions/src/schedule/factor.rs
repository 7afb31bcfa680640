//! Common factors of the terms of a sum.
//!
//! In: the terms of one sum. Out: its value, with x*a + x*b as x*(a + b) where that saves multiplications.
//! Method: greedy choice of the literal with the largest saving, as in Brayton, McMullen 1982 (the decomposition and
//! factorization of Boolean expressions), for algebraic literals: a coefficient, a factor, or a divisor. A product that
//! is needed elsewhere, too, is saved by that share only.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::graph::{Graph, Value};
use super::rebuild::{Origins, pair_counts};
use super::statics::Statics;
use crate::expr::Id;

/// When common factors come out of sums.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Grouping {
    /// Never.
    Off,
    /// Wherever the sum itself gets shorter.
    Local,
    /// Where the sum gets shorter by more than it loses in shared products.
    Shared,
}

/// What can be common to several terms.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Literal {
    Coefficient(Id),
    Factor(u32),
    Divisor(u32),
}

/// How much the routine's products are shared.
#[derive(Debug)]
pub(super) struct Sharing {
    grouping: Grouping,
    pairs: FxHashMap<(u32, u32), u32>,
    origins: Origins,
    uses: Vec<u32>,
}

/// A term with its product taken apart.
#[derive(Clone, Debug)]
struct Term {
    value: Value,
    magnitude: Id,
    factors: Vec<(u32, i32)>,
    /// What a literal of this term saves when it comes out.
    worth: Vec<(Literal, f64)>,
}

/// Rounds of grouping in one sum; each at least halves what can still be grouped.
const ROUNDS: usize = 16;

/// The least saving, in multiplications, for which a sum is regrouped: more than rounding errors of the shares.
const LEAST_SAVING: f64 = 1e-6;

impl Sharing {
    /// The sharing in this graph.
    pub(super) fn new(grouping: Grouping, graph: &Graph, order: &[u32]) -> Self {
        let pairs = if grouping == Grouping::Shared { pair_counts(graph, order) } else { FxHashMap::default() };
        Self { grouping, pairs, origins: Origins::default(), uses: Vec::new() }
    }

    /// Notes that the core `new` stands for the core `old`, which is used so often.
    pub(super) fn record(&mut self, old: u32, new: u32, uses: u32) {
        self.origins.record(old, new);
        if self.uses.len() <= new as usize {
            self.uses.resize(new as usize + 1, 0);
        }
        self.uses[new as usize] += uses;
    }

    /// The sum of these terms.
    pub(super) fn sum(&self, statics: &mut Statics, graph: &mut Graph, mut terms: Vec<Value>) -> Value {
        if self.grouping != Grouping::Off && terms.len() > 1 {
            for _ in 0..ROUNDS {
                if !self.group(statics, graph, &mut terms) {
                    break;
                }
            }
        }
        graph.sum(statics, terms)
    }

    /// Takes common factors out of the terms, each term once; whether there were any.
    fn group(&self, statics: &mut Statics, graph: &mut Graph, terms: &mut Vec<Value>) -> bool {
        let mut parts: Vec<Option<Term>> = terms.iter().map(|&term| Some(self.term(statics, graph, term))).collect();
        let mut grouped = Vec::new();
        for (literal, members) in ranked(&parts) {
            let open: Vec<usize> = members.into_iter().filter(|&member| parts[member].is_some()).collect();
            if saving(&parts, literal, &open) < LEAST_SAVING {
                continue;
            }
            let members: Vec<Term> = open.into_iter().filter_map(|member| parts[member].take()).collect();
            grouped.push(self.take_out(statics, graph, &members));
        }
        let changed = !grouped.is_empty();
        if changed {
            *terms = parts.into_iter().flatten().map(|part| part.value).chain(grouped).collect();
        }
        changed
    }

    fn term(&self, statics: &mut Statics, graph: &Graph, value: Value) -> Term {
        let (_, magnitude) = statics.magnitude(value.coefficient);
        let factors = graph.factor_list(value.core);
        let scaled = !statics.is_unit(magnitude);
        let length = usize::from(scaled) + factors.iter().map(|factor| factor.1.unsigned_abs() as usize).sum::<usize>();
        let mut worth = Vec::new();
        if scaled && length > 1 {
            worth.push((Literal::Coefficient(magnitude), 1.0));
        }
        for &(core, exponent) in &factors {
            if exponent < 0 {
                worth.push((Literal::Divisor(core), 1.0));
            } else if length > 1 {
                worth.push((Literal::Factor(core), self.worth(value.core, core, &factors)));
            }
        }
        Term { value, magnitude, factors, worth }
    }

    /// The share of a multiplication by `factor` that this term pays.
    fn worth(&self, product: u32, factor: u32, factors: &[(u32, i32)]) -> f64 {
        if self.grouping != Grouping::Shared {
            return 1.0;
        }
        if product != factor && self.uses.get(product as usize).is_some_and(|&uses| uses > 1) {
            return 0.0;
        }
        let old = self.origins.of(factor);
        let mut most = 1;
        for other in factors.iter().filter(|other| other.0 != factor) {
            let other = self.origins.of(other.0);
            most = most.max(self.pairs.get(&(old.min(other), old.max(other))).copied().unwrap_or(1));
        }
        1.0 / f64::from(most)
    }

    /// The common factor of the members times the sum of what remains.
    fn take_out(&self, statics: &mut Statics, graph: &mut Graph, members: &[Term]) -> Value {
        let mut common = members[0].factors.clone();
        for member in &members[1..] {
            common = intersection(&common, &member.factors);
        }
        let magnitude = members[0].magnitude;
        let coefficient =
            if members.iter().all(|member| member.magnitude == magnitude) { magnitude } else { statics.one };
        let inverse: Vec<(u32, i32)> = common.iter().map(|&(core, exponent)| (core, -exponent)).collect();
        let mut rest = Vec::with_capacity(members.len());
        for member in members {
            let factors = member.factors.iter().chain(&inverse).copied().collect();
            let core = graph.power_product(factors);
            let left = if coefficient == statics.one {
                member.value.coefficient
            } else {
                let negative = statics.is_negative(member.value.coefficient);
                statics.signed(negative, statics.one)
            };
            rest.push(Value { coefficient: left, core });
        }
        let inner = self.sum(statics, graph, rest);
        let outer = Value { coefficient, core: graph.power_product(common) };
        graph.product(statics, &[(outer, 1), (inner, 1)])
    }
}

/// The literals of several terms with those terms, the largest saving first.
fn ranked(parts: &[Option<Term>]) -> Vec<(Literal, Vec<usize>)> {
    let mut members: BTreeMap<Literal, (f64, Vec<usize>)> = BTreeMap::new();
    for (at, part) in parts.iter().enumerate() {
        for &(literal, worth) in part.iter().flat_map(|part| &part.worth) {
            let entry = members.entry(literal).or_insert((-1.0, Vec::new()));
            entry.0 += worth;
            entry.1.push(at);
        }
    }
    let mut ranked: Vec<_> = members.into_iter().filter(|(_, (saving, _))| *saving > LEAST_SAVING).collect();
    ranked.sort_by(|left, right| right.1.0.total_cmp(&left.1.0).then(left.0.cmp(&right.0)));
    ranked.into_iter().map(|(literal, (_, members))| (literal, members)).collect()
}

/// The multiplications that taking the literal out of these terms saves.
fn saving(parts: &[Option<Term>], literal: Literal, members: &[usize]) -> f64 {
    let worth = |term: &Term| term.worth.iter().find(|entry| entry.0 == literal).map_or(0.0, |entry| entry.1);
    members.iter().filter_map(|&member| parts[member].as_ref()).map(worth).sum::<f64>() - 1.0
}

/// The factors of both, each with the exponent nearer to zero.
fn intersection(left: &[(u32, i32)], right: &[(u32, i32)]) -> Vec<(u32, i32)> {
    let mut result = Vec::new();
    for &(core, exponent) in left {
        let Ok(at) = right.binary_search_by_key(&core, |factor| factor.0) else { continue };
        let other = right[at].1;
        if exponent.signum() == other.signum() {
            result.push((core, if exponent.abs() < other.abs() { exponent } else { other }));
        }
    }
    result
}
