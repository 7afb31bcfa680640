//! States that stay an affine combination of others.
//!
//! In: equations. Out: the same with such states calculated from the others.
//! Method: rates are expanded to monomials; Gaussian elimination finds a combination of other rates that may be a
//! state's; that the difference vanishes identically is then proved on the expanded polynomials. Candidates are the
//! displacements, ways and integrals; combined are positions, orientations, displacements, ways and integrals.

use std::collections::BTreeMap;

use super::report::{Fate, Report, show};
use crate::expr::{Id, Monomials, Symbol, monomials, same_polynomial};
use crate::system::equations::{Kind, Origin, StateEquations};

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
    equations.replace(&|symbol| symbol.as_state().and_then(|state| images.get(&state).copied()));
    let kept: Vec<bool> = (0..equations.states.len()).map(|state| !images.contains_key(&state)).collect();
    super::live::keep_states(equations, report, &kept);
}

/// Start value of the state plus the combination's change since the start.
fn affine(equations: &mut StateEquations, state: usize, combination: &Combination) -> Id {
    let mut terms = vec![(equations.states[state].start, 1.0)];
    for (&other, &coefficient) in combination {
        let symbol = equations.pool.symbol(Symbol::state(other));
        terms.extend([(symbol, coefficient), (equations.states[other].start, -coefficient)]);
    }
    equations.pool.linear(0.0, &terms)
}

/// Whether an expression needs nothing that is known at the start only.
fn is_fixed(equations: &StateEquations, id: Id) -> bool {
    equations.pool.symbols(&[id]).into_iter().all(|symbol| !matches!(symbol, Symbol::Unknown(_)))
}

/// Which states are proved combinations of others that are not recovered themselves.
fn combinations(equations: &mut StateEquations) -> BTreeMap<usize, Combination> {
    let kind = |state: usize| equations.states[state].origin.kind();
    let is_candidate = |kind: Kind| matches!(kind, Kind::Displacement | Kind::Way | Kind::Integral);
    let mut recovered = BTreeMap::new();
    if !equations.states.iter().any(|state| is_candidate(state.origin.kind())) {
        return recovered;
    }
    // Regressors first, candidates last, so that a candidate is reduced by all that may stay.
    // What a memory keeps jumps: its rate says nothing of it.
    let is_memory = |state: usize| matches!(equations.states[state].origin, Origin::Memory(_));
    let is_smooth = |&state: &usize| kind(state) != Kind::Momentum && !is_memory(state);
    let mut order: Vec<usize> = (0..equations.states.len()).filter(is_smooth).collect();
    order.sort_by_key(|&state| is_candidate(kind(state)));
    let mut basis: Vec<Row> = Vec::new();
    for state in order {
        let rate = equations.states[state].rate;
        let Some(expanded) = monomials(&mut equations.pool, rate) else { continue };
        let mut row = Row { entries: expanded, combination: Combination::from([(state, 1.0)]) };
        row.reduce_by(&basis);
        if !row.is_zero() {
            basis.push(row);
        } else if is_candidate(equations.states[state].origin.kind()) {
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

#[cfg(test)]
mod tests {
    use crate::system::reduce::tests::{coupling, oscillator, scene};

    #[test]
    fn a_displacement_that_the_poses_determine_is_not_integrated() {
        let graph = "param k: N/m = 40; param c: N*s/m = 0.2;
            1 a[3]: translation; position x of a start [1, 2, 3]; I m = 2 start [1, 0, 0.3]; C s = k start [0.1, 0, 0];
            R r = c; a -> m; a -> s; a -> r; observe { x: m = x; q: m = s.q; }";
        let scene = scene(graph, "");
        assert_eq!(scene.words(&["s.q_x", "s.q_z"]), ["recovered x_x - 0.9", "recovered x_z - 3"]);
        assert_eq!(scene.reduced.states.len(), 4, "{}", scene.report);
        scene.agrees();
    }

    #[test]
    fn a_pin_s_spring_between_two_bodies_is_recovered_from_their_poses() {
        // Arms are along the bodies' own axes: the spring between (0.3, 0) of one and (-0.2, 0) of the other.
        let graph = "param k: N/m = 90;
            1 v[3]: translation; 1 w[3]: rotation; position x of v; orientation R of w;
            I m = 2 start [0.2, 0.1, 0]; I J = 0.3 start [0, 0, 0.4]; v -> m; w -> J;
            MTF arm(f) = cross(f, R * [0.3, 0, 0]); 0 tip[3]: translation; 1 slip[3]: translation;
            C pin = k; v -> tip; w -> arm -> tip; tip -> slip -> pin;
            observe { x: m = x; q: m = pin.q; R = R; }";
        let scene = scene(graph, "");
        // The orientation is projected after a step, the integrated displacement is not: truncation tells them apart.
        scene.agrees_to(1e-8);
        let recovered = scene.report.fates.iter().filter(|(_, fate)| matches!(fate, super::Fate::Recovered(_))).count();
        assert!(recovered >= 2, "{}", scene.report);
        assert!(scene.left().iter().all(|name| !name.starts_with("pin")), "{}", scene.report);
    }

    #[test]
    fn one_of_the_angles_around_a_loop_is_recovered() {
        let graph = oscillator("a", ["1", "", ""], ["1", ""])
            + &oscillator("b", ["2", "", ""], ["0", ""])
            + &oscillator("c", ["3", "", ""], ["0.5", ""])
            + &coupling("ab", "a", "b", "k")
            + &coupling("bc", "b", "c", "k")
            + &coupling("ac", "a", "c", "l")
            + "param k: N/m = 20; param l: N/m = 7; observe { a: m/s = a.flow; q: m = ac.q; }";
        let loops = scene(&graph, "");
        assert_eq!(loops.words(&["ab.q", "bc.q", "ac.q"]), ["integrated", "integrated", "recovered ab.q + bc.q"]);
        loops.agrees();
        let started = scene(&graph.replace("C ac = l", "C ac = l start 0.25"), "");
        assert_eq!(started.words(&["ac.q"]), ["recovered ab.q + bc.q + 0.25"]);
        started.agrees();
    }

    #[test]
    fn coefficients_that_are_not_numbers_recover_nothing() {
        let graph = "param ratio: 1 = 2; param k: N/m = 20; 1 a: translation; I m = 2 start 1; C s = k; a -> m; a -> s;
            TF lever = ratio; 1 b: translation; C u = k; a -> lever -> b -> u; observe { p: m = s.q; q: m = u.q; }";
        let tuned = scene(graph, "");
        assert_eq!(tuned.words(&["s.q", "u.q"]), ["integrated", "integrated"], "{}", tuned.report);
        tuned.agrees();
        let folded = scene(graph, "tune { k }");
        assert!(folded.reduced.states.len() == 2, "{}", folded.report);
        folded.agrees();
    }

    #[test]
    fn coefficients_that_move_recover_nothing() {
        let graph = "param k: N/m = 20; 1 a: translation; I m = 2 start 1; C s = k; a -> m; a -> s;
            MTF arm = cos(s.q / 1); 1 b: translation; C u = k; a -> arm -> b -> u; observe { p: m = s.q; q: m = u.q; }";
        let scene = scene(graph, "tune {}");
        assert_eq!(scene.words(&["s.q", "u.q"]), ["integrated", "integrated"], "{}", scene.report);
        scene.agrees();
    }

    #[test]
    fn a_guess_is_known_at_the_start_only() {
        let graph = |x: &str| {
            format!(
                "param k: N/m = 40; 1 a[3]: translation; position x of a start [{x}, 2, 3];
                 I m = 2 start [1, 0, 0.3]; C s = k start [0.1, 0, 0]; a -> m; a -> s; observe {{ x: m = x; \
                 q: m = s.q; }}"
            )
        };
        let scene = scene(&graph("guess(1)"), "");
        assert_eq!(scene.words(&["s.q_x", "s.q_z"]), ["integrated", "recovered x_z - 3"]);
        scene.agrees();
    }

    #[test]
    fn rates_that_are_equal_in_one_branch_only_recover_nothing() {
        let graph = "param k: N/m = 20; 1 a: translation; I m = 2 start 1; C s = k; a -> m; a -> s;
            MTF arm = if s.q < 0 { 1 } else { 1.5 }; 1 b: translation; C u = k; a -> arm -> b -> u;
            observe { p: m = s.q; q: m = u.q; }";
        let scene = scene(graph, "tune {}");
        assert_eq!(scene.reduced.states.len(), 3, "{}", scene.report);
        scene.agrees();
    }

    #[test]
    fn start_values_are_taken_with_the_tuned_parameters() {
        let graph =
            "param k: N/m = 20; param x0: m = 0.1; param y0: m = 0.3; 1 a: translation; I m = 2; C s = k start x0;
            C u = k start y0; a -> m; a -> s; a -> u; observe { p: m = s.q; q: m = u.q; }";
        let scene = scene(graph, "tune { x0, y0 }");
        assert_eq!(scene.words(&["u.q"]), ["recovered s.q - x0 + y0"]);
        scene.agrees();
    }
}
