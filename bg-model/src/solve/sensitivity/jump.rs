//! How slopes jump where branches change or something hits a stop.
//!
//! In: a state with slopes before, what has happened. Out: the slopes after it.
//! Method: the instant t* of an event is that at which its guard g is zero, so dt*/dp = -(g_x S + g_p) / (g_x f + g_t), with the
//! rate f before. The state at t*, which changes by S + f dt*/dp, goes through the impact, if there is one; from there the
//! rate f+ leads back: S+ = dx+/dp - f+ dt*/dp. Without an impact that is S+ = S + (f - f+) dt*/dp. Source: E. N. Rozenwasser,
//! R. Yusupov, Sensitivity of Automatic Control Systems (2000), chapter 3.

use nalgebra::SVector;

use super::step::Sloped;
use crate::model::reactions::Collision;
use crate::model::scalar::Scalar;
use crate::model::scalar::gradient::GradientIn;
use crate::model::scalar::slopes::{Slopes, WIDTH};
use crate::model::system::System;
use crate::solve::simulation::Switching;

/// The slopes after the event of the state `x`, which has its value before it; `plain` is the same system with slopes of nothing.
/// None where no guard passes through zero with a speed: the derivative does not exist there.
pub(super) fn jumped<V, Sys, const N: usize, const G: usize>(
    system: &Sys,
    plain: &Sys,
    x: &Sloped<V, N>,
    event: &Switching<N, G>,
) -> Option<Sloped<V, N>>
where
    V: Slopes,
    Sys: System<GradientIn<V>, N, G>,
{
    let Switching { before, after, negative_before, reached, left, jumps, .. } = event;
    let after_with =
        |slope: &dyn Fn(usize) -> [f64; WIDTH]| SVector::from_fn(|i, _| GradientIn::new(after.x[i], slope(i)));
    if !jumps && before.rate == after.rate {
        return Some(after_with(&|i| x[i].slopes()));
    }
    let delays = delays(system, plain, x, event)?;
    let along = |rate: &SVector<f64, N>, i: usize, l: usize| rate[i] * delays[l];
    let at_event = |i: usize| std::array::from_fn(|l| x[i].slopes()[l] + along(&before.rate, i, l));
    let mut moved: Sloped<V, N> = SVector::from_fn(|i, _| GradientIn::new(before.x[i], at_event(i)));
    if let (true, Some(impacts)) = (*jumps, system.impacts()) {
        let closed = |k: usize| reached[k] || !negative_before[k];
        let is_low = |k: usize, _: f64, _: bool| !left[k];
        let t = GradientIn::new(before.t, delays);
        Collision::new(impacts).strike(impacts, (t, &mut moved), negative_before, closed, is_low);
    }
    Some(after_with(&|i| std::array::from_fn(|l| moved[i].slopes()[l] - along(&after.rate, i, l))))
}

/// How much later the event is, s per unit of each direction.
fn delays<V, Sys, const N: usize, const G: usize>(
    system: &Sys,
    plain: &Sys,
    x: &Sloped<V, N>,
    event: &Switching<N, G>,
) -> Option<[f64; WIDTH]>
where
    V: Slopes,
    Sys: System<GradientIn<V>, N, G>,
{
    let Switching { before, negative_before, reached, .. } = event;
    let guards = |of: &Sys, by_time: f64, x: &Sloped<V, N>| {
        let mut guards = SVector::repeat(GradientIn::from_f64(0.0));
        of.guards(GradientIn::new(before.t, [by_time; WIDTH]), x, negative_before, &mut guards);
        guards
    };
    let flow = SVector::from_fn(|i, _| GradientIn::new(before.x[i], [before.rate[i]; WIDTH]));
    let (by_direction, by_time) = (guards(system, 0.0, x), guards(plain, 1.0, &flow));
    let speed = |k: &usize| by_time[*k].slopes()[0];
    let k = (0..G).filter(|&k| reached[k]).find(|k| speed(k).is_finite() && speed(k) != 0.0)?;
    let delays = by_direction[k].slopes().map(|slope| -slope / speed(&k));
    delays.iter().all(|delay| delay.is_finite()).then_some(delays)
}
