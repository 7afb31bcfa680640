//! States that stay an affine combination of others.
//!
//! In: equations. Out: the same with such states calculated from the others.
//! Method: rates are expanded to monomials; Gaussian elimination finds a combination of other rates that may be a
//! state's; that the difference vanishes identically is then proved on the expanded polynomials. Candidates are the
//! displacements and integrals; combined are positions, orientations, displacements and integrals.

use std::collections::BTreeMap;

use super::report::{Fate, Report, show};
use super::{index, is_constant, state_of};
use crate::equations::StateEquations;
use crate::expr::{Id, Monomials, Symbol, monomials, same_polynomial};

/// Coefficients below this part of the largest are rounding of the elimination.
const ROUNDING: f64 = 1e-11;

/// A combination: coefficients of states.
type Combination = BTreeMap<usize, f64>;

/// Recovers affine states.
pub(super) fn recover(equations: &mut StateEquations, report: &mut Report) {
    let recovered = combinations(equations);
    let mut images: BTreeMap<usize, Id> = BTreeMap::new();
    for (&state, combination) in &recovered {
        let image = affine(equations, state, combination);
        if is_fixed(equations, image) {
            report.say(state, Fate::Recovered(show(equations, image)));
            images.insert(state, image);
        }
    }
    equations.replace(&|symbol| state_of(symbol).and_then(|state| images.get(&state).copied()));
    let kept: Vec<bool> = (0..equations.states.len()).map(|state| !images.contains_key(&state)).collect();
    super::live::keep_states(equations, report, &kept);
}

/// Start value of the state plus the combination's change since the start.
fn affine(equations: &mut StateEquations, state: usize, combination: &Combination) -> Id {
    let mut terms = vec![(equations.states[state].start, 1.0)];
    for (&other, &coefficient) in combination {
        let symbol = equations.pool.symbol(Symbol::State(index(other)));
        terms.extend([(symbol, coefficient), (equations.states[other].start, -coefficient)]);
    }
    equations.pool.linear(0.0, &terms)
}

/// Whether an expression needs nothing that is known at the start only.
fn is_fixed(equations: &StateEquations, id: Id) -> bool {
    let pool = &equations.pool;
    is_constant(pool, id) || pool.symbols(&[id]).into_iter().all(|symbol| !matches!(symbol, Symbol::Unknown(_)))
}

/// Which states are proved combinations of others that are not recovered themselves.
fn combinations(equations: &mut StateEquations) -> BTreeMap<usize, Combination> {
    let is_candidate = |storage: &str| matches!(storage, "C" | "integral");
    let is_regressor = |storage: &str| matches!(storage, "C" | "integral" | "position" | "orientation");
    let mut recovered = BTreeMap::new();
    if !equations.states.iter().any(|state| is_candidate(state.storage)) {
        return recovered;
    }
    // Regressors first, candidates last, so that a candidate is reduced by all that may stay.
    let mut order: Vec<usize> =
        (0..equations.states.len()).filter(|&state| is_regressor(equations.states[state].storage)).collect();
    order.sort_by_key(|&state| is_candidate(equations.states[state].storage));
    let mut basis: Vec<Row> = Vec::new();
    for state in order {
        let rate = equations.states[state].rate;
        let Some(expanded) = monomials(&mut equations.pool, rate) else { continue };
        let mut row = Row { entries: expanded, combination: Combination::from([(state, 1.0)]) };
        row.reduce_by(&basis);
        if !row.is_zero() {
            basis.push(row);
        } else if is_candidate(equations.states[state].storage) {
            let combination = row.solved_for(state);
            if proved(equations, rate, &combination) {
                recovered.insert(state, combination);
            }
        }
    }
    recovered
}

/// Whether a rate is the combination of the others' rates, identically.
fn proved(equations: &mut StateEquations, rate: Id, combination: &Combination) -> bool {
    let terms: Vec<(Id, f64)> = combination.iter().map(|(&other, &c)| (equations.states[other].rate, c)).collect();
    let sum = equations.pool.linear(0.0, &terms);
    same_polynomial(&mut equations.pool, rate, sum)
}

/// A combination of states and the monomials of its rate.
struct Row {
    entries: Monomials,
    combination: Combination,
}

impl Row {
    /// Eliminates the leading monomials of the basis.
    fn reduce_by(&mut self, basis: &[Row]) {
        let largest = self.entries.values().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        for row in basis {
            let Some((pivot, &pivot_value)) = row.entries.iter().next() else { continue };
            let Some(&value) = self.entries.get(pivot) else { continue };
            let factor = value / pivot_value;
            for (monomial, &entry) in &row.entries {
                *self.entries.entry(monomial.clone()).or_insert(0.0) -= factor * entry;
            }
            for (&state, &coefficient) in &row.combination {
                *self.combination.entry(state).or_insert(0.0) -= factor * coefficient;
            }
            self.entries.retain(|_, value| value.abs() > ROUNDING * largest);
        }
    }

    fn is_zero(&self) -> bool {
        self.entries.is_empty()
    }

    /// The vanishing combination, solved for one of its states.
    fn solved_for(&self, state: usize) -> Combination {
        let own = self.combination[&state];
        let others = self.combination.iter().filter(|&(&other, &c)| other != state && c.abs() > ROUNDING);
        others.map(|(&other, &coefficient)| (other, -coefficient / own)).collect()
    }
}
