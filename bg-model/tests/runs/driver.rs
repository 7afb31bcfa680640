//! The driver: counts, samples, refused input, failures.

use crate::problems::*;
use bg_model::failure::{BadInput, Cause, Failure, Quantity};
use bg_model::integrator::{Absolute, Dop853, Rk4, Tolerances};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{EachSample, Ongoing, Samples, Settings, Span, integrate};

#[test]
fn the_counts_of_kepler_are_those_of_the_method() {
    let (finish, record) = run(&kepler(), Dop853::new(), kepler_start(), 20.0, &settings(1e-9));
    let counts = finish.statistics;
    // One rate at the start, one for the first step, eleven an attempt, one at the end of an accepted step.
    assert_eq!(counts.rate_evaluations, 2 + 12 * counts.steps + 11 * counts.rejected);
    assert_eq!((counts.dense_evaluations, counts.guard_evaluations, counts.events), (0, 0, 0));
    assert_eq!(record.steps.len() as u64, counts.steps);
    // Pinned; to be renewed only with a reason.
    assert_eq!((counts.steps, counts.rejected), (245, 46));
    let shortest = record.steps.windows(2).map(|t| t[1] - t[0]).fold(f64::INFINITY, f64::min);
    assert_eq!(counts.smallest_step, shortest.min(record.steps[0]));
    assert!(counts.largest_step > 10.0 * counts.smallest_step);
}

/// A mass that is let go on an unstretched spring of 1e4 rad/s, by whose velocity alone errors count: an odd function
/// of the time, of which the terms that an estimate of order 5 sees vanish. Both estimates of DOP853 together say 0.4
/// tolerances where it errs by 11.
#[test]
fn a_first_step_from_rest_errs_by_no_more_than_is_allowed() {
    let frequency = 1e4;
    let system = smooth(move |_, x: &SVector<f64, 2>, _: &[bool; 0]| [x[1], 1.0 - frequency * frequency * x[0]]);
    let allowed = 5e-9 / frequency;
    let tolerances = Tolerances { relative: 1e-14, absolute: Absolute::PerState(vec![1.0, allowed]) };
    let (_, record) = run(&system, Dop853::new(), [0.0; 2], 1.0, &Settings { tolerances, ..Settings::default() });
    let (t, x, _) = record.samples[1];
    let off = (x[1] - libm::sin(frequency * t) / frequency).abs() / allowed;
    assert!(t > 1e-6 && off < 1.0, "{off} tolerances at {t:e} s");
}

#[test]
fn the_counts_of_rk4_are_five_a_step() {
    let (finish, _) = run(&kepler(), Rk4::new(0.01), kepler_start(), 0.3, &settings(1e-9));
    let counts = finish.statistics;
    assert_eq!((finish.t, counts.steps, counts.rejected, counts.rate_evaluations), (0.3, 30, 0, 1 + 4 * 30));
}

#[test]
fn samples_do_not_alter_the_steps_and_cost_three_rates_a_step() {
    let with = |samples| run(&kepler(), Dop853::new(), kepler_start(), 20.0, &Settings { samples, ..settings(1e-9) });
    let (plain, plain_record) = with(Samples::Steps);
    let (sampled, record) = with(Samples::Every(0.001));
    assert_eq!(record.samples.len(), 20_001);
    assert_eq!(record.steps, plain_record.steps);
    assert_eq!((sampled.t, &sampled.x), (plain.t, &plain.x));
    let (counts, plain) = (sampled.statistics, plain.statistics);
    assert_eq!(counts.rate_evaluations - plain.rate_evaluations, counts.dense_evaluations);
    assert!(counts.dense_evaluations <= 3 * counts.steps && counts.dense_evaluations % 3 == 0);
    // The steps are longer than the interval nearly everywhere, but not where they are short at the perihelion.
    assert!(counts.dense_evaluations > counts.steps);
    assert_eq!(record.samples.last().map(|last| (last.0, last.1)), Some((20.0, *sampled.state())));
    let times_are_multiples = record
        .samples
        .iter()
        .enumerate()
        .all(|(k, sample)| sample.0 == (k as f64 * 0.001).min(20.0) || (k == 20_000 && sample.0 == 20.0));
    assert!(times_are_multiples);
}

#[test]
fn sampled_states_are_as_good_as_the_steps() {
    let at = |t_end| *run(&kepler(), Dop853::new(), kepler_start(), t_end, &settings(1e-13)).0.state();
    let instants = vec![0.3, 1.7, 3.9, 5.5, 6.2];
    let settings = Settings { samples: Samples::At(instants.clone()), ..settings(1e-10) };
    let (_, record) = run(&kepler(), Dop853::new(), kepler_start(), 7.0, &settings);
    assert_eq!(record.samples.iter().map(|sample| sample.0).collect::<Vec<_>>(), instants);
    for (t, x, _) in &record.samples {
        let error = (x - at(*t)).norm() / at(*t).norm();
        assert!(error < 3e-8, "{t}: {error}");
    }
}

#[test]
fn an_empty_span_gives_its_start_once() {
    for samples in [Samples::Steps, Samples::Every(0.1), Samples::At(vec![0.0])] {
        let (finish, record) =
            run(&kepler(), Dop853::new(), kepler_start(), 0.0, &Settings { samples, ..settings(1e-9) });
        assert_eq!((finish.t, *finish.state(), finish.statistics.steps), (0.0, kepler_start(), 0));
        assert_eq!(record.samples, [(0.0, kepler_start(), [])]);
    }
}

#[test]
fn a_run_in_two_parts_arrives_at_the_same_place() {
    let mut times = Vec::new();
    let mut observer = EachSample(|t, _: &[f64], _: &[bool]| times.push(t));
    let mut method = Dop853::new();
    let (first, second) = (Span { t0: -3.0, t_end: 1.0 }, Span { t0: 1.0, t_end: 17.0 });
    let settings = Settings { samples: Samples::Every(4.0), ..settings(1e-12) };
    let middle = integrate(&kepler(), &mut method, &kepler_start(), first, &settings, &mut observer).unwrap();
    let end = integrate(&kepler(), &mut method, middle.state(), second, &settings, &mut observer).unwrap();
    assert!((end.x - SVector::from(KEPLER_AT_20)).norm() < 1e-8);
    assert_eq!(times, [-3.0, 1.0, 1.0, 5.0, 9.0, 13.0, 17.0]);
}

#[test]
fn the_largest_step_is_kept() {
    let settings = Settings { largest_step: 0.02, ..settings(1e-6) };
    let (finish, _) = run(&kepler(), Dop853::new(), kepler_start(), 2.0, &settings);
    assert!(finish.statistics.largest_step <= 0.02 * (1.0 + 1e-9) && finish.statistics.steps >= 100);
}

#[test]
fn the_largest_step_holds_for_the_last_step_too() {
    // After ten steps a rest is left that is shorter than a hundredth of a step.
    let system = smooth(|_, _: &SVector<f64, 1>, _: &[bool; 0]| [1.0]);
    let settings = Settings { first_step: Some(0.1), largest_step: 0.1, ..settings(1e-6) };
    let (finish, _) = run(&system, Dop853::new(), [0.0], 1.0005, &settings);
    assert!(finish.statistics.largest_step <= 0.1 * (1.0 + 1e-9), "{}", finish.statistics);
    assert_eq!((finish.t, finish.statistics.steps), (1.0005, 11));
}

#[test]
fn an_infinite_sample_interval_gives_the_start_and_the_end() {
    for interval in [f64::INFINITY, f64::MAX] {
        let settings = Settings { samples: Samples::Every(interval), ..settings(1e-6) };
        let (finish, record) = run(&kepler(), Dop853::new(), kepler_start(), 2.0, &settings);
        assert_eq!(record.samples, [(0.0, kepler_start(), []), (2.0, *finish.state(), [])], "{interval}");
    }
}

/// The guard x starts at zero and falls; or it passes zero at 0.5 s, to where both branches push it.
#[test]
fn a_step_that_is_longer_than_the_run_is_no_measure_for_a_guard_at_zero() {
    let falling = switched([|_, x| x[0]], |_, x: &SVector<f64, 1>, _: &[bool; 1]| [-(1.0 - x[0] * x[0])]);
    let span = Span { t0: 0.0, t_end: 1.0 };
    for start in [0.0, 0.25] {
        let start = SVector::from([start]);
        for first in [1e9, f64::INFINITY] {
            let settings = Settings { first_step: Some(first), ..settings(1e-6) };
            let finish = integrate(&falling, &mut Dop853::new(), &start, span, &settings, &mut ()).unwrap();
            assert!(finish.negative == [true] && finish.x[0] < -0.4, "{first}: {finish:?}");
        }
        let settings = Settings { tolerances: Tolerances::new(1e-6, 1e-6), ..Settings::default() };
        let finish = integrate(&falling, &mut Rk4::new(1e9), &start, span, &settings, &mut ()).unwrap();
        assert!(finish.negative == [true] && finish.x[0] < -0.4, "{finish:?}");
    }
}

fn failure<const N: usize>(
    rate: impl Fn(f64, &SVector<f64, N>, &[bool; 0]) -> [f64; N],
    start: [f64; N],
    span: [f64; 2],
    settings: &Settings,
) -> Failure {
    let system = Flow { rate, guards: [], names: &["crank.p", "rod.p"] };
    let span = Span { t0: span[0], t_end: span[1] };
    integrate(&system, &mut Dop853::new(), &SVector::from(start), span, settings, &mut ()).unwrap_err()
}

#[test]
fn a_rate_that_stops_being_a_number_names_its_state_and_keeps_the_last() {
    let rate = |t: f64, x: &SVector<f64, 2>, _: &[bool; 0]| [-x[0], if t > 0.5 { f64::NAN } else { 1.0 }];
    let failure = failure(rate, [1.0, 0.0], [0.0, 1.0], &settings(1e-9));
    let Cause::NonFinite { quantity: Quantity::Rate, name: "rod.p", index: 1, value, t, h, .. } = failure.cause else {
        panic!("{failure}")
    };
    assert!(value.is_nan() && t <= 0.5 && 0.5 - t < 1e-13 && h > 0.0, "{failure}");
    assert_eq!(failure.last.t, t);
    assert!((failure.last.state() - SVector::from([(-t).exp(), t])).norm() < 1e-9);
    assert!(failure.last.statistics.steps > 0 && failure.last.statistics.rejected > 0);
    assert!(failure.to_string().starts_with("the rate of `rod.p` is NaN in a step of"), "{failure}");
}

#[test]
fn a_fixed_step_fails_at_once_where_a_number_is_missing() {
    let system = smooth(|t: f64, _: &SVector<f64, 1>, _: &[bool; 0]| [(0.55 - t).sqrt()]);
    let span = Span { t0: 0.0, t_end: 1.0 };
    let failure =
        integrate(&system, &mut Rk4::new(0.1), &SVector::from([0.0]), span, &settings(1e-6), &mut ()).unwrap_err();
    assert!(matches!(failure.cause, Cause::NonFinite { quantity: Quantity::Rate, index: 0, .. }), "{failure}");
    assert_eq!((failure.last.t, failure.last.statistics.steps), (0.5, 5));
}

#[test]
fn a_pole_makes_the_step_too_small() {
    let failure = failure(|_, x, _| [x[0] * x[0]], [1.0], [0.0, 2.0], &settings(1e-9));
    match failure.cause {
        Cause::StepTooSmall { state, index, t, .. } => assert_eq!((state, index, t), ("crank.p", 0, failure.last.t)),
        Cause::NonFinite { t, .. } => assert_eq!(t, failure.last.t),
        ref cause => panic!("{cause}"),
    }
    assert!((failure.last.t - 1.0).abs() < 1e-6 && failure.last.x[0].is_finite(), "{failure}");
}

#[test]
fn a_run_gives_up_at_its_limit() {
    let settings = Settings { step_limit: 7, ..settings(1e-9) };
    let failure = failure(|_, x, _| [x[1], -x[0]], [1.0, 0.0], [0.0, 1e6], &settings);
    assert!(matches!(failure.cause, Cause::TooManySteps { limit: 7, .. }), "{failure}");
    assert_eq!(failure.last.statistics.steps + failure.last.statistics.rejected, 7);
}

#[test]
fn a_start_without_a_rate_fails_before_the_first_step() {
    let failure = failure(|_, _, _| [0.0, f64::INFINITY], [0.0, 0.0], [2.0, 3.0], &settings(1e-9));
    let Cause::NonFinite { quantity: Quantity::Rate, name: "rod.p", t: 2.0, h: 0.0, .. } = failure.cause else {
        panic!("{failure}")
    };
}

#[test]
fn input_that_cannot_be_is_refused_by_name() {
    let refused = |start: [f64; 2], span, settings: &Settings| {
        let failure = failure(|_, x, _| [x[1], -x[0]], start, span, settings);
        assert_eq!(failure.last.statistics.rate_evaluations, 0);
        match failure.cause {
            Cause::BadInput(bad) => bad,
            cause => panic!("{cause}"),
        }
    };
    let (good, unit) = (settings(1e-9), [0.0, 1.0]);
    for span in [[1.0, 0.0], [f64::NAN, 1.0], [0.0, f64::INFINITY]] {
        assert!(matches!(refused([1.0, 0.0], span, &good), BadInput::Span { .. }));
    }
    assert!(matches!(refused([1.0, f64::NAN], unit, &good), BadInput::Start { state: "rod.p", .. }));
    for relative in [0.0, -1.0, f64::NAN, 1e-15, f64::INFINITY] {
        let settings = Settings { tolerances: Tolerances::new(relative, 1e-9), ..good.clone() };
        let bad = refused([1.0, 0.0], unit, &settings);
        assert!(matches!(bad, BadInput::RelativeTolerance { smallest, .. } if smallest == 10.0 * f64::EPSILON));
        assert!(bad.to_string().contains("2.2"), "{bad}");
    }
    for absolute in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let absolute = Absolute::PerState(vec![1e-9, absolute]);
        let settings = Settings { tolerances: Tolerances { relative: 1e-9, absolute }, ..good.clone() };
        assert!(matches!(refused([1.0, 0.0], unit, &settings), BadInput::AbsoluteTolerance { state: "rod.p", .. }));
    }
    let absolute = Absolute::PerState(vec![1e-9; 3]);
    let settings = Settings { tolerances: Tolerances { relative: 1e-9, absolute }, ..good.clone() };
    let bad = refused([1.0, 0.0], unit, &settings);
    assert_eq!(bad, BadInput::AbsoluteTolerances { given: 3, states: 2 });
    assert!(bad.to_string().starts_with("there are 3 absolute tolerances for 2 states"), "{bad}");
    for step in [0.0, f64::NAN, -1.0, 1e-16] {
        let settings = Settings { first_step: Some(step), ..good.clone() };
        assert!(matches!(refused([1.0, 0.0], unit, &settings), BadInput::Step { which: "first", .. }));
        let settings = Settings { largest_step: step, ..good.clone() };
        assert!(matches!(refused([1.0, 0.0], unit, &settings), BadInput::Step { which: "largest", .. }));
        let settings = Settings { samples: Samples::Every(step), ..good.clone() };
        assert!(matches!(refused([1.0, 0.0], unit, &settings), BadInput::SampleInterval { .. }));
    }
    for (instants, index) in
        [(vec![0.5, 0.4], 1), (vec![-0.1], 0), (vec![0.2, 1.1], 1), (vec![f64::NAN], 0), (vec![0.0, f64::INFINITY], 1)]
    {
        let settings = Settings { samples: Samples::At(instants), ..good.clone() };
        let bad = refused([1.0, 0.0], unit, &settings);
        assert!(matches!(bad, BadInput::SampleInstant { index: found, .. } if found == index), "{bad}");
    }
}

#[test]
fn a_fixed_step_that_cannot_be_is_refused() {
    for step in [0.0, -0.1, f64::NAN, f64::INFINITY, 1e-18] {
        let span = Span { t0: 0.0, t_end: 1.0 };
        let settings = settings(1e-9);
        let failure = integrate(&kepler(), &mut Rk4::new(step), &kepler_start(), span, &settings, &mut ()).unwrap_err();
        assert!(matches!(failure.cause, Cause::BadInput(BadInput::Step { which: "fixed", .. })), "{step}: {failure}");
    }
}

#[test]
fn a_start_of_another_number_of_states_is_refused() {
    let (mut run, mut method) = (Ongoing::at(0.0, &[1.0]), Dop853::new());
    let failure = run.advance(&kepler(), &mut method, 1.0, &settings(1e-9), &mut ()).unwrap_err();
    assert_eq!(failure.cause, Cause::BadInput(BadInput::States { given: 1, states: 4 }));
    assert!(failure.to_string().starts_with("the start has 1 value(s) for 4 state(s)"), "{failure}");
    assert_eq!((failure.last.t, failure.last.x.len()), (0.0, 1));
}
