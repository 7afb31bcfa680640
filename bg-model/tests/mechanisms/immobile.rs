//! A mechanism whose rigid joints leave no motion is refused at the start, with their names; one that is meant to stand
//! still is not.

use std::sync::LazyLock;

use bg_loaded::Graph;
use bg_model::assembly::AssemblyError;
use bg_model::dynamics::Machine;
use bg_model::run::{Request, Simulation, Trajectory};

use super::text::{graphs, model};

const TEXT: &str = "
/// A rod of 1 m that lies along x at the start.
part Rod {
    body rod {
        mass 1; inertia [1e-3, 1 / 12, 1 / 12];
        point left = [-0.5, 0, 0]; point right = [0.5, 0, 0];
    }
}

/// Two rods on the ground that lean against each other: a triangle of pins.
graph Triangle {
    gravity [0, -9.81, 0];
    ground { point A = [0, 0, 0]; point B = [1, 0, 0]; }
    part left: Rod { start rod.left at [0, 0, 0]; start rod turned rotation_z(1.0471975511965976); }
    part right: Rod { start rod.right at [1, 0, 0]; start rod turned rotation_z(-1.0471975511965976); }
    joint foot: revolute z (ground.A -> left.rod.left) { rigid; }
    joint tip: revolute z (left.rod.right -> right.rod.left) { rigid; }
    joint heel: revolute z (right.rod.right -> ground.B) { rigid; }
    observe { tip.force }
    scene InThePlane { expect planar; }
}

/// A body that is welded to the ground at both ends, on a frame that one joint fixes.
graph WeldedTwice {
    gravity [0, -9.81, 0];
    ground { point O = [0, 0, 0]; }
    part frame: Rod;
    part shelf: Rod;
    joint base: fixed (ground.O -> frame.rod) { rigid; }
    joint near: fixed (frame.rod.left -> shelf.rod.left) { rigid; }
    joint far: fixed (frame.rod.right -> shelf.rod.right) { rigid; }
    observe { base.force }
    scenes only;
    scene WeldedTwice { expect planar; }
}

/// A parallelogram with a rod across, from one corner to the other.
graph Braced {
    gravity [0, -9.81, 0];
    ground { point A = [0, 0, 0]; point B = [1, 0, 0]; }
    part crank: Rod { start rod.left at [0, 0, 0]; start rod turned rotation_z(1.0471975511965976); }
    part follower: Rod { start rod.left at [1, 0, 0]; start rod turned rotation_z(1.0471975511965976); }
    part coupler: Rod { start rod.left at [0.5, 0.8660254037844386, 0]; }
    part brace: Rod { start rod.right at [1, 0, 0]; start rod turned rotation_z(-1.0471975511965976); }
    joint a: revolute z (ground.A -> crank.rod.left) { rigid; }
    joint b: revolute z (ground.B -> follower.rod.left) { rigid; }
    joint c: revolute z (crank.rod.right -> coupler.rod.left) { rigid; }
    joint d: revolute z (follower.rod.right -> coupler.rod.right) { rigid; }
    joint across: revolute z (coupler.rod.left -> brace.rod.left) { rigid; }
    joint back: revolute z (ground.B -> brace.rod.right) { rigid; }
    observe { across.force }
    scenes only;
    scene Braced { expect planar; }
}

/// A rod on a ball joint and three stays without mass: each holds something of its own, and together everything.
graph Stayed {
    gravity [0, 0, -9.81];
    ground { point O = [0, 0, 0]; }
    part mast: Rod { start rod.left at [0, 0, 0]; }
    joint ball: spherical (ground.O -> mast.rod.left) { rigid; }
    1 roll: rotation; 1 pitch: rotation; 1 yaw: rotation;
    TF about_x(w) = dot([1, 0, 0], w); TF about_y(w) = dot([0, 1, 0], w); TF about_z(w) = dot([0, 0, 1], w);
    mast.rod.rotation -> about_x -> roll; mast.rod.rotation -> about_y -> pitch; mast.rod.rotation -> about_z -> yaw;
    rSe stay_x = 0; rSe stay_y = 0; rSe stay_z = 0;
    roll -> stay_x; pitch -> stay_y; yaw -> stay_z;
    observe { ball.force }
}

/// The frame alone, which stands.
graph Frame {
    gravity [0, -9.81, 0];
    ground { point O = [0, 0, 0]; }
    part frame: Rod;
    part shelf: Rod;
    joint base: fixed (ground.O -> frame.rod) { rigid; }
    joint near: fixed (frame.rod.left -> shelf.rod.left) { rigid; }
    observe { base.force; x: m = shelf.rod.position.x }
    scenes only;
    scene Frame { expect planar; }
}

/// A rod on the frame.
graph OnFrame {
    gravity [0, -9.81, 0];
    ground { point O = [0, 0, 0]; }
    part frame: Rod;
    part rod: Rod { start rod.left at [0.5, 0, 0]; }
    joint base: fixed (ground.O -> frame.rod) { rigid; }
    joint pin: revolute z (frame.rod.right -> rod.rod.left) { rigid; }
    observe { base.force; height: m = rod.rod.position.y }
    scenes only;
    scene OnFrame { expect planar; }
}

/// A rod on a pin about which it is turned at a speed that depends on time.
graph Turned {
    param speed: rad/s = 0;
    param growth: rad/s^2 = 2;
    gravity [0, -9.81, 0];
    ground { point O = [0, 0, 0]; }
    part rod: Rod { start rod.left at [0, 0, 0]; start rod velocity [guess(0), guess(0), 0]; \
    start rod spin [0, 0, guess(0)]; }
    joint pin: revolute z (ground.O -> rod.rod.left) { rigid; }
    rSe motor = speed + growth * t;
    pin.spin -> motor;
    observe { angle: rad = rod.rod.angle }
    scenes only;
    scene Turned { expect planar; }
}

/// The same at a constant speed.
graph Steady {
    param speed: rad/s = 3;
    gravity [0, -9.81, 0];
    ground { point O = [0, 0, 0]; }
    part rod: Rod { start rod.left at [0, 0, 0]; start rod velocity [guess(0), guess(0), 0]; \
    start rod spin [0, 0, guess(0)]; }
    joint pin: revolute z (ground.O -> rod.rod.left) { rigid; }
    rSe motor = speed;
    pin.spin -> motor;
    observe { angle: rad = rod.rod.angle }
    scenes only;
    scene Steady { expect planar; }
}
";

static GRAPHS: LazyLock<Vec<Graph>> = LazyLock::new(|| graphs(TEXT));

/// The refusal of a model.
fn refused(name: &str) -> String {
    let error = model(&GRAPHS, name, &[]).start().unwrap_err();
    assert!(matches!(error, AssemblyError::Immobile { .. }), "{error}");
    error.to_string()
}

/// A run with samples at its start and its end.
fn run(name: &str, end: f64) -> Trajectory {
    let model = model(&GRAPHS, name, &[]);
    Simulation::over(model, Request::default()).every(end).until(end).run().unwrap()
}

#[test]
fn joints_that_leave_no_motion_are_named() {
    let expected = |joints: &str| {
        format!(
            "the mechanism cannot move: rigid joints {joints} hold it together in every direction; \
             leave one of them out, make it compliant, or give it another free axis"
        )
    };
    assert_eq!(refused("Triangle"), expected("`foot`, `tip`, `heel`"));
    assert_eq!(refused("InThePlane"), expected("`foot`, `tip`, `heel`"));
    // Not the joint that fixes the frame.
    assert_eq!(refused("WeldedTwice"), expected("`near`, `far`"));
    assert_eq!(refused("Braced"), expected("`a`, `b`, `c`, `across`, `d`, `back`"));
    assert_eq!(refused("Stayed"), expected("`ball`, `stay_x`, `stay_y`, `stay_z`"));
}

#[test]
fn what_is_meant_to_stand_or_is_moved_by_a_source_starts() {
    let frame = run("Frame", 0.1);
    let (force, x) = (frame["base.force_y"][1], frame["x"][1]);
    assert!((force - 2.0 * 9.81).abs() < 1e-9 && x.abs() < 1e-12, "{force} {x}");
    let on_frame = run("OnFrame", 0.1);
    assert!(on_frame["height"][1] < -0.02, "{}", on_frame["height"][1]);
    let turned = run("Turned", 1.0);
    assert!((turned["angle"][1] - 1.0).abs() < 1e-6, "{}", turned["angle"][1]);
    let steady = run("Steady", 1.0);
    assert!((steady["angle"][1] - 3.0).abs() < 1e-6, "{}", steady["angle"][1]);
    // A source that stands still for once.
    assert!(model(&GRAPHS, "Steady", &[("speed", 0.0)]).start().is_ok());
}
