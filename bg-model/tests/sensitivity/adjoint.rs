//! Adjoint gradients against slopes that follow a run.

use bg_model::integrator::Integrator;
use bg_model::mechanism::Mechanism;
use bg_model::parameters::Parameters;
use bg_model::run::{Progress, Request};
use bg_model::sensitivity::{
    Direction, Gradients, Measured, Objective, Sensitivities, SensitivityError, gradient, gradient_within,
    sensitivities,
};
use bg_model::simulation::Samples;

use super::{
    AT_REST, Ball, BallParameters, Belt, BeltParameters, Block, BlockParameters, Crank, CrankParameters, Dropped,
    DroppedParameters, Lifted, LiftedParameters, MOST_AT_REST, Oscillator, Pendulum, PendulumParameters, Sampled,
    SampledParameters, at_rest,
};

/// All parameters and the start of each state.
fn everything<Me: Mechanism>() -> Vec<Direction> {
    let starts = (0..Me::describe().states.len()).map(Direction::Start);
    Direction::parameters::<Me>().into_iter().chain(starts).collect()
}

fn request(t: f64) -> Request {
    Request { method: Integrator::Dop853, t_end: t, rtol: 1e-9, ..Request::default() }
}

/// The slopes of the outputs at the start and at these instants.
fn slopes<Me: Mechanism>(model: &Me, t: f64, instants: &[f64]) -> Sensitivities {
    let samples = Samples::At([&[0.0], instants].concat());
    sensitivities(model, &Request { samples, ..request(t) }, &everything::<Me>()).expect("slopes")
}

/// The largest difference between derivatives, in parts of the largest one per part of its direction.
fn difference<Me: Mechanism>(model: &Me, found: &Gradients, expected: &[f64]) -> f64 {
    let size = |direction: &Direction| match *direction {
        Direction::Parameter(index) => model.parameters().value(index).abs().max(1e-2),
        Direction::Start(_) => 1.0,
    };
    let sizes: Vec<f64> = found.directions.iter().map(size).collect();
    let largest = expected.iter().zip(&sizes).map(|(slope, size)| (slope * size).abs()).fold(1e-12, f64::max);
    let each = found.by.iter().zip(expected).zip(&sizes);
    each.map(|((found, expected), size)| ((found - expected) * size).abs() / largest).fold(0.0, f64::max)
}

/// The largest difference of the gradients of all last outputs from slopes, and how many events there were.
fn deviation<Me: Mechanism>(model: &Me, t: f64) -> (f64, u64) {
    let expected = slopes(model, t, &[t]);
    let mut worst = 0.0_f64;
    for output in 0..Me::describe().outputs.len() {
        let found = gradient(model, &request(t), &Objective::last(output), &everything::<Me>()).expect("a gradient");
        assert_eq!(found.value, expected.trajectory.columns[output].values[1]);
        let of_output: Vec<f64> = (0..found.directions.len()).map(|k| expected.of(k, output)[1]).collect();
        worst = worst.max(difference(model, &found, &of_output));
    }
    (worst, expected.trajectory.statistics.events)
}

/// 0.9 s is an instant of one clock.
#[test]
fn samples_whose_instants_move() {
    let model = Sampled::new(SampledParameters::default()).unwrap();
    for t in [0.9, 0.95] {
        let (error, _) = deviation(&model, t);
        assert!(error < 1e-9, "{t} {error:e}");
    }
}

#[test]
fn a_pendulum_on_a_rigid_hinge() {
    let (error, _) = deviation(&Pendulum::new(PendulumParameters::default()).unwrap(), 1.5);
    assert!(error < 1e-11, "{error:e}");
}

#[test]
fn a_closed_loop_from_its_assembled_start() {
    let (error, _) = deviation(&Crank::new(CrankParameters::default()).unwrap(), 0.5);
    assert!(error < 1e-11, "{error:e}");
}

#[test]
fn a_law_with_two_branches() {
    let (error, events) = deviation(&Block::new(BlockParameters::default()).unwrap(), 2.0);
    assert!(error < 1e-11 && events > 5, "{error:e} {events}");
}

#[test]
fn sticking_and_slipping() {
    let (error, events) = deviation(&Belt::new(BeltParameters::default()).unwrap(), 4.0);
    assert!(error < 1e-11 && events > 3, "{error:e} {events}");
}

#[test]
fn impacts() {
    let ball = deviation(&Ball::new(BallParameters::default()).unwrap(), 3.0);
    let lifted = deviation(&Lifted::new(LiftedParameters::default()).unwrap(), 3.0);
    for (error, events) in [ball, lifted] {
        assert!(error < 1e-11 && events >= 3, "{error:e} {events}");
    }
}

#[test]
fn a_contact_by_restitution_keeps_a_speed() {
    let (error, events) = deviation(&Dropped::new(DroppedParameters::default()).unwrap(), 0.25);
    assert!(error < 1e-11 && events >= 2, "{error:e} {events}");
}

/// The squares of what measured columns leave, at instants inside steps, of which two columns share some.
#[test]
fn squares_of_what_measurements_leave() {
    let model = Belt::new(BeltParameters::default()).unwrap();
    let instants: Vec<f64> = (0..40).map(|k| 0.1 * f64::from(k)).collect();
    let every_second: Vec<f64> = instants.iter().copied().step_by(2).collect();
    let column = |output: usize, noise: f64, instants: &[f64]| {
        let values = instants.iter().map(|&t| (t, 0.05 * (3.0 * t).sin())).collect();
        Measured { output, values, noise }
    };
    let columns = [column(0, 1e-2, &instants), column(1, 0.1, &every_second)];
    let found = gradient(&model, &request(4.0), &Objective::squares(&columns), &everything::<Belt>()).unwrap();
    let forward = slopes(&model, 4.0, &instants[1..]);
    let (mut value, mut expected) = (0.0, vec![0.0; found.by.len()]);
    for Measured { output, values, noise } in &columns {
        for &(t, measured) in values {
            let k = instants.iter().position(|&instant| instant == t).unwrap();
            let left = (forward.trajectory.columns[*output].values[k] - measured) / noise;
            value += left * left;
            let each = expected.iter_mut().enumerate();
            each.for_each(|(d, sum)| *sum += 2.0 * left / noise * forward.of(d, *output)[k]);
        }
    }
    assert!((found.value - value).abs() < 1e-12 * value, "{} {value}", found.value);
    let error = difference(&model, &found, &expected);
    assert!(error < 1e-11, "{error:e}");
}

/// The integral of a speed is the way, over impacts at which the speed jumps.
#[test]
fn integrals_over_jumps() {
    fn check<Me: Mechanism>(model: &Me, t: f64, [speed, place]: [usize; 2]) {
        let found = gradient(model, &request(t), &Objective::integral(speed), &everything::<Me>()).unwrap();
        let forward = slopes(model, t, &[t]);
        let of = |column: &[f64]| column[1] - column[0];
        let expected: Vec<f64> = (0..found.by.len()).map(|k| of(forward.of(k, place))).collect();
        let way = of(&forward.trajectory.columns[place].values);
        assert!((found.value - way).abs() < 1e-9 * way.abs(), "{} {way}", found.value);
        let error = difference(model, &found, &expected);
        assert!(error < 1e-9, "{error:e}");
    }
    check(&Ball::new(BallParameters::default()).unwrap(), 3.0, [1, 0]);
    check(&Block::new(BlockParameters::default()).unwrap(), 2.0, [1, 0]);
}

#[test]
fn sums_of_several_terms() {
    let model = Block::new(BlockParameters::default()).unwrap();
    let objective = Objective::last(0).times(3.0).plus(Objective::at(1, 0.7)).plus(Objective::samples(
        &[0.7, 1.1],
        |k, outputs, by| {
            by[0] += outputs[1] * (k + 1) as f64;
            by[1] += outputs[0] * (k + 1) as f64;
            outputs[0] * outputs[1] * (k + 1) as f64
        },
    ));
    let found = gradient(&model, &request(2.0), &objective, &everything::<Block>()).unwrap();
    let forward = slopes(&model, 2.0, &[0.7, 1.1, 2.0]);
    let value = |output: usize, sample: usize| forward.trajectory.columns[output].values[sample];
    let expected: Vec<f64> = (0..found.by.len())
        .map(|k| {
            let slope = |output: usize, sample: usize| forward.of(k, output)[sample];
            let product = |sample| value(0, sample) * slope(1, sample) + value(1, sample) * slope(0, sample);
            3.0 * slope(0, 3) + slope(1, 1) + product(1) + 2.0 * product(2)
        })
        .collect();
    assert!(
        (found.value - (3.0 * value(0, 3) + value(1, 1) + value(0, 1) * value(1, 1) + 2.0 * value(0, 2) * value(1, 2)))
            .abs()
            < 1e-14
    );
    assert!(difference(&model, &found, &expected) < 1e-11, "{:e}", difference(&model, &found, &expected));
}

/// A sample inside a step is on the way of that step, whose integral counts once.
#[test]
fn an_integral_beside_samples_is_what_it_is_alone() {
    let model = Block::new(BlockParameters::default()).unwrap();
    let of = |objective: Objective<'_>| gradient(&model, &request(2.0), &objective, &everything::<Block>()).unwrap();
    let instants: Vec<f64> = (1..40).map(|k| 0.05 * f64::from(k)).collect();
    let sum = || {
        Objective::samples(&instants, |_, outputs, by| {
            by[0] += 1.0;
            outputs[0]
        })
    };
    let [integral, samples, both] = [Objective::integral(1), sum(), Objective::integral(1).plus(sum())].map(of);
    assert!((both.value - integral.value - samples.value).abs() < 1e-12 * samples.value.abs());
    let expected: Vec<f64> = integral.by.iter().zip(&samples.by).map(|(a, b)| a + b).collect();
    assert!(difference(&model, &both, &expected) < 1e-12, "{:e}", difference(&model, &both, &expected));
}

#[test]
fn of_a_long_run_states_are_made_again() {
    fn check<Me: Mechanism>(model: &Me, t: f64, states: usize) {
        let [objective, again] = [(); 2].map(|()| Objective::last(0).plus(Objective::integral(1)));
        let all = gradient(model, &request(t), &objective, &everything::<Me>()).unwrap();
        let few = gradient_within(model, &request(t), &again, &everything::<Me>(), states).unwrap();
        let steps = all.trajectory.statistics.steps;
        assert!(steps > 4 * states as u64, "{steps}");
        assert!(difference(model, &few, &all.by) < 1e-9, "{:e}", difference(model, &few, &all.by));
    }
    check(&Belt::new(BeltParameters::default()).unwrap(), 4.0, 4);
    check(&Crank::new(CrankParameters::default()).unwrap(), 2.0, 4);
    // The state jumps at its events.
    check(&Ball::new(BallParameters::default()).unwrap(), 3.0, 2);
}

#[test]
fn a_run_by_another_method_has_the_same_gradient_to_its_accuracy() {
    let model = Block::new(BlockParameters::default()).unwrap();
    let of = |method| {
        let request = Request { method, rtol: 1e-11, ..request(2.0) };
        gradient(&model, &request, &Objective::last(0), &everything::<Block>()).unwrap()
    };
    let expected = of(Integrator::Dop853).by;
    for method in [Integrator::Radau9, Integrator::Nystrom, Integrator::Taylor] {
        let error = difference(&model, &of(method), &expected);
        assert!(error < 1e-7, "{}: {error:e}", method.name());
    }
}

#[test]
fn the_gradient_of_a_state_at_rest_is_that_of_the_solution() {
    let (model, expected) = at_rest();
    let start = Direction::parameter::<Oscillator>("start").unwrap();
    for (method, most) in MOST_AT_REST {
        let request = Request { method, rtol: 1e-8, ..request(AT_REST) };
        let found = gradient(&model, &request, &Objective::last(0), &[start]).unwrap();
        let error = (found.by[0] - expected).abs();
        assert!(error < most, "{}: {error:e}", method.name());
    }
}

#[test]
fn who_waits_is_told_how_far_both_ways_are() {
    let (model, progress) = (Block::new(BlockParameters::default()).unwrap(), Progress::default());
    let asked = Request { progress: progress.clone(), ..request(2.0) };
    sensitivities(&model, &asked, &[Direction::Parameter(0)]).expect("slopes");
    assert_eq!(progress.done(), 1.0);
    // The run is not all of a gradient.
    gradient(&model, &asked, &Objective::last(0), &[Direction::Parameter(0)]).expect("a gradient");
    assert_eq!(progress.done(), 1.0);
}

#[test]
fn an_instant_outside_of_the_run_is_told() {
    let model = Block::new(BlockParameters::default()).unwrap();
    for t in [-0.1, 2.1, f64::NAN] {
        let found = gradient(&model, &request(2.0), &Objective::at(0, t), &[]);
        assert!(matches!(found, Err(SensitivityError::OutsideOfRun { .. })), "{found:?}");
    }
}
