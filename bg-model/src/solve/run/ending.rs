//! What ends a run before its end: nothing, or a condition of its outputs.
//!
//! In: a model and its run. Out: the run with or without a condition. Which of the two is a type, so that a program
//! which has no conditions compiles its models without them.

use std::ops::Index;

use nalgebra::SVector;

use crate::model::description::OutputInfo;
use crate::model::system::Model;
use crate::solve::event::{Located, Never};
use crate::solve::failure::Failure;
use crate::solve::finish::Finish;
use crate::solve::integrator::Method;
use crate::solve::simulation::{Beginning, Observer, Settings, Span, make};

/// A model at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a> {
    /// Time, s.
    pub t: f64,
    outputs: &'a [f64],
    infos: &'static [OutputInfo],
}

impl Index<&str> for Sample<'_> {
    type Output = f64;

    /// The output called `name`, in its unit.
    ///
    /// # Panics
    /// There is no such output.
    fn index(&self, name: &str) -> &f64 {
        let names = || self.infos.iter().map(|info| info.name).collect::<Vec<_>>().join(", ");
        let index = self.infos.iter().position(|info| info.name == name);
        &self.outputs[index.unwrap_or_else(|| panic!("the model has no output `{name}`; it has {}", names()))]
    }
}

/// What may end a run.
pub trait Ending {
    /// Integrates as [`integrate`](crate::simulation::integrate) does, and ends where this says so.
    ///
    /// # Errors
    /// As [`integrate`](crate::simulation::integrate).
    fn integrate<Mo, Me, O, const N: usize, const G: usize, const M: usize>(
        self,
        model: &Mo,
        method: &mut Me,
        start: &Beginning<N, G>,
        span: Span,
        settings: &Settings<N>,
        observer: &mut O,
    ) -> Result<Finish<N, G>, Failure<N, G>>
    where
        Mo: Model<f64, N, G, M>,
        Me: Method,
        O: Observer<N, G>;
}

/// Nothing but its end ends a run.
#[derive(Clone, Copy, Debug)]
pub struct Unconditional;

impl Ending for Unconditional {
    fn integrate<Mo, Me, O, const N: usize, const G: usize, const M: usize>(
        self,
        model: &Mo,
        method: &mut Me,
        start: &Beginning<N, G>,
        span: Span,
        settings: &Settings<N>,
        observer: &mut O,
    ) -> Result<Finish<N, G>, Failure<N, G>>
    where
        Mo: Model<f64, N, G, M>,
        Me: Method,
        O: Observer<N, G>,
    {
        make(model, method, start, span, settings, Never, observer)
    }
}

/// A function of the outputs, which ends a run where it passes through zero.
#[derive(Clone, Copy, Debug)]
pub struct When<F>(pub(super) F);

impl<F: FnMut(&Sample<'_>) -> f64> Ending for When<F> {
    fn integrate<Mo, Me, O, const N: usize, const G: usize, const M: usize>(
        mut self,
        model: &Mo,
        method: &mut Me,
        start: &Beginning<N, G>,
        span: Span,
        settings: &Settings<N>,
        observer: &mut O,
    ) -> Result<Finish<N, G>, Failure<N, G>>
    where
        Mo: Model<f64, N, G, M>,
        Me: Method,
        O: Observer<N, G>,
    {
        let infos = model.description().outputs;
        let condition = |t: f64, x: &SVector<f64, N>, negative: &[bool; G]| {
            let mut outputs = SVector::<f64, M>::zeros();
            model.outputs(t, x, negative, &mut outputs);
            (self.0)(&Sample { t, outputs: outputs.as_slice(), infos })
        };
        make(model, method, start, span, settings, Located::new(condition), observer)
    }
}
