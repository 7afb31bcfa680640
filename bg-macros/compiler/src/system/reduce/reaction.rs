//! The reactions of rigid joints and of dry friction, solved for.
//!
//! In: equations whose rates depend on multipliers. Out: the same with every multiplier's value in their solution.
//! Method: the time derivative of every flow to be kept at zero is linear in the multipliers, A l + b = 0, with A
//! symmetric and positive definite where the constraints are independent; A is factored as L D L^T in symbols, so that
//! the solution is part of the flat code. What truncation lets grow of a flow v and its gap q is taken away by
//! [`crate::system::projection`]; where the graph asks for them, Baumgarte's terms let it decay, dv/dt = -2 a v - a^2 q
//! (Computer Methods in Applied Mechanics and Engineering 1, 1972).

use std::collections::BTreeMap;

use super::{closing, friction};
use crate::expr::{Id, Pool, Symbol, derivative, partial, substitute};
use crate::system::equations::definite::Factors;
use crate::system::equations::impact::{Impacts, Struck};
use crate::system::equations::solution::Solution;
use crate::system::equations::stop::RETURN;
use crate::system::equations::{Kind, Reaction, Slip, StateEquations};

/// Solves for all multipliers. They stay symbols in the equations until these are closed.
pub fn solve(equations: &mut StateEquations) {
    let mut unlocked = equations.unlocked.take().unwrap_or_default();
    let mut reactions = std::mem::take(&mut equations.reactions);
    reactions.append(&mut unlocked.stops.clone());
    if reactions.is_empty() {
        return;
    }
    // Joints that rest on stops are locked in the rates, and move where something hits.
    unlocked.exchange(&mut equations.states);
    let (mut reactions, moves) = closing::arrange(equations, reactions);
    let free = Acting::of(equations, &reactions);
    let hit = (!unlocked.stops.is_empty()).then(|| impacts(equations, &reactions, &free));
    unlocked.exchange(&mut equations.states);
    let rigid = friction::rigid(&reactions);
    let mut acting = free.clone();
    let hit = hit.map(|mut impacts| {
        let flows: Vec<Id> = impacts.stops.iter().map(|stop| stop.slip.flow).collect();
        let rates = flow_rates(equations, &flows);
        impacts.stops.iter_mut().zip(rates).for_each(|(stop, rate)| stop.acceleration = rate);
        reactions.truncate(rigid);
        acting = Acting::of(equations, &reactions);
        impacts
    });
    let (accelerations, pool) = (&acting.accelerations, &mut equations.pool);
    let decoupled = friction::decoupled(pool, &reactions, &acting.matrix);
    let factors = Factors::of(pool, &decoupled, |pool, row, pivot, entry| inverse(pool, &reactions[row], pivot, entry));
    let multipliers: Vec<Symbol> = reactions.iter().map(|reaction| reaction.multiplier).collect();
    let efforts = friction::efforts(pool, &reactions);
    let residuals = friction::residuals(pool, &multipliers, &efforts, accelerations);
    let right = right(pool, &multipliers, &residuals);
    let solved = factors.solve(pool, &right);
    let values = (0..solved.len()).map(|row| with(pool, efforts[row], multipliers[row], solved[row])).collect();
    equations.impacts = hit.unwrap_or_else(|| impacts(equations, &reactions, &free));
    let holding = &mut equations.holding;
    (holding.matrix, holding.moves) = (free.matrix.into_iter().take(rigid).collect(), moves);
    holding.rigid = reactions.into_iter().take(rigid).map(|reaction| reaction.slip).collect();
    equations.solution = Solution { multipliers, residuals, efforts, factors, values };
}

/// What reactions do to the flows that they hold.
#[derive(Clone)]
struct Acting {
    /// The rates of the flows.
    rates: Vec<Id>,
    /// A l + b.
    accelerations: Vec<Id>,
    /// A.
    matrix: Vec<Vec<Id>>,
}

impl Acting {
    fn of(equations: &mut StateEquations, reactions: &[Reaction]) -> Self {
        let flows: Vec<Id> = reactions.iter().map(|reaction| reaction.slip.flow).collect();
        let rates = flow_rates(equations, &flows);
        let accelerations = accelerations(equations, reactions, &rates);
        let matrix = matrix(&mut equations.pool, reactions, &accelerations);
        Self { rates, accelerations, matrix }
    }
}

/// -b of A l + b: the residuals without the reactions.
fn right(pool: &mut Pool, multipliers: &[Symbol], residuals: &[Id]) -> Vec<Id> {
    let zero = pool.zero();
    let constants = substitute(pool, residuals, &|symbol| multipliers.contains(&symbol).then_some(zero));
    constants.into_iter().map(|constant| pool.neg(constant)).collect()
}

/// An expression with this value in the place of a symbol, as what a reaction applies where its multiplier has that.
pub(super) fn with(pool: &mut Pool, id: Id, of: Symbol, value: Id) -> Id {
    substitute(pool, &[id], &|symbol| (symbol == of).then_some(value))[0]
}

/// 1 / D of a row.
fn inverse(pool: &mut Pool, reaction: &Reaction, pivot: Id, entry: Id) -> Id {
    if reaction.switched.is_some() {
        friction::reciprocal(pool, pivot, reaction.slip.mobility.unwrap_or(entry))
    } else {
        kept(pool, &reaction.slip, pivot)
    }
}

/// 1 / D of a row that is kept, 0 of one that is not: its reaction is zero.
fn kept(pool: &mut Pool, slip: &Slip, pivot: Id) -> Id {
    let Some(kept) = slip.kept else { return pool.powi(pivot, -1) };
    let kept = pool.symbol(Symbol::Kept(kept));
    let scaled = pool.mul(kept, pivot);
    let divisor = pool.linear(1.0, &[(scaled, 1.0), (kept, -1.0)]);
    pool.div(kept, divisor)
}

/// What impacts are calculated from: nothing without a stop.
fn impacts(equations: &mut StateEquations, reactions: &[Reaction], acting: &Acting) -> Impacts {
    let StateEquations { pool, states, .. } = equations;
    // Stops come after what is rigid, then dry friction, whose efforts are bounded and so no impulses.
    let rows = reactions.iter().take_while(|reaction| reaction.switched.is_none() || reaction.rebound.is_some());
    let rows: Vec<Reaction> = rows.cloned().collect();
    let stop = |(reaction, &acceleration): (&Reaction, &Id)| {
        Some(Struck { slip: reaction.slip.clone(), rebound: reaction.rebound?, acceleration })
    };
    let stops: Vec<Struck> = rows.iter().zip(&acting.rates).filter_map(stop).collect();
    if stops.is_empty() {
        return Impacts::default();
    }
    let rigid = rows.iter().take(rows.len() - stops.len()).map(|reaction| reaction.slip.clone()).collect();
    let moves = closing::moves(pool, states, &rows, &closing::is_moved);
    let mut integrals = closing::moves(pool, states, &rows, &|kind| kind == Kind::Integral);
    // What is not linear in the efforts has no impulse.
    let is_known = |symbol: Symbol| !matches!(symbol, Symbol::Multiplier(_));
    integrals.retain(|(_, by)| pool.symbols(by).into_iter().all(is_known));
    Impacts { rigid, stops, matrix: acting.matrix[..rows.len()].to_vec(), moves, integrals }
}

/// dv/dt of these flows v.
fn flow_rates(equations: &mut StateEquations, flows: &[Id]) -> Vec<Id> {
    let pool = &mut equations.pool;
    let mut seeds: BTreeMap<Symbol, Id> = BTreeMap::from([(Symbol::Time, pool.one())]);
    for (state, definition) in equations.states.iter().enumerate() {
        seeds.insert(Symbol::state(state), definition.rate);
    }
    derivative(pool, flows, &seeds)
}

/// dv/dt of every flow v, with Baumgarte's terms 2 a v + a^2 q where they are asked for; zero where the reactions are
/// right. Dry friction keeps no place; what rests on a stop returns to it slowly.
fn accelerations(equations: &mut StateEquations, reactions: &[Reaction], rates: &[Id]) -> Vec<Id> {
    let pool = &mut equations.pool;
    let (zero, baumgarte) = (pool.zero(), equations.baumgarte.unwrap_or(0.0));
    let acceleration = |(reaction, &rate): (&Reaction, &Id)| {
        let Slip { flow, gap, .. } = reaction.slip;
        let [by_flow, by_gap] = decay(reaction, baumgarte);
        pool.linear(0.0, &[(rate, 1.0), (flow, by_flow), (gap.unwrap_or(zero), by_gap)])
    };
    reactions.iter().zip(rates).map(acceleration).collect()
}

/// By which parts of a flow, 1/s, and of its gap, 1/s^2, the rate of the flow falls where it is held; those of rigid
/// joints are Baumgarte's.
pub(super) fn decay(of: &Reaction, baumgarte: f64) -> [f64; 2] {
    match (&of.switched, of.rebound) {
        (_, Some(_)) => [2.0 * RETURN, RETURN * RETURN],
        (Some(_), None) => [friction::DECAY, 0.0],
        (None, None) => [2.0 * baumgarte, baumgarte * baumgarte],
    }
}

/// A of expressions that are linear in the multipliers: its lower triangle by rows.
fn matrix(pool: &mut Pool, reactions: &[Reaction], expressions: &[Id]) -> Vec<Vec<Id>> {
    let columns: Vec<Vec<Id>> =
        reactions.iter().map(|reaction| partial(pool, expressions, reaction.multiplier)).collect();
    (0..reactions.len()).map(|i| (0..=i).map(|j| columns[j][i]).collect()).collect()
}

#[cfg(test)]
mod tests {
    use crate::expr::{Environment, evaluate};
    use crate::system::reduce::tests::scene;

    const BOB: &str = "param mass: kg = 2; param g: m/s^2 = 9.81; gravity [0, -g, 0]; ground { point O = [0, 0, 0]; }
        body bob { mass mass; inertia [0.1, 0.2, 0.3]; point top = [0, 0.5, 0]; start top at [0, 0, 0];
            start turned rotation_z(0.7); }";

    #[test]
    fn a_rigid_pendulum_has_the_reactions_of_the_textbook() {
        let graph = format!(
            "{BOB} joint pivot: revolute z (ground.O -> bob.top) {{ rigid; }}
             observe {{ angle: rad = pivot.direction; w: rad/s = pivot.speed; f: N = pivot.force; gap: m = pivot.gap; \
             }}"
        );
        let scene = scene(&graph, "all reactions;");
        assert_eq!(scene.reduced.states.len(), 7, "{}", scene.report);
        assert!(scene.reduced.reactions.is_empty());
        // At rest at the angle a: w' = -m g l sin(a) / (J + m l^2), and the centre of mass falls with l w'.
        let (mass, length, moment, gravity, angle) = (2.0, 0.5, 0.3, 9.81, 0.7_f64);
        let turn = -mass * gravity * length * angle.sin() / (moment + mass * length * length);
        let force = [mass * length * turn * angle.cos(), mass * (gravity + length * turn * angle.sin())];
        let (full, reduced) = scene.starts();
        for outputs in [full, reduced] {
            for (found, expected) in outputs[2..4].iter().zip(force) {
                assert!((found - expected).abs() < 1e-12, "{outputs:?} {force:?}");
            }
            assert!((outputs[0] - angle).abs() < 1e-15 && outputs[4].abs() < 1e-12);
        }
        scene.agrees();
    }

    #[test]
    fn a_joint_made_rigid_by_the_scene_is_the_same_as_a_rigid_one() {
        let joint = |clauses: &str| {
            format!(
                "{BOB} joint pivot: spherical (ground.O -> bob.top) {{ {clauses} }}
                 observe {{ p: m = bob.position; f: N = pivot.force; h: kg*m^2/s = bob.h; }}"
            )
        };
        let compliant = scene(&joint("stiffness 1e3;"), "rigid joints; all reactions;");
        let rigid = scene(&joint("rigid;"), "all reactions;");
        assert_eq!(compliant.starts(), rigid.starts());
        assert_eq!(compliant.left(), rigid.left());
        compliant.agrees();
    }

    #[test]
    fn reactions_out_of_the_plane_need_no_solution() {
        let graph = format!(
            "{BOB} body rod {{ mass 1; inertia [0.1, 0.01, 0.1]; point top = [0, 0.2, 0]; \
            start top at [0.5 * sin(0.7) * 0, -0.5, 0]; }}
             joint pivot: revolute z (ground.O -> bob.top) {{ rigid; }}
             observe {{ p: m = bob.position; q: m = rod.position; f: N = pivot.force; }}"
        );
        let scene = scene(&graph, "all reactions; observe { f: N = pivot.force; m: N*m = pivot.moment; }");
        let zero = |name: &str| {
            let output = scene.reduced.outputs.iter().find(|output| output.name == name).expect(name);
            scene.reduced.pool.is_zero(output.value)
        };
        assert!(zero("f_z") && !zero("f_x"), "{}", scene.report);
        scene.agrees();
    }

    /// q'' + 2 a q' + a^2 q = 0 has the double root -a: from rest, q = q0 (1 + a t) exp(-a t).
    #[test]
    fn a_gap_decays_with_the_double_root_of_baumgarte_s_terms() {
        let graph =
            "baumgarte 50; 1 k[3]: translation; position q of k start [0.02, 0, 0]; I m = 2; rSe hold = [0, 0, 0] at q;
            k -> m; k -> hold; observe { q: m = q.x; }";
        let (_, gaps) = scene(graph, "").columns();
        // The harness samples every 50 ms.
        for (k, row) in gaps.iter().enumerate() {
            let at = 50.0 * 0.05 * k as f64;
            let expected = 0.02 * (1.0 + at) * (-at).exp();
            assert!((row[0] - expected).abs() < 1e-6, "{k}: {} {expected}", row[0]);
        }
        assert!((gaps[1][0] - 0.02 * 3.5 * (-2.5_f64).exp()).abs() < 1e-6, "{}", gaps[1][0]);
    }

    /// q'' + 2 q' + q = 0 where a ball rests on a floor, whose place truncation has left: the pull of the floor is 1/s,
    /// critically damped.
    #[test]
    fn what_rests_on_a_stop_returns_to_its_place() {
        let graph = "1 fall: translation; I ball = 2; Se weight = -20; weight -> fall -> ball;
            stop floor on fall { at least 0; start 0.5; restitution 0.5; } observe { y: m = floor.place; }";
        let of = scene(graph, "").literal;
        let name = |index: usize| of.states[index].name.as_str();
        let (place, momentum) = if name(0) == "ball.p" { (1, 0) } else { (0, 1) };
        assert_eq!([name(place), name(momentum)], ["floor.way.q", "ball.p"]);
        for (y, v, is_clear) in [(1e-3, 0.0, false), (0.0, 4e-3, false), (-2e-3, 3e-3, false), (0.5, 3.0, true)] {
            let mut states = [0.0; 2];
            (states[place], states[momentum]) = (y, 2.0 * v);
            let environment = Environment { states: &states, negative: &[is_clear], ..Environment::default() };
            let rate = evaluate(&of.pool, &[of.states[momentum].rate], &environment)[0] / 2.0;
            let expected = if is_clear { -10.0 } else { -2.0 * v - y };
            assert!((rate - expected).abs() < 1e-14, "{y} {v}: {rate} {expected}");
        }
    }

    /// Of a parameter that a scene does not tune a number is left, and the others have their new places.
    #[test]
    fn how_something_leaves_a_stop_is_by_the_parameters_of_the_scene() {
        let graph = "param a: kg = 2; param e: 1 = 0.25; 1 fall: translation; I ball = a; Se weight = -20;
            weight -> fall -> ball; stop floor on fall { at least 0; start 0.5; restitution e; \
            } observe { y: m = floor.place; }";
        for (tuned, expected) in [("a", 0.25), ("e", 0.7)] {
            let of = scene(graph, &format!("tune {{ {tuned} }}")).reduced;
            let environment = Environment { parameters: &[0.7], ..Environment::default() };
            let found = evaluate(&of.pool, &[of.impacts.stops[0].rebound.restitution], &environment);
            assert_eq!(found, [expected], "{tuned}");
        }
    }

    /// The effort that keeps a prescribed flow depends on the flow's change, which an input does not tell.
    #[test]
    fn a_kept_flow_follows_no_input() {
        let text = "graph G { input speed: m/s; 1 k: translation; I m = 2; rSe hold = speed; k -> hold; k -> m; }";
        let source = crate::source::syntax::parse(text.parse().expect("tokens")).expect("a graph");
        let faults = crate::graph::resolve(&source.graphs[0]).expect_err("an input has no known rate");
        assert_eq!(faults[0].code, "BG0323");
    }

    /// A flow that is a function of time is kept exactly, with the effort that its change needs, whichever way the half
    /// arrow points.
    #[test]
    fn a_kept_flow_follows_a_function_of_time() {
        for arrow in ["k -> hold", "hold -> k"] {
            let graph = "param a: m/s = 1; 1 k: translation; I m = 2 start 0; rSe hold = a * sin(2 * t); k -> m;
                observe { v: m/s = k.flow; }";
            let (_, motion) = scene(&format!("{graph} {arrow};"), "").columns();
            // The harness samples every 50 ms.
            let late = motion.iter().enumerate();
            let lag = late.fold(0.0_f64, |lag, (k, row)| lag.max((row[0] - (0.1 * k as f64).sin()).abs()));
            assert!(lag < 1e-6, "{arrow}: {lag:e}");
        }
    }
}
