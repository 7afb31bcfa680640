//! The inputs of an instance: what its host sets while the model runs.
//!
//! In: values from outside. Out: [`Input`]s that have them from then on, the same for the model and its derivatives.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use bg_model::input::Input;

/// A number that can be changed while a model reads it.
#[derive(Debug, Default)]
struct Cell(AtomicU64);

impl Cell {
    fn get(&self) -> f64 {
        f64::from_bits(self.0.load(Ordering::Relaxed))
    }
    fn set(&self, value: f64) {
        self.0.store(value.to_bits(), Ordering::Relaxed);
    }
}

/// The values of all inputs, each in its unit, and how fast they change along the direction in which derivatives are
/// asked for.
#[derive(Clone, Debug)]
pub struct Signals {
    cells: Arc<[(Cell, Cell)]>,
}

impl Signals {
    pub fn new(count: usize) -> Self {
        Self { cells: (0..count).map(|_| Default::default()).collect() }
    }

    pub fn get(&self, index: usize) -> f64 {
        self.cells[index].0.get()
    }

    pub fn set(&self, index: usize, value: f64) {
        self.cells[index].0.set(value);
    }

    pub fn set_along(&self, index: usize, value: f64) {
        self.cells[index].1.set(value);
    }

    pub fn values(&self) -> Vec<f64> {
        self.cells.iter().map(|(value, _)| value.get()).collect()
    }

    /// What a model reads them by.
    pub fn inputs(&self) -> Vec<Input> {
        let input = |index: usize| {
            let (of_value, along) = (self.cells.clone(), self.cells.clone());
            Input::with_tangent(move |_| of_value[index].0.get(), move |_| along[index].1.get())
        };
        (0..self.cells.len()).map(input).collect()
    }
}
