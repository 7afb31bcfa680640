//! Derivatives by parameters and start values against five-point differences in double-double arithmetic, and closed
//! forms.

mod adjoint;

use bg_model::bond_graph;
use bg_model::extended::Accuracy;
use bg_model::integrator::Integrator;
use bg_model::mechanism::{InEachBuild, Mechanism};
use bg_model::parameters::Parameters;
use bg_model::run::Request;
use bg_model::scalar::{Dual, Scalar};
use bg_model::sensitivity::{Direction, differences, sensitivities};
use bg_model::simulation::Samples;

bond_graph! {
    /// A rod on a hinge that does not give, with what it loses.
    graph Pendulum {
        param angle: rad = 0.4; param length: m = 0.6, above 0; param friction: N*m*s/rad = 0.05;
        param gravity: m/s^2 = 9.81;
        param spin: rad/s = 1;
        gravity [0, -gravity, 0];
        ground { point pivot = [0, 0, 0]; }
        body rod {
            cuboid [length, 0.03, 0.03] density 7850; point end = [-length / 2, 0, 0];
            start end at [0, 0, 0]; start turned rotation_z(angle);
            start velocity [guess(0), guess(0), 0]; start spin [0, 0, spin];
        }
        joint pin: revolute z (ground.pivot -> rod.end) { rigid; }
        drive brake on pin torque = -friction * pin.speed;
        observe { angle: rad = rod.angle; x: m = rod.position.x; force: N = pin.force.y;
            lost: J = integral(brake.power) }
        scenes only;
        scene Pendulum { expect planar; }
    }
    /// A block on a spring, whose contact resists its two directions differently, with a jump between them.
    graph Block {
        param mass: kg = 1, above 0; param stiffness: N/m = 100, above 0; param cut: N*s/m = 5; param back: N*s/m = 1;
        param drop: N = 0.2; param start: m = 0.5;
        1 slide: translation; I block = mass; C spring = stiffness start start;
        R saw(v) = if v < 0 { cut * v - drop } else { back * v + drop };
        slide -> block; slide -> spring; slide -> saw;
        observe { x: m = spring.q; v: m/s = slide.flow; force: N = saw.effort; lost: J = integral(dissipated_power) }
    }
    /// A mass that a belt carries until its spring tears it off.
    graph Belt {
        param mass: kg = 2, above 0; param stiffness: N/m = 50, above 0; param belt: m/s = 0.1; param still: N = 6;
        param kinetic: N = 4;
        1 slide: translation; I body = mass start mass * belt; C spring = stiffness;
        Sf drum = belt; 0 between: translation; 1 slip: translation;
        drum -> between -> slide -> body; slide -> spring; between -> slip;
        friction rub on slip { coulomb kinetic; static still; }
        observe { x: m = spring.q; v: m/s = slide.flow; force: N = rub.effort; lost: J = integral(dissipated_power) }
    }
    /// A ball that falls on a floor.
    graph Ball {
        param mass: kg = 2, above 0; param height: m = 1.25; param gravity: m/s^2 = 9.81; param give: 1 = 0.8;
        1 fall: translation; I ball = mass; Se weight = -mass * gravity; weight -> fall -> ball;
        stop floor on fall { at least 0; start height; restitution give; }
        observe { y: m = floor.place; v: m/s = fall.flow; lost: J = integral(dissipated_power) }
    }
    /// The same on a table that is lifted faster and faster.
    graph Lifted {
        param mass: kg = 2, above 0; param height: m = 1.25; param gravity: m/s^2 = 9.81; param give: 1 = 0.8;
        param rise: m/s^2 = 1.5;
        1 fall: translation; I ball = mass; Se weight = -mass * gravity; weight -> fall -> ball;
        MSf table = rise * t; 0 between: translation; 1 apart: translation; table -> between -> fall; between -> apart;
        stop floor on apart { at most 0; start -height; restitution give; }
        observe { y: m = floor.place; v: m/s = fall.flow; lost: J = integral(dissipated_power) }
    }
    /// A ball that falls on a floor which gives way, and keeps the speed at which it met it.
    graph Dropped {
        param mass: kg = 0.5, above 0; param height: m = 0.05; param gravity: m/s^2 = 9.81; param stiffness: N/m = 1e4;
        param give: 1 = 0.7;
        gravity [0, -gravity, 0];
        ground { point O = [0, 0, 0]; }
        body ball { mass mass; inertia [1e-3, 1e-3, 1e-3]; start at [0, 0.1 + height, 0]; }
        contact floor (ground.O line x -> ball circle 0.1) { stiffness stiffness; restitution give; }
        observe { y: m = ball.position.y; v: m/s = ball.velocity.y; lost: J = integral(dissipated_power) }
        scenes only;
        scene Dropped { expect planar; }
    }
    /// A wheel whose speed a computer keeps, with a limit; every so often it looks at the angle, too.
    graph Sampled {
        param period: s = 0.02, above 0; param delay: s = 0.003, at least 0; param wanted: rad/s = 10;
        param gain: N*m*s/rad = 3;
        param integral: N*m/rad = 9; param most: N*m = 12, above 0; param inertia: kg*m^2 = 0.5, above 0;
        param began: rad/s = 1;
        every period offset delay {
            sample error: rad/s = wanted - shaft.flow - correction;
            sample wish: N*m = gain * error + integral * sum.last;
            sample sum: rad = if abs(wish) < most { sum.last + period * error } else { sum.last };
            sample torque: N*m = if wish > most { most } else if wish < -most { -most } else { wish };
        }
        every 5 * period { sample correction: rad/s = 0.1 * shaft.displacement / (1 s); }
        MSe motor = torque; 1 shaft: rotation; I wheel = inertia start inertia * began; R rub(w) = 0.4 * w * abs(w);
        motor -> shaft -> wheel; shaft -> rub;
        observe { speed: rad/s = shaft.flow; angle: rad = shaft.displacement; torque: N*m = torque;
            work: J = integral(motor.power) }
    }
    /// A mass on a spring.
    graph Oscillator {
        param mass: kg = 2, above 0; param stiffness: N/m = 50, above 0; param start: m = 0.1;
        1 slide: translation; I body = mass; C spring = stiffness start start; slide -> body; slide -> spring;
        observe { x: m = spring.q }
    }
    /// A slider and a crank of rigid joints, whose loop the assembly closes.
    graph Crank {
        param radius: m = 0.2, above 0; param rod: m = 0.6, above 0; param angle: rad = 1; param spin: rad/s = -8;
        param drag: N*s/m = 2;
        ground { point O = [0, 0, 0]; }
        body crank { mass 1; inertia [0.02, 0.02, 0.02]; point a = [-radius / 2, 0, 0]; point b = [radius / 2, 0, 0];
            start a at [0, 0, 0]; start turned rotation_z(angle); start velocity [guess(0), guess(0), 0];
            start spin [0, 0, spin]; }
        body link { mass 0.5; inertia [0.01, 0.01, 0.01]; point b = [-rod / 2, 0, 0]; point c = [rod / 2, 0, 0];
            start b at [radius * cos(angle), radius * sin(angle), 0]; start turned rotation_z(guess(-0.3));
            start velocity [guess(0), guess(0), 0]; start spin [0, 0, guess(0)]; }
        body slider { mass 0.7; inertia [0.01, 0.01, 0.01]; start at [guess(0.7), 0, 0];
            start velocity [guess(0), guess(0), 0]; }
        joint pin_o: revolute z (ground.O -> crank.a) { rigid; }
        joint pin_a: revolute z (crank.b -> link.b) { rigid; }
        joint pin_b: revolute z (link.c -> slider) { rigid; }
        joint guide: prismatic x (ground.O -> slider) { rigid; }
        drive load on guide force = -drag * slider.velocity.x;
        observe { x: m = guide.travel; v: m/s = slider.velocity.x; angle: rad = crank.angle; force: N = pin_a.force.x }
        scenes only;
        scene Crank { expect planar; }
    }
}

fn request(t: f64, method: Integrator) -> Request {
    Request { method, t_end: t, rtol: 1e-12, atol: Some(1e-13), samples: Samples::At(vec![t]), ..Request::default() }
}

/// The largest difference of an exact derivative from differences, in parts of the largest derivative of its output at
/// `t` (s) per part of its parameter; and how many events there were.
fn deviation<Me: Mechanism>(model: &Me, t: f64, method: Integrator) -> (f64, u64) {
    let directions = Direction::parameters::<Me>();
    let found = sensitivities(model, &request(t, method), &directions).expect("derivatives");
    let in_vectors = sensitivities(&InEachBuild(model.clone()), &request(t, method), &directions).expect("derivatives");
    for (k, output) in (0..directions.len()).flat_map(|k| (0..Me::describe().outputs.len()).map(move |of| (k, of))) {
        let [of_each, of_all] = [&found, &in_vectors].map(|found| found.of(k, output)[0].to_bits());
        assert_eq!(of_each, of_all, "output {output} by parameter {k}");
    }
    let values: Vec<f64> = (0..directions.len()).map(|k| model.parameters().value(k)).collect();
    let mut worst = 0.0_f64;
    let accuracy = Accuracy { columns: 8, tolerance: 1e-20 };
    let expected: Vec<Vec<f64>> = (0..directions.len())
        .map(|parameter| differences(model, parameter, t, 1e-4, accuracy).expect("runs"))
        .collect();
    for output in 0..Me::describe().outputs.len() {
        let size = |k: usize| (expected[k][output] * values[k]).abs();
        let largest = (0..directions.len()).map(size).fold(0.0, f64::max);
        for (k, expected) in expected.iter().enumerate() {
            let error = ((found.of(k, output)[0] - expected[output]) * values[k]).abs() / largest;
            worst = worst.max(error);
        }
    }
    (worst, found.trajectory.statistics.events)
}

#[test]
fn a_pendulum_on_a_rigid_hinge() {
    let (error, _) = deviation(&Pendulum::new(PendulumParameters::default()).unwrap(), 1.5, Integrator::Dop853);
    assert!(error < 1e-9, "{error:e}");
}

#[test]
fn a_closed_loop_from_its_assembled_start() {
    let (error, _) = deviation(&Crank::new(CrankParameters::default()).unwrap(), 0.5, Integrator::Dop853);
    assert!(error < 1e-9, "{error:e}");
}

#[test]
fn a_law_with_two_branches() {
    let (error, events) = deviation(&Block::new(BlockParameters::default()).unwrap(), 2.0, Integrator::Auto);
    assert!(error < 1e-9 && events > 5, "{error:e} {events}");
}

#[test]
fn a_contact_by_restitution_keeps_a_speed_of_an_instant_that_moves() {
    let (error, events) = deviation(&Dropped::new(DroppedParameters::default()).unwrap(), 0.25, Integrator::Dop853);
    assert!(error < 1e-8 && events >= 2, "{error:e} {events}");
}

#[test]
fn samples_whose_instants_move() {
    let (error, _) = deviation(&Sampled::new(SampledParameters::default()).unwrap(), 0.95, Integrator::Dop853);
    assert!(error < 1e-9, "{error:e}");
}

#[test]
fn sticking_and_slipping() {
    let (error, events) = deviation(&Belt::new(BeltParameters::default()).unwrap(), 4.0, Integrator::Dop853);
    assert!(error < 1e-9 && events > 3, "{error:e} {events}");
}

/// Place and speed of the ball at `t` (s) after it has bounced: from h, g and e.
fn bounced<S: Scalar>(height: S, gravity: S, give: S, t: S) -> [S; 2] {
    let number = S::from_f64;
    let first = (number(2.0) * gravity * height).sqrt();
    let (mut since, mut speed) = (t - first / gravity, give * first);
    loop {
        let flight = number(2.0) * speed / gravity;
        if since.to_f64() < flight.to_f64() {
            return [speed * since - number(0.5) * gravity * since * since, speed - gravity * since];
        }
        (since, speed) = (since - flight, speed * give);
    }
}

#[test]
fn impacts_against_the_closed_form() {
    let model = Ball::new(BallParameters::default()).unwrap();
    let by = |name| Direction::parameter::<Ball>(name).unwrap();
    let place = Ball::describe().states.iter().position(|state| state.unit == "m").expect("the place of the stop");
    let directions = [by("height"), by("gravity"), by("give"), by("mass"), Direction::Start(place)];
    for method in [Integrator::Dop853, Integrator::Radau9] {
        let found = sensitivities(&model, &request(3.0, method), &directions).unwrap();
        assert!(found.trajectory.statistics.events >= 3, "{}", found.trajectory.statistics.events);
        let expected = |k: usize| {
            let mut numbers = [1.25, 9.81, 0.8].map(Dual::from_f64);
            numbers[k].slope = 1.0;
            let [height, gravity, give] = numbers;
            bounced(height, gravity, give, Dual::from_f64(3.0))
        };
        for output in 0..2 {
            for k in 0..3 {
                let Dual { value, slope } = expected(k)[output];
                assert!((found.trajectory.columns[output].values[0] - value).abs() < 1e-9);
                let error = (found.of(k, output)[0] - slope).abs() / slope.abs();
                assert!(error < 1e-9, "{} by {k}: {error:e}", method.name());
            }
            // A heavier ball bounces alike.
            assert!(found.of(3, output)[0].abs() < 1e-9, "{}", found.of(3, output)[0]);
        }
        // The stop's place is the state that starts at the height.
        assert!((found.of(4, 0)[0] - found.of(0, 0)[0]).abs() < 1e-12);
    }
}

/// Seen from the table the ball falls with g + a; where it hits, the speed of the table depends on the instant.
#[test]
fn impacts_on_what_moves_against_the_closed_form() {
    let model = Lifted::new(LiftedParameters::default()).unwrap();
    let names = ["height", "gravity", "give", "rise"];
    let directions = names.map(|name| Direction::parameter::<Lifted>(name).unwrap());
    let found = sensitivities(&model, &request(3.0, Integrator::Dop853), &directions).unwrap();
    assert!(found.trajectory.statistics.events >= 3, "{}", found.trajectory.statistics.events);
    for k in 0..4 {
        let mut numbers = [1.25, 9.81, 0.8, 1.5].map(Dual::from_f64);
        numbers[k].slope = 1.0;
        let ([height, gravity, give, rise], t) = (numbers, Dual::from_f64(3.0));
        let [place, speed] = bounced(height, gravity + rise, give, t);
        // The way of the table past the ball.
        for (output, Dual { value, slope }) in [-place, speed + rise * t].into_iter().enumerate() {
            assert!((found.trajectory.columns[output].values[0] - value).abs() < 1e-9);
            let error = (found.of(k, output)[0] - slope).abs() / slope.abs();
            assert!(error < 1e-9, "{}: {error:e}", names[k]);
        }
    }
}

/// The steps of a Taylor series go over more than a radian, for which those of the slopes are divided: x = x_0 cos(w t)
/// with w = sqrt(k / m).
#[test]
fn slopes_along_long_steps_are_as_exact_as_the_run() {
    let model = Oscillator::new(OscillatorParameters::default()).unwrap();
    let stiffness = Direction::parameter::<Oscillator>("stiffness").unwrap();
    let request = Request { rtol: 1e-11, ..request(6.0, Integrator::Taylor) };
    let found = sensitivities(&model, &request, &[stiffness]).unwrap();
    let steps = found.trajectory.statistics.steps;
    let expected = -0.1 * 30.0_f64.sin() * 6.0 / (2.0 * 2.0 * 5.0);
    let error = (found.of(0, 0)[0] - expected).abs() / expected.abs();
    assert!(error < 1e-9 && steps < 30, "in {steps} steps: {error:e}");
}

/// At rest every step of a run is exact, however long: not so its slopes, dx/dx_0 = cos(w t).
#[test]
fn slopes_of_a_state_at_rest_are_those_of_the_solution() {
    let (model, expected) = at_rest();
    let start = Direction::parameter::<Oscillator>("start").unwrap();
    for (method, most) in MOST_AT_REST {
        let request = Request { rtol: 1e-8, atol: None, ..request(AT_REST, method) };
        let found = sensitivities(&model, &request, &[start]).unwrap();
        let error = (found.of(0, 0)[0] - expected).abs();
        assert!(error < most, "{}: {error:e}", method.name());
    }
}

/// How long it is looked at, s.
const AT_REST: f64 = 0.05;
/// The largest error of a derivative at rtol 1e-8. DOP853's own steps are divided where they lose half of the digits.
const MOST_AT_REST: [(Integrator, f64); 5] = [
    (Integrator::Dop853, 1e-4),
    (Integrator::Taylor, 1e-6),
    (Integrator::Radau9, 1e-6),
    (Integrator::Nystrom, 1e-6),
    (Integrator::Auto, 1e-6),
];

/// An oscillator at rest, and how its place after that time depends on where it starts.
fn at_rest() -> (Oscillator, f64) {
    let parameters = OscillatorParameters { start: 0.0, stiffness: 2e6, ..OscillatorParameters::default() };
    (Oscillator::new(parameters).unwrap(), (1e3 * AT_REST).cos())
}

#[test]
fn each_direction_is_the_same_beside_others_and_alone() {
    let model = Block::new(BlockParameters::default()).unwrap();
    let all = Direction::parameters::<Block>();
    let together = sensitivities(&model, &request(1.0, Integrator::Dop853), &all).unwrap();
    for (k, &direction) in all.iter().enumerate() {
        let alone = sensitivities(&model, &request(1.0, Integrator::Dop853), &[direction]).unwrap();
        for output in 0..4 {
            let difference = (together.of(k, output)[0] - alone.of(0, output)[0]).abs();
            assert!(difference <= 1e-11 * (1.0 + alone.of(0, output)[0].abs()), "{difference:e}");
        }
    }
}

#[test]
fn the_run_is_the_one_without_derivatives() {
    let model = Belt::new(BeltParameters::default()).unwrap();
    let request = Request { samples: Samples::Every(0.1), ..request(4.0, Integrator::Auto) };
    let plain = bg_model::run::Simulation::of(&model, request.clone()).run().unwrap();
    let found = sensitivities(&model, &request, &Direction::parameters::<Belt>()).unwrap();
    assert_eq!(found.trajectory.recording, plain.recording);
    assert_eq!(found.trajectory.statistics, plain.statistics);
}
