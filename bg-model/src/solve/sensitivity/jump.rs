//! How slopes jump where branches change or something hits a stop.
//!
//! In: a state with slopes before, what has happened. Out: the slopes after it.
//! Method: the instant t* of an event is that at which its guard g is zero, so dt*/dp = -(g_x S + g_p) / (g_x f + g_t),
//! with the rate f before. The state at t*, which changes by S + f dt*/dp, goes through the impact, if there is one;
//! from there the rate f+ leads back: S+ = dx+/dp - f+ dt*/dp. Without an impact that is S+ = S + (f - f+) dt*/dp.
//! Source: E. N. Rozenwasser, R. Yusupov, Sensitivity of Automatic Control Systems (2000), chapter 3.

use nalgebra::{DVector, SVector};

use super::step::Sloped;
use crate::model::capability::Impacts;
use crate::model::reactions::{Collision, impacts_in};
use crate::model::scalar::slopes::WIDTH;
use crate::model::scalar::{Gradient, Scalar};
use crate::model::system::{System, switches};
use crate::solve::simulation::Switching;

/// The slopes after the event of the state `x`, which has its value before it; `plain` is the same system with slopes
/// of nothing. None where no guard passes through zero with a speed: the derivative does not exist there.
pub(super) fn jumped<Sys, const N: usize, const G: usize>(
    system: &Sys,
    plain: &Sys,
    x: &Sloped<N>,
    event: &Switching,
) -> Option<Sloped<N>>
where
    Sys: System<Gradient, N, G>,
{
    let Switching { before, after, jumps, .. } = event;
    let after_with =
        |slope: &dyn Fn(usize) -> [f64; WIDTH]| SVector::from_fn(|i, _| Gradient::new(after.x[i], slope(i)));
    if !jumps && before.rate == after.rate {
        return Some(after_with(&|i| x[i].slopes()));
    }
    let delays = delays(system, plain, x, event)?;
    let along = |rate: &DVector<f64>, i: usize, l: usize| rate[i] * delays[l];
    let at_event = |i: usize| std::array::from_fn(|l| x[i].slopes()[l] + along(&before.rate, i, l));
    let moved = SVector::from_fn(|i, _| Gradient::new(before.x[i], at_event(i)));
    let moved = struck(system, event, Gradient::new(before.t, delays), moved);
    Some(after_with(&|i| std::array::from_fn(|l| moved[i].slopes()[l] - along(&after.rate, i, l))))
}

/// How much later the event is, s per unit of each direction.
fn delays<Sys, const N: usize, const G: usize>(
    system: &Sys,
    plain: &Sys,
    x: &Sloped<N>,
    event: &Switching,
) -> Option<[f64; WIDTH]>
where
    Sys: System<Gradient, N, G>,
{
    let (k, speed) = passed(plain, event)?;
    let delays = guards(system, event, 0.0, x)[k].slopes().map(|slope| -slope / speed);
    delays.iter().all(|delay| delay.is_finite()).then_some(delays)
}

/// The guard that decides on the instant, and how fast it passes through zero, in its unit per s. `plain` has slopes of
/// nothing.
pub(super) fn passed<Sys, const N: usize, const G: usize>(plain: &Sys, event: &Switching) -> Option<(usize, f64)>
where
    Sys: System<Gradient, N, G>,
{
    let Switching { before, reached, .. } = event;
    let flow = SVector::from_fn(|i, _| Gradient::new(before.x[i], [before.rate[i]; WIDTH]));
    let by_time = guards(plain, event, 1.0, &flow);
    let mut speeds = (0..G).filter(|&k| reached[k]).map(|k| (k, by_time[k].slopes()[0]));
    speeds.find(|(_, speed)| speed.is_finite() && *speed != 0.0)
}

/// The guards at the end of the step that leads to the event, at the state `x` and where time has these slopes.
pub(super) fn guards<Sys, const N: usize, const G: usize>(
    system: &Sys,
    event: &Switching,
    by_time: f64,
    x: &Sloped<N>,
) -> SVector<Gradient, G>
where
    Sys: System<Gradient, N, G>,
{
    let mut guards = SVector::repeat(Gradient::from_f64(0.0));
    system.guards(Gradient::new(event.before.t, [by_time; WIDTH]), x, switches(&event.negative_before), &mut guards);
    guards
}

/// The state `x` at the instant `t` (s) after the impact of an event, if it has one.
pub(super) fn struck<Sys, const N: usize, const G: usize>(
    system: &Sys,
    event: &Switching,
    t: Gradient,
    mut x: Sloped<N>,
) -> Sloped<N>
where
    Sys: System<Gradient, N, G>,
{
    let Switching { negative_before, reached, left, jumps, .. } = event;
    if let (true, Some(impacts)) = (*jumps, system.impacts()) {
        let closed = |k: usize| reached[k] || !negative_before[k];
        let is_low = |k: usize, _: f64, _: bool| !left[k];
        let mut collision = Collision::new(impacts.stops(), impacts.kept());
        collision.strike(&impacts_in(impacts), (t, x.as_mut_slice()), negative_before, closed, is_low);
    }
    x
}
