//! The model in numbers with slopes: along the parameters that are asked for, and along the states.
//!
//! In: what makes a model of parameters with slopes. Out: derivatives of what is asked of it, a few directions at a
//! time.

use core::convert::Infallible;

use std::rc::Rc;

use super::super::{Direction, SensitivityError};
use crate::model::dynamics::Machine;
use crate::model::scalar::Gradient;
use crate::model::scalar::slopes::WIDTH;

/// A model in numbers with slopes.
pub(super) type Sloped = Rc<dyn Machine<Gradient>>;

/// The models, and how the objective depends on each direction, as far as it was followed.
pub(super) struct Lifted {
    /// Those with slopes along the directions, so many directions each.
    sloped: Vec<Sloped>,
    /// That with slopes of nothing.
    plain: Sloped,
    /// The derivatives of the objective along the directions.
    pub by: Vec<f64>,
}

impl Lifted {
    /// The models that `lifted` makes for some directions at a time.
    pub fn new(
        directions: &[Direction],
        lifted: impl Fn(&[Direction]) -> Result<Sloped, SensitivityError>,
    ) -> Result<Self, SensitivityError> {
        let sloped = directions.chunks(WIDTH).map(&lifted).collect::<Result<_, _>>()?;
        Ok(Self { sloped, plain: lifted(&[])?, by: vec![0.0; directions.len()] })
    }

    pub fn plain(&self) -> &dyn Machine<Gradient> {
        &*self.plain
    }

    /// The derivatives by each state at `x` of what has these slopes.
    pub fn by_states(
        &self,
        x: &[f64],
        slopes: impl Fn(&dyn Machine<Gradient>, &[Gradient]) -> [f64; WIDTH],
    ) -> Vec<f64> {
        let mut by = vec![0.0; x.len()];
        for (number, by) in by.chunks_mut(WIDTH).enumerate() {
            let along = |i: usize| std::array::from_fn(|l| f64::from(u8::from(number * WIDTH + l == i)));
            let x: Vec<_> = x.iter().enumerate().map(|(i, &x)| Gradient::new(x, along(i))).collect();
            by.iter_mut().zip(slopes(&*self.plain, &x)).for_each(|(by, slope)| *by = slope);
        }
        by
    }

    /// Adds `factor` times the derivatives by each parameter of what has these slopes.
    pub fn add_by_parameters(&mut self, factor: f64, slopes: impl Fn(&dyn Machine<Gradient>) -> [f64; WIDTH]) {
        let Ok(()) =
            self.try_add_by_parameters(|system| Ok::<_, Infallible>(slopes(system).map(|slope| factor * slope)));
    }

    /// The same, once, where the slopes may not be had.
    ///
    /// # Errors
    /// That of the first ones that cannot.
    pub fn try_add_by_parameters<E>(
        &mut self,
        slopes: impl Fn(&dyn Machine<Gradient>) -> Result<[f64; WIDTH], E>,
    ) -> Result<(), E> {
        for (by, system) in self.by.chunks_mut(WIDTH).zip(&self.sloped) {
            by.iter_mut().zip(slopes(&**system)?).for_each(|(by, slope)| *by += slope);
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
