//! What a step of the Taylor series and a rate with second derivatives cost, in rates of explicit methods, without a
//! clock.
//!
//! In: the operations of a rate, of one with second derivatives and of a series, which the compiler counts, and a
//! relative tolerance. Out: the price. What an operation takes beside others depends on the machine; the weights are
//! what fits several models on machines with AVX2.

use super::super::taylor::order_for;
use super::race::STEP;
use crate::model::capability::Operations;
use crate::solve::integrator::Flow;

/// The loosest relative tolerance at which the series is worth a trial: its lowest orders are dear for what they reach.
const LOOSEST: f64 = 1e-3;

/// The price of an accepted step beside its attempts, where joints hold motions: its end is projected, and what they
/// hold is looked at.
pub(super) const HELD: f64 = 5.0;

/// Operations of a rate of a Runge-Kutta step for each state: its sums, and its part of the error estimate.
const STATE: f64 = 10.0;
/// The same of an order, and of a step.
const STATE_OF_ORDER: f64 = 3.0;
/// What an operation of an order, the next of the products that it sums up, and the next of those one after the other
/// take, in operations of a rate.
const ORDER: f64 = 1.9;
const PRODUCT: f64 = 0.05;
const SUM: f64 = 1.0;
/// Operations for each state of a rate with second derivatives: of states of second order there are two sums.
const STATE_OF_FORCES: f64 = 12.0;
/// The price of a rate with second derivatives where nobody has counted.
const OF_FORCES: f64 = 1.2;
/// The operations of an order whose code a processor keeps at hand; of more, each takes so many times as long: 1.35 on
/// an AMD EPYC of 2024, 1.75 on an Intel Xeon of 2023.
const AT_HAND: f64 = 1000.0;
const BEYOND: f64 = 1.53;

/// The price of a step at the relative tolerance `relative`, in rates; none without a series, where its operations are
/// not known, and where the tolerance is loose.
pub(super) fn of_step(flow: &Flow<'_>, relative: f64) -> Option<f64> {
    let operations = flow.series().filter(|_| relative <= LOOSEST)?.operations?;
    Some(price(&operations, flow.states(), order_for(relative)))
}

/// The price of a rate that gives second derivatives; none where there are none.
pub(super) fn of_forces(flow: &Flow<'_>) -> Option<f64> {
    let price = || flow.operations_of_forces().map_or(OF_FORCES, |operations| forces(operations, flow.states()));
    (!flow.second().is_empty()).then(price)
}

/// The price of a rate with second derivatives of a system with so many states, from the operations of a rate and of
/// such a one.
fn forces([rate, forces]: [u32; 2], states: usize) -> f64 {
    let states = states as f64;
    (f64::from(forces) + STATE_OF_FORCES * states) / (f64::from(rate) + STATE * states)
}

/// The price of a step of a system with so many states by a series of this order.
fn price(operations: &Operations, states: usize, order: usize) -> f64 {
    let Operations { rate, order: each, products, sums } = *operations;
    let [rate, each, products, sums] = [rate, each, products, sums].map(f64::from);
    let (states, order) = (states as f64, order as f64);
    let lower = 0.5 * (order - 1.0);
    let of_code = if each > AT_HAND { BEYOND * ORDER } else { ORDER };
    let of_order = of_code * each + STATE_OF_ORDER * states + lower * (PRODUCT * products + SUM * sums);
    // A step of either kind has the rate at its end, the series another one for the defect there.
    let of_rate = (STEP + 1.0) / STEP * rate + STATE * states;
    (order * of_order + 2.0 * rate) / of_rate
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Models with states, with the time of a step over that of a rate in a step of DOP853, both with AVX2, as
    /// measured, and with how much the price may be off; of `full` on two machines.
    #[test]
    fn prices_are_those_that_were_measured() {
        let of = |rate, order, products, sums| Operations { rate, order, products, sums };
        let motion = of(225, 383, 46, 0);
        let paper = of(255, 451, 58, 0);
        let slider_crank = of(121, 188, 17, 0);
        let pendulum = of(42, 78, 8, 0);
        let full = of(826, 1758, 289, 0);
        for (operations, states, order, measured, off) in [
            (motion, 29, 14, 23.3, 0.1),
            (motion, 29, 16, 26.3, 0.1),
            (motion, 29, 18, 29.5, 0.1),
            (motion, 29, 20, 33.3, 0.1),
            (paper, 31, 16, 29.1, 0.1),
            (paper, 31, 20, 36.2, 0.1),
            (slider_crank, 20, 14, 18.0, 0.1),
            (slider_crank, 20, 16, 21.0, 0.1),
            (slider_crank, 20, 20, 25.0, 0.1),
            (full, 83, 14, 39.5, 0.2),
            (full, 83, 14, 49.0, 0.2),
            (full, 83, 20, 60.7, 0.2),
            (full, 83, 20, 78.0, 0.2),
            (pendulum, 14, 14, 12.2, 0.3),
            (pendulum, 14, 20, 15.8, 0.4),
        ] {
            let price = price(&operations, states, order);
            assert!((price / measured - 1.0).abs() < off, "{price} for {measured}");
        }
    }
}
