//! Bodies on hinges beside their literal graphs, in states that no run has chosen; what is not reduced so.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::expr::{Environment, Id, Symbol, derivative, evaluate, substitute};
use crate::program::{Request, schedule};
use crate::random::Random;
use crate::system::equations::stage::Ordered;
use crate::system::equations::{Origin, State, StateEquations};
use crate::system::jacobian::{self, Jacobian};
use crate::system::reduce::reaction;
use crate::system::reduce::tests::{Draw, Scene, scene};

mod loops;

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
    scene.report.counts.last().and_then(|count| count.operations).expect("a count")
}

/// Makes the components of orientations that are states those of a rotation at random (Euler, Rodrigues).
fn turn(of: &[State], states: &mut [f64], draw: &mut Draw) {
    let mut drawn: BTreeMap<usize, [f64; 4]> = BTreeMap::new();
    for (state, value) in of.iter().zip(states) {
        let Origin::Orientation(track, row, column) = state.origin else { continue };
        let [w, x, y, z] = *drawn.entry(track).or_insert_with(|| [0; 4].map(|_| draw.number()));
        let (norm, v) = (w * w + x * x + y * y + z * z, [x, y, z]);
        let turned = if row == column {
            w * w + 2.0 * v[row] * v[row] - (x * x + y * y + z * z)
        } else {
            let side = if (row + 1) % 3 == column { -w } else { w };
            2.0 * (v[row] * v[column] + side * v[3 - row - column])
        };
        *value = turned / norm;
    }
}

/// The states of the literal graph, where the reduced model has these and outputs that begin with these values.
fn literal_states(Scene { literal, reduced, .. }: &Scene, states: &[f64], outputs: &[f64]) -> Vec<f64> {
    let by_name: BTreeMap<&str, f64> =
        reduced.outputs.iter().map(|output| output.name.as_str()).zip(outputs.iter().copied()).collect();
    let value = |name: &str| {
        if let Some(own) = reduced.states.iter().position(|state| state.name == name) {
            return states[own];
        }
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
    literal.states.iter().map(|state| value(&state.name)).collect()
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
    let roots: Vec<Id> = outputs.iter().chain(&rates).chain([&reduced.balance.stored]).copied().collect();
    let values: Vec<Id> = literal.outputs.iter().map(|output| output.value).collect();
    let seeds: BTreeMap<Symbol, Id> =
        literal.states.iter().enumerate().map(|(k, state)| (Symbol::state(k), state.rate)).collect();
    let slopes = derivative(&mut literal.pool, &values, &seeds);
    let others: Vec<Id> = values.iter().chain(&slopes).chain([&literal.balance.stored]).copied().collect();
    for _ in 0..4 {
        let mut states: Vec<f64> = reduced.states.iter().map(|_| draw.number()).collect();
        turn(&reduced.states, &mut states, &mut draw);
        let negative: Vec<bool> = reduced.switches.iter().map(|_| draw.number() > 0.0).collect();
        let found = evaluate(
            &reduced.pool,
            &roots,
            &Environment { states: &states, negative: &negative, ..Environment::default() },
        );
        let full = literal_states(scene, &states, &found);
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
    joined(&axes.iter().map(|axis| format!("revolute {axis}")).collect::<Vec<_>>(), clauses)
}

/// The same with joints of these kinds; one with `<` before it goes from the second body to the first.
fn joined(kinds: &[String], clauses: &str) -> String {
    let mut text = "gravity [0, 0, -9.81]; ground { point O = [0, 0, 0.3]; }".to_owned();
    let mut place = [0.0, 0.0, 0.3];
    for (k, kind) in kinds.iter().enumerate() {
        let upper = if k == 0 { "ground.O".to_owned() } else { format!("b{}.low", k - 1) };
        let [x, y, z] = place;
        let (kind, ends) = match kind.strip_prefix('<') {
            Some(kind) => (kind, format!("b{k}.top -> {upper}")),
            None => (kind.as_str(), format!("{upper} -> b{k}.top")),
        };
        let _ = write!(
            text,
            "body b{k} {{ mass {}; inertia [[0.1, 0.01, 0.02], [0.01, 0.2, -0.03], [0.02, -0.03, 0.15]];
                point top = [0.1, 0.2, 0.5]; point low = [0.2, -0.1, -0.4]; start top at [{x}, {y}, {z}]; }}
             joint j{k}: {kind} ({ends}) {{ rigid; }} {clauses}",
            1 + k
        );
        place = [x + 0.1, y - 0.3, z - 0.9];
    }
    text
}

#[test]
fn a_pendulum_about_any_axis_has_an_angle_and_a_speed() {
    for (axis, gravity) in [("x", "[0, 0, -9.81]"), ("y", "[0, 0, -9.81]"), ("z", "[0, -9.81, 0]")] {
        let pendulum = chain(&[axis], "").replacen("[0, 0, -9.81]", gravity, 1);
        let scene = scene(&format!("{pendulum} {}", observed(1, "")), "tune {}");
        assert_eq!(scene.left(), ["j0.q", "j0.u"], "{}", scene.report);
        agrees(&scene);
    }
}

#[test]
fn hinges_one_after_the_other_move_as_their_bodies_do() {
    for (axes, expected) in [(&["y", "z"][..], 73), (&["z", "x", "y"], 300), (&["x", "x"], 62)] {
        let scene = scene(&format!("{} {}", chain(axes, ""), observed(axes.len(), "")), "tune {}");
        assert_eq!(scene.left().len(), 2 * axes.len(), "{}", scene.report);
        agrees(&scene);
        assert_eq!(operations(&scene), expected, "{axes:?}");
    }
}

/// Links of a plane that lie beside each other, whose joints hold them against moments across it.
const BESIDE: &str = "gravity [0, -9.81, 0]; ground { point O = [0, 0, 0]; point C = [0.4, 0, 0]; }
    body b0 { mass 1; inertia [1e-3, 1e-3, 2e-3]; point foot = [0, -0.05, 0]; point head = [0, 0.05, 0.02]; \
    start foot at [0, 0, 0]; }
    body b1 { mass 2; inertia [1e-3, 2e-2, 2e-2]; point left = [-0.2, 0, 0]; point right = [0.2, 0, 0.01]; \
    start left at [0, 0.1, 0.02]; }
    joint o: revolute z (ground.O -> b0.foot) { rigid; } joint a: revolute z (b0.head -> b1.left) { rigid; }";

#[test]
fn links_beside_each_other_turn_by_angles() {
    for (others, outputs) in
        [("", ""), ("drive f on b1.right force = [1, 2, 3];", "f: N = a.force; m: N*m = o.moment;")]
    {
        let scene = scene(&format!("{BESIDE} {others} {}", observed(2, outputs)), "tune {}");
        assert_eq!(scene.left(), ["o.q", "o.u", "a.q", "a.u"], "{}", scene.report);
        assert_eq!(operations(&scene), if others.is_empty() { 27 } else { 42 }, "{others}");
        agrees(&scene);
    }
}

#[test]
fn a_flat_tree_that_is_pushed_across_turns_by_angles() {
    let flat = BESIDE.replace("0.02];", "0];").replace("0.01];", "0];").replace("0.1, 0.02]", "0.1, 0]");
    let of = |others: &str| scene(&format!("{flat} {others} {}", observed(2, "")), "tune {}");
    assert!(of("").left().iter().all(|state| !state.ends_with(".u")), "bodies' own momenta take less");
    let scene = of("drive f on b1.right force = [0, 0, 3];");
    assert_eq!(scene.left(), ["o.q", "o.u", "a.q", "a.u"], "{}", scene.report);
    agrees(&scene);
}

#[test]
fn a_loop_of_links_beside_each_other_is_one_of_the_plane() {
    let rocker =
        "body b2 { mass 1; inertia [1e-2, 1e-3, 1e-2]; point foot = [0, -0.05, 0]; point head = [0, 0.05, 0.03];
            start foot at [0.4, 0, 0]; }
        joint b: revolute z (b1.right -> b2.head) { rigid; } joint c: revolute z (ground.C -> b2.foot) { rigid; }";
    let scene = scene(&format!("{BESIDE} {rocker} {}", observed(3, "")), "tune {}");
    assert_eq!(scene.left().len(), 6, "{}", scene.report);
    assert_eq!(operations(&scene), 291);
}

/// Two bodies on one, one of them on a hinge whose axis is along no coordinate axis.
const BRANCHES: &str = "body b2 { mass 3; inertia [0.1, 0.2, 0.3]; point top = [0, 0.1, 0.2] turned rotation_x(0.4); \
    start top at [0.3, -0.3, -0.6];
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

/// Joints of all kinds between the ground and bodies, from either end.
#[test]
fn joints_of_all_kinds_move_as_their_bodies_do() {
    let all = [
        (&["prismatic z"][..], 2),
        (&["prismatic z", "revolute y"], 4),
        (&["revolute y", "prismatic x", "revolute x"], 6),
        (&["revolute x", "<prismatic z", "<revolute y"], 6),
        (&["cylindrical z", "revolute x"], 6),
        (&["revolute y", "<cylindrical x"], 6),
        (&["universal x y", "revolute z"], 6),
        (&["revolute z", "<universal z x"], 6),
        (&["revolute y", "fixed", "revolute x"], 4),
        (&["fixed", "revolute x", "<fixed", "prismatic y"], 4),
        (&["spherical", "revolute x"], 14),
        (&["revolute y", "<spherical", "fixed", "prismatic z"], 16),
        (&["spherical", "spherical"], 24),
    ];
    for (kinds, states) in all {
        let kinds: Vec<String> = kinds.iter().map(|&kind| kind.to_owned()).collect();
        let scene = put(&format!("{} {}", joined(&kinds, ""), observed(kinds.len(), "")));
        assert_eq!(scene.reduced.states.len(), states, "{kinds:?}: {:?}", scene.left());
        agrees(&scene);
    }
}

/// A body on no joint carries others, with a ball and a spring on it.
#[test]
fn a_floating_base_moves_as_its_bodies_do() {
    let kinds = ["revolute y", "<universal x y", "prismatic z"].map(str::to_owned);
    let text = joined(&kinds, "")
        .replace(
            "ground { point O = [0, 0, 0.3]; }",
            "ground { point O = [0, 0, 0.3]; }
        body base { mass 4; inertia [0.4, 0.5, 0.6]; point hip = [0.1, 0, -0.3]; point side = [-0.2, 0.3, 0.1]; \
        start hip at [0, 0, 0.3]; }
        body b3 { mass 2; inertia [0.1, 0.2, 0.3]; point top = [0, 0.5, 0]; start top at [-0.3, 0.3, 0.7]; }
        joint hang: spherical (base.side -> b3.top) { rigid; }
        spring s (ground.O -> b3) { stiffness 20; length 0.1; damping 0.4; \
        }",
        )
        .replace("ground.O -> b0", "base.hip -> b0");
    let scene = put(&format!("{text} {}", observed(4, "")));
    assert_eq!(scene.reduced.states.len(), 18 + 12 + 2 + 4 + 2, "{:?}", scene.left());
    agrees(&scene);
    let alone = "body free { mass 2; inertia [0.1, 0.2, 0.3]; } ";
    let text = format!("{alone} {} {}", chain(&["x", "z"], ""), observed(2, ""));
    assert_eq!(put(&text).reduced.states.len(), 18 + 4);
}

/// The angles that laws read are the coordinates, from either end and with points turned by quarters; a state that
/// counts turns is none of its own. Beside the literal graph in a run.
#[test]
fn angles_that_are_read_are_the_coordinates() {
    let quarter = std::f64::consts::FRAC_PI_2;
    for ends in ["ground.O -> a.top", "a.top -> ground.O"] {
        for second in ["a.low -> b.top", "b.top -> a.low"] {
            let text = format!(
                "gravity [0, 0, -9.81]; ground {{ point O = [0, 0, 0.3]; }}
                 body a {{ mass 2; inertia [0.1, 0.2, 0.3]; point top = [0, 0.1, 0.2] turned rotation_x({quarter}); \
                 start turned rotation_x(-{quarter});
                     point low = [0.1, 0, -0.4] turned rotation_z({quarter}); start top at [0, 0, 0.3]; }}
                 joint i: revolute x ({ends}) {{ rigid; }}
                 body b {{ mass 1; inertia [0.2, 0.1, 0.15]; point top = [0.1, 0, 0.3] turned rotation_y(-{quarter});
                     start turned rotation_x(-{quarter}) * rotation_z({quarter}) * rotation_y({quarter}); \
                     start top at [0.1, -0.6, 0.4]; }}
                 joint j: revolute y ({second}) {{ rigid; }}
                 drive turn on i torque = -3 * i.angle; drive back on j torque = 0.5 - 2 * j.angle - 0.1 * j.speed;
                 observe {{ a.position; b.position; p: rad = i.angle; q: rad = j.angle; w: rad/s = j.speed; }}"
            );
            let scene = scene(&text, "tune {}");
            assert_eq!(scene.left().len(), 4, "{}", scene.report);
            for joint in ["i", "j"] {
                let word = &scene.words(&[&format!("{joint}.angle")])[0];
                assert!([format!("equal {joint}.q"), format!("recovered {joint}.q")].contains(word), "{word}");
            }
            // Runge-Kutta's steps err so in the literal coordinates.
            scene.agrees_to(1e-5);
        }
    }
}

/// Points by sums of decimals meet but for rounding, 8.7e-19 m here: the numbers are those of a published double
/// pendulum.
#[test]
fn rounding_of_places_tears_no_joint() {
    let text = "gravity [0, 0, -9.81]; ground { point O = [0.0060872, 0, 0.035]; }
        body b0 { mass 0.26703; center [0.0086107, 2.1727e-6, 0.036012];
            inertia [[4.0827e-4, 1.2675e-9, 1.8738e-5], [1.2675e-9, 3.8791e-4, 3.5443e-8], [1.8738e-5, 3.5443e-8, \
            3.6421e-5]];
            point low = [0.023, 0, 0.1]; start at [0.0060872, 0, 0.035]; }
        joint i: revolute x (ground.O -> b0) { rigid; }
        body b1 { mass 0.33238; center [-0.0050107, 1.9371e-10, 0.10088];
            inertia [[0.0011753, -3.854e-13, -2.9304e-8], [-3.854e-13, 0.0011666, -5.2365e-12], [-2.9304e-8, \
            -5.2365e-12, 1.4553e-5]];
            start at [0.0060872, 0, 0.035] + [0.023, 0, 0.1]; }
        joint j: revolute x (b0.low -> b1) { rigid; }
        drive m on i torque = 0.1;";
    let scene = scene(&format!("{text} {}", observed(2, "p: rad = i.angle; q: rad = j.angle;")), "tune {}");
    assert_eq!(scene.left().len(), 4, "{}", scene.report);
    agrees(&scene);
    assert_eq!(operations(&scene), 63);
}

/// What acts along slides, and is taken out of the forces and the moments of both bodies.
#[test]
fn forces_along_slides_are_those_of_the_bodies() {
    let kinds = ["prismatic z", "revolute y", "<cylindrical x"].map(str::to_owned);
    let loads = "drive push on j0 force = 3 - 20 * j0.travel; friction rub on j2 { coulomb 2; viscous 0.3; \
        } drive turn on j2 torque = 0.2;";
    let scene = put(&format!("{} {loads} {}", joined(&kinds, ""), observed(3, "d: m = j2.travel;")));
    assert_eq!(scene.reduced.states.len(), 8, "{:?}", scene.left());
    agrees(&scene);
    let count = |loads: &str| operations(&put(&format!("{} {loads} {}", joined(&kinds, ""), observed(3, ""))));
    let push =
        "param p: N*s/rad = 3; drive push on j0 force = p * j1.speed; drive pull on j2 force = 2 * p * j1.speed;";
    assert_eq!(count(push), count("") + 7);
}

/// Bodies that start turned and moving in their joints, beside their literal graph in a run.
#[test]
fn coordinates_start_where_the_bodies_do() {
    let text = "gravity [0, 0, -9.81]; ground { point O = [0, 0, 0.3]; }
        body a { mass 2; inertia [0.1, 0.2, 0.3]; point top = [0, 0.1, 0.2]; start turned rotation_z(0.4);
            start top at [0, 0, 0.5]; start velocity [0, 0, 0.3] + cross([0, 0, 0.7], [sin(0.4) * 0.1, -cos(0.4) * \
            0.1, 0]); start spin [0, 0, 0.7]; }
        joint guide: cylindrical z (ground.O -> a.top) { rigid; }
        body b { mass 1; inertia [0.2, 0.1, 0.15]; point top = [0.1, 0, 0.3]; \
        start turned rotation_z(0.4) * rotation_x(0.5) * rotation_y(-0.8);
            start top at [0, 0, 0.5]; start spin [0, 0, 0.7];
            start velocity [0, 0, 0.3] - cross([0, 0, 0.7], rotation_z(0.4) * rotation_x(0.5) * rotation_y(-0.8) * \
            [0.1, 0, 0.3]); }
        joint cross: universal x y (a.top -> b.top) { rigid; }
        observe { a.position; b.position; a.orientation; b.orientation; d: m = guide.travel; w: rad/s = guide.speed; }";
    let scene = scene(text, "tune {}");
    assert_eq!(scene.left().len(), 8, "{}", scene.report);
    scene.agrees_to(1e-9);
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
    assert_eq!([8, 16, 24].map(count), [1914, 4520, 7105]);
    let rods = [8, 16].map(|hinges: usize| operations(&scene(&rods(hinges), "tune {}")));
    assert_eq!(rods, [1079, 2599]);
}

/// Rods of 1 m and 1 kg, level, on hinges about y and z by turns, under gravity along no axis.
fn rods(hinges: usize) -> String {
    let mut text = "gravity [1, -3, -9]; ground { point O = [0, 0, 0]; } ".to_owned();
    for k in 0..hinges {
        let upper = if k == 0 { "ground.O".to_owned() } else { format!("b{}.right", k - 1) };
        let axis = ["y", "z"][k % 2];
        let _ = write!(
            text,
            "body b{k} {{ mass 1; inertia [1e-3, 1 / 12, 1 / 12]; point left = [-0.5, 0, 0]; point right = [0.5, 0, 0];
                start left at [{k}, 0, 0]; }}
             joint j{k}: revolute {axis} ({upper} -> b{k}.left) {{ rigid; }} "
        );
    }
    let angles: String = (0..hinges).map(|k| format!("a{k}: rad = j{k}.angle; ")).collect();
    format!("{text} observe {{ {angles} }}")
}

/// The equations in joint coordinates beside the literal ones, whichever are shorter.
fn put(statements: &str) -> Scene {
    let text = format!("graph G {{ {statements} scene Reduced {{ tune {{}} }} }}");
    let source = crate::source::syntax::parse(text.parse().expect("tokens")).unwrap_or_else(|_| panic!("{statements}"));
    let variant = crate::source::scene::variants(&source.graphs[0]).expect("scenes").remove(1);
    let derived = crate::pipeline::derive(&variant.graph).expect("equations").equations;
    let (mut literal, mut reduced) = (derived.clone(), derived);
    let mut report = crate::system::reduce::Report::new(&reduced);
    super::put(
        &mut reduced,
        &mut report,
        (super::Which::NotFlat, super::Loops::Held),
        &mut crate::program::rate_operations,
    )
    .unwrap_or_else(|| panic!("no tree: {statements}"));
    for equations in [&mut literal, &mut reduced] {
        reaction::solve(equations);
        equations.close();
        let one = equations.pool.one();
        equations.replace(&|symbol| matches!(symbol, Symbol::Kept(_)).then_some(one));
        // Outputs keep the symbols of reactions that joints may share.
        let solution = equations.solution.clone();
        equations.replace(&|symbol| solution.value(symbol));
    }
    let operations = crate::program::rate_operations(&mut reduced);
    report.count("joints by their coordinates", reduced.states.len(), Some(operations));
    Scene { literal, tuned: vec![false; reduced.parameters.len()], reduced, report }
}

/// Frictions on joints' own speeds, one on each, take a few operations a joint: beside the literal graph, sticking and
/// sliding at random, with their efforts.
#[test]
fn dry_friction_of_joints_costs_as_the_number_of_hinges() {
    let axes = ["y", "z", "x", "y"];
    let brakes = |count: usize| -> String {
        (0..count).map(|k| format!("friction brake{k} on j{k} {{ coulomb {}; viscous 0.3; }} ", 2 + k)).collect()
    };
    let efforts = |count: usize| -> String { (0..count).map(|k| format!("e{k}: N*m = brake{k}.effort; ")).collect() };
    let of = |count: usize| put(&format!("{} {} {}", chain(&axes, ""), brakes(count), observed(4, &efforts(count))));
    for count in [1, 2, 4] {
        let scene = of(count);
        assert!(scene.reduced.solution.values.is_empty(), "{}", scene.report);
        agrees(&scene);
    }
    assert_eq!([0, 2, 4].map(|count| operations(&of(count))), [631, 655, 765]);
}

/// What else is held: a joint that closes a loop, dry friction, a stop; free bodies that a joint holds at the tree.
#[test]
fn what_else_is_held_has_the_rates_of_the_bodies() {
    let four = ["y", "z", "x", "y"];
    let ball = "joint shut: spherical (ground.P -> b3.low) { rigid; }";
    let guide = "joint guide: cylindrical z (ground.P -> b3.low) { rigid; }";
    let brakes = "friction brake on j1 { coulomb 5; viscous 0.3; } friction slow on j3 { coulomb 2; }";
    let ends = "stop end on j1 { at most 0.2; restitution 0.5; } stop side on j2 { at least -1; restitution 0; }";
    let hung = "body b4 { mass 2; inertia [0.1, 0.2, 0.3]; point top = [0, 0.5, 0]; start top at [0.4, -1.2, -3.3]; }
        joint hang: spherical (b3.low -> b4.top) { rigid; }";
    for (others, states) in [(ball, 8), (guide, 8), (brakes, 8), (ends, 10), (hung, 20)] {
        let grounded = chain(&four, "").replacen("point O", "point P = [1.1, 0.2, -2.5]; point O", 1);
        let bodies = if others == hung { 5 } else { 4 };
        let scene = put(&format!("{grounded} {others} {}", observed(bodies, "")));
        assert_eq!(scene.reduced.states.len(), states, "{others}: {:?}", scene.left());
        agrees(&scene);
    }
}

/// Of the stops of equations the effort or the gap of each guard, how flows and their rates are, and how impulses of
/// these stops change the flows of all, while rigid joints hold.
fn of_stops(equations: &StateEquations, environment: &Environment<'_>) -> Vec<f64> {
    let impacts = &equations.impacts;
    let rigid = impacts.rigid.len();
    let guards = equations.switches.iter().map(|switch| switch.guard);
    let flows = impacts.stops.iter().flat_map(|stop| [stop.slip.flow, stop.acceleration]);
    let ids: Vec<Id> = guards.chain(flows).collect();
    let mut all = evaluate(&equations.pool, &ids, environment);
    let mut matrix: Vec<Vec<f64>> =
        impacts.matrix.iter().map(|row| evaluate(&equations.pool, row, environment)).collect();
    for pivot in 0..rigid {
        let column: Vec<f64> = matrix[pivot..].iter().map(|row| row[pivot]).collect();
        for (i, row) in matrix.iter_mut().enumerate().skip(pivot + 1) {
            for j in pivot + 1..=i {
                row[j] -= column[i - pivot] * column[j - pivot] / column[0];
            }
        }
    }
    all.extend(matrix[rigid..].iter().flat_map(|row| row[rigid..].to_vec()));
    all
}

/// Joints that rest on stops, or stick, have known accelerations: what guards tell, how flows change and what impacts
/// are calculated from is what it is in the literal graph, also beside rows that joints share, and takes few
/// operations.
#[test]
fn joints_that_rest_on_stops_are_locked() {
    const BOTH: &str = "stop a on j0 { at least -0.3; at most 0.2; restitution 0.5; }
        stop b on j2 { at most 0.1; restitution 0; }";
    const ROUGH: &str = "stop a on j1 { at most 0.2; restitution 0.5; } friction c on j1 { coulomb 5; viscous 1; }
        friction d on j2 { coulomb 2; }";
    const TIED: &str = "stop a on j0 { at most 0.2; restitution 0.5; } stop b on j1 { at least -0.2; restitution 0; }
        TF ratio = 0.5; 0 tie: translation; rSe follows = 0; j1.slide -> ratio -> tie -> j2.slide; follows -> tie;";
    // With switches that are not all positive: two holds on one joint are nothing that the literal graph can be
    // compared in.
    let cases: [(&[&str], &str, &[usize]); 3] = [
        (&["revolute y", "revolute z", "revolute x"], BOTH, &[0, 1]),
        (&["revolute y", "revolute z", "revolute x"], ROUGH, &[0, 1, 2]),
        (&["revolute y", "prismatic x", "prismatic z"], TIED, &[]),
    ];
    let mut counts = Vec::new();
    for (kinds, others, of_one_joint) in cases {
        let kinds: Vec<String> = kinds.iter().map(|&kind| kind.to_owned()).collect();
        let scene = put(&format!("{} {others} {}", joined(&kinds, ""), observed(3, "")));
        let (reduced, literal) = (&scene.reduced, &scene.literal);
        let outputs: Vec<Id> = reduced.outputs.iter().map(|output| output.value).collect();
        let mut draw = Draw(Random::new(5));
        let switches = reduced.switches.len();
        for branch in 0..1_u32 << switches {
            let negative: Vec<bool> = (0..switches).map(|switch| branch >> switch & 1 == 1).collect();
            if !of_one_joint.is_empty() && of_one_joint.iter().all(|&switch| !negative[switch]) {
                continue;
            }
            let states: Vec<f64> = reduced.states.iter().map(|_| draw.number()).collect();
            let own = Environment { states: &states, negative: &negative, ..Environment::default() };
            let full = literal_states(&scene, &states, &evaluate(&reduced.pool, &outputs, &own));
            let [found, wanted] = [of_stops(reduced, &own), of_stops(literal, &Environment { states: &full, ..own })];
            let stops = reduced.impacts.stops.len();
            assert!(found.len() == switches + 2 * stops + stops * (stops + 1) / 2 && stops > 0, "{others}");
            assert_eq!(found.len(), wanted.len(), "{others}");
            let size = wanted.iter().fold(1.0_f64, |size, value| size.max(value.abs()));
            for (k, (found, wanted)) in found.iter().zip(&wanted).enumerate() {
                assert!((found - wanted).abs() < 1e-10 * size, "{k}: {found} {wanted}, {negative:?}\n{others}");
            }
        }
        agrees(&scene);
        counts.push(operations(&scene));
    }
    assert_eq!(counts, [374, 383, 127]);
}

/// Forces and moments of joints of all kinds are those of the literal graph, with what acts along and about them; they
/// take nothing of a rate.
#[test]
fn reactions_are_those_of_the_bodies() {
    let all = [
        &["revolute y", "prismatic x"][..],
        &["revolute x", "<prismatic z", "<revolute y"],
        &["universal x y", "<cylindrical x"],
        &["spherical", "<universal z x"],
    ];
    let loads = "spring s (ground.O -> b1.low) { stiffness 20; length 0.1; damping 0.4; }
        drive f on b1.low force = [1, 2, 3]; drive twist on b0 torque = [0.3, 0, 0.1];";
    for kinds in all {
        let kinds: Vec<String> = kinds.iter().map(|&kind| kind.to_owned()).collect();
        let forces: String =
            (0..kinds.len()).map(|k| format!("f{k}: N = j{k}.force; m{k}: N*m = j{k}.moment; ")).collect();
        let forces = if kinds[0] == "spherical" { forces.replace("m0: N*m = j0.moment; ", "") } else { forces };
        let slide = kinds.iter().position(|kind| kind.contains("prismatic"));
        let push = slide.map_or_else(String::new, |k| format!("drive push on j{k} force = 3 - 20 * j{k}.travel;"));
        let of =
            |outputs: &str| put(&format!("{} {loads} {push} {}", joined(&kinds, ""), observed(kinds.len(), outputs)));
        let scene = of(&forces);
        agrees(&scene);
        assert_eq!(operations(&scene), operations(&of("")), "{kinds:?}");
    }
}

/// Where a joint closes a loop and all that joints hold is independent, reactions are one number each: those of the
/// loop's joint and of the tree's.
#[test]
fn reactions_of_loops_are_those_of_the_bodies() {
    let grounded = chain(&["y", "z", "x", "y"], "").replacen("point O", "point P = [1.1, 0.2, -2.5]; point O", 1);
    let shut = "joint shut: spherical (ground.P -> b3) { rigid; }";
    let of = |outputs: &str| put(&format!("{grounded} {shut} {}", observed(4, outputs)));
    let scene = of("f: N = j1.force; m: N*m = j1.moment; s: N = shut.force;");
    agrees(&scene);
    assert_eq!(operations(&scene), operations(&of("")));
    // At the start all hinges are in one line with this point, in which the rows hold less.
    let straight = shut.replace("b3)", "b3.low)");
    let text = format!("{grounded} {straight} {}", observed(4, "s: N = shut.force;"));
    assert!(arranged(&text).states.iter().all(|state| !matches!(state.origin, Origin::Speed(..))));
}

/// In a scene that is reduced the reactions that outputs name are there; the others are not asked for.
#[test]
fn reactions_that_are_read_leave_joint_coordinates() {
    let text = format!("{} {}", chain(&["y", "z"], ""), observed(2, "f: N = j1.force;"));
    let scene = scene(&text, "tune {}");
    assert_eq!(scene.left().len(), 4, "{}", scene.report);
    assert_eq!(operations(&scene), 73);
    agrees(&scene);
}

/// Start velocities that joints determine are looked for as speeds of the joints, and where they do not the bodies keep
/// their states.
#[test]
fn guessed_velocities_start_as_those_of_the_bodies() {
    let of = |spin: &str, guess: &str| {
        format!(
            "gravity [0, 0, -9.81]; ground {{ point O = [0, 0, 0.3]; }}
             body a {{ mass 2; inertia [0.1, 0.2, 0.3]; point top = [0, 0.1, 0.2]; point low = [0.1, 0, -0.4];
                 start top at [0, 0, 0.3]; start spin {spin}; start velocity guess; }}
             joint i: revolute y (ground.O -> a.top) {{ rigid; }}
             body b {{ mass 1; inertia [0.2, 0.1, 0.15]; point top = [0.1, 0, 0.3]; start top at [0.1, -0.1, -0.3];
                 start spin {guess}; start velocity guess; }}
             joint j: revolute x (a.low -> b.top) {{ rigid; }}
             observe {{ a.position; b.position; a.orientation; b.orientation; w: rad/s = j.speed; }}"
        )
    };
    let fixed = scene(&of("[0, 0.7, 0]", "[0.4, 0.7, 0]"), "tune {}");
    assert_eq!(fixed.left().len(), 4, "{}", fixed.report);
    assert!(fixed.reduced.assembly.speeds.len() <= 6, "{:?}", fixed.reduced.assembly.speeds);
    let open = scene(&of("[0, 0.7, 0]", "guess"), "tune {}");
    assert!(open.left().len() > 4, "nothing determines the second speed: {:?}", open.left());
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

/// The equations of a scene as they are differentiated: their reactions are symbols.
fn arranged(statements: &str) -> Ordered {
    let text = format!("graph G {{ {statements} scenes only; scene Reduced {{ tune {{}} }} }}");
    let source = crate::source::syntax::parse(text.parse().expect("tokens")).unwrap_or_else(|_| panic!("{statements}"));
    let variant = crate::source::scene::variants(&source.graphs[0]).expect("scenes").remove(1);
    crate::pipeline::arrange(&variant).unwrap_or_else(|faults| panic!("{faults:?}")).equations
}

/// df/dx in a state: unknowns beside the states are eliminated by their equations.
fn matrix(jacobian: &Jacobian, environment: &Environment<'_>, n: usize) -> Vec<Vec<f64>> {
    let size = n + jacobian.unknowns.len();
    let ids: Vec<Id> = jacobian.entries.iter().map(|entry| entry.value).collect();
    let mut pool = jacobian.pool.clone();
    let one = pool.one();
    let ids = substitute(&mut pool, &ids, &|symbol| matches!(symbol, Symbol::Kept(_)).then_some(one));
    let mut rows = vec![vec![0.0; size]; size];
    for (entry, value) in jacobian.entries.iter().zip(evaluate(&pool, &ids, environment)) {
        rows[entry.row][entry.column] = value;
    }
    for column in (n..size).rev() {
        let of_largest = |&row: &usize| rows[row][column].abs();
        let pivot = (n..=column).max_by(|a, b| of_largest(a).total_cmp(&of_largest(b))).expect("a row");
        rows.swap(pivot, column);
        let (pivot, own) = (rows[column].clone(), rows[column][column]);
        for row in (0..size).filter(|&row| row != column) {
            let factor = rows[row][column] / own;
            rows[row].iter_mut().zip(&pivot).for_each(|(entry, by)| *entry -= factor * by);
        }
    }
    rows.truncate(n);
    rows.iter_mut().for_each(|row| row.truncate(n));
    rows
}

/// Panics unless the derivatives with accelerations as unknowns are those entry by entry, in states at random; gives
/// the unknowns and the operations of both with df/dt.
fn same_derivatives(statements: &str) -> (usize, [usize; 2]) {
    let equations = arranged(statements);
    let n = equations.states.len();
    let found = jacobian::differentiate(&equations);
    let expected = jacobian::by_entries(&equations);
    let mut draw = Draw(Random::new(11));
    for round in 0..4 {
        let mut states: Vec<f64> = equations.states.iter().map(|_| draw.number()).collect();
        turn(&equations.states, &mut states, &mut draw);
        let inputs: Vec<f64> = equations.inputs.iter().map(|_| draw.number()).collect();
        // Sticking and resting first, then sliding each way.
        let negative: Vec<bool> = (0..equations.switches.len()).map(|switch| round >> switch & 1 == 1).collect();
        let environment =
            Environment { states: &states, inputs: &inputs, negative: &negative, time: 0.3, ..Environment::default() };
        let [found, expected] = [&found, &expected].map(|of| matrix(of, &environment, n));
        let size = expected.iter().flatten().fold(1.0_f64, |size, entry| size.max(entry.abs()));
        for (row, column) in (0..n).flat_map(|row| (0..n).map(move |column| (row, column))) {
            let (found, expected) = (found[row][column], expected[row][column]);
            let names = [row, column].map(|state| &equations.states[state].name);
            assert!((found - expected).abs() < 1e-10 * size, "{names:?}: {found} {expected}\n{statements}");
        }
    }
    let count = |mut of: Jacobian| {
        let roots = of.roots();
        schedule(&mut of.pool, [Request { name: "jacobian", roots: &roots }]).routines[0].counts.total()
    };
    (found.unknowns.len(), [found, expected].map(count))
}

/// Derivatives of chains and trees with joints of all kinds, with loads and drives that depend on the motion: as many
/// unknowns as freedoms.
#[test]
fn derivatives_by_accelerations_are_those_entry_by_entry() {
    let loads = "input push: N*m; drive m on j1 torque = 3 - 2 * j1.angle - 0.3 * j1.speed + push; \
        drive n on j0 torque = 1.5 * j1.speed;
        drive f on b1.low force = [1, 2, 3]; drive twist on b1 torque = [0.3, 0, 0.1];
        spring s (ground.O -> b1.low) { stiffness 20; length 0.1; damping 0.4; }";
    for (text, freedoms) in [
        (format!("{} {loads} {}", chain(&["y", "z"], ""), observed(2, "")), 2),
        (format!("{} {}", branches(&["z", "x"], ""), observed(3, "")), 3),
        (format!("{} {}", chain(&["z", "x", "x", "y", "z"], ""), observed(5, "")), 5),
    ] {
        assert_eq!(same_derivatives(&text).0, freedoms);
    }
    for (kinds, freedoms) in [
        (&["revolute y", "prismatic x", "revolute x"][..], 3),
        (&["prismatic x", "revolute y", "<prismatic z"], 3),
        (&["revolute y", "<cylindrical x"], 3),
        (&["universal x y", "fixed", "<revolute z"], 3),
    ] {
        let kinds: Vec<String> = kinds.iter().map(|&kind| kind.to_owned()).collect();
        let text = format!("{} {}", joined(&kinds, ""), observed(kinds.len(), ""));
        assert_eq!(same_derivatives(&text).0, freedoms, "{kinds:?}");
    }
}

/// Of a body on no joint, and of one on a ball at the ground, motion and accelerations are unknowns; a joint that
/// sticks has a known acceleration, and so has one that rests on a stop; with a ball farther out, and with stops and
/// dry friction, derivatives are those of the rates.
#[test]
fn derivatives_of_bodies_that_keep_their_orientation() {
    let floating = joined(&["revolute y", "<universal x y", "prismatic z"].map(str::to_owned), "")
        .replace(
            "ground { point O = [0, 0, 0.3]; }",
            "ground { point O = [0, 0, 0.3]; }
             body base { mass 4; inertia [0.4, 0.5, 0.6]; point hip = [0.1, 0, -0.3]; start hip at [0, 0, 0.3]; }
             spring s (ground.O -> base) { stiffness 20; length 0.1; damping 0.4; }",
        )
        .replace("ground.O -> b0", "base.hip -> b0");
    let of = |kinds: &[&str], others: &str| {
        let kinds: Vec<String> = kinds.iter().map(|&kind| kind.to_owned()).collect();
        format!("{} {others} {}", joined(&kinds, ""), observed(kinds.len(), ""))
    };
    for (text, unknowns) in [
        (format!("{floating} {}", observed(3, "x: m = base.position; r = base.orientation;")), 9 + 4),
        (of(&["spherical", "revolute x", "prismatic y"], ""), 9 + 2),
        (of(&["revolute y", "spherical"], ""), 0),
        (of(&["revolute y", "revolute x"], "friction brake on j1 { coulomb 5; viscous 0.3; }"), 2),
        (of(&["revolute y", "revolute x"], "stop end on j1 { at most 0.2; restitution 0.5; }"), 2),
        (
            of(
                &["revolute y", "<revolute x", "prismatic z"],
                "stop one on j1 { at least -0.3; at most 0.2; restitution 0; } stop two on j2 { at most 0.1; \
                restitution 0.5; }
                 drive m on j1 torque = 3 - 2 * j1.angle - 0.3 * j1.speed;",
            ),
            3,
        ),
        (
            of(
                &["revolute y", "revolute x"],
                "stop s on j1 { at most 0.2; restitution 0; } friction b on j1 { coulomb 5; \
            }",
            ),
            2,
        ),
    ] {
        assert_eq!(same_derivatives(&text).0, unknowns, "{text}");
    }
}

/// Of joints that nobody watches, on a branch of their own, no acceleration is an unknown.
#[test]
fn derivatives_of_what_is_watched_alone() {
    let one = chain(&["y", "z"], "");
    let bodies = &one[one.find("body").expect("a body")..];
    let other = bodies
        .replace("mass 1", "mass 3")
        .replace("b0", "c0")
        .replace("b1", "c1")
        .replace("j0", "k0")
        .replace("j1", "k1");
    let two = format!("{one} {other}");
    let of = |angles: &str| same_derivatives(&format!("{two} observe {{ {angles} }}")).0;
    assert_eq!(of("a: rad = j1.angle; b: rad = k1.angle;"), 4);
    assert_eq!(of("a: rad = j1.angle;"), 2);
}

/// Reactions of joints that close loops are unknowns beside the accelerations.
#[test]
fn derivatives_of_loops_have_accelerations_and_reactions() {
    let grounded = chain(&["y", "z", "x", "y"], "").replacen("point O", "point P = [1.1, 0.2, -2.5]; point O", 1);
    for (others, reactions) in [("spherical", 3), ("cylindrical z", 4)] {
        let shut = format!("joint shut: {others} (ground.P -> b3.low) {{ rigid; }}");
        let text = format!("{grounded} {shut} {}", observed(4, ""));
        assert_eq!(same_derivatives(&text).0, 4 + reactions, "{others}");
    }
}

/// Pinned: with df/dt, beside those entry by entry.
#[test]
fn operations_of_derivatives() {
    let count = |axes: &[&str]| {
        let angles: String = (0..axes.len()).map(|k| format!("a{k}: rad = j{k}.angle; ")).collect();
        same_derivatives(&format!("{} observe {{ {angles} }}", chain(axes, ""))).1
    };
    assert_eq!(count(&["y", "z"]), [197, 209]);
    assert_eq!(count(&["y", "z", "y", "z"]), [1810, 3213]);
    // Of a floating base the rates of its momenta are written by its accelerations.
    let base = "body base { mass 4; inertia [0.4, 0.5, 0.6]; point hip = [0.1, 0, -0.3]; start hip at [0, 0, 0.3]; }
        drive m on j0 torque = 3;";
    let floating = chain(&["y"], base).replace("ground.O -> b0", "base.hip -> b0");
    assert_eq!(same_derivatives(&format!("{floating} {}", observed(1, ""))).1, [1629, 3934]);
}
