//! A model where it stands, without the numbers of its states in its type.
//!
//! In: a model with its parameters. Out: rates, outputs, guards at a time and state; what an event makes of branches and state; the
//! state a piece of time later, by a run that goes on from piece to piece.

use bg_model::integrator::{AnyMethod, Integrator, Tolerances};
use bg_model::mechanism::ModelVisitor;
use bg_model::nalgebra::SVector;
use bg_model::run::Request;
use bg_model::simulation::{Ongoing, Settings};
use bg_model::statistics::Statistics;
use bg_model::system::Model;

use super::Fault;

/// A model at a time, in a state, its switches in branches.
pub(crate) trait Machine {
    /// Time, s.
    fn time(&self) -> f64;
    fn set_time(&mut self, t: f64);
    fn states(&self) -> &[f64];
    fn set_states(&mut self, x: &[f64]);
    /// Whether each switch is in the branch of its negative guard.
    fn branches(&self) -> &[bool];
    /// Writes dx/dt.
    fn rates(&self, rates: &mut [f64]);
    fn outputs(&self, outputs: &mut [f64]);
    fn guards(&self, guards: &mut [f64]);
    /// How far the state is from the invariants: the largest change that the projection makes of a state, relative to what is
    /// larger, the state or 1 SI unit.
    fn drift(&self) -> f64;
    /// An event: projects the state, lets it jump where something hits a stop, finds the branches that hold from here on. Gives
    /// whether the state has changed.
    fn settle(&mut self, rtol: f64) -> Result<bool, Fault>;
    /// The first instant after the time at which a step must end, s; infinity where there is none.
    fn next_break(&self) -> f64;
    /// Goes on to time `to` (s), over all events. On failure it stands where the run has come to.
    fn advance(&mut self, to: f64, rtol: f64) -> Result<(), Fault>;
    /// What the rate reads from outside has changed.
    fn disturb(&mut self);
    /// The size that the next step of the run is to have, s, where that is known.
    fn next_step(&self) -> Option<f64>;
    /// What the run has cost, where there is one.
    fn statistics(&self) -> Option<Statistics>;
    /// Stands at another place; the next step of the run is tried with `step` (s).
    fn place(&mut self, t: f64, x: &[f64], negative: &[bool], step: Option<f64>);
    /// Another one at the same place, whose run goes on with the same steps.
    fn twin(&self) -> Box<dyn Machine>;
}

/// Makes a machine of a model, at its start.
pub(crate) struct AtStart {
    /// The time of the start, s.
    pub t: f64,
}

impl ModelVisitor<f64> for AtStart {
    type Output = Result<Box<dyn Machine>, Fault>;

    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Self::Output
    where
        Mo: Model<f64, N, G, M> + Clone + 'static,
    {
        let x = model.start().map_err(|fault| Fault::Start(fault.to_string()))?;
        Ok(Box::new(Standing::<Mo, N, G, M> { model: model.clone(), t: self.t, x, negative: [false; G], run: None }))
    }
}

/// A model where it stands.
#[derive(Clone)]
struct Standing<Mo, const N: usize, const G: usize, const M: usize> {
    model: Mo,
    t: f64,
    x: SVector<f64, N>,
    negative: [bool; G],
    /// The run from here on, once there is one.
    run: Option<Run<N, G>>,
}

#[derive(Clone)]
struct Run<const N: usize, const G: usize> {
    method: AnyMethod<N>,
    ongoing: Ongoing<N, G>,
}

impl<const N: usize, const G: usize> Run<N, G> {
    fn at(t: f64, x: SVector<f64, N>) -> Self {
        Self { method: Integrator::default().method(Request::default().fixed_step), ongoing: Ongoing::at(t, x) }
    }
}

fn settings<const N: usize>(rtol: f64) -> Settings<N> {
    Settings { tolerances: Tolerances::relative(rtol), ..Settings::default() }
}

impl<Mo, const N: usize, const G: usize, const M: usize> Machine for Standing<Mo, N, G, M>
where
    Mo: Model<f64, N, G, M> + Clone + 'static,
{
    fn time(&self) -> f64 {
        self.t
    }

    fn set_time(&mut self, t: f64) {
        self.t = t;
    }

    fn states(&self) -> &[f64] {
        self.x.as_slice()
    }

    fn set_states(&mut self, x: &[f64]) {
        self.x.as_mut_slice().copy_from_slice(x);
    }

    fn branches(&self) -> &[bool] {
        &self.negative
    }

    fn rates(&self, rates: &mut [f64]) {
        let mut dx = SVector::zeros();
        self.model.rate(self.t, &self.x, &self.negative, &mut dx);
        rates.copy_from_slice(dx.as_slice());
    }

    fn outputs(&self, outputs: &mut [f64]) {
        let mut y = SVector::<f64, M>::zeros();
        self.model.outputs(self.t, &self.x, &self.negative, &mut y);
        outputs.copy_from_slice(y.as_slice());
    }

    fn guards(&self, guards: &mut [f64]) {
        let mut values = SVector::<f64, G>::zeros();
        self.model.guards(self.t, &self.x, &self.negative, &mut values);
        guards.copy_from_slice(values.as_slice());
    }

    fn drift(&self) -> f64 {
        let mut x = self.x;
        self.model.project(self.t, &self.negative, &mut x);
        let change = |(new, old): (&f64, &f64)| (new - old).abs() / old.abs().max(1.0);
        x.iter().zip(self.x.iter()).map(change).fold(0.0, f64::max)
    }

    fn settle(&mut self, rtol: f64) -> Result<bool, Fault> {
        let before = self.x;
        self.model.project(self.t, &self.negative, &mut self.x);
        if G > 0 {
            // A run of no length finds branches and impacts.
            let Run { mut method, mut ongoing } = Run::<N, G>::at(self.t, self.x);
            let settled = ongoing.advance(&self.model, &mut method, self.t, &settings(rtol), &mut ());
            settled.map_err(|failure| Fault::Stopped(failure.to_string()))?;
            (self.x, self.negative) = (*ongoing.state(), *ongoing.negative());
        }
        Ok(self.x != before)
    }

    fn next_break(&self) -> f64 {
        self.model.next_break(self.t)
    }

    fn advance(&mut self, to: f64, rtol: f64) -> Result<(), Fault> {
        let run = self.run.get_or_insert_with(|| Run::at(self.t, self.x));
        let outcome = run.ongoing.advance(&self.model, &mut run.method, to, &settings(rtol), &mut ());
        (self.t, self.x) = (run.ongoing.time(), *run.ongoing.state());
        self.negative = *run.ongoing.negative();
        outcome.map(|_| ()).map_err(|failure| Fault::Stopped(failure.to_string()))
    }

    fn disturb(&mut self) {
        if let Some(run) = &mut self.run {
            run.ongoing.renew(None);
        }
    }

    fn next_step(&self) -> Option<f64> {
        self.run.as_ref().and_then(|run| run.ongoing.next_step())
    }

    fn statistics(&self) -> Option<Statistics> {
        self.run.as_ref().map(|run| *run.ongoing.statistics())
    }

    fn place(&mut self, t: f64, x: &[f64], negative: &[bool], step: Option<f64>) {
        self.t = t;
        self.set_states(x);
        self.negative.copy_from_slice(negative);
        self.run = step.map(|step| {
            let mut run = Run::at(t, self.x);
            run.ongoing.renew(Some(step));
            run
        });
    }

    fn twin(&self) -> Box<dyn Machine> {
        Box::new(self.clone())
    }
}
