//! States that stay equal up to sign.
//!
//! In: equations. Out: the same with one state for each class of equal ones.
//! Method: partition refinement. Candidates are states with the same start value up to sign; assume each class equal,
//! derive, split the classes whose rates (or projections) differ, repeat until none splits. What remains is proved by
//! induction in time: equal start, equal rate wherever the equalities hold. States that start at zero show no sign; they
//! get it from their rates.

use std::collections::BTreeMap;

use super::report::{Fate, Report};
use super::state_of;
use crate::equations::StateEquations;
use crate::expr::{Id, Node, Pool, substitute};

/// Merges equal states.
pub(super) fn merge(equations: &mut StateEquations, report: &mut Report) {
    let classes = classes(equations);
    let symbols: Vec<Id> = state_symbols(equations);
    let images: Vec<Id> = images(&mut equations.pool, &symbols, &classes);
    let mut kept = vec![true; classes.len()];
    for (state, &(first, negative)) in classes.iter().enumerate() {
        if first != state {
            kept[state] = false;
            let sign = if negative { "-" } else { "" };
            report.say(state, Fate::Equal(format!("{sign}{}", equations.states[first].name)));
        }
    }
    equations.replace(&|symbol| state_of(symbol).map(|state| images[state]));
    super::live::keep_states(equations, report, &kept);
}

/// For each state the first of its class, and whether it is its negative.
type Classes = Vec<(usize, bool)>;

fn state_symbols(equations: &mut StateEquations) -> Vec<Id> {
    let states = equations.states.len();
    (0..states).map(|state| equations.pool.symbol(crate::expr::Symbol::State(super::index(state)))).collect()
}

/// Every state in terms of the first of its class.
fn images(pool: &mut Pool, symbols: &[Id], classes: &Classes) -> Vec<Id> {
    classes.iter().map(|&(first, negative)| if negative { pool.neg(symbols[first]) } else { symbols[first] }).collect()
}

fn classes(equations: &mut StateEquations) -> Classes {
    let symbols = state_symbols(equations);
    let candidates = Candidates::of(equations);
    let pool = &mut equations.pool;
    let mut current = candidates.first(pool, &symbols);
    // Every round splits a class or is the last; signs that will not settle prove nothing.
    for _ in 0..2 * symbols.len() + 2 {
        let image = images(pool, &symbols, &current);
        let at = |symbol| state_of(symbol).map(|state| image[state]);
        let rates = substitute(pool, &candidates.rates, &at);
        let projections = substitute(pool, &candidates.projections, &at);
        let next = group(symbols.len(), |state| {
            let negative = candidates.sign(pool, state, rates[state])?;
            let signed = [rates[state], projections[state]].map(|id| if negative { pool.neg(id) } else { id });
            Some((vec![candidates.starts[state].0, symbols[current[state].0], signed[0], signed[1]], negative))
        });
        if next == current {
            return current;
        }
        current = next;
    }
    (0..symbols.len()).map(|state| (state, false)).collect()
}

/// What equal states have in common.
struct Candidates {
    /// Start values without their signs, and whether they had one.
    starts: Vec<(Id, bool)>,
    rates: Vec<Id>,
    /// What `project` gives the state: itself where nothing.
    projections: Vec<Id>,
}

impl Candidates {
    /// The coarsest classes: equal start values up to sign; where these are zero, equal rates up to sign if the others'
    /// classes hold.
    fn first(&self, pool: &mut Pool, symbols: &[Id]) -> Classes {
        let nonzero = group(symbols.len(), |state| {
            let (start, negative) = self.starts[state];
            (!pool.is_zero(start)).then_some((vec![start], negative))
        });
        let image = images(pool, symbols, &nonzero);
        let rates = substitute(pool, &self.rates, &|symbol| state_of(symbol).map(|state| image[state]));
        group(symbols.len(), |state| {
            let negative = self.sign(pool, state, rates[state])?;
            let (start, _) = self.starts[state];
            let rate = unsigned(pool, rates[state]).0;
            Some((if pool.is_zero(start) { vec![start, rate] } else { vec![start] }, negative))
        })
    }

    /// Whether a state is negative beside its class: by its start value, or by its rate if it starts at zero. A state
    /// that starts at zero and has no rate shows no sign.
    fn sign(&self, pool: &mut Pool, state: usize, rate: Id) -> Option<bool> {
        match self.starts[state] {
            (start, negative) if !pool.is_zero(start) => Some(negative),
            _ if pool.is_zero(rate) => None,
            _ => Some(unsigned(pool, rate).1),
        }
    }

    fn of(equations: &mut StateEquations) -> Self {
        let zero = equations.pool.zero();
        let mut projections = vec![zero; equations.states.len()];
        for &(state, id) in &equations.projections {
            projections[state] = id;
        }
        let rates = equations.states.iter().map(|state| state.rate).collect();
        let starts = equations.states.iter().map(|state| unsigned(&mut equations.pool, state.start)).collect();
        Self { starts, rates, projections }
    }
}

/// States with the same key in one class; a state without a key stays alone.
fn group(states: usize, mut key: impl FnMut(usize) -> Option<(Vec<Id>, bool)>) -> Classes {
    let mut firsts: BTreeMap<Vec<Id>, (usize, bool)> = BTreeMap::new();
    (0..states)
        .map(|state| match key(state) {
            None => (state, false),
            Some((key, sign)) => {
                let &mut (first, first_sign) = firsts.entry(key).or_insert((state, sign));
                (first, sign != first_sign)
            }
        })
        .collect()
}

/// An expression without its sign, and whether it had one.
fn unsigned(pool: &mut Pool, id: Id) -> (Id, bool) {
    let negative = match pool.node(id) {
        Node::Number(number) => number.value() < 0.0,
        Node::Sum { constant, terms } if constant.value() == 0.0 && terms.len() == 1 => terms[0].1.value() < 0.0,
        _ => false,
    };
    (if negative { pool.neg(id) } else { id }, negative)
}
