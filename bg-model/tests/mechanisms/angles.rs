//! Angles count turns: laws, stops, switches and outputs that read them.

use std::f64::consts::{PI, TAU};

use bg_model::bond_graph;
use bg_model::integrator::Integrator;
use bg_model::mechanism::Mechanism;
use bg_model::run::{Simulation, Trajectory};
use bg_model::system::Model;

bond_graph! {
    /// A flywheel that winds up a torsion spring, given as a law of its angle.
    graph Flywheel {
        param stiffness: N*m/rad = 0.1, above 0;
        param tilt: rad = 0;
        ground { point pivot = [0, 0, 0]; }
        body wheel { mass 1; inertia [0.1, 0.1, 0.1]; start turned rotation_z(tilt); start spin [0, 0, 10]; }
        joint pin: revolute z (ground.pivot -> wheel) { stiffness 1e4; tilt stiffness 1e3; }
        drive spring on pin torque = -stiffness * pin.angle;
        observe { angle: rad = pin.angle; body: rad = wheel.angle; direction: rad = pin.direction;
            torque: N*m = spring.effort }
        scene Flat { expect planar; tune { stiffness, tilt } }
        scene Turned { expect planar; angles; expect states = 2; tune { stiffness, tilt } }
        scene Rigid { rigid joints; expect planar; tune { stiffness, tilt } }
    }
    /// The same without a drive, between stops three turns away.
    graph Stopped {
        param tilt: rad = 0.5;
        ground { point pivot = [0, 0, 0]; }
        body wheel { mass 1; inertia [0.1, 0.1, 0.1]; start turned rotation_z(tilt); start spin [0, 0, 10]; }
        joint pin: revolute z (ground.pivot -> wheel) { rigid; }
        stop ends on pin { at most 18.84955592153876; at least -1; restitution 0.5; }
        observe { angle: rad = pin.angle; place: rad = ends.place; speed: rad/s = pin.speed }
        scene StoppedFlat { expect planar; angles; }
    }
    /// The same wheel with a torsion spring, and a mass on a spring: storages at displacements that are counted
    /// already.
    graph Given {
        param stiffness: N*m/rad = 0.1, above 0; param k: N/m = 50;
        ground { point pivot = [0, 0, 0]; }
        body wheel { mass 1; inertia [0.1, 0.1, 0.1]; start spin [0, 0, 10]; }
        joint pin: revolute z (ground.pivot -> wheel) { rigid; }
        C bar = stiffness at pin.angle; pin.spin -> bar;
        1 slide: translation; I load = 2 start 1; C spring = k at slide.displacement; slide -> load; slide -> spring;
        observe { angle: rad = pin.angle; x: m = slide.displacement; force: N = spring.effort;
            torque: N*m = bar.effort }
    }
    /// A nut on a screw: a joint that turns and slides, with a law of both.
    graph Screw {
        param stiffness: N*m/rad = 0.1, above 0;
        ground { point pivot = [0, 0, 0]; }
        body nut { mass 1; inertia [0.1, 0.1, 0.1]; start spin [10, 0, 0]; }
        joint pin: cylindrical x (ground.pivot -> nut) { rigid; }
        drive turn on pin torque = -stiffness * pin.angle;
        MSe push = if pin.angle > 9 { 1 } else { 0 }; push -> pin.slide;
        observe { angle: rad = pin.angle; travel: m = pin.travel; turned: rad = pin.spin.displacement }
    }
    /// Two wheels on skew axes, the second carried by the first.
    graph Gimbal {
        ground { point pivot = [0, 0, 0]; }
        body ring { mass 1; inertia [0.1, 0.2, 0.3]; start turned rotation_z(3); start spin [0, 0, 9]; }
        body rotor { mass 1; inertia [0.1, 0.1, 0.1]; start turned rotation_z(3);
            start spin [-1.1289600644789, -7.9199399728036, 9]; }
        joint outer: revolute z (ground.pivot -> ring) { rigid; }
        joint inner: revolute y (ring -> rotor) { rigid; }
        drive twist on inner torque = -0.05 * inner.angle;
        start impulse;
        observe { outer: rad = outer.angle; inner: rad = inner.angle; seen: rad = inner.direction }
    }
    /// A controller of its own axis: the angle of a rod in the y-z plane, unwrapped in a hand-written expression.
    graph ByHand {
        body rod { mass 1; inertia [0.1, 0.1, 0.1]; start spin [4, 0, 0]; }
        let roll: rad = unwrapped(rod.y_axis.z, rod.y_axis.y, rod.angular_velocity.x);
        observe { roll; twice: rad = 2 * roll;
            alone: rad = unwrapped(-rod.z_axis.y, rod.z_axis.z, 0.8 * rod.angular_velocity.x) }
    }
}

fn run<Me: Mechanism>(model: &Me, end: f64) -> Trajectory {
    Simulation::new(model).rtol(1e-10).atol(1e-11).every(0.05).until(end).run().expect("a run")
}

/// The largest difference of a column from what it should be at each time.
fn off(run: &Trajectory, column: &str, expected: impl Fn(f64) -> f64) -> f64 {
    run.times.iter().zip(&run[column]).map(|(&t, value)| (value - expected(t)).abs()).fold(0.0, f64::max)
}

/// 0.1 q'' = -0.1 q.
fn wound(tilt: f64) -> impl Fn(f64) -> f64 {
    move |t| tilt * t.cos() + 10.0 * t.sin()
}

#[test]
fn a_law_of_an_angle_winds_up_over_turns() {
    let expected = |run: &Trajectory, tilt: f64, name: &str| {
        for angle in ["angle", "body"] {
            assert!(off(run, angle, wound(tilt)) < 1e-6, "{name}, {angle}: {:e}", off(run, angle, wound(tilt)));
        }
        assert!(run["direction"].iter().all(|angle| angle.abs() <= PI), "{name}");
        assert!(run["angle"].iter().any(|angle| angle.abs() > 9.9), "{name}");
    };
    for tilt in [0.0, -3.0] {
        let literal = Flywheel::new(FlywheelParameters { tilt, ..Default::default() }).expect("a model");
        expected(&run(&literal, 6.0), tilt, "literal");
        expected(&run(&Flat::new(FlatParameters { tilt, ..Default::default() }).expect("a model"), 6.0), tilt, "flat");
        let turned = Turned::new(TurnedParameters { tilt, ..Default::default() }).expect("a model");
        expected(&run(&turned, 6.0), tilt, "turned");
        let rigid = Rigid::new(RigidParameters { tilt, ..Default::default() }).expect("a model");
        expected(&run(&rigid, 6.0), tilt, "rigid");
    }
}

/// They were refused: nothing knew how fast an angle that counts turns, or a displacement of a junction, changes.
#[test]
fn a_storage_may_be_at_an_angle_or_a_displacement_that_is_counted() {
    let model = Given::new(GivenParameters::default()).expect("a model");
    let run = run(&model, 6.0);
    // 2 x'' = -50 x, with a momentum of 1 N s at the start.
    let travel = |t: f64| 0.1 * (5.0 * t).sin();
    assert!(off(&run, "angle", wound(0.0)) < 1e-6 && off(&run, "torque", |t| 0.1 * wound(0.0)(t)) < 1e-7);
    assert!(off(&run, "x", travel) < 1e-8 && off(&run, "force", |t| 50.0 * travel(t)) < 1e-6);
    // At the start the spring has no force: a run that measures errors by sizes found none for the displacement, and
    // stopped.
    for method in [Integrator::Auto, Integrator::Dop853, Integrator::Taylor, Integrator::Radau9, Integrator::Bs5] {
        let by_sizes = Simulation::new(&model).method(method).rtol(1e-8).every(0.05).until(6.0).run().expect("a run");
        assert!(off(&by_sizes, "x", travel) < 3e-7, "{method:?}: {:e}", off(&by_sizes, "x", travel));
    }
}

#[test]
fn every_kind_of_integrator_counts_the_same_turns() {
    let model = Flywheel::new(FlywheelParameters::default()).expect("a model");
    for method in [Integrator::Dop853, Integrator::Taylor, Integrator::Radau5, Integrator::Rk4] {
        let run = Simulation::new(&model).method(method).every(0.05).until(6.0).run().expect("a run");
        assert!(off(&run, "angle", wound(0.0)) < 1e-4, "{method:?}: {:e}", off(&run, "angle", wound(0.0)));
    }
}

#[test]
fn a_run_that_goes_on_from_a_state_keeps_its_turns() {
    let model = Flywheel::new(FlywheelParameters::default()).expect("a model");
    let mut first = run(&model, 1.5);
    assert!(*first["angle"].last().expect("a row") > 9.0);
    first.continue_until(&model, 6.0).expect("a run");
    assert!(off(&first, "angle", wound(0.0)) < 1e-6);
}

#[test]
fn a_stop_three_turns_away_is_hit_there() {
    let tilt = 0.5;
    let hit = (3.0 * TAU - tilt) / 10.0;
    let expected = |t: f64| if t < hit { tilt + 10.0 * t } else { 3.0 * TAU - 5.0 * (t - hit) };
    let of = |run: Trajectory, name: &str| {
        for column in ["angle", "place"] {
            assert!(off(&run, column, expected) < 1e-8, "{name}, {column}: {:e}", off(&run, column, expected));
        }
    };
    of(run(&Stopped::new(StoppedParameters { tilt }).expect("a model"), 3.0), "literal");
    of(run(&StoppedFlat::new(StoppedFlatParameters::default()).expect("a model"), 3.0), "flat");
}

#[test]
fn a_joint_that_starts_beyond_its_stop_is_refused() {
    let refused = |tilt: f64| match Stopped::new(StoppedParameters { tilt }) {
        Ok(model) => model.start().err().map(|error| error.to_string()),
        Err(error) => Some(error.to_string()),
    };
    let text = refused(-2.0).expect("the least angle is -1");
    assert!(text.contains("ends") && text.contains("beyond its end"), "{text}");
    assert_eq!(refused(-0.9), None);
    // An angle starts in (-pi, pi]: that of 5 rad is -1.28.
    assert!(refused(5.0).is_some());
}

#[test]
fn a_joint_that_turns_and_slides_counts_its_turns() {
    let run = run(&Screw::new(ScrewParameters::default()).expect("a model"), 6.0);
    for angle in ["angle", "turned"] {
        assert!(off(&run, angle, wound(0.0)) < 1e-6, "{angle}: {:e}", off(&run, angle, wound(0.0)));
    }
    // Pushed by 1 N from the angle 9, at asin 0.9, to where that is left, for 0.902 s.
    let (from, to) = (0.9_f64.asin(), PI - 0.9_f64.asin());
    let moved = move |t: f64| match t {
        t if t < from => 0.0,
        t if t < to => 0.5 * (t - from).powi(2),
        t => 0.5 * (to - from).powi(2) + (to - from) * (t - to),
    };
    assert!(off(&run, "travel", moved) < 1e-6, "{:e}", off(&run, "travel", moved));
}

#[test]
fn an_angle_on_a_moving_axis_is_that_of_the_pose_with_its_turns() {
    let run = run(&Gimbal::new(GimbalParameters::default()).expect("a model"), 6.0);
    // A ball has no gyroscopic moment about the ring's axis: 0.1 q'' = -0.05 q.
    let pace = 0.5_f64.sqrt();
    assert!(off(&run, "inner", |t| 8.0 / pace * (pace * t).sin()) < 1e-6);
    for (angle, seen) in run["inner"].iter().zip(&run["seen"]) {
        let turns = (angle - seen) / TAU;
        assert!((turns - turns.round()).abs() < 1e-12, "{turns}");
    }
    assert!(run["outer"].iter().any(|angle| angle.abs() > 2.0 * TAU), "it does turn");
}

#[test]
fn any_sine_and_cosine_can_be_unwrapped() {
    let model = ByHand::new(ByHandParameters::default()).expect("a model");
    let names: Vec<&str> = model.description().states.iter().map(|state| state.name).collect();
    assert!(names.contains(&"roll") && names.contains(&"alone"), "{names:?}");
    let run = run(&model, 5.0);
    assert!(off(&run, "roll", |t| 4.0 * t) < 1e-7);
    assert!(off(&run, "twice", |t| 8.0 * t) < 1e-7);
    assert!(off(&run, "alone", |t| 4.0 * t) < 1e-7, "a speed that is 20 % off is no error of the angle");
}
