//! Steps by an explicit tableau of several runs side by side.
//!
//! In: as [`Stages`]. Out: the steps that each run makes by itself, to the bit. Not for tableaus with a late estimate.

use super::stages::Stages;
use super::{Explicit, Tableau, norm};
use crate::model::scalar::lanes::{Lanes, Vector, replace};
use crate::solve::integrator::Scale;
use crate::solve::integrator::compensated::CompensatedSum;
use crate::solve::integrator::lanes::OfOne;
use crate::solve::integrator::steps::{Begin, Rates};

/// The method of tableau `T` for runs side by side.
#[derive(Debug)]
pub(crate) struct ExplicitInLanes<T, V> {
    stages: Stages<T, Lanes<V>, 1>,
    sum: CompensatedSum<Lanes<V>, 1>,
}

impl<T: Tableau, V: Vector> ExplicitInLanes<T, V> {
    /// Of so many states, its work space empty.
    pub fn new(states: usize) -> Self {
        const { assert!(T::LATE.is_empty()) };
        Self { stages: Stages::new(states), sum: CompensatedSum::new(states) }
    }

    /// What rounding has kept from the states at the starts of the steps.
    pub fn compensation(&mut self) -> &mut [Lanes<V>] {
        &mut self.sum.start
    }

    /// What it has kept at their ends.
    pub fn to_be_carried(&self) -> &[Lanes<V>] {
        &self.sum.end
    }

    /// The rates of a stage, each with its state.
    pub fn stage(&self, stage: usize) -> impl Iterator<Item = (usize, Lanes<V>)> {
        self.stages.stage(stage)
    }

    /// Tries a step at each place; gives the norms of the error estimates.
    #[inline(always)]
    pub fn attempt(
        &mut self,
        rates: &impl Rates<Lanes<V>>,
        begin: &Begin<'_, Lanes<V>>,
        scale: &Scale<Lanes<V>>,
        end: &mut [Lanes<V>],
    ) -> Lanes<V> {
        norm::<T, _>(begin.h, self.stages.step(rates, begin, scale, &mut self.sum, end))
    }

    /// The attempts at the places of `accepted` were.
    #[inline(always)]
    pub fn advance(&mut self, accepted: V::Mask) {
        if T::IS_COMPENSATED {
            replace(&mut self.sum.start, accepted, &self.sum.end);
        }
    }
}

impl<T: Tableau> OfOne for Explicit<T> {
    fn compensation(&mut self) -> &mut [f64] {
        &mut self.sum.start
    }

    fn keep(&mut self, compensation: &dyn Fn(&mut [f64]), stage: &dyn Fn(usize, &mut [f64])) {
        compensation(&mut self.sum.end);
        (0..T::END).for_each(|index| self.stages.set_stage(index, |rate| stage(index, rate)));
    }

    fn rates(&self) -> u64 {
        (T::END - 1) as u64
    }
}
