//! Loops in space in closed form, beside the literal graphs in states that no run has chosen; what is left as it was.

use super::{agrees, observed, operations};
use crate::random::Random;
use crate::system::reduce::Fate;
use crate::system::reduce::tests::{Scene, scene};

/// A crank about z, a rocker about x, a rod on a ball of each; the crank's radius and what it starts with.
fn rssr(radius: f64, clauses: &str) -> String {
    let half = radius / 2.0;
    format!(
        "gravity [0, -9.81, 0]; ground {{ point O = [0, 0, 0]; point P = [1, 0, 0.5]; }}
         body b0 {{ mass 1; inertia [0.01, 0.02, 0.02]; point left = [-{half}, 0, 0]; point right = [{half}, 0, 0];
             start left at [0, 0, 0]; {clauses} }}
         joint pin: revolute z (ground.O -> b0.left) {{ rigid; }}
         body b1 {{ mass 1.5; inertia [0.03, 0.02, 0.03]; point low = [0, -0.3, 0]; point high = [0, 0.3, 0];
             start low at [1, 0, 0.5]; }}
         joint hinge: revolute x (ground.P -> b1.low) {{ rigid; }}
         body b2 {{ mass 0.5; inertia [0.03, 0.01, 0.035]; point near = [0, -0.5, 0]; \
             point far = [1 - {radius}, 0.1, 0.5]; start near at [{radius}, 0, 0]; }}
         joint first: spherical (b0.right -> b2.near) {{ rigid; }}
         joint second: spherical (b2.far -> b1.high) {{ rigid; }} {}",
        observed(3, "")
    )
}

/// The states that a joint which closes a loop gives.
fn closed(scene: &Scene) -> Vec<&str> {
    let fates = scene.report.fates.iter();
    fates.filter(|(_, fate)| matches!(fate, Fate::Closed(_))).map(|(state, _)| state.name.as_str()).collect()
}

/// Of a rod on two balls its turning about its own axis stays.
#[test]
fn a_rod_on_two_balls_moves_as_its_bodies_do() {
    let scene = scene(&rssr(0.1, ""), "");
    assert_eq!(scene.left(), ["pin.q", "pin.u", "first.q3", "first.u3"], "{}", scene.report);
    assert_eq!(closed(&scene), ["hinge.q", "hinge.u", "first.q1", "first.q2", "first.u1", "first.u2"]);
    assert!(scene.reduced.holding.rigid.is_empty() && scene.reduced.solution.values.is_empty());
    let laws: Vec<(&str, bool)> =
        scene.reduced.fallible.iter().map(|law| (law.element.as_str(), law.may_vanish)).collect();
    assert_eq!(laws, [("second", false), ("second", false)], "the rocker's angle, and the second one of the ball");
    assert_eq!(operations(&scene), 392, "{}", scene.report);
    agrees(&scene);
}

/// Mechanisms like it, with the rocker about x or y anywhere beside the crank.
#[test]
fn rods_on_two_balls_drawn_at_random_move_as_their_bodies_do() {
    let mut random = Random::new(7);
    let mut closed_ones = 0;
    for k in 0..10 {
        let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
        let (crank, foot) = (between(0.05, 0.25), [between(0.6, 1.4), between(-0.3, 0.3), between(-0.7, 0.7)]);
        let (length, angle) = (between(0.4, 0.9), between(-0.8, 0.8));
        let [axis, of, to] = if k % 2 == 0 { [0, 1, 2] } else { [1, 2, 0] };
        let mut along = [0.0; 3];
        along[of] = length / 2.0;
        let mut tip = foot;
        (tip[of], tip[to]) = (foot[of] + length * angle.cos(), foot[to] + length * angle.sin());
        let (low, half, name) = (along.map(|part| -part), crank / 2.0, ["x", "y"][axis]);
        let far = [tip[0] - crank, tip[1], tip[2]];
        let scene = scene(
            &format!(
                "gravity [0.7, -9.81, 1.3]; ground {{ point O = [0, 0, 0]; point P = {foot:?}; }}
                 body b0 {{ mass 1; inertia [0.01, 0.02, 0.02]; point left = [-{half}, 0, 0];
                     point right = [{half}, 0, 0]; start left at [0, 0, 0]; }}
                 joint pin: revolute z (ground.O -> b0.left) {{ rigid; }}
                 body b1 {{ mass 1.5; inertia [0.03, 0.02, 0.03]; point low = {low:?}; point high = {along:?};
                     start low at {foot:?}; start turned rotation_{name}({angle}); }}
                 joint hinge: revolute {name} (ground.P -> b1.low) {{ rigid; }}
                 body b2 {{ mass 0.5; inertia [0.03, 0.01, 0.035]; point near = [0, 0, 0]; point far = {far:?};
                     start near at [{crank}, 0, 0]; }}
                 joint first: spherical (b0.right -> b2.near) {{ rigid; }}
                 joint second: spherical (b2.far -> b1.high) {{ rigid; }} {}",
                observed(3, "")
            ),
            "",
        );
        closed_ones += usize::from(!closed(&scene).is_empty());
        agrees(&scene);
    }
    assert!((2..10).contains(&closed_ones), "{closed_ones} are closed");
}

/// A rocker and a rod in line: no rocker follows such a crank all the way round.
#[test]
fn a_rod_that_may_be_in_line_with_the_rocker_keeps_its_rows() {
    let plain = scene(&rssr(0.3, ""), "");
    assert_eq!((plain.left().len(), closed(&plain).len()), (16, 0), "{}", plain.report);
    let said = scene(&rssr(0.3, ""), "dependent { b1, b2 }");
    assert_eq!(said.left().len(), 4, "{}", said.report);
    let laws: Vec<bool> = said.reduced.fallible.iter().map(|law| law.may_vanish).collect();
    assert!(laws.contains(&true), "{laws:?}");
    assert!(operations(&said) < operations(&plain), "{} {}", said.report, plain.report);
}

/// Three angles of a ball that no loop gives meet poses in which they are no coordinates, also where another loop is
/// closed.
#[test]
fn a_ball_that_no_loop_gives_has_no_angles() {
    let [short, long] = [0.1, 0.3].map(|radius| rssr(radius, "").replace(&observed(3, ""), ""));
    let (_, long) = long.split_once("body b0").expect("gravity and ground before it");
    let names = [("b0", "b3"), ("b1", "b4"), ("b2", "b5"), ("pin", "pin2"), ("hinge", "hinge2"), ("first", "first2")];
    let other = names.iter().fold(format!("body b0{long}"), |text, (own, other)| text.replace(own, other));
    let scene =
        scene(&format!("{short} {} {}", other.replace("second", "second2"), observed(6, "")), "dependent { b1, b2 }");
    assert!(scene.left().iter().all(|state| !state.starts_with("first2.q")), "{}", scene.report);
    assert_eq!(closed(&scene).len(), 0, "{}", scene.report);
    agrees(&scene);
}

/// The crank turns and the rocker does not, or not as it has to: the run time says so.
#[test]
fn start_velocities_that_may_not_fit_keep_the_rows() {
    let scene = scene(&rssr(0.1, "start spin [0, 0, 1]; start velocity [0, 0.05, 0];"), "");
    assert_eq!((scene.left().len(), closed(&scene).len()), (16, 0), "{}", scene.report);
}

#[test]
fn an_output_that_shows_a_reaction_of_the_loop_keeps_the_rows() {
    let shown = rssr(0.1, "").replace("observe {", "observe { f: N = second.force;");
    let scene = scene(&shown, "");
    assert!(closed(&scene).is_empty(), "{}", scene.report);
}

/// Two shafts by a universal joint, the bearing of the second on a hinge: the second one's angle follows.
const SHAFTS: &str = "gravity [0, -9.81, 0]; ground { point A = [0, 0, -0.6]; point C = [0, 0, 0]; }
    body b0 { mass 2; inertia [0.02, 0.02, 0.03]; point end = [0, 0, 0.3]; point base = [0, 0, -0.3];
        start at [0, 0, -0.3]; }
    body b1 { mass 1.5; inertia [0.03, 0.02, 0.01]; point pivot = [0, 0, -0.5]; start pivot at [0, 0, 0];
        start turned rotation_x(-0.5); }
    body b2 { mass 1; inertia [0.01, 0.015, 0.02]; point near = [0, 0, -0.4]; point far = [0, 0, 0.1];
        start near at [0, 0, 0]; start turned rotation_x(-0.5); }
    joint input: revolute z (ground.A -> b0.base) { rigid; }
    joint tilt: revolute x (ground.C -> b1.pivot) { rigid; }
    joint bearing: revolute z (b1 -> b2.far) { rigid; }
    joint cross: universal y x (b0.end -> b2.near) { rigid; }
    drive motor on input torque = 0.3;";

/// That they move as they should: `bg-model/tests/mechanisms/loops_in_space.rs`; the literal graph holds them twice.
#[test]
fn a_shaft_follows_from_the_one_before_its_universal_joint() {
    let scene = scene(&format!("{SHAFTS} {}", observed(3, "")), "dependent b2;");
    assert_eq!(scene.left(), ["input.q", "input.u", "tilt.q", "tilt.u"], "{}", scene.report);
    assert_eq!(scene.words(&["bearing.q"]), ["closed cross"]);
}

/// An angle that a loop gives and that is read counts its turns: a state that nothing else depends on.
#[test]
fn turns_of_an_angle_that_a_loop_gives_are_counted() {
    let scene = scene(&format!("{SHAFTS} observe {{ b: rad = bearing.angle; }}"), "dependent b2;");
    assert_eq!(scene.words(&["bearing.q", "bearing.u"]), ["quadrature", "closed cross"], "{}", scene.report);
}
