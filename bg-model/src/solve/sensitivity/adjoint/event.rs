//! An event followed backwards.
//!
//! In: what has happened, how the objective depends on the state after it. Out: how it depends on the state before it,
//! and on parameters. Method: what `jump` does, transposed. With a guard g that passes through zero at the speed v, the
//! impact C(x, t, p) and weights l of the state after it, the instant has the weight w = l C_x f + l C_t - l f+, and
//! what the integral over the run gains by a later instant; the state before gets l C_x - (w / v) g_x, the parameters l
//! C_p - (w / v) g_p. Derivatives of guards and impacts are numbers with slopes along each state and each parameter:
//! events are few.

use super::super::jump::{guards, instant, leads_on, passed, struck};
use super::back::{add, dot};
use super::lifted::Lifted;
use crate::model::dynamics::Machine;
use crate::model::scalar::slopes::WIDTH;
use crate::model::scalar::{Gradient, Scalar};
use crate::solve::simulation::Switching;

/// Replaces the `weights` of the state after an event by those of the state before it, and adds to the derivatives by
/// parameters. `gained` is what the integral over the run gains for each s by which the event is later. None where no
/// guard passes through zero with a speed.
pub(super) fn back_over(lifted: &mut Lifted, event: &Switching, gained: f64, weights: &mut [f64]) -> Option<()> {
    let Switching { before, after, .. } = event;
    let leads_on = leads_on(lifted.plain(), event);
    if !leads_on && before.rate == after.rate && gained == 0.0 {
        return Some(());
    }
    let given: Vec<Gradient> = before.x.iter().copied().map(Gradient::from_f64).collect();
    let is_of_clock = instant(lifted.plain(), event).is_some();
    let passed = if is_of_clock { None } else { Some(passed(lifted.plain(), event)?) };
    let mut by_instant = gained - dot(weights, after.rate.as_slice());
    if leads_on {
        let after = weights.to_vec();
        let weighted = |system: &dyn Machine<Gradient>, t: Gradient, x: &[Gradient]| {
            let struck = struck(system, event, t, x.to_vec());
            std::array::from_fn(|l| after.iter().zip(&struck).map(|(after, struck)| after * struck.slopes()[l]).sum())
        };
        let t = Gradient::from_f64(before.t);
        by_instant += weighted(lifted.plain(), Gradient::new(before.t, [1.0; WIDTH]), &given)[0];
        lifted.add_by_parameters(1.0, |system| weighted(system, t, &given));
        weights.copy_from_slice(&lifted.by_states(before.x.as_slice(), |plain, x| weighted(plain, t, x)));
    }
    by_instant += dot(weights, before.rate.as_slice());
    let Some((guard, speed)) = passed else {
        let slopes = |system: &dyn Machine<Gradient>| instant(system, event).map_or([0.0; WIDTH], |at| at.slopes());
        lifted.add_by_parameters(by_instant, slopes);
        return by_instant.is_finite().then_some(());
    };
    let later = -by_instant / speed;
    let slopes = |system: &dyn Machine<Gradient>, x: &[Gradient]| guards(system, event, 0.0, x)[guard].slopes();
    let by_guard = lifted.by_states(before.x.as_slice(), slopes);
    add(weights, &by_guard.iter().map(|by| by * later).collect::<Vec<_>>());
    lifted.add_by_parameters(later, |system| slopes(system, &given));
    later.is_finite().then_some(())
}
