//! Steps by an explicit tableau of several runs side by side.
//!
//! In: as [`Stages`]. Out: the steps that each run makes by itself, to the bit. Not for tableaus with a late estimate.

use nalgebra::SVector;

use super::stages::Stages;
use super::{Explicit, Tableau, norm};
use crate::model::scalar::lanes::{Lanes, Vector, replace};
use crate::solve::integrator::Scale;
use crate::solve::integrator::compensated::CompensatedSum;
use crate::solve::integrator::lanes::OfOne;
use crate::solve::integrator::steps::{Begin, Rates};

/// The method of tableau `T` for runs side by side.
#[derive(Debug)]
pub(crate) struct ExplicitInLanes<T, V, const N: usize> {
    stages: Stages<T, Lanes<V>, N>,
    sum: CompensatedSum<Lanes<V>, N>,
}

impl<T: Tableau, V: Vector, const N: usize> ExplicitInLanes<T, V, N> {
    /// Its work space empty.
    pub fn new() -> Self {
        const { assert!(T::LATE.is_empty()) };
        Self { stages: Stages::new(), sum: CompensatedSum::new() }
    }

    /// What rounding has kept from the states at the starts of the steps.
    pub fn compensation(&mut self) -> &mut SVector<Lanes<V>, N> {
        &mut self.sum.start
    }

    /// What it has kept at their ends.
    pub fn to_be_carried(&self) -> &SVector<Lanes<V>, N> {
        &self.sum.end
    }

    /// The rates of a stage.
    pub fn stage(&self, stage: usize) -> &SVector<Lanes<V>, N> {
        &self.stages.k[stage]
    }

    /// Tries a step at each place; gives the norms of the error estimates.
    #[inline(always)]
    pub fn attempt(
        &mut self,
        rates: &impl Rates<Lanes<V>, N>,
        begin: &Begin<'_, Lanes<V>, N>,
        scale: &Scale<N, Lanes<V>>,
        end: &mut SVector<Lanes<V>, N>,
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

impl<T: Tableau, const N: usize> OfOne<N> for Explicit<T, N> {
    fn compensation(&mut self) -> &mut SVector<f64, N> {
        &mut self.sum.start
    }

    fn keep(&mut self, compensation: SVector<f64, N>, stage: &dyn Fn(usize) -> SVector<f64, N>) {
        self.sum.end = compensation;
        self.stages.k[..T::END].iter_mut().enumerate().for_each(|(index, k)| *k = stage(index));
    }

    fn rates(&self) -> u64 {
        (T::END - 1) as u64
    }
}
