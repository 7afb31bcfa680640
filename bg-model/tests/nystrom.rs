//! The Runge-Kutta-Nystrom method: observed orders with and without states of second order, errors that follow the
//! tolerance, steps that end where stability does, and what it costs on stiff, lightly damped joints.

mod problems;

use std::ops::Range;

use bg_model::integrator::{Cfmr7, Method, Nystrom};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Samples, Settings};
use bg_model::statistics::Statistics;
use bg_model::system::System;
use problems::*;

/// The slope of the error over the step between two steps, in logarithms.
fn order(errors: [f64; 2]) -> f64 {
    (errors[0] / errors[1]).log2()
}

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

    fn second_order(&self) -> Range<usize> {
        0..if self.is_second { 2 } else { 0 }
    }

    fn second_derivatives(&self, _x: &SVector<f64, 4>, dx: &mut SVector<f64, 4>) {
        (dx[0], dx[1]) = (dx[2], dx[3]);
    }
}

fn ends<M: Method<4>>(pendulum: &Pendulum, method: M, settings: &Settings<4>) -> (SVector<f64, 4>, Statistics) {
    let (finish, _) = run(pendulum, method, [1.0, 0.0, 0.0, 0.0], 2.0, settings);
    (finish.x, finish.statistics)
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
