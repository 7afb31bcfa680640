//! The model in numbers with slopes: along the parameters that are asked for, and along the states.
//!
//! In: what makes a model of parameters with slopes. Out: derivatives of what is asked of it, a few directions at a
//! time.

use core::convert::Infallible;

use nalgebra::SVector;

use super::super::{Direction, SensitivityError};
use crate::model::scalar::Gradient;
use crate::model::scalar::slopes::WIDTH;

/// A state with slopes.
pub(super) type Sloped<const N: usize> = SVector<Gradient, N>;

/// The models, and how the objective depends on each direction, as far as it was followed.
pub(super) struct Lifted<Li> {
    /// Those with slopes along the directions, so many directions each.
    sloped: Vec<Li>,
    /// That with slopes of nothing.
    plain: Li,
    /// The derivatives of the objective along the directions.
    pub by: Vec<f64>,
}

impl<Li> Lifted<Li> {
    /// The models that `lifted` makes for some directions at a time.
    pub fn new(
        directions: &[Direction],
        lifted: impl Fn(&[Direction]) -> Result<Li, SensitivityError>,
    ) -> Result<Self, SensitivityError> {
        let sloped = directions.chunks(WIDTH).map(&lifted).collect::<Result<_, _>>()?;
        Ok(Self { sloped, plain: lifted(&[])?, by: vec![0.0; directions.len()] })
    }

    pub fn plain(&self) -> &Li {
        &self.plain
    }

    /// The derivatives by each state at `x` of what has these slopes.
    pub fn by_states<const N: usize>(
        &self,
        x: &SVector<f64, N>,
        slopes: impl Fn(&Li, &Sloped<N>) -> [f64; WIDTH],
    ) -> SVector<f64, N> {
        let mut by = SVector::<f64, N>::zeros();
        for first in (0..N).step_by(WIDTH) {
            let along = |i: usize| std::array::from_fn(|l| f64::from(u8::from(first + l == i)));
            let slopes = slopes(&self.plain, &SVector::from_fn(|i, _| Gradient::new(x[i], along(i))));
            by.iter_mut().skip(first).zip(slopes).for_each(|(by, slope)| *by = slope);
        }
        by
    }

    /// Adds `factor` times the derivatives by each parameter of what has these slopes.
    pub fn add_by_parameters(&mut self, factor: f64, slopes: impl Fn(&Li) -> [f64; WIDTH]) {
        let Ok(()) =
            self.try_add_by_parameters(|system| Ok::<_, Infallible>(slopes(system).map(|slope| factor * slope)));
    }

    /// The same, once, where the slopes may not be had.
    ///
    /// # Errors
    /// That of the first ones that cannot.
    pub fn try_add_by_parameters<E>(&mut self, slopes: impl Fn(&Li) -> Result<[f64; WIDTH], E>) -> Result<(), E> {
        for (by, system) in self.by.chunks_mut(WIDTH).zip(&self.sloped) {
            by.iter_mut().zip(slopes(system)?).for_each(|(by, slope)| *by += slope);
        }
        Ok(())
    }
}

/// The slopes of a weighted sum. What does not change has no weight, which may be none.
pub(super) fn weighted(of: &[Gradient], weights: &[f64]) -> [f64; WIDTH] {
    let mut sum = [0.0; WIDTH];
    for (number, weight) in of.iter().zip(weights) {
        let changing = sum.iter_mut().zip(number.slopes()).filter(|(_, slope)| *slope != 0.0);
        changing.for_each(|(sum, slope)| *sum += slope * weight);
    }
    sum
}
