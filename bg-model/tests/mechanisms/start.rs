//! Start velocities: guessed ones that fit the joints, misfits with joint and speed, impulses with their energy.

use std::sync::LazyLock;

use bg_loaded::Graph;
use bg_model::assembly::AssemblyError;
use bg_model::dynamics::{Dynamics, Machine};
use bg_model::integrator::Dop853;
use bg_model::run::{Request, Simulation};
use bg_model::scalar::{DoubleDouble, Scalar};
use bg_model::simulation::{Settings, Span, drive};

use super::text::{self, graphs, model};

const TEXT: &str = "
/// A bar that turns about a pin at its end, which the start does not know of.
graph Bar {
    param spin: rad/s = 10;
    param aside: m/s = 0;
    ground { point O = [0, 0, 0]; }
    body bar {
        mass 2; inertia [0.05, 0.05, 0.05]; point end = [-0.05, 0, 0];
        start end at [0, 0, 0]; start spin [0, 0, spin]; start velocity [0, aside, 0];
    }
    joint pin: revolute z (ground.O -> bar.end) { stiffness 1e5; damping 1; tilt stiffness 1e3; }
    observe { w: rad/s = pin.speed; gap: m = pin.gap; stored: J = stored_energy }
    scene RigidBar { rigid joints; }
}

/// The same, whose pin takes the misfit.
graph StruckBar {
    param spin: rad/s = 10;
    param aside: m/s = 0;
    ground { point O = [0, 0, 0]; }
    body bar {
        mass 2; inertia [0.05, 0.05, 0.05]; point end = [-0.05, 0, 0];
        start end at [0, 0, 0]; start spin [0, 0, spin]; start velocity [0, aside, 0];
    }
    joint pin: revolute z (ground.O -> bar.end) { rigid; }
    start impulse;
    observe { w: rad/s = pin.speed; gap: m = pin.gap; stored: J = stored_energy }
    /// In the plane.
    scene PlanarBar { expect planar; }
}

/// A four-bar linkage of which the crank's speed is given.
graph FourBar {
    param speed: rad/s = 7;
    ground { point O = [0, 0, 0]; point P = [0.3, 0, 0]; }
    body crank {
        mass 1; inertia [0.01, 0.01, 0.02]; point O = [-0.05, 0, 0]; point A = [0.05, 0, 0];
        start O at [0, 0, 0]; start turned rotation_z(1.1);
        start spin [0, 0, speed]; start velocity [guess(0), guess(0), 0];
    }
    body coupler {
        mass 1; inertia [0.01, 0.01, 0.02]; point A = [-0.14, 0.02, 0]; point B = [0.14, 0.02, 0];
        start A at [guess(0.05), guess(0.1), 0]; start turned rotation_z(guess(0.2));
        start spin guess; start velocity guess([0.1, 0, 0]);
    }
    body rocker {
        mass 1; inertia [0.01, 0.01, 0.02]; point P = [-0.125, 0, 0]; point B = [0.125, 0, 0];
        start P at [0.3, 0, 0]; start turned rotation_z(guess(1.6));
        start spin [0, 0, guess(40)]; start velocity guess;
    }
    joint pin_o: revolute z (ground.O -> crank.O) { stiffness 1e6; damping 10; tilt stiffness 1e3; }
    joint pin_p: revolute z (ground.P -> rocker.P) { stiffness 1e6; damping 10; tilt stiffness 1e3; }
    joint pin_a: revolute z (crank.A -> coupler.A) { stiffness 1e6; damping 10; tilt stiffness 1e3; }
    joint pin_b: revolute z (rocker.B -> coupler.B) { stiffness 1e6; damping 10; tilt stiffness 1e3; }
    observe {
        angles = [pin_o.angle, atan2(coupler.x_axis.y, coupler.x_axis.x), rocker.angle];
        spins: rad/s = [crank.angular_velocity.z, coupler.angular_velocity.z, rocker.angular_velocity.z];
        crank: m/s = crank.velocity; coupler: m/s = coupler.B.velocity; rocker: m/s = rocker.B.velocity;
        aside: rad/s = coupler.angular_velocity;
    }
}

/// The same, without what the pins in the plane hold twice, on ideal pins.
graph FlatFourBar {
    param speed: rad/s = 7;
    ground { point O = [0, 0, 0]; point P = [0.3, 0, 0]; }
    body crank {
        mass 1; inertia [0.01, 0.01, 0.02]; point O = [-0.05, 0, 0]; point A = [0.05, 0, 0];
        start O at [0, 0, 0]; start turned rotation_z(1.1);
        start spin [0, 0, speed]; start velocity [guess(0), guess(0), 0];
    }
    body coupler {
        mass 1; inertia [0.01, 0.01, 0.02]; point A = [-0.14, 0.02, 0]; point B = [0.14, 0.02, 0];
        start A at [guess(0.05), guess(0.1), 0]; start turned rotation_z(guess(0.2));
        start spin [0, 0, guess(0)]; start velocity [guess(0), guess(0), 0];
    }
    body rocker {
        mass 1; inertia [0.01, 0.01, 0.02]; point P = [-0.125, 0, 0]; point B = [0.125, 0, 0];
        start P at [0.3, 0, 0]; start turned rotation_z(guess(1.6));
        start spin [0, 0, guess(40)]; start velocity [guess(0), guess(0), 0];
    }
    joint pin_o: revolute z (ground.O -> crank.O) { rigid; }
    joint pin_p: spherical (ground.P -> rocker.P) { stiffness 1e6; }
    joint pin_a: spherical (crank.A -> coupler.A) { rigid; }
    joint pin_b: spherical (rocker.B -> coupler.B) { rigid; }
    observe {
        angles = [pin_o.angle, atan2(coupler.x_axis.y, coupler.x_axis.x), rocker.angle];
        spins: rad/s = [crank.angular_velocity.z, coupler.angular_velocity.z, rocker.angular_velocity.z];
    }
}

/// A slider whose speed is given, on a rod whose end is held: nothing is left to guess that would help.
graph Stuck {
    ground { point O = [0, 0, 0]; }
    body rod {
        mass 1; inertia [0.1, 0.1, 0.1]; point end = [-0.5, 0, 0];
        start end at [0, 0, 0]; start velocity [0.25, guess(0), 0]; start spin [0, 0, 3];
    }
    joint pin: spherical (ground.O -> rod.end) { stiffness 1e5; }
    observe { rod.velocity }
    scene RigidStuck { rigid joints; }
}

/// A mass whose flow a sink keeps at a function of time.
graph Kept {
    param from: kg*m/s = 0; param fast: m/s = 3;
    1 slide: translation; I mass = 2 start guess(from); rSe hold = fast * cos(2 * t);
    slide -> mass; slide -> hold;
    observe { v: m/s = slide.flow }
}

/// The same, put to its flow by an impulse.
graph Struck {
    param from: kg*m/s = 1; param fast: m/s = 3;
    1 slide: translation; I mass = 2 start from; rSe hold = fast * cos(2 * t);
    slide -> mass; slide -> hold; start impulse;
    observe { v: m/s = slide.flow }
}

/// A block on a rigid guide that its start is off by a part of the machine's size, pushed along.
graph Guided {
    param size: m = 1, above 0;
    param off: 1 = 0;
    param push: N = 1;
    body block { mass 2; inertia [0.1, 0.1, 0.1]; start at [size, off * size, 0]; }
    joint guide: prismatic x (ground -> block) { rigid; }
    drive pull on guide force = push;
    observe { x: m = block.position.x; y: m = block.position.y }
}

/// A mass that a sink without a joint holds at a place where it is not.
graph Apart {
    1 v[3]: translation; position x of v start [0, 0.02, 0]; I m = 2; rSe anchor = [0, 0, 0] at x;
    v -> m; v -> anchor;
    observe { x: m = x }
}
";

static GRAPHS: LazyLock<Vec<Graph>> = LazyLock::new(|| graphs(TEXT));

/// The outputs at a state, no switch in the branch of its negative guard.
fn outputs(model: &dyn Machine, x: &[f64]) -> Vec<f64> {
    text::outputs(model, 0.0, x, &vec![false; model.switches()])
}

/// The largest magnitude of these numbers.
fn largest(of: impl IntoIterator<Item = f64>) -> f64 {
    of.into_iter().fold(0.0, |largest, value| largest.max(value.abs()))
}

#[test]
fn a_velocity_that_does_not_fit_a_rigid_joint_is_an_error_with_joint_and_speed() {
    let error = model(&GRAPHS, "RigidBar", &[]).start().unwrap_err();
    assert!(matches!(error, AssemblyError::Torn { .. }), "{error}");
    assert_eq!(
        error.to_string(),
        "the start velocities do not fit: joint `pin` is torn apart at -0.5 m/s in y (allowed: 2e-9); \
         correct them, give `guess(..)` to those that may change, or write `start impulse;`"
    );
    // The same on a compliant pin is a start with a spring that is being stretched; and what fits, fits.
    let compliant = model(&GRAPHS, "Bar", &[]);
    assert_eq!(outputs(&*compliant, &compliant.start().unwrap())[0], 10.0);
    let fitting = model(&GRAPHS, "RigidBar", &[("aside", 0.5)]);
    assert!(fitting.start().is_ok());
    assert_eq!(fitting.impulse_energy(), Ok(0.0));
}

#[test]
fn what_is_a_little_open_is_closed_before_a_run_and_more_is_refused() {
    for size in [-40, -20, 0, 20, 40].map(|exponent| 2.0_f64.powi(exponent)) {
        let guided = |off: f64| model(&GRAPHS, "Guided", &[("size", size), ("off", off), ("push", size)]);
        for off in [1e-14, 1e-12, 0.99e-10] {
            let model = guided(off);
            let y = outputs(&*model, &model.start().unwrap())[1];
            assert!(y.abs() <= 1e-14 * size, "{size}: {y:e}");
            let run = Simulation::over(model, Request::default()).every(0.5).until(1.0).run().unwrap();
            let way = run["x"].last().unwrap() / size - 1.25;
            assert!(way.abs() < 1e-12, "{size}: {way:e}");
        }
        let AssemblyError::Open { largest, .. } = guided(1.01e-10).start().unwrap_err() else {
            panic!("{size}: a gap")
        };
        assert!((largest.allowed / size - 1e-10).abs() < 1e-16, "{size}: {largest}");
    }
}

#[test]
fn what_fits_is_a_part_of_what_moves() {
    // The root of twice the kinetic energy over the mass that the end has: 0.25 J and 2.5 J, 1 / (1/2 + 1/20) kg.
    let fastest = (5.5_f64 * 0.55).sqrt();
    for size in [1e-12, 1.0, 1e12] {
        let start = |misfit: f64| {
            let values = [("spin", 10.0 * size), ("aside", (0.5 + misfit) * size)];
            model(&GRAPHS, "RigidBar", &values).start()
        };
        assert!(start(0.99e-9 * fastest).is_ok(), "{size}");
        let AssemblyError::Torn { allowed, .. } = start(1.01e-9 * fastest).unwrap_err() else {
            panic!("{size}: a misfit")
        };
        assert!((allowed / size / fastest - 1e-9).abs() < 1e-17, "{size}: {allowed:e}");
    }
}

#[test]
fn an_impulse_leaves_what_angular_momentum_leaves_and_says_what_energy_went() {
    let struck = model(&GRAPHS, "StruckBar", &[]);
    let (start, lost) = (struck.start().unwrap(), struck.impulse_energy().unwrap());
    let y = outputs(&*struck, &start);
    // About the pin: J w before, (J + m r^2) w after; J = 0.05, m r^2 = 0.005.
    assert!((y[0] - 100.0 / 11.0).abs() < 1e-13, "{y:?}");
    assert!((lost - 2.5 / 11.0).abs() < 1e-14 && (y[4] + lost - 2.5).abs() < 1e-14, "{y:?} {lost}");
    let span = Span { t0: 0.0, t_end: 1.0 };
    let settings = Settings::default();
    let finish = drive(&*struck, &mut Dop853::new(), &start, span, &settings, None, &mut ()).unwrap();
    let late = outputs(&*struck, finish.x.as_slice());
    assert!((late[0] - 100.0 / 11.0).abs() < 1e-6 && largest(late[1..4].iter().copied()) < 1e-6, "{late:?}");
    // A scene has the same, and so has a model in other numbers.
    let planar = model(&GRAPHS, "PlanarBar", &[]);
    let y = outputs(&*planar, &planar.start().unwrap());
    assert!((y[0] - 100.0 / 11.0).abs() < 1e-13 && (planar.impulse_energy().unwrap() - lost).abs() < 1e-14);
    let exact = struck.in_scalar::<DoubleDouble>();
    let [half, mass, arm, inertia, spin] = [0.5, 2.0, 0.05, 0.05, 10.0].map(DoubleDouble::from);
    let beside = mass * arm * arm;
    let error = exact.impulse_energy().unwrap() - half * inertia * spin * spin * beside / (inertia + beside);
    assert!(error.to_f64().abs() < 1e-30, "{error:?}");
    // What fits loses nothing.
    let fitting = model(&GRAPHS, "StruckBar", &[("aside", 0.5)]);
    assert!(fitting.impulse_energy().unwrap().abs() < 1e-30);
}

/// The speeds of coupler and rocker by the closed form (Norton, Design of Machinery, section 6.7).
fn four_bar(angles: &[f64], speed: f64) -> [f64; 2] {
    let (a, b, c) = (0.1, 0.28, 0.25);
    let [crank, coupler, rocker] = [angles[0], angles[1], angles[2]];
    [
        a * speed / b * (rocker - crank).sin() / (coupler - rocker).sin(),
        a * speed / c * (crank - coupler).sin() / (rocker - coupler).sin(),
    ]
}

#[test]
fn guessed_velocities_of_a_four_bar_linkage_are_those_of_the_closed_form() {
    for speed in [7.0, -300.0] {
        let compliant = model(&GRAPHS, "FourBar", &[("speed", speed)]);
        let y = outputs(&*compliant, &compliant.start().unwrap());
        let bound = 1e-12 * speed.abs();
        let [coupler, rocker] = four_bar(&y[..3], speed);
        assert!((y[3] - speed).abs() < bound, "{y:?}");
        assert!((y[4] - coupler).abs() < bound && (y[5] - rocker).abs() < bound, "{y:?} {coupler} {rocker}");
        // The crank's centre is in its middle; coupler and rocker meet; what nothing asks to turn does not.
        assert!((y[6] + 0.05 * speed * y[0].sin()).abs() < bound && (y[7] - 0.05 * speed * y[0].cos()).abs() < bound);
        let apart = largest((9..12).map(|k| y[k] - y[k + 3]));
        assert!(apart < bound && y[15].abs() < bound && y[16].abs() < bound);

        let rigid = model(&GRAPHS, "FlatFourBar", &[("speed", speed)]);
        let y = outputs(&*rigid, &rigid.start().unwrap());
        let [coupler, rocker] = four_bar(&y[..3], speed);
        assert!((y[4] - coupler).abs() < bound && (y[5] - rocker).abs() < bound, "{y:?} {coupler} {rocker}");
    }
}

#[test]
fn guesses_that_cannot_help_leave_an_error() {
    let compliant = model(&GRAPHS, "Stuck", &[]);
    assert_eq!(
        compliant.start().unwrap_err().to_string(),
        "the start velocities do not fit: joint `pin` is torn apart at 0.25 m/s in x (allowed: 2e-9); \
         correct them, give `guess(..)` to those that may change"
    );
    let rigid = model(&GRAPHS, "RigidStuck", &[]);
    assert!(rigid.start().unwrap_err().to_string().ends_with("or write `start impulse;`"));
}

#[test]
fn a_kept_flow_that_is_a_function_of_time_is_met_at_the_start() {
    let kept = model(&GRAPHS, "Kept", &[]);
    assert!((kept.start().unwrap()[0] - 6.0).abs() < 1e-14);
    let struck = model(&GRAPHS, "Struck", &[]);
    assert!((struck.start().unwrap()[0] - 6.0).abs() < 1e-14);
    // Half of m (3 - 0.5)^2; the rest of what the mass gains comes from the sink's own flow.
    assert!((struck.impulse_energy().unwrap() - 6.25).abs() < 1e-13);
    assert_eq!(struck.held().expect("a sink holds it").rigid.len(), 1);
}

#[test]
fn a_gap_of_a_sink_that_belongs_to_no_joint_is_an_error() {
    let error = model(&GRAPHS, "Apart", &[]).start().unwrap_err();
    let AssemblyError::Open { largest, .. } = &error else { panic!("{error}") };
    assert_eq!((largest.gap.joint, largest.gap.component, largest.size), ("anchor", "y", 0.02));
}
