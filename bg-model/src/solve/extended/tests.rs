//! Problems with known solutions, in double-double to 25 digits.

use nalgebra::SVector;

use super::*;
use crate::model::dynamics::Over;
use crate::model::system::System;

const CLOSE: Accuracy = Accuracy { columns: 10, tolerance: 1e-28 };

fn number(value: f64) -> DoubleDouble {
    DoubleDouble::from(value)
}

fn pi() -> DoubleDouble {
    number(-1.0).acos()
}

fn span(t_end: f64) -> Span {
    Span { t0: 0.0, t_end }
}

/// A system over slices.
fn of<const N: usize, const G: usize, Sys>(system: &Sys) -> Over<&Sys, N, G, 0> {
    Over(system)
}

/// x'' = -w^2 x with w = 1 where x is positive, and 2 where it is negative.
struct Lopsided;

impl<S: Scalar<Switch = bool>> System<S, 2, 1> for Lopsided {
    fn rate(&self, _: S, x: &SVector<S, 2>, negative: &[bool; 1], dx: &mut SVector<S, 2>) {
        dx[0] = x[1];
        dx[1] = -x[0] * S::from_f64(if negative[0] { 4.0 } else { 1.0 });
    }
    fn guards(&self, _: S, x: &SVector<S, 2>, _: &[bool; 1], guards: &mut SVector<S, 1>) {
        guards[0] = x[0];
    }
}

/// A planet at 1 - e from a sun of mass 1.
struct Kepler;

impl<S: Scalar<Switch = bool>> System<S, 4, 0> for Kepler {
    fn rate(&self, _: S, x: &SVector<S, 4>, _: &[bool; 0], dx: &mut SVector<S, 4>) {
        let square = x[0] * x[0] + x[1] * x[1];
        let cube = square * square.sqrt();
        *dx = SVector::from([x[2], x[3], -x[0] / cube, -x[1] / cube]);
    }
}

/// dx/dt = x^2 cos t, so that x = 1 / (1/x0 - sin t).
fn growth(t: DoubleDouble, x: &[DoubleDouble], dx: &mut [DoubleDouble]) {
    dx[0] = x[0] * x[0] * t.cos();
}

/// x counts the time with a clock that runs twice as fast where its guard is negative; the guard is a function of time.
struct Timer<F>(F);

impl<S: Scalar<Switch = bool>, F: Fn(S) -> S> System<S, 1, 1> for Timer<F> {
    fn rate(&self, _: S, _: &SVector<S, 1>, negative: &[bool; 1], dx: &mut SVector<S, 1>) {
        dx[0] = S::from_f64(if negative[0] { 2.0 } else { 1.0 });
    }
    fn guards(&self, t: S, _: &SVector<S, 1>, _: &[bool; 1], guards: &mut SVector<S, 1>) {
        guards[0] = self.0(t);
    }
}

#[test]
fn the_order_is_twice_the_columns() {
    for (columns, h) in [(2, 0.02), (3, 0.02), (4, 0.02), (6, 0.03), (9, 0.2)] {
        let mut method = Extrapolation::<DoubleDouble>::new(columns as usize, 1);
        let (t, x) = (number(0.4), number(0.8));
        let constant = number(1.0) / x + t.sin();
        let mut error = |h: DoubleDouble| {
            method.attempt(t, &[x], h, &mut growth, &mut |_, _| {});
            (method.end[0] - number(1.0) / (constant - (t + h).sin())).to_f64().abs()
        };
        let h = number(h);
        let order = libm::log2(error(h + h) / error(h)) - 1.0;
        assert!((order - f64::from(2 * columns)).abs() < 0.4, "{columns} columns: {order}");
    }
}

#[test]
fn an_oscillator_is_followed_to_25_digits() {
    let instants = [0.0, 0.3, 7.0, 20.0];
    let start = [number(1.0), number(0.0)];
    let frozen = Frozen(Lopsided);
    let mut seen = 0;
    let finish = integrate(&of::<2, 0, _>(&frozen), &start, span(20.0), CLOSE, &instants, &mut |t, x, _| {
        assert_eq!(t, number(instants[seen]));
        let error = (x[0] - t.cos()).to_f64().abs().max((x[1] + t.sin()).to_f64().abs());
        assert!(error < 1e-26, "{error:e} at {t:?}");
        seen += 1;
    });
    let finish = finish.unwrap();
    assert_eq!((seen, finish.events.len()), (4, 0));
    assert!((finish.steps, finish.rejected, finish.rate_evaluations) == (96, 0, 9696), "{finish:?}");
}

/// A system with its switch left in the positive branch.
struct Frozen<Sys>(Sys);

impl<S: Scalar<Switch = bool>, Sys: System<S, 2, 1>> System<S, 2, 0> for Frozen<Sys> {
    fn rate(&self, t: S, x: &SVector<S, 2>, _: &[bool; 0], dx: &mut SVector<S, 2>) {
        self.0.rate(t, x, &[false], dx);
    }
}

#[test]
fn a_planet_is_followed_to_25_digits() {
    let e = number(0.5);
    let one = number(1.0);
    let start = [one - e, number(0.0), number(0.0), ((one + e) / (one - e)).sqrt()];
    let finish = integrate(&of::<4, 0, _>(&Kepler), &start, span(20.0), CLOSE, &[], &mut |_, _, _| {}).unwrap();
    // Kepler's equation by Newton's method.
    let anomaly = (0..60).fold(number(20.0), |a, _| a - (a - e * a.sin() - number(20.0)) / (one - e * a.cos()));
    let expected = [anomaly.cos() - e, (one - e * e).sqrt() * anomaly.sin()];
    let error = (0..2).map(|i| (finish.x[i] - expected[i]).to_f64().abs()).fold(0.0, f64::max);
    assert!(error < 1e-25, "{error:e}");
}

#[test]
fn switchings_are_located_to_25_digits() {
    let start = [number(1.0), number(0.0)];
    let mut is_positive = |_, _: &[DoubleDouble], negative: &[bool]| assert!(!negative[0]);
    let finish = integrate(&of::<2, 1, _>(&Lopsided), &start, span(12.0), CLOSE, &[6.0], &mut is_positive).unwrap();
    // Half periods of pi where x is positive and pi/2 where it is negative.
    let expected = [0.5, 1.0, 2.0, 2.5, 3.5].map(|half_turns| pi() * number(half_turns));
    assert_eq!(finish.events.len(), expected.len());
    for (event, expected) in finish.events.iter().zip(expected) {
        let error = (event.t - expected).to_f64().abs();
        assert!(error < 1e-26, "{error:e} at {event:?}");
    }
    let phase = (number(12.0) - expected[4]) * number(2.0);
    let error = (finish.x[0] + number(0.5) * phase.sin()).to_f64().abs();
    assert!(finish.negative == [true] && error < 1e-26, "{error:e}");
}

#[test]
fn the_scalar_may_be_f64() {
    let accuracy = Accuracy { columns: 6, tolerance: 1e-13 };
    let finish =
        integrate(&of::<2, 1, _>(&Lopsided), &[1.0, 0.0], span(12.0), accuracy, &[], &mut |_, _, _| {}).unwrap();
    let times: Vec<f64> = finish.events.iter().map(|event| event.t / std::f64::consts::PI).collect();
    assert_eq!(times.len(), 5);
    assert!(times.iter().zip([0.5, 1.0, 2.0, 2.5, 3.5]).all(|(t, expected)| (t - expected).abs() < 1e-12), "{times:?}");
}

#[test]
fn a_short_visit_to_the_other_side_is_not_missed() {
    // Negative for 2 acos(1 - d) about t = 5: one thousandth of the step that the rate alone would allow.
    for depth in [1e-2, 1e-4, 1e-6] {
        let level = number(1.0) - number(depth);
        let timer = Timer(|t: DoubleDouble| level - (t - number(5.0)).cos());
        let finish =
            integrate(&of::<1, 1, _>(&timer), &[number(0.0)], span(9.0), CLOSE, &[], &mut |_, _, _| {}).unwrap();
        let half = level.acos();
        assert_eq!(finish.events.len(), 2, "{depth:e}");
        let error = |k: usize, t: DoubleDouble| (finish.events[k].t - t).to_f64().abs();
        let (entry, exit) = (error(0, number(5.0) - half), error(1, number(5.0) + half));
        assert!(entry < 1e-25 && exit < 1e-25, "{depth:e}: {entry:e} {exit:e}");
        let surplus = (finish.x[0] - number(9.0) - half - half).to_f64().abs();
        assert!(surplus < 1e-25, "{depth:e}: {surplus:e}");
    }
}

#[test]
fn a_guard_that_touches_zero_changes_nothing() {
    let timer = Timer(|t: DoubleDouble| number(1.0 + 1e-20) - (t - number(2.0)).cos());
    let finish = integrate(&of::<1, 1, _>(&timer), &[number(0.0)], span(4.0), CLOSE, &[], &mut |_, _, _| {}).unwrap();
    let error = (finish.x[0] - number(4.0)).to_f64().abs();
    assert!(finish.events.is_empty() && error < 1e-27, "{error:e}");
}

#[test]
fn a_zero_guard_at_the_start_is_decided_by_what_follows() {
    for (sign, slower) in [(1.0, true), (-1.0, false)] {
        let timer = Timer(|t: f64| sign * t * t);
        let accuracy = Accuracy { columns: 3, tolerance: 1e-12 };
        let finish = integrate(&of::<1, 1, _>(&timer), &[0.0], span(1.0), accuracy, &[], &mut |_, _, _| {}).unwrap();
        let expected = if slower { 1.0 } else { 2.0 };
        assert!((finish.x[0] - expected).abs() < 1e-12 && finish.events.is_empty(), "{finish:?}");
    }
}

/// dx/dt = 1 where x is negative and -1 where it is not: there is no motion beyond x = 0.
struct Stuck;

impl System<f64, 1, 1> for Stuck {
    fn rate(&self, t: f64, _: &SVector<f64, 1>, negative: &[bool; 1], dx: &mut SVector<f64, 1>) {
        dx[0] = if t > 0.75 { f64::NAN } else { if negative[0] { 1.0 } else { -1.0 } };
    }
    fn guards(&self, _: f64, x: &SVector<f64, 1>, _: &[bool; 1], guards: &mut SVector<f64, 1>) {
        guards[0] = x[0];
    }
}

#[test]
fn faults_say_what_and_when() {
    let run = |start: f64, columns, instants: &[f64]| {
        let accuracy = Accuracy { columns, tolerance: 1e-10 };
        integrate(&of::<1, 1, _>(&Stuck), &[start], span(1.0), accuracy, instants, &mut |_, _, _| {}).unwrap_err()
    };
    assert!(matches!(run(2.0, 1, &[]), Fault::BadInput(_)));
    assert!(matches!(run(2.0, 4, &[0.5, 0.25]), Fault::BadInput(_)));
    assert!(matches!(run(2.0, 4, &[2.0]), Fault::BadInput(_)));
    // The rate at the end of a step is that at the start of the next one, so a step may end a little later.
    let Fault::StepTooSmall { t, .. } = run(2.0, 4, &[0.5]) else { panic!("a rate that is no number") };
    assert!((t - 0.75).abs() < 1e-6, "{t}");
    let Fault::EventsAccumulate { switch: 0, t, .. } = run(0.5, 4, &[]) else { panic!("no motion is possible") };
    assert!((t - 0.5).abs() < 1e-9, "{t}");
}

/// A planet in another unit of length: a power of two, so that nothing is rounded otherwise.
struct Measured {
    unit: f64,
}

impl<S: Scalar<Switch = bool>> System<S, 4, 0> for Measured {
    fn rate(&self, t: S, x: &SVector<S, 4>, _: &[bool; 0], dx: &mut SVector<S, 4>) {
        Kepler.rate(t, &x.map(|x| x.times(1.0 / self.unit)), &[], dx);
        *dx = dx.map(|dx| dx.times(self.unit));
    }
}

#[test]
fn another_unit_takes_the_same_steps() {
    let run = |unit: f64| {
        let start = SVector::from([0.5, 0.0, 0.0, 1.75]).map(|x| number(unit * x));
        let measured = Measured { unit };
        let system = of::<4, 0, _>(&measured);
        let finish = integrate(&system, start.as_slice(), span(20.0), CLOSE, &[], &mut |_, _, _| {}).unwrap();
        let own: Vec<DoubleDouble> = finish.x.iter().map(|x| x.times(1.0 / unit)).collect();
        (finish.steps, finish.rejected, own)
    };
    let expected = run(1.0);
    for exponent in [-40, -20, 20, 40] {
        assert_eq!(run(2.0_f64.powi(exponent)), expected, "{exponent}");
    }
}
