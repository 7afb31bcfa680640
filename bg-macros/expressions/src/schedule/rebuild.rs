//! A graph built anew: sums used once go into the sums that use them, common factors come out of sums.
//!
//! In: a [`Graph`] and its roots in any order of cores. Out: a graph in normal form without dead cores.
//! Method: one sweep, children first; every sum is regrouped by [`super::factor`].

use rustc_hash::FxHashMap;

use super::factor::{Grouping, Sharing};
use super::graph::{Core, Graph, ONE, Value};
use super::greedy::LONGEST;
use super::statics::Statics;

/// The graph of the same roots, its sums regrouped.
pub(super) fn rebuild(
    statics: &mut Statics,
    graph: &Graph,
    roots: &[Value],
    grouping: Grouping,
) -> (Graph, Vec<Value>) {
    let order = graph.post_order(roots);
    let uses = graph.uses(&order, roots);
    let mut sweep = Sweep {
        inlined: inlined(statics, graph, &order, &uses),
        values: vec![Value { coefficient: statics.one, core: ONE }; graph.cores.len()],
        sharing: Sharing::new(grouping, graph, &order),
        target: Graph::new(),
        graph,
        statics,
    };
    for &core in &order {
        if !sweep.inlined[core as usize] {
            let value = sweep.value(core);
            sweep.values[core as usize] = value;
            sweep.sharing.record(core, value.core, uses[core as usize]);
        }
    }
    let roots = roots.iter().map(|&root| sweep.mapped(root)).collect();
    (sweep.target, roots)
}

struct Sweep<'s, 'p> {
    graph: &'s Graph,
    statics: &'s mut Statics<'p>,
    target: Graph,
    inlined: Vec<bool>,
    values: Vec<Value>,
    sharing: Sharing,
}

impl Sweep<'_, '_> {
    fn value(&mut self, core: u32) -> Value {
        let graph = self.graph;
        match &graph.cores[core] {
            leaf @ (Core::One | Core::Symbol(_)) => {
                Value { coefficient: self.statics.one, core: self.target.cores.intern(leaf.clone()) }
            }
            Core::Call(function, arguments) => {
                let arguments = arguments.iter().map(|&argument| self.mapped(argument)).collect();
                self.target.call(self.statics, *function, arguments)
            }
            Core::Select { switch, negative, positive } => {
                let (negative, positive) = (self.mapped(*negative), self.mapped(*positive));
                self.target.select(self.statics, *switch, negative, positive)
            }
            Core::Product(factors) => {
                let powers: Vec<_> = factors.iter().map(|&(f, exponent)| (self.values[f as usize], exponent)).collect();
                self.target.product(self.statics, &powers)
            }
            Core::Sum(terms) => {
                let terms = self.addends(terms);
                self.sharing.sum(self.statics, &mut self.target, terms)
            }
        }
    }

    fn mapped(&mut self, value: Value) -> Value {
        let inner = self.values[value.core as usize];
        Value { coefficient: self.statics.times(value.coefficient, inner.coefficient), core: inner.core }
    }

    /// The terms of a sum and of the sums that go into it, in the new graph.
    fn addends(&mut self, terms: &[Value]) -> Vec<Value> {
        let graph = self.graph;
        let mut result = Vec::with_capacity(terms.len());
        let mut pending: Vec<Value> = terms.iter().rev().copied().collect();
        while let Some(term) = pending.pop() {
            match &graph.cores[term.core] {
                Core::Sum(inner) if self.inlined[term.core as usize] => {
                    for &Value { coefficient, core } in inner.iter().rev() {
                        pending.push(Value { coefficient: self.statics.times(term.coefficient, coefficient), core });
                    }
                }
                _ => result.push(self.mapped(term)),
            }
        }
        result
    }
}

/// The sums that are used once, by a sum, and cost nothing more there.
fn inlined(statics: &Statics, graph: &Graph, order: &[u32], uses: &[u32]) -> Vec<bool> {
    let mut inlined = vec![false; graph.cores.len()];
    for &core in order {
        let Core::Sum(terms) = &graph.cores[core] else { continue };
        for term in terms {
            let Core::Sum(inner) = &graph.cores[term.core] else { continue };
            let free = statics.is_unit(term.coefficient) || !has_unit(statics, inner);
            inlined[term.core as usize] = uses[term.core as usize] == 1 && free;
        }
    }
    inlined
}

/// Whether a sum has a dynamic term with the coefficient -1 or 1.
pub(super) fn has_unit(statics: &Statics, terms: &[Value]) -> bool {
    terms.iter().any(|term| term.core != ONE && statics.is_unit(term.coefficient))
}

/// How often two factors are multiplied with each other in different products.
pub(super) fn pair_counts(graph: &Graph, order: &[u32]) -> FxHashMap<(u32, u32), u32> {
    let mut counts = FxHashMap::default();
    for &core in order {
        let factors = graph.factors(core);
        // Beyond this length a product is no monomial of a mechanism's equations, and its pairs would be too many.
        for (at, first) in factors.iter().enumerate().take(LONGEST) {
            for second in factors[at + 1..].iter().take(LONGEST) {
                *counts.entry((first.0, second.0)).or_insert(0) += 1;
            }
        }
    }
    counts
}

/// The old cores of new ones, for what was counted in the old graph.
#[derive(Debug, Default)]
pub(super) struct Origins(Vec<u32>);

impl Origins {
    /// Notes that `new` stands for `old`; the first note stays.
    pub(super) fn record(&mut self, old: u32, new: u32) {
        if self.0.len() <= new as usize {
            self.0.resize(new as usize + 1, u32::MAX);
        }
        let entry = &mut self.0[new as usize];
        if *entry == u32::MAX {
            *entry = old;
        }
    }

    /// The old core of a new one, `u32::MAX` if there is none.
    pub(super) fn of(&self, new: u32) -> u32 {
        self.0.get(new as usize).copied().unwrap_or(u32::MAX)
    }
}
