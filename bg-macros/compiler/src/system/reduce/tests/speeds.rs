//! Rigid scenes in fewer unknowns beside their literal graphs.

use std::fmt::Write;

use super::{Scene, scene};
use crate::expr::{Environment, evaluate};
use crate::system::equations::{Kind, Slip, StateEquations};

/// A chain of rods on pins from the ground, the first of them driven.
fn chain(rods: usize, first: &str) -> String {
    let mut text = "gravity [0, -9.81, 0]; ground { point O = [0, 0, 0]; }".to_owned();
    for k in 0..rods {
        let clauses = if k == 0 { first } else { "" };
        let upper = if k == 0 { "ground.O".to_owned() } else { format!("b{}.low", k - 1) };
        let _ = write!(
            text,
            "body b{k} {{ mass 1; inertia [0.1, 0.01, 0.1]; point top = [0, 0.5, 0]; point low = [0, -0.5, 0];
                start top at [0, -{k}, 0]; {clauses} }}
             joint j{k}: revolute z ({upper} -> b{k}.top) {{ rigid; }}"
        );
    }
    let _ = write!(text, "drive m on j0 torque = 3; observe {{ p: m = b{}.position; f: N = j0.force; }}", rods - 1);
    text
}

/// A crank that moves a slotted arm: a block on the crank's end slides along the arm.
const SHAPER: &str = "param torque: N*m = 2; gravity [0, -9.81, 0]; ground { point O = [0, 0, 0]; \
    point Q = [0, -1, 0]; }
    body crank { mass 1; inertia [0.02, 0.02, 0.02]; point O = [0, 0, 0]; point A = [0.3, 0, 0]; start O at [0, 0, 0]; }
    body arm { mass 2; inertia [0.3, 0.3, 0.3]; point Q = [-0.5, 0, 0]; start Q at [0, -1, 0]; \
    start turned rotation_z(guess(1.3)); }
    body block { mass 0.5; inertia [0.01, 0.01, 0.01]; start at [0.3, 0, 0]; start turned rotation_z(guess(1.3)); }
    joint o: revolute z (ground.O -> crank.O) { rigid; }
    joint q: revolute z (ground.Q -> arm.Q) { rigid; }
    joint a: revolute z (crank.A -> block) { rigid; }
    joint slot: prismatic x (arm -> block) { rigid; }
    drive motor on o torque = torque;
    observe { e: J = stored_energy; w: J = integral(supplied_power); y: m = slot.y_offset; FORCE }";

/// The operations of a rate after the last reduction.
fn operations(scene: &Scene) -> usize {
    scene.report.counts.last().and_then(|count| count.operations).expect("a count")
}

fn fits_the_literal_model(scene: &Scene) {
    let (full, reduced) = scene.starts();
    let size = full.iter().fold(1.0_f64, |size, value| size.max(value.abs()));
    assert!(full.iter().zip(&reduced).all(|(a, b)| (a - b).abs() < 1e-12 * size), "{full:?} {reduced:?}");
    // Truncation of other states, and of gaps that the literal model does not project here.
    scene.agrees_to(2e-6);
}

#[test]
fn rods_on_pins_are_left_with_an_angle_and_a_momentum_each() {
    for (rods, expected) in [(1, 6), (2, 35)] {
        let scene = scene(&chain(rods, ""), "tune {}");
        assert_eq!(scene.left().len(), 3 * rods, "{}", scene.report);
        assert_eq!(operations(&scene), expected, "{}", scene.report);
        assert!(scene.reduced.holding.rigid.is_empty());
        fits_the_literal_model(&scene);
    }
    let scene = scene(&chain(2, ""), "tune {}");
    let names = ["b1.linear.p_x", "b1.position_y", "b1.angular.p_z"];
    assert_eq!(scene.words(&names), ["joined j1", "joined j1", "integrated"]);
}

/// The full matrix of a long chain takes more operations than the band of its reactions.
#[test]
fn a_long_chain_keeps_its_reactions() {
    let scene = scene(&chain(10, ""), "tune {}");
    assert_eq!((scene.left().len(), scene.reduced.holding.rigid.len()), (70, 20));
}

/// What spins at the start tears the pins until impulses or guesses make it fit: that is for the run time to find.
#[test]
fn a_start_that_may_not_fit_keeps_its_reactions() {
    for (start, states) in [("start spin [0, 0, 2];", 7), ("start spin [0, 0, 2]; start velocity [1, 0, 0];", 3)] {
        let scene = scene(&chain(1, start), "tune {}");
        assert_eq!(scene.left().len(), states, "{start} {}", scene.report);
        fits_the_literal_model(&scene);
    }
}

/// Closing rows that are as many as the momenta hold everything or follow from each other.
#[test]
fn what_may_not_move_keeps_its_reactions() {
    let graph = format!("{} joint back: revolute z (ground.O -> b0.low) {{ rigid; }}", chain(1, ""));
    let scene = scene(&graph, "tune {}");
    assert_eq!(scene.reduced.holding.rigid.len(), 4, "{}", scene.report);
}

/// The block turns with the arm: one orientation and one momentum of the two are left, and the slot's reaction across.
#[test]
fn a_slide_between_moving_bodies_leaves_one_reaction() {
    let shaper = SHAPER
        .replace("FORCE", "")
        .replace("start at [0.3, 0, 0]; start turned rotation_z(guess(1.3));", "start at [0.3, 0, 0];");
    let shaper =
        shaper.replace("start Q at [0, -1, 0]; start turned rotation_z(guess(1.3));", "start Q at [-0.9, 0, 0];");
    let shaper = shaper.replace("point Q = [0, -1, 0];", "point Q = [-0.9, 0, 0];");
    let scene = scene(&shaper, "tune { torque }");
    assert_eq!(scene.left().len(), 7, "{}", scene.report);
    assert_eq!(scene.words(&["block.orientation_11", "block.angular.p_z"]), ["joined slot", "joined slot"]);
    assert_eq!(scene.reduced.holding.rigid.len(), 1, "{}", scene.report);
    // The literal graph holds the plane three times over, so it has no reactions here; energy and the slot say whether
    // all is right.
    let (_, rows) = scene.columns();
    let moved = rows.iter().fold(0.0_f64, |most, row| most.max(row[0]));
    let lost = rows.iter().fold(0.0_f64, |most, row| most.max((row[0] - row[1]).abs()));
    let open = rows.iter().fold(0.0_f64, |most, row| most.max(row[2].abs()));
    assert!(moved > 1.0 && lost < 1e-4 * moved && open < 1e-4, "{moved} {lost:e} {open:e}");
}

/// Two guesses of one angle need not be equal: the block's orientation stays, and the rows that hold it. Where these
/// may follow from each other and a reaction is watched, all rows stay.
#[test]
fn orientations_that_start_apart_stay() {
    for (force, rows) in [("", 2), ("f: N = o.force;", 8)] {
        let scene = scene(&SHAPER.replace("FORCE", force), "tune { torque }");
        assert!(scene.words(&["block.orientation_11"]) == ["integrated"], "{}", scene.report);
        assert_eq!(scene.reduced.holding.rigid.len(), rows, "{}", scene.report);
    }
}

/// Squared cosines and sines are 1 in every equation but those that make them so.
#[test]
fn angles_are_put_back_on_the_circle() {
    let scene = scene(&chain(2, ""), "tune {}");
    let StateEquations { pool, states, projections, .. } = &scene.reduced;
    let off: Vec<f64> =
        states.iter().map(|state| if state.origin.kind() == Kind::Orientation { 0.7 } else { 0.0 }).collect();
    let roots: Vec<_> = projections.iter().map(|&(_, id)| id).collect();
    assert_eq!(roots.len(), 4);
    for value in evaluate(pool, &roots, &Environment { states: &off, ..Environment::default() }) {
        // Newton's step from 0.7, which is 7e-3 off.
        assert!((value - 0.5_f64.sqrt()).abs() < 2e-4, "{value}");
    }
}

/// What is left of a loop's rows is judged beside the entry that they have in the matrix of all rows.
#[test]
fn rows_that_close_a_loop_are_known_as_such() {
    let four_bar = format!(
        "{} body c {{ mass 2; inertia [0.1, 0.01, 0.1]; point top = [0, 0.5, 0]; point low = [0, -0.5, 0];
            start top at [1, 0, 0]; }}
         body d {{ mass 3; inertia [0.1, 0.2, 0.3]; point left = [-0.5, 0, 0]; point right = [0.5, 0, 0];
            start left at [0, -1, 0]; }}
         joint p: revolute z (ground.P -> c.top) {{ rigid; }} joint q: revolute z (b0.low -> d.left) {{ rigid; }}
         joint r: revolute z (d.right -> c.low) {{ rigid; }}",
        chain(1, "")
            .replace("f: N = j0.force;", "")
            .replace("point O = [0, 0, 0];", "point O = [0, 0, 0]; point P = [1, 0, 0];")
    );
    let [all, left] = ["all reactions;", ""].map(|clause| scene(&four_bar, &format!("{clause} tune {{}}")).reduced);
    assert_eq!((all.holding.rigid.len(), left.holding.rigid.len()), (8, 2));
    let at_start = |of: &StateEquations, id| {
        let starts: Vec<_> = of.states.iter().map(|state| state.start).collect();
        let states = evaluate(&of.pool, &starts, &Environment::default());
        evaluate(&of.pool, &[id], &Environment { states: &states, ..Environment::default() })[0]
    };
    for (row, slip) in left.holding.rigid.iter().enumerate() {
        assert_eq!(slip.kept, Some(u32::try_from(row).expect("a few rows")));
        let is_same = |other: &Slip| other.joint == slip.joint && other.direction == slip.direction;
        let place = all.holding.rigid.iter().position(is_same).expect("the row");
        let [own, among_all] = [(&left, slip.mobility.expect("a mobility")), (&all, all.holding.matrix[place][place])]
            .map(|(of, id)| at_start(of, id));
        assert!((own / among_all - 1.0).abs() < 1e-12, "{own} {among_all}");
    }
}

/// A pin that is open by 10 mm at the start is for the run time to refuse.
#[test]
fn a_pin_that_is_open_at_the_start_keeps_its_reactions() {
    let graph = chain(1, "").replace("start top at [0, -0, 0]", "start top at [0, 0.01, 0]");
    let scene = scene(&graph, "tune {}");
    assert_eq!((scene.left().len(), scene.reduced.holding.rigid.len()), (5, 1), "{}", scene.report);
}

/// At the angle a from below and the speed w, about the pin: J w' = 3 - m g l sin(a), and the pin carries the rod
/// round.
#[test]
fn the_reactions_of_solved_rows_are_those_of_the_motion() {
    let scene = scene(&chain(1, ""), "tune {}");
    let StateEquations { pool, states, outputs, .. } = &scene.reduced;
    let (mass, length, own, angle, speed) = (1.0, 0.5, 0.1, 0.7_f64, 3.0);
    let moment = own + mass * length * length;
    let value = |name: &str| match name {
        "b0.orientation_11" => angle.cos(),
        "b0.orientation_12" => -angle.sin(),
        "b0.angular.p_z" => own * speed,
        _ => panic!("{name}"),
    };
    let at: Vec<f64> = states.iter().map(|state| value(&state.name)).collect();
    let momentum = states.iter().position(|state| state.name == "b0.angular.p_z").expect("a momentum");
    let roots: Vec<_> = [states[momentum].rate].into_iter().chain(outputs.iter().map(|output| output.value)).collect();
    let found = evaluate(pool, &roots, &Environment { states: &at, ..Environment::default() });
    let turn = (3.0 - mass * 9.81 * length * angle.sin()) / moment;
    let [across, along] = [mass * length * turn, mass * length * speed * speed];
    let force = [across * angle.cos() - along * angle.sin(), mass * 9.81 + across * angle.sin() + along * angle.cos()];
    let expected = [own * turn, length * angle.sin(), -length * angle.cos(), 0.0, force[0], force[1]];
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-13, "{found} {expected}");
    }
}
