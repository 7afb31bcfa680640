//! Rigid joints that hold the same motion: two hinges of one door in all poses, a parallelogram where it lies flat.

use std::sync::LazyLock;

use bg_loaded::Graph;
use bg_model::assembly::AssemblyError;
use bg_model::dynamics::Machine;
use bg_model::failure::{Cause, Failure};
use bg_model::holding::Redundancy;
use bg_model::integrator::{Bs5, Dop853, Method, Radau9, Taylor, Tolerances};
use bg_model::simulation::{Finish, Settings, Span, drive};

use super::text::{graphs, model, outputs};

const TEXT: &str = "
/// A door of 20 kg on two hinges, one above the other.
graph Door {
    param angle: rad = 0.7;
    gravity [0, 0, -9.81];
    ground { point lower = [-0.37, 0.11, -0.93]; point upper = [-0.37, 0.11, 1.07]; }
    body door {
        mass 20; inertia [7, 1, 6];
        point lower = [-0.4, 0, -1]; point upper = [-0.4, 0, 1];
        start lower at [-0.37, 0.11, -0.93]; start turned rotation_z(angle);
    }
    joint bottom: revolute z (ground.lower -> door.lower) { rigid; }
    joint top: revolute z (ground.upper -> door.upper) { rigid; stiffness 1e6; damping 1e3; tilt stiffness 1e4; }
    observe { f: N = bottom.force; top.force }
}

/// The same with a horizontal axis.
graph Trapdoor {
    gravity [0, -9.81, 0];
    ground { point lower = [0, 0, -1]; point upper = [0, 0, 1]; }
    body door {
        mass 20; inertia [7, 1, 6];
        point lower = [0, 0.4, -1]; point upper = [0, 0.4, 1];
        start lower at [0, 0, -1]; start turned rotation_z(0.01);
    }
    joint bottom: revolute z (ground.lower -> door.lower) { rigid; }
    joint top: revolute z (ground.upper -> door.upper) { rigid; }
    observe { angle: rad = door.angle; top.force }
}

/// The same, where the upper hinge holds only sideways, and where it gives a little.
graph Hung {
    param angle: rad = 0.7;
    gravity [0, 0, -9.81];
    ground { point lower = [-0.37, 0.11, -0.93]; point upper = [-0.37, 0.11, 1.07]; }
    body door {
        mass 20; inertia [7, 1, 6];
        point lower = [-0.4, 0, -1]; point upper = [-0.4, 0, 1];
        start lower at [-0.37, 0.11, -0.93]; start turned rotation_z(angle);
    }
    joint bottom: spherical (ground.lower -> door.lower) { rigid; }
    1 top.x: translation; 1 top.y: translation;
    1 tip[3]: translation; 0 arm[3]: translation;
    MTF lever(w) = cross(w, door.upper.arm);
    door.translation -> arm -> tip; door.rotation -> lever -> arm;
    TF along_x(v) = dot([1, 0, 0], v); TF along_y(v) = dot([0, 1, 0], v);
    tip -> along_x -> top.x; tip -> along_y -> top.y;
    rSe top.x_reaction = 0 at door.upper.position.x + 0.37;
    rSe top.y_reaction = 0 at door.upper.position.y - 0.11;
    top.x -> top.x_reaction; top.y -> top.y_reaction;
    observe { bottom.force; angle: rad = door.angle; aside: N = top.x_reaction.effort; \
    across: N = top.y_reaction.effort }
}

/// Two cranks and a coupler, all links 0.3 m or 0.5 m long.
graph Parallelogram {
    param angle: rad = 1;
    param speed: rad/s = 3;
    ground { point O = [0, 0, 0]; point P = [0.5, 0, 0]; }
    body crank {
        mass 1; inertia [0.01, 0.01, 0.01]; point O = [-0.15, 0, 0]; point A = [0.15, 0, 0];
        start O at [0, 0, 0]; start turned rotation_z(angle);
        start spin [0, 0, speed]; start velocity [guess(0), guess(0), 0];
    }
    body follower {
        mass 1; inertia [0.01, 0.01, 0.01]; point O = [-0.15, 0, 0]; point B = [0.15, 0, 0];
        start O at [0.5, 0, 0]; start turned rotation_z(angle);
        start spin [0, 0, guess(0)]; start velocity [guess(0), guess(0), 0];
    }
    body coupler {
        mass 1; inertia [0.01, 0.01, 0.02]; point A = [-0.25, 0, 0]; point B = [0.25, 0, 0];
        start A at [0.3 * cos(angle), 0.3 * sin(angle), 0];
        start spin [0, 0, guess(0)]; start velocity [guess(0), guess(0), 0];
    }
    joint pin_o: revolute z (ground.O -> crank.O) { stiffness 1e6; damping 10; tilt stiffness 1e3; }
    joint pin_p: revolute z (ground.P -> follower.O) { stiffness 1e6; damping 10; tilt stiffness 1e3; }
    joint pin_a: revolute z (crank.A -> coupler.A) { stiffness 1e6; damping 10; tilt stiffness 1e3; }
    joint pin_b: revolute z (follower.B -> coupler.B) { stiffness 1e6; damping 10; tilt stiffness 1e3; }
    observe { crank: rad = crank.angle; follower: rad = follower.angle; pin_b.force }
    /// On ideal pins, in the plane.
    scene RigidParallelogram { rigid joints; expect planar; }
}
";

static GRAPHS: LazyLock<Vec<Graph>> = LazyLock::new(|| graphs(TEXT));

/// A run from the start.
fn run(model: &dyn Machine, method: &mut dyn Method, t_end: f64, settings: &Settings) -> Result<Finish, Failure> {
    drive(model, method, &model.start().unwrap(), Span { t0: 0.0, t_end }, settings, None, &mut ())
}

/// The outputs where a run has come to.
fn at_the_end(model: &dyn Machine, finish: &Finish) -> Vec<f64> {
    outputs(model, finish.t, finish.x.as_slice(), &finish.negative)
}

/// Each of two equal hinges takes half of what the door needs, in the least sum of squares of forces and moments.
#[test]
fn two_rigid_hinges_of_one_door_share_its_weight() {
    let model = model(&GRAPHS, "Door", &[]);
    let redundant = model.redundant();
    let expected = Redundancy {
        joint: "top",
        directions: vec!["in x", "in y", "in z", "about x", "about y"],
        others: vec!["bottom"],
    };
    assert_eq!(redundant, [expected]);
    assert_eq!(
        redundant[0].to_string(),
        "rigid joint `top` holds in x, in y, in z, about x, about y what rigid joint `bottom` holds already"
    );
    let finish = run(&*model, &mut Dop853::new(), 2.0, &Settings::default()).unwrap();
    // It rests.
    for y in [outputs(&*model, 0.0, &model.start().unwrap(), &[]), at_the_end(&*model, &finish)] {
        let (weight, arm) = (20.0 * 9.81, 0.4);
        // Both forces carry the weight; the moment of the weight is taken by forces aside, 1 m above and below the
        // middle, and by moments, in the least sum of squares of (f, -f, m, m): 2 f + 2 m = weight * arm with f = m.
        let aside = weight * arm / 4.0;
        assert!((y[2] - weight / 2.0).abs() < 1e-6 && (y[5] - weight / 2.0).abs() < 1e-6, "{y:?}");
        assert!((y[0].hypot(y[1]) - aside).abs() < 1e-6 && (y[3].hypot(y[4]) - aside).abs() < 1e-6, "{y:?}");
        assert!((y[0] + y[3]).abs() < 1e-6 && (y[1] + y[4]).abs() < 1e-6, "{y:?}");
    }
}

/// The same door with a horizontal axis swings as the physical pendulum that it is, m l^2 + J about its axis.
#[test]
fn a_trapdoor_on_two_rigid_hinges_is_a_pendulum() {
    let model = model(&GRAPHS, "Trapdoor", &[]);
    let settings = Settings { tolerances: Tolerances::new(1e-10, 1e-11), ..Settings::default() };
    let moment = 6.0 + 20.0 * 0.4 * 0.4;
    // A quarter of the period of small swings: K(sin(0.005)) / sqrt(m g l / J) of the exact pendulum.
    let quarter =
        0.5 * std::f64::consts::PI * (1.0 + 0.005_f64.sin().powi(2) / 4.0) / (20.0_f64 * 9.81 * 0.4 / moment).sqrt();
    let y = at_the_end(&*model, &run(&*model, &mut Dop853::new(), quarter, &settings).unwrap());
    assert!(y[0].abs() < 1e-8, "{y:?}");
}

#[test]
fn hinges_that_hold_each_their_own_carry_the_door_s_weight() {
    let model = model(&GRAPHS, "Hung", &[]);
    let finish = run(&*model, &mut Taylor::new(), 0.2, &Settings::default()).unwrap();
    for y in [outputs(&*model, 0.0, &model.start().unwrap(), &finish.negative), at_the_end(&*model, &finish)] {
        // The axis is vertical, so the door stays; its centre is 0.4 m beside the axis, the hinges are 2 m apart.
        let weight = 20.0 * 9.81;
        let pull = weight * 0.4 / 2.0;
        assert!((y[2] - weight).abs() < 1e-6 && (y[3] - 0.7).abs() < 1e-9, "{y:?}");
        assert!((y[0].hypot(y[1]) - pull).abs() < 1e-6 && (y[4].hypot(y[5]) - pull).abs() < 1e-6, "{y:?}");
    }
}

/// The cranks turn at a constant speed, and the coupler does not turn; the links lie in one line at known times.
fn through_flat_poses(method: &mut dyn Method, rtol: f64) {
    let model = model(&GRAPHS, "RigidParallelogram", &[]);
    let settings =
        Settings { tolerances: Tolerances::new(rtol, 0.1 * rtol), step_limit: 100_000, ..Settings::default() };
    let name = method.name();
    // Four flat poses.
    let t_end = (4.5 * std::f64::consts::PI - 1.0) / 3.0;
    let finish = match run(&*model, method, t_end, &settings) {
        Ok(finish) => finish,
        Err(failure) if name.starts_with("Radau") => return creeps(&failure.cause),
        Err(failure) => panic!("{name} {rtol:e}: {failure}"),
    };
    let y = at_the_end(&*model, &finish);
    let error = y.iter().take(2).fold(0.0_f64, |error, angle| error.max((angle - 4.5 * std::f64::consts::PI).abs()));
    println!("{name} {rtol:e}: {error:e} rad after {} steps", finish.statistics.steps);
    assert!(error < 100.0 * rtol, "{name} {rtol:e}: {y:?}");
}

/// Newton's iteration needs derivatives of the rates, which grow without bound: it stops there or passes, it does not
/// err.
fn creeps(cause: &Cause) {
    let Cause::Singular { redundancy, .. } = cause else { panic!("{cause}") };
    assert_eq!((redundancy.joint, redundancy.others.len()), ("pin_b", 3), "{cause}");
}

#[test]
fn a_parallelogram_passes_the_poses_in_which_it_lies_flat() {
    for rtol in [1e-4, 1e-6, 1e-9] {
        through_flat_poses(&mut Dop853::new(), rtol);
        through_flat_poses(&mut Bs5::new(), rtol);
        through_flat_poses(&mut Radau9::new(), rtol);
        through_flat_poses(&mut Taylor::new(), rtol);
    }
}

#[test]
fn a_start_in_a_singular_pose_is_an_error_with_its_joints() {
    let error = model(&GRAPHS, "RigidParallelogram", &[("angle", 0.0)]).start().unwrap_err();
    let AssemblyError::Redundant(redundancy) = &error else { panic!("{error}") };
    assert_eq!((redundancy.joint, redundancy.others.len()), ("pin_b", 3), "{error}");
    assert!(error.to_string().starts_with("the start pose is singular: in it rigid joint `pin_b`"), "{error}");
}

/// A link that turns by more than a right angle in a step has constraints that turn around, without a singular pose.
#[test]
fn a_parallelogram_that_does_not_come_to_lie_flat_runs() {
    let model = model(&GRAPHS, "RigidParallelogram", &[("speed", -0.5)]);
    let y = at_the_end(&*model, &run(&*model, &mut Dop853::new(), 1.9, &Settings::default()).unwrap());
    assert!((y[0] - 0.05).abs() < 1e-5 && (y[1] - 0.05).abs() < 1e-5, "{y:?}");
}
