//! An event followed backwards.
//!
//! In: what has happened, how the objective depends on the state after it. Out: how it depends on the state before it,
//! and on parameters. Method: what `jump` does, transposed. With a guard g that passes through zero at the speed v, the
//! impact C(x, t, p) and weights l of the state after it, the instant has the weight w = l C_x f + l C_t - l f+, and
//! what the integral over the run gains by a later instant; the state before gets l C_x - (w / v) g_x, the parameters l
//! C_p - (w / v) g_p. Derivatives of guards and impacts are numbers with slopes along each state and each parameter:
//! events are few.

use nalgebra::SVector;

use super::super::jump::{guards, passed, struck};
use super::lifted::{Lifted, Sloped};
use crate::model::dynamics::Over;
use crate::model::scalar::slopes::WIDTH;
use crate::model::scalar::{Gradient, Scalar};
use crate::model::system::{Model, values};
use crate::solve::simulation::Switching;

/// Replaces the `weights` of the state after an event by those of the state before it, and adds to the derivatives by
/// parameters. `gained` is what the integral over the run gains for each s by which the event is later. None where no
/// guard passes through zero with a speed.
pub(super) fn back_over<Li, const N: usize, const G: usize, const M: usize>(
    lifted: &mut Lifted<Li>,
    event: &Switching,
    gained: f64,
    weights: &mut SVector<f64, N>,
) -> Option<()>
where
    Li: Model<Gradient, N, G, M>,
{
    let Switching { before, after, jumps, .. } = event;
    if !jumps && before.rate == after.rate && gained == 0.0 {
        return Some(());
    }
    let [x, rate, rate_after] = [&before.x, &before.rate, &after.rate].map(|of| values::<N>(of.as_slice()));
    let given: Sloped<N> = x.map(Gradient::from_f64);
    let (guard, speed) = passed(&over(lifted.plain()), event)?;
    let mut by_instant = gained - weights.dot(rate_after);
    if *jumps {
        let after = *weights;
        let weighted = |system: &Li, t: Gradient, x: &Sloped<N>| {
            let struck = struck(&over(system), event, t, x.as_slice().to_vec());
            std::array::from_fn(|l| (0..N).map(|i| after[i] * struck[i].slopes()[l]).sum())
        };
        let t = Gradient::from_f64(before.t);
        by_instant += weighted(lifted.plain(), Gradient::new(before.t, [1.0; WIDTH]), &given)[0];
        lifted.add_by_parameters(1.0, |system| weighted(system, t, &given));
        *weights = lifted.by_states(x, |plain, x| weighted(plain, t, x));
    }
    by_instant += weights.dot(rate);
    let later = -by_instant / speed;
    let slopes = |system: &Li, x: &Sloped<N>| guards(&over(system), event, 0.0, x.as_slice())[guard].slopes();
    *weights += lifted.by_states(x, slopes) * later;
    lifted.add_by_parameters(later, |system| slopes(system, &given));
    later.is_finite().then_some(())
}

/// A system over slices.
fn over<Li, const N: usize, const G: usize, const M: usize>(system: &Li) -> Over<&Li, N, G, M>
where
    Li: Model<Gradient, N, G, M>,
{
    Over(system)
}
