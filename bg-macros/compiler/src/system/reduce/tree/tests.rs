//! Bodies on hinges beside their literal graphs, in states that no run has chosen; what is not reduced so.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::expr::{Environment, Id, Symbol, derivative, evaluate};
use crate::random::Random;
use crate::system::reduce::tests::{Draw, Scene, scene};

/// A state with all outputs of `bodies` bodies and `others`.
fn observed(bodies: usize, others: &str) -> String {
    let mut text = String::new();
    for k in 0..bodies {
        let _ = write!(
            text,
            "x{k}: m = b{k}.position; r{k} = b{k}.orientation; p{k}: kg*m/s = b{k}.p; h{k}: kg*m^2/s = b{k}.h; "
        );
    }
    format!("observe {{ {text} {others} }}")
}

/// The operations of a rate after the last reduction.
fn operations(scene: &Scene) -> usize {
    scene.report.counts.last().expect("a count").operations
}

/// Panics unless, in states at random, the literal states have the rates that the reduced model gives their images, and
/// all outputs and energies are the same.
fn agrees(scene: &Scene) {
    let (mut literal, mut reduced) = (scene.literal.clone(), scene.reduced.clone());
    let mut draw = Draw(Random::new(7));
    let outputs: Vec<Id> = reduced.outputs.iter().map(|output| output.value).collect();
    let seeds: BTreeMap<Symbol, Id> =
        reduced.states.iter().enumerate().map(|(k, state)| (Symbol::state(k), state.rate)).collect();
    let rates = derivative(&mut reduced.pool, &outputs, &seeds);
    let roots: Vec<Id> = outputs.iter().chain(&rates).chain([&reduced.stored]).copied().collect();
    let values: Vec<Id> = literal.outputs.iter().map(|output| output.value).collect();
    let seeds: BTreeMap<Symbol, Id> =
        literal.states.iter().enumerate().map(|(k, state)| (Symbol::state(k), state.rate)).collect();
    let slopes = derivative(&mut literal.pool, &values, &seeds);
    let others: Vec<Id> = values.iter().chain(&slopes).chain([&literal.stored]).copied().collect();
    for _ in 0..4 {
        let states: Vec<f64> = reduced.states.iter().map(|_| draw.number()).collect();
        let negative = vec![false; reduced.switches.len()];
        let found = evaluate(
            &reduced.pool,
            &roots,
            &Environment { states: &states, negative: &negative, ..Environment::default() },
        );
        let by_name: BTreeMap<&str, f64> =
            reduced.outputs.iter().map(|output| output.name.as_str()).zip(found.iter().copied()).collect();
        let value = |name: &str| {
            let Some((body, rest)) = name.strip_prefix('b').and_then(|name| name.split_once('.')) else { return 0.0 };
            let (letter, suffix) = match rest.split_once('_') {
                Some(("position", suffix)) => ('x', suffix),
                Some(("orientation", suffix)) => ('r', suffix),
                Some(("linear.p", suffix)) => ('p', suffix),
                Some(("angular.p", suffix)) => ('h', suffix),
                _ => return 0.0,
            };
            by_name[format!("{letter}{body}_{suffix}").as_str()]
        };
        let full: Vec<f64> = literal.states.iter().map(|state| value(&state.name)).collect();
        let negative = vec![false; literal.switches.len()];
        let expected = evaluate(
            &literal.pool,
            &others,
            &Environment { states: &full, negative: &negative, ..Environment::default() },
        );
        let size = expected.iter().fold(1.0_f64, |size, value| size.max(value.abs()));
        for (k, (found, expected)) in found.iter().zip(&expected).enumerate() {
            let name = &reduced.outputs[k % reduced.outputs.len()].name;
            assert!((found - expected).abs() < 1e-10 * size, "{k} {name}: {found} {expected}\n{}", scene.report);
        }
    }
}

/// Hinges one after the other about these axes, with offsets and tensors that are not diagonal.
fn chain(axes: &[&str], clauses: &str) -> String {
    let mut text = "gravity [0, 0, -9.81]; ground { point O = [0, 0, 0.3]; }".to_owned();
    let mut place = [0.0, 0.0, 0.3];
    for (k, axis) in axes.iter().enumerate() {
        let upper = if k == 0 { "ground.O".to_owned() } else { format!("b{}.low", k - 1) };
        let [x, y, z] = place;
        let _ = write!(
            text,
            "body b{k} {{ mass {}; inertia [[0.1, 0.01, 0.02], [0.01, 0.2, -0.03], [0.02, -0.03, 0.15]];
                point top = [0.1, 0.2, 0.5]; point low = [0.2, -0.1, -0.4]; start top at [{x}, {y}, {z}]; }}
             joint j{k}: revolute {axis} ({upper} -> b{k}.top) {{ rigid; }} {clauses}",
            1 + k
        );
        place = [x + 0.1, y - 0.3, z - 0.9];
    }
    text
}

#[test]
fn a_pendulum_about_any_axis_has_an_angle_and_a_speed() {
    for axis in ["x", "y"] {
        let scene = scene(&format!("{} {}", chain(&[axis], ""), observed(1, "")), "tune {}");
        assert_eq!(scene.left(), ["j0.q", "j0.u"], "{}", scene.report);
        agrees(&scene);
    }
}

#[test]
fn hinges_one_after_the_other_move_as_their_bodies_do() {
    for (axes, expected) in [(&["y", "z"][..], 95), (&["z", "x", "y"], 409), (&["x", "x"], 67)] {
        let scene = scene(&format!("{} {}", chain(axes, ""), observed(axes.len(), "")), "tune {}");
        assert_eq!(scene.left().len(), 2 * axes.len(), "{}", scene.report);
        agrees(&scene);
        assert_eq!(operations(&scene), expected, "{axes:?}");
    }
}

/// Two bodies on one, one of them on a hinge whose axis is along no coordinate axis.
const BRANCHES: &str = "body b2 { mass 3; inertia [0.1, 0.2, 0.3]; point top = [0, 0.1, 0.2] turned rotation_x(0.4); start top at [0.3, -0.3, -0.6];
        start turned rotation_y(0.3); }
    joint j2: revolute y (b0.side -> b2.top) { rigid; }";

fn branches(axes: &[&str], others: &str) -> String {
    let side = "point side = [0.3, -0.1, -0.4 + 0.1] turned rotation_y(0.3) * rotation_x(0.4);";
    chain(axes, "").replacen("point low", &format!("{side} point low"), 1)
        + &BRANCHES.replace("[0.3, -0.3, -0.6]", "[0.2, -0.3, -0.5]")
        + others
}

#[test]
fn a_tree_with_branches_moves_as_its_bodies_do() {
    let scene = scene(&format!("{} {}", branches(&["z", "x"], ""), observed(3, "")), "tune {}");
    assert_eq!(scene.left().len(), 6, "{}", scene.report);
    agrees(&scene);
}

/// What acts about hinges, on bodies and between them, by laws of angles and speeds.
#[test]
fn loads_of_all_kinds_are_those_of_the_bodies() {
    let loads = "drive m on j1 torque = 3 - 2 * j1.angle - 0.3 * j1.speed; drive n on j0 torque = 1.5 * j1.speed;
        drive f on b1.low force = [1, 2, 3]; drive twist on b1 torque = [0.3, 0, 0.1];
        spring s (ground.O -> b1.low) { stiffness 20; length 0.1; damping 0.4; }";
    let others = "a: rad = j1.angle; w: rad/s = j1.speed; e: W = m.power;";
    let scene = scene(&format!("{} {loads} {}", chain(&["y", "z"], ""), observed(2, others)), "tune {}");
    assert_eq!(scene.left().len(), 4, "{}", scene.report);
    agrees(&scene);
}

/// Chains for which the matrix of all reactions would take minutes: each hinge after the first few takes as many
/// operations.
#[test]
fn operations_grow_as_the_number_of_hinges() {
    let count = |hinges: usize| {
        let axes: Vec<&str> = (0..hinges).map(|k| ["y", "z"][k % 2]).collect();
        let angles: String = (0..hinges).map(|k| format!("a{k}: rad = j{k}.angle; ")).collect();
        operations(&scene(&format!("{} observe {{ {angles} }}", chain(&axes, "")), "tune {}"))
    };
    assert_eq!([8, 16, 24].map(count), [2326, 5393, 8459]);
}

/// What the recursion does not know keeps its rows.
#[test]
fn a_loop_and_dry_friction_leave_bodies_as_they_are() {
    let brake = "friction brake on j1 { coulomb 5; }";
    for others in ["joint shut: spherical (ground.O -> b1.low) { rigid; }", brake] {
        let text = format!("graph G {{ {} {others} scene Reduced {{ tune {{}} }} }}", chain(&["y", "z"], ""));
        let Ok(source) = crate::source::syntax::parse(text.parse().expect("tokens")) else { panic!("{others}") };
        let variant = crate::source::scene::variants(&source.graphs[0]).expect("scenes").remove(1);
        let mut equations = crate::pipeline::derive(&variant.graph).expect("equations").equations;
        let mut report = crate::system::reduce::Report::new(&equations);
        assert!(super::put(&mut equations, &mut report).is_none(), "{others}");
    }
}

/// What pictures would show of a reaction is not known, and the rest is a number.
#[test]
fn pictures_show_what_is_known() {
    let scene = scene(&format!("{} {}", chain(&["y", "z"], ""), observed(2, "")), "tune {}");
    let [literal, reduced] = [&scene.literal, &scene.reduced].map(|of| of.shown.quantities());
    let known = reduced.iter().filter(|quantity| quantity.is_some()).count();
    assert!(known > 20 && known < literal.len(), "{known} of {}", literal.len());
    let states = vec![0.3; scene.reduced.states.len()];
    let ids: Vec<Id> = reduced.into_iter().flatten().flatten().copied().collect();
    let values = evaluate(&scene.reduced.pool, &ids, &Environment { states: &states, ..Environment::default() });
    assert!(values.iter().all(|value| value.is_finite()), "{values:?}");
}
