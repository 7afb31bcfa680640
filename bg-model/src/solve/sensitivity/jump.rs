//! How slopes jump where branches change or something hits a stop.
//!
//! In: a state with slopes before, what has happened. Out: the slopes after it.
//! Method: the instant t* of an event is that at which its guard g is zero, so dt*/dp = -(g_x S + g_p) / (g_x f + g_t),
//! with the rate f before. The state at t*, which changes by S + f dt*/dp, goes through the impact, if there is one;
//! from there the rate f+ leads back: S+ = dx+/dp - f+ dt*/dp. Without an impact that is S+ = S + (f - f+) dt*/dp.
//! Source: E. N. Rozenwasser, R. Yusupov, Sensitivity of Automatic Control Systems (2000), chapter 3.

use nalgebra::DVector;

use crate::model::dynamics::Dynamics;
use crate::model::reactions::{Collision, impacts_of};
use crate::model::sampled;
use crate::model::scalar::slopes::WIDTH;
use crate::model::scalar::{Gradient, Scalar};
use crate::solve::simulation::Switching;

/// What an event does to slopes.
pub(super) struct Jump {
    /// The state after it, with its slopes there at a fixed time.
    pub after: Vec<Gradient>,
    /// The instant with its slopes.
    pub t: Gradient,
    /// The states before and after it, with the slopes that they have at the instant of the event, wherever that moves.
    pub at_event: [Vec<Gradient>; 2],
}

/// The slopes after the event of the state `x`, which has its value before it; `plain` is the same system with slopes
/// of nothing. None where no guard passes through zero with a speed: the derivative does not exist there.
pub(super) fn jumped(
    system: &dyn Dynamics<Gradient>,
    plain: &dyn Dynamics<Gradient>,
    x: &[Gradient],
    event: &Switching,
) -> Option<Jump> {
    let Switching { before, after, jumps, .. } = event;
    let delays = delays(system, plain, x, event);
    let is_smooth = !jumps && before.rate == after.rate && system.memories().is_empty();
    // Where nothing changes but outputs the slopes do not need the instant.
    let delays = if is_smooth { delays.unwrap_or_default() } else { delays? };
    let t = Gradient::new(before.t, delays);
    let along = |rate: &DVector<f64>, i: usize, l: usize| rate[i] * delays[l];
    let at_event = |i: usize| std::array::from_fn(|l| x[i].slopes()[l] + along(&before.rate, i, l));
    let reached: Vec<_> = (0..x.len()).map(|i| Gradient::new(before.x[i], at_event(i))).collect();
    let left = struck(system, event, t, reached.clone());
    let slope = |i: usize| {
        if is_smooth { x[i].slopes() } else { std::array::from_fn(|l| left[i].slopes()[l] - along(&after.rate, i, l)) }
    };
    let after = after.x.iter().enumerate().map(|(i, &value)| Gradient::new(value, slope(i))).collect();
    Some(Jump { after, t, at_event: [reached, left] })
}

/// How much later the event is, s per unit of each direction.
fn delays(
    system: &dyn Dynamics<Gradient>,
    plain: &dyn Dynamics<Gradient>,
    x: &[Gradient],
    event: &Switching,
) -> Option<[f64; WIDTH]> {
    if let Some(instant) = instant(system, event) {
        return Some(instant.slopes());
    }
    let (k, speed) = passed(plain, event)?;
    let delays = guards(system, event, 0.0, x)[k].slopes().map(|slope| -slope / speed);
    delays.iter().all(|delay| delay.is_finite()).then_some(delays)
}

/// The instant, s, where samples are computed at it: that of the clock, wherever the state has come to.
pub(super) fn instant(system: &dyn Dynamics<Gradient>, event: &Switching) -> Option<Gradient> {
    let clocks = system.clocks();
    clocks.iter().find(|clock| event.reached[clock.switch])?.at(event.before.t)
}

/// The guard that decides on the instant, and how fast it passes through zero, in its unit per s. `plain` has slopes of
/// nothing.
pub(super) fn passed(plain: &dyn Dynamics<Gradient>, event: &Switching) -> Option<(usize, f64)> {
    let Switching { before, reached, .. } = event;
    let flow = before.x.iter().zip(&before.rate).map(|(&x, &rate)| Gradient::new(x, [rate; WIDTH]));
    let by_time = guards(plain, event, 1.0, &flow.collect::<Vec<_>>());
    let mut speeds = (0..by_time.len()).filter(|&k| reached[k]).map(|k| (k, by_time[k].slopes()[0]));
    speeds.find(|(_, speed)| speed.is_finite() && *speed != 0.0)
}

/// The guards at the end of the step that leads to the event, at the state `x` and where time has these slopes.
pub(super) fn guards(
    system: &dyn Dynamics<Gradient>,
    event: &Switching,
    by_time: f64,
    x: &[Gradient],
) -> Vec<Gradient> {
    let mut guards = vec![Gradient::from_f64(0.0); system.switches()];
    system.guards(Gradient::new(event.before.t, [by_time; WIDTH]), x, &event.negative_before, &mut guards);
    guards
}

/// The state `x` at the instant `t` (s) after the impact of an event, if it has one, with what memories keep from there
/// on.
pub(super) fn struck(
    system: &dyn Dynamics<Gradient>,
    event: &Switching,
    t: Gradient,
    mut x: Vec<Gradient>,
) -> Vec<Gradient> {
    let Switching { negative_before, reached, left, jumps, .. } = event;
    if let (true, Some(stops)) = (*jumps, system.stops()) {
        let closed = |k: usize| reached[k] || !negative_before[k];
        let is_low = |k: usize, _: f64, _: bool| !left[k];
        let mut collision = Collision::new(stops, system.kept_of_stops());
        collision.strike(&impacts_of(system), (t, &mut x), negative_before, closed, is_low);
    }
    if instant(system, event).is_some() {
        let clocks = system.clocks();
        let ticking = clocks.iter().map(|clock| clock.switch).filter(|&switch| reached[switch]);
        sampled::compute(system, &ticking.collect::<Vec<_>>(), t, negative_before, &mut x);
        return x;
    }
    // As the step to the event and the event itself do: what a memory follows is taken at this instant, which depends
    // on the parameters.
    let changed = negative_before.iter().zip(reached).map(|(negative, reached)| negative != reached).collect();
    let memories = system.memories();
    if !memories.is_empty() {
        for negative in [negative_before, &changed] {
            let mut projected = x.clone();
            system.project(t, negative, &mut projected);
            memories.iter().for_each(|&memory| x[memory] = projected[memory]);
        }
    }
    x
}

/// Whether an event leads from one state to another one.
pub(super) fn leads_on(system: &dyn Dynamics<Gradient>, event: &Switching) -> bool {
    event.jumps || !system.memories().is_empty()
}
