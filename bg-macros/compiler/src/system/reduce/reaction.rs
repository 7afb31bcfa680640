//! The reactions of rigid joints and of dry friction, solved for.
//!
//! In: equations whose rates depend on multipliers. Out: the same with every multiplier replaced by its value.
//! Method: the time derivative of every flow to be kept at zero is linear in the multipliers, A l + b = 0, with A
//! symmetric and positive definite where the constraints are independent; A is factored as L D L^T in symbols, so that
//! the solution is part of the flat code. What truncation lets grow of a flow v and its gap q decays by Baumgarte's
//! terms, dv/dt = -2 a v - a^2 q (Computer Methods in Applied Mechanics and Engineering 1, 1972).

use std::collections::BTreeMap;

use super::friction;
use crate::expr::{Branch, Id, Pool, Symbol, derivative, partial};
use crate::system::equations::{Kind, Reaction, State, StateEquations};

/// Rate at which a remaining gap decays, 1/s: slow beside the motion of a step, fast beside its growth by truncation.
const DECAY: f64 = 50.0;

/// Solves for all multipliers.
pub fn solve(equations: &mut StateEquations) {
    let reactions = std::mem::take(&mut equations.reactions);
    if reactions.is_empty() {
        return;
    }
    let accelerations = accelerations(equations, &reactions);
    let pool = &mut equations.pool;
    let mut system = Linear::of(pool, &reactions, &accelerations);
    let rigid = friction::rigid(&reactions);
    let matrix = system.matrix[..rigid].to_vec();
    system.matrix = friction::decoupled(pool, &reactions, &system.matrix);
    let solution = system.solved(pool, rigid);
    let efforts = reactions.iter().zip(solution).map(|(reaction, value)| friction::effort(pool, reaction, value));
    let efforts: Vec<Id> = efforts.collect();
    let value: BTreeMap<Symbol, Id> = reactions.iter().map(|reaction| reaction.multiplier).zip(efforts).collect();
    let before = equations.states.clone();
    equations.replace(&|symbol| value.get(&symbol).copied());
    let holding = &mut equations.holding;
    (holding.matrix, holding.moves) = (matrix, moves(&mut equations.pool, &before, &reactions[..rigid]));
    holding.rigid = reactions.into_iter().take(rigid).map(|reaction| reaction.slip).collect();
    holding.replace(&mut equations.pool, &|symbol| value.get(&symbol).copied(), &Branch::Kept);
}

/// dv/dt + 2 a v + a^2 q of every flow v with its gap q; zero where the reactions are right. Dry friction keeps no place.
fn accelerations(equations: &mut StateEquations, reactions: &[Reaction]) -> Vec<Id> {
    let pool = &mut equations.pool;
    let mut seeds: BTreeMap<Symbol, Id> = BTreeMap::from([(Symbol::Time, pool.one())]);
    for (state, definition) in equations.states.iter().enumerate() {
        seeds.insert(Symbol::state(state), definition.rate);
    }
    let flows: Vec<Id> = reactions.iter().map(|reaction| reaction.slip.flow).collect();
    let rates = derivative(pool, &flows, &seeds);
    let zero = pool.zero();
    reactions
        .iter()
        .zip(rates)
        .map(|(reaction, rate)| {
            let gap = reaction.gap.unwrap_or(zero);
            let decay = if reaction.friction.is_some() { friction::DECAY } else { 2.0 * DECAY };
            pool.linear(0.0, &[(rate, 1.0), (reaction.slip.flow, decay), (gap, DECAY * DECAY)])
        })
        .collect()
}

/// The momenta whose rates depend on multipliers, and how.
fn moves(pool: &mut Pool, states: &[State], reactions: &[Reaction]) -> Vec<(usize, Vec<Id>)> {
    let momenta: Vec<usize> =
        (0..states.len()).filter(|&state| states[state].origin.kind() == Kind::Momentum).collect();
    let rates: Vec<Id> = momenta.iter().map(|&state| states[state].rate).collect();
    let columns: Vec<Vec<Id>> = reactions.iter().map(|reaction| partial(pool, &rates, reaction.multiplier)).collect();
    let row = |k: usize| columns.iter().map(|column| column[k]).collect::<Vec<Id>>();
    let rows = momenta.into_iter().enumerate().map(|(k, state)| (state, row(k)));
    rows.filter(|(_, row)| row.iter().any(|&id| !pool.is_zero(id))).collect()
}

/// A l + b = 0.
struct Linear {
    /// Lower triangle by rows.
    matrix: Vec<Vec<Id>>,
    constant: Vec<Id>,
}

impl Linear {
    /// The coefficients of expressions that are linear in the multipliers.
    fn of(pool: &mut Pool, reactions: &[Reaction], expressions: &[Id]) -> Self {
        let columns: Vec<Vec<Id>> =
            reactions.iter().map(|reaction| partial(pool, expressions, reaction.multiplier)).collect();
        let matrix = (0..reactions.len()).map(|i| (0..=i).map(|j| columns[j][i]).collect()).collect();
        let constant = friction::constants(pool, reactions, expressions);
        Self { matrix, constant }
    }

    /// l by L D L^T, without a search for pivots (Golub and Van Loan, Matrix Computations, algorithm 4.1.2). From row `rigid` on it
    /// is dry friction, which shares no load with what holds the motion already.
    fn solved(self, pool: &mut Pool, rigid: usize) -> Vec<Id> {
        let n = self.constant.len();
        let mut lower: Vec<Vec<Id>> = Vec::with_capacity(n);
        let mut diagonal: Vec<Pivot> = Vec::with_capacity(n);
        for (i, mut row) in self.matrix.into_iter().enumerate() {
            // The row's entries are L_ij D_j until all of them are known.
            for (j, above) in lower.iter().enumerate() {
                let known: Vec<Id> = (0..j).map(|k| pool.mul(row[k], above[k])).collect();
                let known = pool.sum(&known);
                row[j] = pool.sub(row[j], known);
            }
            let mut squares = Vec::with_capacity(i);
            for (entry, &divisor) in row.iter_mut().zip(&diagonal) {
                let scaled = *entry;
                *entry = divisor.divide(pool, scaled);
                squares.push(pool.mul(scaled, *entry));
            }
            let squares = pool.sum(&squares);
            let pivot = pool.sub(row[i], squares);
            diagonal.push(if i < rigid {
                Pivot::Of(pivot)
            } else {
                Pivot::Inverse(friction::reciprocal(pool, pivot, row[i]))
            });
            lower.push(row);
        }
        let mut solution: Vec<Id> = Vec::with_capacity(n);
        for (row, &constant) in lower.iter().zip(&self.constant) {
            let known: Vec<Id> = row.iter().zip(&solution).map(|(&entry, &value)| pool.mul(entry, value)).collect();
            let known = pool.sum(&known);
            let right = pool.neg(constant);
            solution.push(pool.sub(right, known));
        }
        for (value, &divisor) in solution.iter_mut().zip(&diagonal) {
            *value = divisor.divide(pool, *value);
        }
        for i in (0..n).rev() {
            let known: Vec<Id> = (i + 1..n).map(|k| pool.mul(lower[k][i], solution[k])).collect();
            let known = pool.sum(&known);
            solution[i] = pool.sub(solution[i], known);
        }
        solution
    }
}

/// A pivot, or the reciprocal of one.
#[derive(Clone, Copy)]
enum Pivot {
    Of(Id),
    Inverse(Id),
}

impl Pivot {
    fn divide(self, pool: &mut Pool, value: Id) -> Id {
        match self {
            Self::Of(pivot) => pool.div(value, pivot),
            Self::Inverse(inverse) => pool.mul(value, inverse),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::system::reduce::tests::scene;

    const BOB: &str = "param mass: kg = 2; param g: m/s^2 = 9.81; gravity [0, -g, 0]; ground { point O = [0, 0, 0]; }
        body bob { mass mass; inertia [0.1, 0.2, 0.3]; point top = [0, 0.5, 0]; start top at [0, 0, 0];
            start turned rotation_z(0.7); }";

    #[test]
    fn a_rigid_pendulum_has_the_reactions_of_the_textbook() {
        let graph = format!(
            "{BOB} joint pivot: revolute z (ground.O -> bob.top) {{ rigid; }}
             observe {{ angle: rad = pivot.angle; w: rad/s = pivot.speed; f: N = pivot.force; gap: m = pivot.gap; }}"
        );
        let scene = scene(&graph, "");
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
        let compliant = scene(&joint("stiffness 1e3;"), "rigid joints;");
        let rigid = scene(&joint("rigid;"), "");
        assert_eq!(compliant.starts(), rigid.starts());
        assert_eq!(compliant.left(), rigid.left());
        compliant.agrees();
    }

    #[test]
    fn reactions_out_of_the_plane_need_no_solution() {
        let graph = format!(
            "{BOB} body rod {{ mass 1; inertia [0.1, 0.01, 0.1]; point top = [0, 0.2, 0]; start top at [0.5 * sin(0.7) * 0, -0.5, 0]; }}
             joint pivot: revolute z (ground.O -> bob.top) {{ rigid; }}
             observe {{ p: m = bob.position; q: m = rod.position; f: N = pivot.force; }}"
        );
        let scene = scene(&graph, "observe { f: N = pivot.force; m: N*m = pivot.moment; }");
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
        let graph = "1 k[3]: translation; position q of k start [0.02, 0, 0]; I m = 2; rSe hold = [0, 0, 0] at q;
            k -> m; k -> hold; observe { q: m = q.x; }";
        let (_, gaps) = scene(graph, "").columns();
        // The harness samples every 50 ms.
        for (k, row) in gaps.iter().enumerate() {
            let at = super::DECAY * 0.05 * k as f64;
            let expected = 0.02 * (1.0 + at) * (-at).exp();
            assert!((row[0] - expected).abs() < 1e-6, "{k}: {} {expected}", row[0]);
        }
        assert!((gaps[1][0] - 0.02 * 3.5 * (-2.5_f64).exp()).abs() < 1e-6, "{}", gaps[1][0]);
    }

    /// The effort that keeps a prescribed flow depends on the flow's change, which an input does not tell.
    #[test]
    fn a_kept_flow_follows_no_input() {
        let text = "graph G { input speed: m/s; 1 k: translation; I m = 2; rSe hold = speed; k -> hold; k -> m; }";
        let source = crate::source::syntax::parse(text.parse().expect("tokens")).expect("a graph");
        let faults = crate::graph::resolve(&source.graphs[0]).expect_err("an input has no known rate");
        assert_eq!(faults[0].code, "BG0323");
    }

    /// A flow that is a function of time is kept exactly, with the effort that its change needs, whichever way the half arrow
    /// points.
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
