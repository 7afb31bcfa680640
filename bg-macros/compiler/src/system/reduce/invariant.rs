//! Constant states.
//!
//! In: equations. Out: the same without the states that keep their start value.
//! Method: assume every state constant at its start value, derive, drop the assumptions whose rate (or projection) does
//! not come out so, repeat until none is dropped. What remains is the greatest set of states whose rates vanish
//! wherever all of them have their start values; by induction in time they keep them.

use std::collections::BTreeSet;

use super::report::{Fate, Report, show};
use super::{is_constant, settle_switches};
use crate::expr::{Id, Symbol, substitute};
use crate::system::equations::StateEquations;

/// Folds the constant states.
pub(super) fn fold(equations: &mut StateEquations, report: &mut Report) {
    let constant = constants(equations);
    let starts: Vec<Id> = equations.states.iter().map(|state| state.start).collect();
    for (state, _) in constant.0.iter().enumerate().filter(|(_, constant)| **constant) {
        report.say(state, Fate::Constant(show(equations, starts[state])));
    }
    let (constant, idle) = constant;
    let zero = equations.pool.zero();
    equations.replace(&|symbol| match symbol.as_state() {
        Some(state) => constant[state].then_some(starts[state]),
        None => idle.contains(&symbol).then_some(zero),
    });
    equations.reactions.retain(|reaction| !idle.contains(&reaction.multiplier));
    let kept: Vec<bool> = constant.iter().map(|constant| !constant).collect();
    super::live::keep_states(equations, report, &kept);
    settle_switches(equations);
}

/// Which states are proved constant, and which multipliers zero.
///
/// A constraint whose flow and gap vanish identically while the constants hold needs no reaction; where several such
/// constraints share a load, the one without any is taken.
fn constants(equations: &mut StateEquations) -> (Vec<bool>, BTreeSet<Symbol>) {
    let starts: Vec<Id> = equations.states.iter().map(|state| state.start).collect();
    let rates: Vec<Id> = equations.states.iter().map(|state| state.rate).collect();
    let projections = equations.projections.clone();
    let projected: Vec<Id> = projections.iter().map(|&(_, id)| id).collect();
    let reactions = equations.reactions.clone();
    let zero = equations.pool.zero();
    let kept: Vec<Id> =
        reactions.iter().flat_map(|reaction| [reaction.slip.flow, reaction.slip.gap.unwrap_or(zero)]).collect();
    let mut idle: BTreeSet<Symbol> = reactions.iter().map(|reaction| reaction.multiplier).collect();
    let pool = &mut equations.pool;
    let mut assumed: Vec<bool> = starts.iter().map(|&start| is_constant(pool, start)).collect();
    loop {
        let at = |symbol: Symbol| match symbol.as_state() {
            Some(state) => assumed[state].then_some(starts[state]),
            None => idle.contains(&symbol).then_some(zero),
        };
        let kept = substitute(pool, &kept, &at);
        let rates = substitute(pool, &rates, &at);
        let projected = substitute(pool, &projected, &at);
        let mut holds: Vec<bool> = rates.iter().map(|&rate| pool.is_zero(rate)).collect();
        for (&(state, _), &image) in projections.iter().zip(&projected) {
            holds[state] &= image == starts[state];
        }
        let next: Vec<bool> = assumed.iter().zip(&holds).map(|(&assumed, &holds)| assumed && holds).collect();
        let moved =
            reactions.iter().zip(kept.chunks_exact(2)).filter(|(_, pair)| !pair.iter().all(|&id| pool.is_zero(id)));
        let moved: Vec<Symbol> = moved.map(|(reaction, _)| reaction.multiplier).collect();
        let before = idle.len();
        idle.retain(|symbol| !moved.contains(symbol));
        if next == assumed && idle.len() == before {
            return (assumed, idle);
        }
        assumed = next;
    }
}

#[cfg(test)]
mod tests {
    use crate::system::reduce::tests::{coupling, oscillator, scene};

    /// Three masses in a row, all at rest; `force` acts on the last one.
    fn chain(force: &str) -> String {
        oscillator("a", ["1", "k", ""], ["0", "0"])
            + &oscillator("b", ["2", "", ""], ["0", "0"])
            + &oscillator("c", ["3", "", ""], ["0", "0"])
            + &coupling("ab", "a", "b", "k")
            + &coupling("bc", "b", "c", "k")
            + "param k: N/m = 20; param push: N = 0; Se force = "
            + force
            + "; force -> c; observe { a: m/s = a.flow; b: m/s = b.flow; c: m/s = c.flow; }"
    }

    #[test]
    fn what_nothing_moves_is_constant_whatever_is_tuned() {
        let scene = scene(&chain("push"), "tune { k }");
        assert!(scene.left().is_empty(), "{}", scene.report);
        assert_eq!(scene.words(&["am.p", "ab.q"]), ["constant 0", "constant 0"]);
        scene.agrees();
    }

    #[test]
    fn one_assumption_that_falls_takes_those_along_that_rest_on_it() {
        // The force moves c, c's momentum stretches bc, that pulls b, and so on to the wall's spring.
        for (force, tune) in [("push", "tune { push }"), ("1", "tune {}"), ("push", "")] {
            let scene = scene(&chain(force), tune);
            assert_eq!(scene.reduced.states.len(), 6, "{}", scene.report);
            scene.agrees();
        }
    }

    #[test]
    fn a_load_that_its_reaction_balances_moves_nothing() {
        let weight = "param m: kg = 2; param g: m/s^2 = 10; param k: N/m = 20;
            1 j: translation; I i = m; C s = k start m * g / k; Se w = m * g; w -> j -> i; j -> s; \
            observe { x: m = s.q; }";
        let balanced = scene(weight, "tune { m, g, k }");
        assert_eq!(balanced.words(&["i.p", "s.q"]), ["constant 0", "constant m*g/k"]);
        balanced.agrees();
        let folded = scene(weight, "tune { m }");
        assert!(folded.left().is_empty(), "{}", folded.report);
        folded.agrees();
        let other = scene(&weight.replace("start m * g / k", "start 2 * m * g / k"), "tune { m }");
        assert_eq!(other.left(), ["i.p", "s.q"]);
        other.agrees();
    }

    #[test]
    fn a_start_that_hangs_on_a_guess_is_not_constant() {
        let at = |place: &str| {
            format!(
                "ground {{ point O = [0, 0, 0]; }} body b {{ mass 2; inertia [1, 1, 1]; start at [{place}, 0, 0]; }}
                 joint j: fixed (ground.O -> b) {{ stiffness 1e2; tilt stiffness 1e2; }} observe {{ x: m = b.position; \
                 }}"
            )
        };
        let known = scene(&at("0"), "");
        assert!(known.left().is_empty(), "{}", known.report);
        let guessed = scene(&at("guess(0)"), "");
        assert!(guessed.left().contains(&"b.position_x"), "{}", guessed.report);
        assert!(guessed.left().contains(&"b.linear.p_x"), "{}", guessed.report);
        guessed.agrees();
        // A guess for a place that nothing depends on: its rate is zero, yet its value is known at run time only.
        let loose = scene(
            "1 j[3]: translation; position x of j start [guess(1), 2, 0]; I m = 2; j -> m;
             observe { x: m = x; }",
            "",
        );
        assert_eq!(loose.words(&["x_x", "x_y"]), ["integrated", "constant 2"]);
        loose.agrees();
    }

    #[test]
    fn time_and_inputs_move_things() {
        for law in ["MSe f = 3 * sin(2 * t)", "Se f = push"] {
            let graph = format!(
                "input push: N; param k: N/m = 3; 1 j: translation; I i = 2; C s = k; {law}; f -> j -> i; j -> s;
                 observe {{ x: m = s.q; }}"
            );
            let scene = scene(&graph, "tune {}");
            assert_eq!(scene.left(), ["i.p", "s.q"]);
            scene.agrees();
        }
    }

    #[test]
    fn a_law_that_switches_must_vanish_in_both_branches() {
        let graph = |negative: &str| {
            format!(
                "param k: N/m = 3; 1 a: translation; I i = 2 start 1; C s = k; a -> i; a -> s;
                 1 b: translation; I j = 2; b -> j; MSe f = if s.q < 0 {{ {negative} }} else {{ 0 }}; f -> b;
                 observe {{ v: m/s = b.flow; x: m = s.q; }}"
            )
        };
        assert_eq!(scene(&graph("0"), "").words(&["j.p"]), ["constant 0"]);
        let moved = scene(&graph("1"), "");
        assert_eq!(moved.words(&["j.p"]), ["integrated"]);
        moved.agrees();
    }

    #[test]
    fn a_spatial_pendulum_that_starts_in_the_plane_stays_there_and_one_pushed_out_does_not() {
        let graph = |spin: &str| {
            format!(
                "param aside: rad/s = 0; gravity [0, -9.81, 0]; ground {{ point O = [0, 0, 0]; }}
                 body bob {{ mass 2; inertia [0.1, 0.2, 0.3]; point top = [0, 0.5, 0]; start top at [0, 0, 0];
                     start turned rotation_z(0.7); start spin {spin}; }}
                 joint pivot: spherical (ground.O -> bob.top) {{ stiffness 1e3; damping 2; }}
                 observe {{ p: m = bob.position; z = bob.z_axis; f: N = pivot.force; }}"
            )
        };
        let plane = scene(&graph("[0, 0, 1]"), "tune {}");
        assert_eq!(plane.reduced.states.len(), 7, "{}", plane.report);
        plane.agrees();
        let tuned = scene(&graph("[aside, 0, 1]"), "tune { aside }");
        assert_eq!(tuned.reduced.states.len(), 18, "{}", tuned.report);
        tuned.agrees();
        // Untuned, the parameter is the number zero.
        assert_eq!(scene(&graph("[aside, 0, 1]"), "tune {}").reduced.states.len(), 7);
    }

    /// At rest nothing has a rate, yet `project` moves what is no orientation towards one.
    #[test]
    fn what_a_projection_moves_is_not_constant() {
        let graph = "param s: 1 = 1.1; 1 j[3]: rotation; I m = 2; j -> m;
            orientation R of j start [[s, 0, 0], [0, 1, 0], [0, 0, 1]]; observe { r = R; }";
        let moved = scene(graph, "tune { s }");
        assert_eq!(
            moved.words(&["m.p_x", "R_11", "R_12", "R_22"]),
            ["constant 0", "integrated", "constant 0", "constant 1"]
        );
        moved.agrees();
        let starts = graph.replace("1.1", "1");
        assert!(scene(&starts, "tune {}").left().is_empty());
    }

    /// The flow is zero for ever, but the gap is open, so the reaction closes it.
    #[test]
    fn a_reaction_with_an_open_gap_is_not_idle() {
        let graph = |height: &str| {
            format!(
                "param height: m = 0.1; 1 j[3]: translation; I m = 2; position x of j start [0, 0, {height}]; j -> m;
                 1 up: translation; TF lift(v) = v.z; rSe hold = 0 at x.z; j -> lift -> up -> hold;
                 observe {{ z: m = x.z; force: N = hold.effort; }}"
            )
        };
        let open = scene(&graph("height"), "tune { height }");
        assert_eq!(open.words(&["x_x", "x_z", "m.p_z"]), ["constant 0", "integrated", "integrated"]);
        open.agrees();
        let closed = scene(&graph("0"), "tune { height }");
        assert!(closed.left().is_empty(), "{}", closed.report);
        closed.agrees();
    }
}
