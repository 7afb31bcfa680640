//! The Runge-Kutta-Nystrom method: observed orders with and without states of second order, errors that stay near the
//! tolerance, steps that end where stability does and follow it, and what it costs on stiff, lightly damped joints.

use std::ops::Range;

use crate::problems::*;
use bg_model::capability::SecondOrder;
use bg_model::integrator::{AnyMethod, Cfmr7, Dop853, Method, Nystrom};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Samples, Settings};
use bg_model::statistics::Statistics;
use bg_model::system::System;

/// The slope of the error over the step between two steps, in logarithms.
fn order(errors: [f64; 2]) -> f64 {
    (errors[0] / errors[1]).log2()
}

/// Forces as the rates and then the second derivatives.
macro_rules! forces {
    ($states:literal, $switches:literal) => {
        fn forces(&self, t: f64, x: &Vector<$states>, negative: &[bool; $switches], dx: &mut Vector<$states>) {
            self.rate(t, x, negative, dx);
            self.second_derivatives(x, dx);
        }
    };
}

type Vector<const N: usize> = SVector<f64, N>;

/// A heavy block on a rod that is an elastic, damped spring: x, y and their momenta, for mass 1.
struct Pendulum {
    /// rad/s.
    frequency: f64,
    /// Damping ratio.
    damping: f64,
    /// Whether x and y are handed over as states of second order.
    is_second: bool,
}

impl System<f64, 4, 0> for Pendulum {
    fn rate(&self, _t: f64, x: &SVector<f64, 4>, _: &[bool; 0], dx: &mut SVector<f64, 4>) {
        let length = x[0].hypot(x[1]);
        let [along_x, along_y] = [x[0] / length, x[1] / length];
        let stretching = along_x * x[2] + along_y * x[3];
        let force = self.frequency * (self.frequency * (length - 1.0) + 2.0 * self.damping * stretching);
        *dx = SVector::from([x[2], x[3], -force * along_x, -force * along_y - 9.81]);
    }

    fn second_order(&self) -> Option<&impl SecondOrder<f64, 4, 0>> {
        self.is_second.then_some(self)
    }
}

impl SecondOrder<f64, 4, 0> for Pendulum {
    fn states(&self) -> Range<usize> {
        0..2
    }

    fn second_derivatives(&self, _x: &SVector<f64, 4>, dx: &mut SVector<f64, 4>) {
        (dx[0], dx[1]) = (dx[2], dx[3]);
    }

    forces!(4, 0);
}

fn ends<M: Method>(pendulum: &Pendulum, method: M, settings: &Settings) -> (SVector<f64, 4>, Statistics) {
    let (finish, _) = run(pendulum, method, [1.0, 0.0, 0.0, 0.0], 2.0, settings);
    (*finish.state(), finish.statistics)
}

/// The errors at t = 2 with a step and half of it.
fn errors(pendulum: &Pendulum, step: f64) -> [f64; 2] {
    let exact = ends(pendulum, Nystrom::new(), &fixed(step / 16.0)).0;
    [step, 0.5 * step].map(|step| (ends(pendulum, Nystrom::new(), &fixed(step)).0 - exact).norm())
}

#[test]
fn it_has_order_6_on_a_soft_pendulum_and_order_5_with_damping() {
    const STEP: f64 = 0.1;
    let soft = |damping| order(errors(&Pendulum { frequency: 12.0, damping, is_second: true }, STEP));
    let (undamped, damped) = (soft(0.0), soft(0.02));
    println!("{undamped} {damped}");
    assert!((5.8..7.0).contains(&undamped) && (4.8..5.5).contains(&damped), "{undamped} {damped}");
}

#[test]
fn without_states_of_second_order_it_is_a_runge_kutta_method_of_order_5() {
    let of_pendulum = order(errors(&Pendulum { frequency: 12.0, damping: 0.02, is_second: false }, 0.02));
    let system = smooth(|t: f64, x: &SVector<f64, 1>, _: &[bool; 0]| [x[0] * libm::cos(t)]);
    let of_wave = order([0.25, 0.125].map(|step| {
        let (finish, _) = run(&system, Nystrom::new(), [1.0], 2.0, &fixed(step));
        (finish.x[0] - libm::exp(libm::sin(2.0))).abs()
    }));
    assert!((4.5..7.5).contains(&of_pendulum) && (4.5..7.5).contains(&of_wave), "{of_pendulum} {of_wave}");
}

#[test]
fn errors_follow_the_tolerance() {
    let pendulum = Pendulum { frequency: 30.0, damping: 0.02, is_second: true };
    let exact = ends(&pendulum, Cfmr7::new(), &settings(1e-13)).0;
    let errors: Vec<f64> =
        (4..=11).map(|k| (ends(&pendulum, Nystrom::new(), &settings(10.0_f64.powi(-k))).0 - exact).norm()).collect();
    assert!(errors.is_sorted_by(|a, b| a > b) && errors[0] < 1e-3 && errors[7] < 1e-9, "{errors:?}");
}

#[test]
fn steps_end_where_stability_does() {
    // A stiff spring that hardly moves: nothing but stability limits the steps.
    let pendulum = Pendulum { frequency: 1e4, damping: 0.02, is_second: true };
    let (_, statistics) = ends(&pendulum, Nystrom::new(), &settings(1e-3));
    let reach = 2.0 / statistics.steps as f64 * 1e4;
    assert!((5.8..6.0).contains(&reach) && statistics.rejected < 10, "{reach} {statistics:?}");
}

#[test]
fn it_takes_fewer_rates_than_cfmr7_on_a_stiff_lightly_damped_joint() {
    let pendulum = Pendulum { frequency: 1e4, damping: 0.02, is_second: true };
    let exact = ends(&pendulum, Cfmr7::new(), &settings(1e-12)).0;
    let of = |(x, statistics): (SVector<f64, 4>, Statistics)| ((x - exact).norm(), statistics.rate_evaluations);
    let ours = of(ends(&pendulum, Nystrom::new(), &settings(1e-5)));
    let others = of(ends(&pendulum, Cfmr7::new(), &settings(1e-5)));
    println!("{ours:?} {others:?}");
    assert!(ours.0 < 1e-6 && others.0 < 1e-6 && 10 * ours.1 < 7 * others.1, "{ours:?} {others:?}");
}

#[test]
fn the_dense_output_is_as_precise_as_the_steps() {
    let pendulum = Pendulum { frequency: 12.0, damping: 0.02, is_second: true };
    let errors = [0.02, 0.01].map(|step| {
        let sampled = |step: f64| {
            let settings = Settings { samples: Samples::Every(0.013), ..fixed(step) };
            run(&pendulum, Nystrom::new(), [1.0, 0.0, 0.0, 0.0], 2.0, &settings).1.samples
        };
        let pairs = sampled(step).into_iter().zip(sampled(step / 16.0));
        pairs.map(|(a, b)| (a.1 - b.1).norm()).fold(0.0, f64::max)
    });
    assert!((4.5..6.5).contains(&order(errors)) && errors[1] < 1e-6, "{errors:?}");
}

/// A crank with a rod and a slider, rigid, driven by a torque that swells: the crank's angle (rad) and its momentum (N
/// m s).
struct SliderCrank {
    /// Whether the angle is handed over as a state of second order.
    is_second: bool,
}

impl SliderCrank {
    /// The inertia about the crank's axis, kg m^2, and its derivative by the angle.
    fn inertia(angle: f64) -> [f64; 2] {
        const CRANK: f64 = 0.1;
        const ROD: f64 = 0.35;
        let (sin, cos) = angle.sin_cos();
        let (across, along) = (CRANK * sin, (ROD * ROD - CRANK * CRANK * sin * sin).sqrt());
        let slope = -across - CRANK * cos * across / along;
        let bend = -CRANK * cos
            - CRANK * CRANK * (cos * cos - sin * sin) / along
            - (CRANK * cos * across).powi(2) / along.powi(3);
        [0.01 + 2.0 * slope * slope, 4.0 * slope * bend]
    }
}

impl System<f64, 2, 0> for SliderCrank {
    fn rate(&self, t: f64, x: &SVector<f64, 2>, _: &[bool; 0], dx: &mut SVector<f64, 2>) {
        let [inertia, slope] = Self::inertia(x[0]);
        let speed = x[1] / inertia;
        let torque = 3.0 + 2.0 * (7.0 * t).sin() - 0.1 * speed;
        *dx = SVector::from([speed, torque + 0.5 * slope * speed * speed]);
    }

    fn second_order(&self) -> Option<&impl SecondOrder<f64, 2, 0>> {
        self.is_second.then_some(self)
    }
}

impl SecondOrder<f64, 2, 0> for SliderCrank {
    fn states(&self) -> Range<usize> {
        0..1
    }

    fn second_derivatives(&self, x: &SVector<f64, 2>, dx: &mut SVector<f64, 2>) {
        let [inertia, slope] = Self::inertia(x[0]);
        dx[0] = (dx[1] - slope * dx[0] * dx[0]) / inertia;
    }

    forces!(2, 0);
}

/// A block of 1 kg on a spring and a damper, pushed by a force that changes with time: position and momentum.
struct Forced {
    /// rad/s.
    frequency: f64,
    /// Damping ratio.
    damping: f64,
    /// Of the force, rad/s.
    force: f64,
}

impl System<f64, 2, 0> for Forced {
    fn rate(&self, t: f64, x: &SVector<f64, 2>, _: &[bool; 0], dx: &mut SVector<f64, 2>) {
        let back = self.frequency * (self.frequency * x[0] + 2.0 * self.damping * x[1]);
        *dx = SVector::from([x[1], (self.force * t).cos() - back]);
    }

    fn second_order(&self) -> Option<&impl SecondOrder<f64, 2, 0>> {
        Some(self)
    }
}

impl SecondOrder<f64, 2, 0> for Forced {
    fn states(&self) -> Range<usize> {
        0..1
    }

    fn second_derivatives(&self, _x: &SVector<f64, 2>, dx: &mut SVector<f64, 2>) {
        dx[0] = dx[1];
    }

    forces!(2, 0);
}

/// The largest error over the tolerance, for tolerances from 1e-2 to 1e-9, of all states over ten seconds.
fn largest_ratio<const N: usize>(system: &impl System<f64, N, 0>, start: [f64; N]) -> f64 {
    let sampled = |method: AnyMethod, tolerance: f64| {
        let settings = Settings { samples: Samples::Every(0.1), ..settings(tolerance) };
        run(system, method, start, 10.0, &settings).1.samples
    };
    let exact = sampled(Dop853::new().into(), 1e-13);
    let ratio = |exponent: i32| {
        let tolerance = 10.0_f64.powi(exponent);
        let ours = sampled(Nystrom::new().into(), tolerance);
        ours.iter().zip(&exact).map(|(a, b)| (a.1 - b.1).amax()).fold(0.0, f64::max) / tolerance
    };
    (-9..=-2).map(ratio).fold(0.0, f64::max)
}

#[test]
fn errors_stay_near_the_tolerance() {
    let ratios = [
        largest_ratio(&SliderCrank { is_second: true }, [0.4, 0.0]),
        largest_ratio(&SliderCrank { is_second: false }, [0.4, 0.0]),
        largest_ratio(&Forced { frequency: 10.0, damping: 0.0, force: 1.0 }, [1e-2, 0.0]),
        largest_ratio(&Forced { frequency: 3.0, damping: 0.1, force: 20.0 }, [0.0, 0.0]),
        largest_ratio(&Forced { frequency: 200.0, damping: 0.01, force: 30.0 }, [0.0, 0.0]),
        largest_ratio(&Pendulum { frequency: 30.0, damping: 0.02, is_second: true }, [1.0, 0.0, 0.0, 0.0]),
    ];
    println!("{ratios:?}");
    assert!(ratios.iter().all(|ratio| *ratio < 30.0), "{ratios:?}");
}

/// A block of 1 kg on a spring whose stiffness changes with time: position and momentum.
struct Tightened {
    /// The frequency at a time (s), rad/s.
    frequency: fn(f64) -> f64,
}

impl System<f64, 2, 0> for Tightened {
    fn rate(&self, t: f64, x: &SVector<f64, 2>, _: &[bool; 0], dx: &mut SVector<f64, 2>) {
        let frequency = (self.frequency)(t);
        *dx = SVector::from([x[1], -frequency * frequency * x[0] - 0.04 * frequency * x[1]]);
    }

    fn second_order(&self) -> Option<&impl SecondOrder<f64, 2, 0>> {
        Some(self)
    }
}

impl SecondOrder<f64, 2, 0> for Tightened {
    fn states(&self) -> Range<usize> {
        0..1
    }

    fn second_derivatives(&self, _x: &SVector<f64, 2>, dx: &mut SVector<f64, 2>) {
        dx[0] = dx[1];
    }

    forces!(2, 0);
}

#[test]
fn steps_follow_the_frequency() {
    // At rest but for 1e-12 m: nothing but stability limits the steps. The phase in ten seconds is 50 500 rad, either
    // way.
    for frequency in [|t: f64| 100.0 + 990.0 * t, |t: f64| 10_000.0 - 990.0 * t] {
        let (finish, _) = run(&Tightened { frequency }, Nystrom::new(), [1e-12, 0.0], 10.0, &settings(1e-6));
        let Statistics { steps, rejected, .. } = finish.statistics;
        let turned = 50_500.0 / steps as f64;
        assert!((5.6..6.0).contains(&turned) && rejected < 10, "{turned} {:?}", finish.statistics);
    }
}

/// Two blocks of 1 kg, each on a spring; after a second the other one is the stiff one. Positions, then momenta.
struct Exchange;

impl System<f64, 4, 1> for Exchange {
    fn rate(&self, _t: f64, x: &SVector<f64, 4>, negative: &[bool; 1], dx: &mut SVector<f64, 4>) {
        let frequencies = if negative[0] { [1e4, 10.0] } else { [10.0, 1e4] };
        let force = |i: usize| -frequencies[i] * (frequencies[i] * x[i] + 0.04 * x[2 + i]);
        *dx = SVector::from([x[2], x[3], force(0), force(1)]);
    }

    fn guards(&self, t: f64, _x: &SVector<f64, 4>, _: &[bool; 1], guards: &mut SVector<f64, 1>) {
        guards[0] = t - 1.0;
    }

    fn second_order(&self) -> Option<&impl SecondOrder<f64, 4, 1>> {
        Some(self)
    }
}

impl SecondOrder<f64, 4, 1> for Exchange {
    fn states(&self) -> Range<usize> {
        0..2
    }

    fn second_derivatives(&self, _x: &SVector<f64, 4>, dx: &mut SVector<f64, 4>) {
        (dx[0], dx[1]) = (dx[2], dx[3]);
    }

    forces!(4, 1);
}

#[test]
fn steps_follow_another_joint_that_becomes_the_stiffest() {
    let (finish, _) = run(&Exchange, Nystrom::new(), [1e-12, 1e-12, 0.0, 0.0], 2.0, &settings(1e-6));
    let turned = 2e4 / finish.statistics.steps as f64;
    assert!((5.6..6.0).contains(&turned) && finish.statistics.rejected < 10, "{turned} {:?}", finish.statistics);
}

/// A ball of 1 kg that bounces on a spring and otherwise flies: height and momentum; and a clock.
struct Ball;

impl System<f64, 3, 1> for Ball {
    fn rate(&self, _t: f64, x: &SVector<f64, 3>, negative: &[bool; 1], dx: &mut SVector<f64, 3>) {
        let spring = if negative[0] { -1e8 * x[0] - 40.0 * x[1] } else { 0.0 };
        *dx = SVector::from([x[1], spring - 9.81, 1.0]);
    }

    fn guards(&self, _t: f64, x: &SVector<f64, 3>, _: &[bool; 1], guards: &mut SVector<f64, 1>) {
        guards[0] = x[0];
    }

    fn second_order(&self) -> Option<&impl SecondOrder<f64, 3, 1>> {
        Some(self)
    }
}

impl SecondOrder<f64, 3, 1> for Ball {
    fn states(&self) -> Range<usize> {
        0..1
    }

    fn second_derivatives(&self, _x: &SVector<f64, 3>, dx: &mut SVector<f64, 3>) {
        dx[0] = dx[1];
    }

    forces!(3, 1);
}

#[test]
fn what_rings_no_longer_does_not_hold_the_steps() {
    let (finish, record) = run(&Ball, Nystrom::new(), [1.0, 0.0, 0.0], 2.0, &settings(1e-6));
    let (exact, _) = run(&Ball, Dop853::new(), [1.0, 0.0, 0.0], 2.0, &settings(1e-12));
    assert!(record.events.len() >= 4 && (&finish.x - &exact.x).amax() < 3e-5, "{:?}", &finish.x - &exact.x);
    // A contact lasts 3e-4 s. Held to the contact's frequency, the flight of two seconds would take 3400 steps.
    assert!(finish.statistics.steps < 200, "{:?}", finish.statistics);
}
