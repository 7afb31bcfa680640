//! Hand-written switched problems.

use std::f64::consts::{FRAC_PI_2, LN_2, PI};

use super::case::{Case, started};
use super::flow::Flow;

/// A mass that is pushed back with a constant force: parabolas, which every method of order 2 follows exactly. What is
/// left is the error of the location alone.
#[must_use]
pub fn relay() -> Case {
    let rate = |_: f64, x: &[f64; 2], negative: &[bool; 1]| [x[1], if negative[0] { 1.0 } else { -1.0 }];
    Case {
        name: "relay",
        source: "x'' = -sgn x from 1/2: zero at 1 s, then every 2 s",
        end: 20.0,
        events: (0..10).map(|k| 1.0 + 2.0 * f64::from(k)).collect(),
        amplification: 0.0,
        step: 0.1,
        problem: started(Flow::new(["x", "v"], [|_, x| x[0]], rate), [0.5, 0.0]),
    }
}

/// An oscillator of angular frequency 1 rad/s where x is positive and 2 rad/s where it is negative.
#[must_use]
pub fn bilinear() -> Case {
    Case {
        name: "bilinear",
        source: "half turns of both circles in alternation",
        end: 30.0,
        events: bilinear_events(30.0),
        amplification: 1.0,
        step: 0.1,
        problem: started(
            Flow::new(["x", "v"], [|_, x| x[0]], |_, x, negative| [x[1], stiffness(negative) * -x[0]]),
            [1.0, 0.0],
        ),
    }
}

/// A state that charges exponentially, twice as fast from 0.5 on and four times as fast from 0.9 on.
#[must_use]
pub fn thresholds() -> Case {
    let rate = |_: f64, x: &[f64; 1], negative: &[bool; 2]| {
        let factor = if negative[1] { 2.0 } else { 1.0 } * if negative[0] { 1.0 } else { 2.0 };
        [factor * (1.0 - x[0])]
    };
    Case {
        name: "thresholds",
        source: "exponentials: ln 2, and half of ln 5 later",
        end: 3.0,
        events: vec![LN_2, LN_2 + 0.5 * libm::log(5.0)],
        amplification: 10.0,
        step: 0.1,
        problem: started(Flow::new(["x"], [|_, x| x[0] - 0.5, |_, x| 0.9 - x[0]], rate), [0.0]),
    }
}

/// The bilinear oscillator with a state that follows it 1000 times as fast, for which implicit methods are made.
#[must_use]
pub fn stiff_follower() -> Case {
    let rate = |_: f64, x: &[f64; 3], negative: &[bool; 1]| [x[1], stiffness(negative) * -x[0], 1e3 * (x[0] - x[2])];
    Case {
        name: "stiff-follower",
        source: "as the bilinear oscillator, which it follows",
        end: 9.0,
        events: bilinear_events(9.0),
        amplification: 1.0,
        step: 2e-3,
        problem: started(Flow::new(["x", "v", "follower"], [|_, x| x[0]], rate), [1.0, 0.0, 1.0]),
    }
}

fn stiffness(negative: &[bool; 1]) -> f64 {
    if negative[0] { 4.0 } else { 1.0 }
}

/// From (1, 0): a quarter of the slow turn, then halves of both turns in alternation.
fn bilinear_events(end: f64) -> Vec<f64> {
    let halves = [FRAC_PI_2, PI].into_iter().cycle();
    let times = halves.scan(FRAC_PI_2, |t, half| Some(std::mem::replace(t, *t + half)));
    times.take_while(|t| *t < end).collect()
}
