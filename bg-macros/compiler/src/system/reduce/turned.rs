//! Angles that are integrals of their speed.
//!
//! In: equations in which an angle is the state that counts its turns and a small angle from there. Out: the same
//! without the small angle, where it is proved to be zero: where the angle turns with the state's rate w, which is so
//! if for its sine s and cosine c the polynomials c s' - s c' and w (c^2 + s^2) are one. Both start at one angle, so
//! they stay together.

use std::collections::BTreeMap;

use crate::expr::{Function, Id, Node, Symbol, derivative, same_polynomial, substitute};
use crate::system::equations::{Origin, StateEquations};

/// Whether an angle is not decided yet: a state, or what is left of one that is constant.
pub(super) fn are_open(equations: &StateEquations) -> bool {
    let rates = equations.states.iter().map(|state| state.rate);
    let outputs = equations.outputs.iter().map(|output| output.value);
    let guards = equations.switches.iter().map(|switch| switch.guard);
    let symbols = equations.pool.symbols(&rates.chain(outputs).chain(guards).collect::<Vec<_>>());
    symbols.into_iter().any(|symbol| matches!(symbol, Symbol::Turned(_))) || !turns(equations).is_empty()
}

/// Decides all angles: those that `proves` asks for and that are proved are their states.
pub(super) fn settle(equations: &mut StateEquations, proves: bool) {
    let turns: Vec<(usize, usize)> = turns(equations);
    let mut images: BTreeMap<Symbol, Id> = BTreeMap::new();
    for &(state, turn) in &turns {
        let is_proved = proves && is_integral(equations, state);
        let pool = &mut equations.pool;
        let image = if is_proved { pool.zero() } else { pool.one() };
        images.insert(Symbol::numbered(Symbol::Turned, turn), image);
    }
    let one = equations.pool.one();
    equations
        .replace(&|symbol| matches!(symbol, Symbol::Turned(_)).then(|| images.get(&symbol).copied().unwrap_or(one)));
    let symbols: Vec<Id> = turns.iter().map(|&(state, _)| equations.pool.symbol(Symbol::state(state))).collect();
    let is_itself = |(state, id): &(usize, Id)| {
        turns.iter().zip(&symbols).any(|((turned, _), symbol)| turned == state && symbol == id)
    };
    equations.projections.retain(|projection| !is_itself(projection));
}

/// The states that count turns, each with the sine and the cosine of its angle.
pub(super) fn angles(equations: &mut StateEquations) -> Vec<(usize, [Id; 2])> {
    let states: Vec<usize> = turns(equations).into_iter().map(|(state, _)| state).collect();
    states.into_iter().filter_map(|state| Some((state, sine_and_cosine(equations, state)?))).collect()
}

/// The states that count turns, with the numbers of their angles.
pub(super) fn turns(equations: &StateEquations) -> Vec<(usize, usize)> {
    let states = equations.states.iter().enumerate();
    states.filter_map(|(k, state)| if let Origin::Turn(turn) = state.origin { Some((k, turn)) } else { None }).collect()
}

/// Whether the angle of a state is the state.
fn is_integral(equations: &mut StateEquations, state: usize) -> bool {
    let Some([sine, cosine]) = sine_and_cosine(equations, state) else { return false };
    let states = equations.states.iter().enumerate();
    let mut seeds: BTreeMap<Symbol, Id> = states.map(|(k, state)| (Symbol::state(k), state.rate)).collect();
    let (pool, speed) = (&mut equations.pool, equations.states[state].rate);
    seeds.insert(Symbol::Time, pool.one());
    let rates = derivative(pool, &[sine, cosine], &seeds);
    let (first, second) = (pool.mul(cosine, rates[0]), pool.mul(sine, rates[1]));
    let turning = pool.sub(first, second);
    let (sine, cosine) = (pool.powi(sine, 2), pool.powi(cosine, 2));
    let square = pool.add(sine, cosine);
    let expected = pool.mul(speed, square);
    same_polynomial(pool, turning, expected)
}

/// The sine and cosine of a state's angle: its small angle seen from the angle 0.
fn sine_and_cosine(equations: &mut StateEquations, state: usize) -> Option<[Id; 2]> {
    let &(_, angle) = equations.projections.iter().find(|(projected, _)| *projected == state)?;
    let (pool, own) = (&mut equations.pool, Symbol::state(state));
    let small = pool.reachable(&[angle]).into_iter().find_map(|id| match pool.node(id) {
        Node::Call(Function::Atan2, parts) if pool.symbols(parts).contains(&own) => Some(parts.clone()),
        _ => None,
    })?;
    let zero = pool.zero();
    let seen = substitute(pool, &small, &|symbol| (symbol == own).then_some(zero));
    seen.try_into().ok()
}

#[cfg(test)]
mod tests {
    use crate::expr::{Function, Node};
    use crate::system::equations::Kind;
    use crate::system::reduce::tests::{Scene, scene};

    /// A wheel on a torsion spring by a law of its angle, of which it winds up more than a turn.
    const WHEEL: &str = "param k: N*m = 0.1; ground { point O = [0, 0, 0]; }
        body wheel { mass 1; inertia [0.1, 0.1, 0.1]; start turned rotation_z(0.5); start spin [0, 0, 8]; }
        joint pin: cylindrical z (ground.O -> wheel) { stiffness 1e3; tilt stiffness 10; }
        drive coil on pin torque = -k * pin.angle;
        observe { angle: rad = pin.angle; body: rad = wheel.angle; direction: rad = pin.direction; \
        power: W = coil.power }";

    fn small_angles(scene: &Scene) -> usize {
        let outputs: Vec<_> = scene.reduced.outputs.iter().map(|output| output.value).collect();
        let is_atan2 = |id: &_| matches!(scene.reduced.pool.node(*id), Node::Call(Function::Atan2, _));
        scene.reduced.pool.reachable(&outputs).iter().filter(|id| is_atan2(id)).count()
    }

    #[test]
    fn an_angle_in_the_plane_is_the_integral_of_its_speed_and_counts_turns() {
        let scene = scene(WHEEL, "tune { k } expect planar;");
        // The literal angle is that of the pose, which Runge-Kutta's steps turn by 1e-9 too little.
        scene.agrees_to(1e-7);
        assert_eq!(small_angles(&scene), 1, "that of the direction\n{}", scene.report);
        assert!(
            scene.reduced.projections.iter().all(|(state, _)| scene.reduced.states[*state].origin.kind() != Kind::Way)
        );
        assert_eq!(scene.words(&["pin.angle", "wheel.angle"]), ["equal wheel.angle", "integrated"]);
        // q'' = -q from 0.5 with 8.
        let (literal, reduced) = scene.columns();
        for (step, (literal, reduced)) in literal.iter().zip(&reduced).enumerate() {
            let t = 0.05 * step as f64;
            let expected = 0.5 * t.cos() + 8.0 * t.sin();
            for angle in [literal[0], literal[1], reduced[0], reduced[1]] {
                assert!((angle - expected).abs() < 1e-6, "{t}: {angle} for {expected}");
            }
            let turns = (expected - literal[2]) / std::f64::consts::TAU;
            assert!((turns - turns.round()).abs() < 1e-5 && literal[2].abs() < 3.2, "{t}: {}", literal[2]);
        }
    }

    #[test]
    fn an_angle_that_the_model_integrates_anyhow_is_no_state_more() {
        let scene = scene(WHEEL, "tune { k } angles;");
        assert_eq!(
            scene.words(&["pin.angle", "wheel.angle"]),
            ["equal wheel.angle", "recovered -wheel.orientation.angle"]
        );
        scene.agrees_to(1e-7);
    }

    #[test]
    fn out_of_the_plane_an_angle_keeps_to_the_pose() {
        let graph = "param k: N*m = 0.4; ground { point O = [0, 0, 0]; }
            body top { mass 1; inertia [0.1, 0.2, 0.3]; start spin [0.7, 0.4, 20]; }
            joint pin: revolute z (ground.O -> top) { stiffness 1e3; tilt stiffness 5; tilt damping 0.1; }
            drive coil on pin torque = -k * pin.angle;
            observe { angle: rad = pin.angle; direction: rad = pin.direction }";
        let scene = scene(graph, "tune { k }");
        scene.agrees_to(1e-9);
        let columns = scene.columns().1;
        let mut before = 0.0;
        for row in columns {
            let turns = (row[0] - row[1]) / std::f64::consts::TAU;
            assert!((turns - turns.round()).abs() < 1e-12, "{turns}");
            assert!((row[0] - before).abs() < 1.5, "it jumps from {before} to {}", row[0]);
            before = row[0];
        }
        let way = scene.reduced.states.iter().position(|state| state.origin.kind() == Kind::Way).expect("a state");
        assert!(scene.reduced.projections.iter().any(|(state, _)| *state == way), "it becomes the angle after a step");
    }

    #[test]
    fn an_angle_at_rest_is_a_number() {
        let graph =
            "ground { point O = [0, 0, 0]; } body wheel { mass 1; inertia [1, 1, 1]; start turned rotation_z(4); }
            joint pin: revolute z (ground.O -> wheel) { rigid; }
            observe { angle: rad = pin.angle; body: rad = wheel.angle }";
        let resting = scene(graph, "");
        assert!(resting.reduced.states.is_empty(), "{}", resting.report);
        for angle in [resting.starts().0, resting.starts().1].concat() {
            assert!((angle - (4.0 - std::f64::consts::TAU)).abs() < 1e-15, "{angle}");
        }
    }

    #[test]
    fn what_nothing_reads_is_no_state() {
        let unread = scene(
            &WHEEL.replace("angle: rad = pin.angle; body: rad = wheel.angle;", "").replace("-k * pin.angle", "-k"),
            "tune { k }",
        );
        assert!(unread.literal.states.iter().all(|state| state.origin.kind() != Kind::Way));
    }

    #[test]
    fn a_junction_has_the_displacement_that_its_flow_has_made() {
        let graph = "param m: kg = 2; param soft: N/m = 0.001; 1 slide: translation; I body = m start 3; \
            param hard: N/m = 8; MSe spring = -hard * slide.displacement;
            C other = soft start 0.1; slide -> body; slide -> other; spring -> slide;
            observe { x: m = slide.displacement; q: m = other.q }";
        let scene = scene(graph, "tune { m }");
        assert_eq!(scene.words(&["slide.displacement"]), ["recovered other.q - 0.1"], "{}", scene.report);
        scene.agrees();
        let (stiffness, mass) = (8.001_f64, 2.0);
        let (literal, _) = scene.columns();
        // 2 x'' = -8 x - 0.001 (x + 0.1), x' = 1.5.
        let (pace, rest) = ((stiffness / mass).sqrt(), -0.0001 / stiffness);
        for (step, row) in literal.iter().enumerate() {
            let t = 0.05 * step as f64;
            let expected = rest - rest * (pace * t).cos() + 1.5 / pace * (pace * t).sin();
            assert!((row[0] - expected).abs() < 1e-8, "{t}: {} for {expected}", row[0]);
        }
    }
}
