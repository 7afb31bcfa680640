//! Orientations that turn about one axis, as angles.
//!
//! In: equations in which an orientation has two components left. Out: the same with one angle in their place, where
//! the components are proved to be its cosine and sine: they start as such, and their rates are those of a rotation,
//! c' = -k s and s' = k c with one k, so the angle's rate is k. Costs a sine and a cosine in the rate for a state less.

use std::collections::BTreeMap;

use super::report::{Fate, Report, show};
use crate::expr::{Function, Id, Node, Pool, Symbol, same_polynomial};
use crate::system::equations::{Origin, State, StateEquations};

/// What rounding may leave of the sum of two squares that is 1.
const ROUNDING: f64 = 1e-14;

/// A cosine and a sine among the states, of one track.
pub(super) struct Turn {
    pub track: usize,
    pub cosine: usize,
    pub sine: usize,
    start: Id,
    pub rate: Id,
}

/// Replaces every planar orientation by its angle.
pub(super) fn integrate(equations: &mut StateEquations, report: &mut Report) {
    let turns = turns(equations);
    let mut images: BTreeMap<usize, Id> = BTreeMap::new();
    let mut kept = vec![true; equations.states.len()];
    for Turn { track, cosine, sine, start, rate } in turns {
        let start = counted(equations, cosine, sine).unwrap_or(start);
        let angle = equations.pool.symbol(Symbol::state(cosine));
        images.insert(cosine, equations.pool.call(Function::Cos, &[angle]));
        images.insert(sine, equations.pool.call(Function::Sin, &[angle]));
        let name = format!("{}.angle", equations.tracks[track]);
        let state = State { name, unit: "rad".to_owned(), origin: Origin::Angle(track), start, rate };
        report.rename(cosine, state.clone());
        equations.states[cosine] = state;
        equations.projections.retain(|(state, _)| ![cosine, sine].contains(state));
        let text = show(equations, images[&sine]);
        report.say(sine, Fate::Recovered(text));
        kept[sine] = false;
    }
    equations.replace(&|symbol| symbol.as_state().and_then(|state| images.get(&state).copied()));
    super::live::keep_states(equations, report, &kept);
}

/// The orientations that turn about one axis.
pub(super) fn turns(equations: &mut StateEquations) -> Vec<Turn> {
    let pairs = pairs(equations).into_iter();
    pairs.filter_map(|(track, cosine, sine)| proved(equations, track, cosine, sine)).collect()
}

/// The orientations with two components left: a track, its diagonal component, and the other.
fn pairs(equations: &StateEquations) -> Vec<(usize, usize, usize)> {
    let mut tracks: BTreeMap<usize, Vec<(usize, bool)>> = BTreeMap::new();
    for (index, state) in equations.states.iter().enumerate() {
        if let Origin::Orientation(track, row, column) = state.origin {
            tracks.entry(track).or_default().push((index, row == column));
        }
    }
    tracks
        .into_iter()
        .filter_map(|(track, components)| match components[..] {
            [(cosine, true), (sine, false)] => Some((track, cosine, sine)),
            _ => None,
        })
        .collect()
}

/// The turn of a cosine and a sine, where start and rates prove that they are one.
fn proved(equations: &mut StateEquations, track: usize, cosine: usize, sine: usize) -> Option<Turn> {
    let [c, s] = [cosine, sine].map(Symbol::state);
    let (cosine_rate, sine_rate) = (equations.states[cosine].rate, equations.states[sine].rate);
    let start = start(&mut equations.pool, equations.states[cosine].start, equations.states[sine].start)?;
    let pool = &mut equations.pool;
    let (cosine_symbol, sine_symbol) = (pool.symbol(c), pool.symbol(s));
    let rate = pool.div(sine_rate, cosine_symbol);
    if pool.symbols(&[rate]).iter().any(|symbol| *symbol == c || *symbol == s) {
        return None;
    }
    let turned = pool.mul(rate, sine_symbol);
    let expected = pool.neg(turned);
    same_polynomial(pool, cosine_rate, expected).then_some(Turn { track, cosine, sine, start, rate })
}

/// Where an angle that counts turns starts from the same cosine and sine: so that its state is this angle and no other.
fn counted(equations: &mut StateEquations, cosine: usize, sine: usize) -> Option<Id> {
    let [x, y] = [cosine, sine].map(|state| equations.states[state].start);
    let pool = &mut equations.pool;
    let turned = pool.neg(y);
    let [forward, backward] = [y, turned].map(|y| pool.call(Function::Atan2, &[y, x]));
    let mut counting = equations.states.iter().filter(|state| matches!(state.origin, Origin::Turn(_)));
    let found = counting.find_map(|state| [forward, backward].into_iter().position(|start| start == state.start))?;
    Some(if found == 0 { forward } else { equations.pool.neg(backward) })
}

/// The angle whose cosine and sine are the start values: 0 for 1 and 0, u for cos u and sin u, -u for cos u and -sin u.
fn start(pool: &mut Pool, cosine: Id, sine: Id) -> Option<Id> {
    if let [Some(c), Some(s)] = [cosine, sine].map(|id| pool.as_number(id)) {
        let is_one = (c * c + s * s - 1.0).abs() < ROUNDING;
        return is_one.then(|| pool.call(Function::Atan2, &[sine, cosine]));
    }
    let Node::Call(Function::Cos, arguments) = pool.node(cosine).clone() else { return None };
    let positive = pool.call(Function::Sin, &arguments);
    if sine == positive {
        return Some(arguments[0]);
    }
    (sine == pool.neg(positive)).then(|| pool.neg(arguments[0]))
}

#[cfg(test)]
mod tests {
    use crate::system::equations::Kind;
    use crate::system::reduce::Fate;
    use crate::system::reduce::tests::scene;

    const PENDULUM: &str = "param tilt: rad = 0.3; gravity [0, -9.81, 0];
        ground { point O = [0, 0, 0]; }
        body bob { mass 2; inertia [0.1, 0.2, 0.3]; point top = [0, 0.5, 0]; start top at [0, 0, 0];
            start turned rotation_z(tilt); }
        joint pivot: revolute z (ground.O -> bob.top) { stiffness 1e4; damping 10; tilt stiffness 10; tilt damping 1; }
        observe { angle: rad = bob.angle; }";

    #[test]
    fn an_orientation_in_the_plane_becomes_its_angle() {
        let scene = scene(PENDULUM, "angles; expect planar;");
        let angle = scene.reduced.states.iter().find(|state| state.origin.kind() == Kind::Angle).expect("an angle");
        assert_eq!((angle.name.as_str(), angle.unit.as_str()), ("bob.orientation.angle", "rad"));
        assert!(scene.reduced.states.iter().all(|state| state.origin.kind() != Kind::Orientation), "{}", scene.report);
        assert!(scene.reduced.projections.is_empty(), "an angle needs no projection");
        assert_eq!(scene.fate("bob.orientation_12"), &Fate::Recovered("sin(bob.orientation.angle)".to_owned()));
        // 2 positions, 2 momenta, angle and angular momentum.
        assert_eq!(scene.report.integrated(), 6);
    }

    #[test]
    fn without_the_clause_and_out_of_the_plane_the_orientation_stays() {
        let plain = scene(PENDULUM, "");
        assert!(plain.reduced.states.iter().all(|state| state.origin.kind() != Kind::Angle));
        let graph = "body top { mass 1; inertia [1, 2, 3]; start spin [0.1, 0, 2]; } observe { top.orientation; }";
        let spatial = scene(graph, "angles;");
        assert!(spatial.reduced.states.iter().all(|state| state.origin.kind() != Kind::Angle), "{}", spatial.report);
    }
}
