//! States that nobody watches.
//!
//! In: equations. Out: the same without states and switches that reach no output.
//! Method: everything that an output depends on is live; so is what the rate, the projection or a switch of something
//! live depends on, and what the joints hold whose reactions act on it.

use super::keep_switches;
use super::report::{Fate, Report};
use crate::expr::{Branch, Id, Node, Symbol};
use crate::system::equations::solution::Known;
use crate::system::equations::{Kind, StateEquations};

/// Drops states and switches that no output needs.
pub(super) fn drop_unwatched(equations: &mut StateEquations, report: &mut Report) {
    let outputs: Vec<Id> = equations.outputs.iter().map(|output| output.value).collect();
    let (live, switches) = live(equations, &outputs);
    for state in (0..live.len()).filter(|&state| !live[state]) {
        report.say(state, Fate::Unwatched);
    }
    for state in quadratures(equations) {
        if live[state] {
            report.say(state, Fate::Quadrature);
        }
    }
    let mut kept = 0;
    let branches: Vec<Branch> = switches
        .iter()
        .map(|&live| {
            kept += u32::from(live);
            if live { Branch::Kept(kept - 1) } else { Branch::Positive }
        })
        .collect();
    forget(equations, &Known::of(&equations.pool, &live, &switches, &equations.solution.clone()));
    keep_states(equations, report, &live);
    keep_switches(equations, &branches);
}

/// States and switches that the roots need.
fn live(equations: &StateEquations, roots: &[Id]) -> (Vec<bool>, Vec<bool>) {
    let pool = &equations.pool;
    let mut states = vec![false; equations.states.len()];
    let mut switches = vec![false; equations.switches.len()];
    let mut open: Vec<Id> = roots.to_vec();
    while let Some(root) = open.pop() {
        for id in pool.reachable(&[root]) {
            match pool.node(id) {
                Node::Symbol(Symbol::State(state)) => {
                    let state = *state as usize;
                    if !std::mem::replace(&mut states[state], true) {
                        open.push(equations.states[state].rate);
                        let projections = equations.projections.iter().filter(|(of, _)| *of == state);
                        open.extend(projections.map(|(_, id)| *id));
                        open.extend(equations.holding.of_momentum(pool, state));
                    }
                }
                Node::Symbol(symbol) => {
                    if let Some(row) = equations.solution.row(*symbol) {
                        open.push(equations.solution.values[row]);
                        open.extend(equations.holding.shared(row));
                    }
                }
                Node::Select { switch, .. } => {
                    let switch = *switch as usize;
                    if !std::mem::replace(&mut switches[switch], true) {
                        open.push(equations.switches[switch].guard);
                        open.extend(equations.impacts.of_switch(switch));
                    }
                }
                _ => {}
            }
        }
    }
    (states, switches)
}

/// Integrals, and angles and ways, that no rate and no guard depends on.
fn quadratures(equations: &StateEquations) -> Vec<usize> {
    let rates = equations.states.iter().map(|state| state.rate);
    let guards = equations.switches.iter().map(|switch| switch.guard);
    let used = equations.pool.symbols(&rates.chain(guards).collect::<Vec<_>>());
    let is_used = |state: usize| used.contains(&Symbol::state(state));
    (0..equations.states.len())
        .filter(|&state| matches!(equations.states[state].origin.kind(), Kind::Integral | Kind::Way) && !is_used(state))
        .collect()
}

/// What needs a state or a switch that goes is not known in the scene. Energies and powers become not-a-number.
fn forget(equations: &mut StateEquations, known: &Known) {
    let unknown = equations.pool.number(f64::NAN);
    let pool = &equations.pool;
    for quantity in [&mut equations.balance.stored, &mut equations.balance.supplied, &mut equations.balance.dissipated]
    {
        if !known.has(pool, *quantity) {
            *quantity = unknown;
        }
    }
    equations.balance.energies.retain(|&energy| known.has(pool, energy));
    equations.fallible.retain(|law| known.has(pool, law.value));
    equations.iterations.retain(|iteration| iteration.residuals.iter().all(|&residual| known.has(pool, residual)));
    equations.shown.prune(pool, known);
    equations.impacts.prune(pool, known);
    let (holding, solution) = (&mut equations.holding, &mut equations.solution);
    let (mut held, mut solved) = (holding.known(pool, known), solution.known(pool, known));
    if holding.is_shared() {
        // One number for both; dry friction, which comes last, is none that is held.
        held.iter_mut().zip(&mut solved).for_each(|(held, solved)| {
            *held &= *solved;
            *solved = *held;
        });
    }
    holding.retain(pool, known, &held);
    solution.retain(&solved);
    if let Some(inverse) = &mut equations.inverse {
        // Nothing that stays depends on what goes.
        let zero = equations.pool.zero();
        let is_gone = |symbol: Symbol| symbol.as_state().is_some_and(|state| !known.has_state(state));
        inverse.replace(&mut equations.pool, &|symbol| is_gone(symbol).then_some(zero), &Branch::Kept);
    }
}

/// Takes away the states without `kept`, to which nothing refers any more, and numbers the others anew.
pub(super) fn keep_states(equations: &mut StateEquations, report: &mut Report, kept: &[bool]) {
    let mut next = 0;
    let numbers: Vec<usize> = kept
        .iter()
        .map(|&kept| {
            next += usize::from(kept);
            next.saturating_sub(1)
        })
        .collect();
    let is_kept = |state: usize| kept[state];
    let states = std::mem::take(&mut equations.states);
    equations.states = states.into_iter().enumerate().filter(|(k, _)| is_kept(*k)).map(|(_, state)| state).collect();
    equations.projections.retain(|(state, _)| is_kept(*state));
    for (state, _) in &mut equations.projections {
        *state = numbers[*state];
    }
    equations.holding.renumber(&|state| is_kept(state).then(|| numbers[state]));
    equations.impacts.renumber(&|state| is_kept(state).then(|| numbers[state]));
    if let Some(unlocked) = &mut equations.unlocked {
        unlocked.renumber(&|state| is_kept(state).then(|| numbers[state]));
    }
    let symbols: Vec<Id> = numbers.iter().map(|&number| equations.pool.symbol(Symbol::state(number))).collect();
    equations.replace(&|symbol| symbol.as_state().map(|state| symbols[state]));
    report.keep(kept);
}

#[cfg(test)]
mod tests {
    use crate::system::reduce::tests::{Scene, oscillator, scene};

    /// A motor whose current turns the wheel's torque source one way: the wheel does not act back.
    const DOWNSTREAM: &str = "param k: N/m = 20; param c: N*s/m = 0.3;
        1 a: translation; I am = 2 start 1; C ak = k; R ar = c; a -> am; a -> ak; a -> ar;
        1 b: translation; I bm = 3; R br(v) = if v < 0 { 1 * v } else { 2 * v }; MSe pull = 4 * ak.q; pull -> b -> bm; \
        b -> br;";

    fn watching(observed: &str) -> Scene {
        scene(&format!("{DOWNSTREAM} observe {{ all: m/s = b.flow; }}"), &format!("observe {{ {observed} }}"))
    }

    #[test]
    fn what_acts_back_on_nothing_watched_goes_with_its_switches() {
        let scene = watching("v: m/s = a.flow");
        assert_eq!(scene.left(), ["am.p", "ak.q"]);
        assert_eq!(scene.words(&["bm.p"]), ["unwatched"]);
        assert!(scene.reduced.switches.is_empty());
        scene.agrees();
    }

    #[test]
    fn what_is_watched_stays_with_all_that_drives_it() {
        for observed in ["v: m/s = b.flow", "f: N = br.effort", "w: J = integral(br.power)"] {
            let scene = watching(observed);
            assert!(["am.p", "ak.q", "bm.p"].iter().all(|name| scene.left().contains(name)), "{}", scene.report);
            assert_eq!(scene.reduced.switches.len(), 1);
            scene.agrees();
        }
    }

    #[test]
    fn a_switch_that_is_watched_keeps_what_its_guard_depends_on() {
        let graph =
            format!("{DOWNSTREAM} let side = if bm.p < 0 {{ 1 }} else {{ 2 }}; observe {{ all: m/s = b.flow; }}");
        let scene = scene(&graph, "observe { side = side; }");
        assert_eq!(scene.left().len(), 3, "{}", scene.report);
        scene.agrees();
    }

    #[test]
    fn energies_that_are_not_known_are_not_a_number() {
        let number = |scene: &Scene| {
            let of = &scene.reduced;
            [of.balance.stored, of.balance.supplied, of.balance.dissipated]
                .map(|id| of.pool.as_number(id).is_some_and(f64::is_nan))
        };
        assert_eq!(number(&watching("v: m/s = a.flow")), [true, true, true]);
        assert_eq!(number(&watching("v: m/s = b.flow")), [false, false, false]);
    }

    /// The resistor on the imposed speed belongs to no state; its switch goes because no output needs it.
    #[test]
    fn the_power_of_a_switch_that_goes_is_not_known() {
        let graph = "input speed: m/s; Sf drive = speed; 1 j: translation; R r(v) = if v < 0 { 2 * v } else { 3 * v };
            drive -> j -> r; Se push = 1; 1 k: translation; I m = 2; push -> k -> m; observe { v: m/s = k.flow; }";
        let scene = scene(graph, "");
        assert!(scene.reduced.switches.is_empty());
        let dissipated = scene.reduced.pool.as_number(scene.reduced.balance.dissipated);
        assert!(dissipated.is_some_and(f64::is_nan), "the power of `r` is that of one branch");
    }

    #[test]
    fn an_integral_that_only_an_output_needs_is_told_apart() {
        let graph = oscillator("a", ["2", "k", ""], ["1", "0"])
            + "param k: N/m = 20; observe { v: m/s = a.flow; w: J = integral(am.power); }";
        let watched = scene(&graph, "");
        assert_eq!(watched.words(&["w"]), ["quadrature"]);
        assert_eq!(watched.report.integrated(), 2);
        watched.agrees();
        let unwatched = scene(&graph, "observe { v: m/s = a.flow; }");
        assert_eq!(unwatched.left(), ["am.p", "ak.q"]);
    }

    #[test]
    fn a_momentum_alone_needs_no_position() {
        let graph =
            "param f: N = 2; param c: N*s/m = 0.5; 1 j[3]: translation; position x of j; I m = 2 start [1, 0, 3];
            R r = c; Se w = [0, f, 0]; w -> j -> m; j -> r; observe { x: m = x; v: m/s = j.flow; }";
        let scene = scene(graph, "observe { v: m/s = j.flow; }");
        assert_eq!(scene.left(), ["m.p_x", "m.p_y", "m.p_z"], "{}", scene.report);
        assert_eq!(scene.words(&["x_y"]), ["unwatched"]);
        scene.agrees();
    }

    /// The rates of one column of an orientation need this column only, its projection needs all three.
    #[test]
    fn what_a_projection_reads_is_watched() {
        let graph = "param a: rad = 0.4; param b: rad = 0.7; param s: 1 = 1.05;
            1 j[3]: rotation; Sf spin = [1, 2, 3]; spin -> j;
            orientation R of j start s * rotation_x(a) * rotation_y(b);
            observe { r = R; }";
        let scene = scene(graph, "observe { x = dot([1, 0, 0], R * [1, 0, 0]); }");
        assert_eq!(scene.left().len(), 9, "{}", scene.report);
        scene.agrees();
    }

    /// What is gone cannot be asked for its values; what stays keeps its element.
    #[test]
    fn laws_that_can_fail_go_with_the_states_they_read() {
        let graph = "1 a: translation; I am = 2 start 1; R ar(v) = 1 * sqrt(v / 1); a -> am; a -> ar;
            1 b: translation; I bm = 3 start 2; R br(v) = 1 / v; b -> bm; b -> br; observe { a: m/s = a.flow; \
            b: m/s = b.flow; }";
        let elements = |observed: &str| {
            let reduced = scene(graph, &format!("observe {{ {observed} }}")).reduced;
            reduced.fallible.into_iter().map(|law| law.element).collect::<Vec<_>>()
        };
        assert_eq!(elements("a = a.flow"), ["ar"]);
        assert_eq!(elements("b = b.flow"), ["br"]);
        assert_eq!(elements("a = a.flow; b = b.flow"), ["ar", "br"]);
    }
}
