//! Friction and stops as words: a bearing, a guide, clutches, ends; against known motions.

use bg_model::bond_graph;
use bg_model::integrator::Integrator;
use bg_model::run::{Simulation, Trajectory};

bond_graph! {
    /// A pendulum that comes to rest in the friction of its bearing.
    graph Pendulum {
        param angle: rad = -0.4;
        param torque: N*m = 1.5;
        gravity [0, -9.81, 0];
        ground { point pivot = [0, 0, 0]; }
        body rod { mass 2; inertia [0.1, 0.1, 0.1]; point end = [-0.5, 0, 0]; start end at [0, 0, 0];
            start turned rotation_z(angle); }
        joint pin: revolute z (ground.pivot -> rod.end) { rigid; }
        friction seat on pin { coulomb torque; }
        observe { angle: rad = pin.angle; speed: rad/s = pin.speed; seat.effort }
        /// In the plane, by its angle.
        scene Swing { observe { angle: rad = pin.angle; speed: rad/s = pin.speed; seat.effort } expect planar; angles; }
    }
    /// On a compliant pin, whose force presses.
    graph Journal {
        gravity [0, -9.81, 0];
        ground { point pivot = [0, 0, 0]; }
        body rod { mass 2; inertia [0.1, 0.1, 0.1]; point end = [-0.5, 0, 0]; start end at [0, 0, 0];
            start turned rotation_z(-0.4); }
        joint pin: revolute z (ground.pivot -> rod.end) { stiffness 1e5; damping 100; tilt stiffness 1e3;
            tilt damping 1; }
        friction seat on pin { coulomb 0.2; static 0.3; stribeck 0.1; viscous 1e-3; radius 0.1; }
        observe { angle: rad = pin.angle; speed: rad/s = pin.speed; seat.effort; force: N = norm(pin.force) }
    }
    /// A block on an incline, pressed to it by a spring and its damper.
    graph Incline {
        param slope: rad = 0.5;
        gravity [9.81 * sin(slope), -9.81 * cos(slope), 0];
        ground { point plane = [0, 0, 0]; }
        body block { mass 3; inertia [0.1, 0.1, 0.1]; }
        joint guide: prismatic x (ground.plane -> block) { stiffness [0, 1e5, 1e5]; damping 300; tilt stiffness 1e4;
            tilt damping 10; }
        friction rub on guide { coulomb 0.4; normal guide.force.y; }
        observe { v: m/s = block.velocity.x; u: m/s = block.velocity.y }
    }
    /// Four inertias and three clutches: `Modelica.Mechanics.Rotational.Examples.CoupledClutches`.
    graph Clutches {
        let press: N = 20 * cos(0.4 * 3.141592653589793 * t / 1);
        let second: N = if t < 0.4 { 0 } else { 20 };
        let third: N = if t < 0.9 { 0 } else { 20 };
        1 one, two, three, four: rotation; I J1 = 1 start 10; I J2 = 1; I J3 = 1; I J4 = 1;
        0 a, b, c: rotation; 1 slip_a, slip_b, slip_c: rotation;
        MSe motor = 10 * sin(31.41592653589793 * t / 1);
        motor -> one -> J1; two -> J2; three -> J3; four -> J4;
        one -> a -> two -> b -> three -> c -> four; a -> slip_a; b -> slip_b; c -> slip_c;
        friction clutch1 on slip_a { coulomb 0.5; static 0.55; normal press; radius 1; }
        friction clutch2 on slip_b { coulomb 0.5; static 0.55; normal second; radius 1; }
        friction clutch3 on slip_c { coulomb 0.5; static 0.55; normal third; radius 1; }
        observe { w1: rad/s = one.flow; w2: rad/s = two.flow; w3: rad/s = three.flow; w4: rad/s = four.flow }
    }
    /// A sledge between two damped ends.
    graph Box {
        1 slide: translation; I sledge = 3 start 6;
        stop ends on slide { at most 0.2; at least -0.1; stiffness 1e4; damping 20; }
        slide -> sledge;
        observe { x: m = ends.spring.q; v: m/s = slide.flow; ends.effort; energy: J = stored_energy;
            lost: J = integral(dissipated_power) }
    }
    /// A weight that falls on a floor, and a carriage that runs against the end of its guide.
    graph Weight {
        1 fall: translation; I body = 2; Se weight = -19.62; weight -> fall -> body;
        stop floor on fall { at least 0; start 1; stiffness 1e4; damping 30; }
        ground { point middle = [0, 0, 0]; }
        body carriage { mass 3; inertia [0.1, 0.1, 0.1]; start velocity [2, 0, 0]; }
        joint guide: prismatic x (ground.middle -> carriage) { rigid; }
        friction rub on guide { coulomb 5; } stop end on guide { at most 0.2; stiffness 1e4; }
        observe { y: m = floor.spring.q; u: m/s = fall.flow; force: N = floor.effort; x: m = guide.travel;
            v: m/s = guide.slide.flow }
    }
    /// A mass that creeps under a load below the dry friction.
    graph Creep {
        param load: N = 3;
        1 slide: translation; I mass = 2; Se pull = load; pull -> slide -> mass;
        friction rub on slide { coulomb 5; creep 1e-3; }
        observe { v: m/s = slide.flow }
    }
}

fn run<Mo: bg_model::mechanism::Mechanism>(model: &Mo, method: Integrator, step: f64, end: f64) -> Trajectory {
    let run = Simulation::new(model).method(method).rtol(1e-10).atol(1e-11).every(step).until(end).run();
    run.unwrap_or_else(|fault| panic!("{}: {fault}", method.name()))
}

/// What may be off; a method of order 2 with fixed steps follows no tolerance.
fn bound(integrator: Integrator) -> f64 {
    if integrator == Integrator::Ros2 { 1e-4 } else { 1e-8 }
}

/// The integrators that follow a tolerance.
fn adaptive() -> impl Iterator<Item = Integrator> {
    Integrator::ALL.into_iter().filter(|integrator| !integrator.has_fixed_step())
}

/// The zero of a function between two places of different sign.
fn zero(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let sign = f(low).signum();
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        *(if f(middle) * sign > 0.0 { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}

/// Where it turns and, in the end, where it rests: the weight's work from one turn to the next is what the friction
/// takes.
fn rest(mut angle: f64, torque: f64) -> f64 {
    let weight = 2.0 * 9.81 * 0.5;
    while weight * angle.cos().abs() > torque {
        let way = -angle.cos().signum();
        let left = |to: f64| weight * (angle.sin() - to.sin()) - torque * (to - angle).abs();
        // Down to the place where the weight's torque is the friction's, then up to the turn.
        let bottom = -std::f64::consts::FRAC_PI_2;
        let slowest = bottom - way * libm::asin(torque / weight);
        angle = zero(slowest, slowest + 3.0 * way, left);
    }
    angle
}

#[test]
fn a_pendulum_comes_to_rest_where_its_work_says() {
    let expected = rest(-0.4, 1.5);
    for method in adaptive() {
        let literal = run(&Pendulum::new(PendulumParameters::default()).expect("in range"), method, 20.0, 20.0);
        let swing = run(&Swing::new(SwingParameters::default()).expect("in range"), method, 20.0, 20.0);
        for (run, bound) in [(literal, 2e-6), (swing, 1e-8)] {
            let (angle, speed) = (run["angle"][1], run["speed"][1]);
            assert!((angle - expected).abs() < bound, "{}: {angle} {expected}", method.name());
            assert!(speed.abs() < 1e-9, "{}: {speed:e}", method.name());
            assert!((run["seat.effort"][1] + 9.81 * angle.cos()).abs() < 1e-6, "{}", method.name());
        }
    }
}

#[test]
fn a_journal_rubs_with_the_force_of_its_pin() {
    let model = Journal::new(JournalParameters::default()).expect("in range");
    for method in adaptive() {
        let run = run(&model, method, 0.05, 12.0);
        let mut sticks = 0;
        for k in 1..run.times.len() {
            let (speed, effort, force) = (run["speed"][k], run["seat.effort"][k], run["force"][k]);
            let drop = 0.1 * libm::exp(-(speed / 0.1) * (speed / 0.1));
            let slides = ((0.2 + drop) * 0.1 * force + 1e-3 * speed.abs()) * speed.signum();
            let holds = speed.abs() < 1e-8 && effort.abs() < 0.3 * 0.1 * force * (1.0 + 1e-9);
            sticks += u32::from(holds);
            assert!(holds || (effort - slides).abs() < 1e-9 * force, "{} {k}: {effort} {slides}", method.name());
        }
        let last = run.times.len() - 1;
        assert!(sticks > 20 && run["speed"][last].abs() < 1e-8, "{}: {sticks}", method.name());
    }
}

/// The normal force has brought the block's fall into the plane to rest: m u' = N - m g cos a, so that the friction has
/// taken mu (g cos a T + u) of the speed along the plane.
#[test]
fn a_block_on_an_incline_slides_by_its_normal_force() {
    for method in adaptive() {
        for slope in [0.5_f64, 0.7, 0.3] {
            let run = run(&Incline::new(InclineParameters { slope }).expect("in range"), method, 2.0, 2.0);
            let slides = 9.81 * slope.sin() * 2.0 - 0.4 * (9.81 * slope.cos() * 2.0 + run["u"][1]);
            let expected = if slope < 0.4_f64.atan() { 0.0 } else { slides };
            assert!((run["v"][1] - expected).abs() < 1e-8, "{} {slope}: {} {expected}", method.name(), run["v"][1]);
        }
    }
}

/// Reference: `CoupledClutches_ref.csv` of Dymola 2016, FMI cross-check repository of the Modelica Association,
/// fmus/2.0/me/win64; of three digits: at 0.3 s its first speed is 1.2e-3 from the exact one. As long as only the first
/// clutch has been pressed, the speeds are integrals.
#[test]
fn coupled_clutches_are_those_of_the_modelica_library() {
    let reference = [
        [0.3, 7.708_389_8, 2.929_885_4, 0.0, 0.0],
        [0.444, 6.043_025, 3.774_146, 0.44, 0.0],
        [1.08, 3.368_686_4, 2.706_804_3, 2.706_804_3, 1.8],
        [1.143, 3.071_106_4, 2.446_584_5, 2.446_584_5, 2.43],
        [1.2, 2.629_627_7, 2.459_820_3, 2.459_820_3, 2.459_820_3],
        [1.5, 3.249_022, 2.465_188, 2.465_188, 2.465_188],
    ];
    let model = Clutches::new(ClutchesParameters::default()).expect("in range");
    for method in Integrator::ALL {
        let run = run(&model, method, 0.001, 1.5);
        let pulled = libm::sin(0.12 * std::f64::consts::PI) * 25.0 / std::f64::consts::PI;
        assert!((run["w2"][300] - pulled).abs() < bound(method), "{}: {} {pulled}", method.name(), run["w2"][300]);
        let driven = 10.0 + 2.0 / std::f64::consts::PI - pulled;
        assert!((run["w1"][300] - driven).abs() < bound(method), "{}: {} {driven}", method.name(), run["w1"][300]);
        for row in reference {
            let k = run.times.iter().position(|t| (t - row[0]).abs() < 1e-9).expect("a sample");
            for (name, expected) in ["w1", "w2", "w3", "w4"].iter().zip(&row[1..]) {
                let found = run[*name][k];
                assert!((found - expected).abs() < 5e-3, "{} {} {name}: {found} {expected}", method.name(), row[0]);
            }
        }
    }
}

/// With sin p = d / (2 sqrt(k m)) the sledge is (pi - 2 p) / w beyond an end, w = sqrt(k / m) cos p, and leaves it with
/// exp(-(pi - 2 p) tan p) of its speed v, where it is v sin(2 p) / w beyond the end: from there on the stop would pull.
#[test]
fn a_stop_gives_back_what_its_damping_leaves() {
    let (mass, stiffness, damping) = (3.0, 1e4, 20.0);
    let phase = libm::asin(damping / (2.0 * f64::sqrt(stiffness * mass)));
    let rest = std::f64::consts::PI - 2.0 * phase;
    let frequency = f64::sqrt(stiffness / mass) * phase.cos();
    let (contact, ratio) = (rest / frequency, libm::exp(-rest * phase.tan()));
    for method in adaptive() {
        let run = run(&Box::new(BoxParameters::default()).expect("in range"), method, 0.01, 2.0);
        let (mut t, mut speed, mut way) = (0.0, 2.0, 0.2);
        while t + way / speed < 2.0 {
            t += way / speed;
            let gone = t + contact;
            for (k, now) in run.times.iter().enumerate().filter(|(_, now)| **now > gone && **now < gone + 0.3 / speed) {
                let v = run["v"][k].abs();
                assert!((v - speed * ratio).abs() < 1e-7, "{} {now}: {v} {}", method.name(), speed * ratio);
            }
            (t, speed) = (gone, speed * ratio);
            way = 0.3 + speed * libm::sin(2.0 * phase) / frequency;
        }
        for k in 0..run.times.len() {
            let (x, effort) = (run["x"][k], run["ends.effort"][k]);
            assert!(effort * x >= 0.0, "{}: pulls with {effort} at {x}", method.name());
            assert!((run["energy"][k] + run["lost"][k] - 6.0).abs() < 1e-8, "{}", method.name());
        }
    }
}

#[test]
fn what_falls_on_a_stop_rests_on_it() {
    for method in adaptive() {
        let run = run(&Weight::new(WeightParameters::default()).expect("in range"), method, 30.0, 30.0);
        assert!((run["y"][1] + 19.62 / 1e4).abs() < 1e-9, "{}: {}", method.name(), run["y"][1]);
        assert!((run["force"][1] + 19.62).abs() < 1e-6, "{}: {}", method.name(), run["force"][1]);
        // 6 J go into 5 N of friction over 1.2 m, but for what is the way beyond the stop: it comes to rest at 0.2 -
        // 1.0.
        let depth = zero(0.0, 0.1, |depth| 6.0 - 5.0 * (0.2 + depth) - 0.5e4 * depth * depth);
        let place = 0.2 + depth - (1.2 - 0.2 - depth);
        assert!((run["x"][1] - place).abs() < 1e-7, "{}: {} {place}", method.name(), run["x"][1]);
        assert!(run["v"][1].abs() < 1e-9, "{}: {}", method.name(), run["v"][1]);
    }
}

/// F v / sqrt(v^2 + c^2) = load, so v = c load / sqrt(F^2 - load^2).
#[test]
fn a_regularised_friction_creeps_with_the_stated_speed() {
    for method in adaptive() {
        let run = run(&Creep::new(CreepParameters::default()).expect("in range"), method, 1.0, 1.0);
        let speed = 1e-3 * 3.0 / 4.0;
        assert!((run["v"][1] - speed).abs() < 1e-8 * speed, "{}: {}", method.name(), run["v"][1]);
    }
}
