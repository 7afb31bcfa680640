//! Exact derivatives of a model along a direction, without the numbers of its states in its type.
//!
//! In: a time, a state, branches, how fast states and inputs are to change. Out: how fast rates, outputs and guards
//! change with them. Method: dual numbers along the states, and along time for inputs, whose tangents are the
//! direction; what changes with time by itself is taken away again.

use std::rc::Rc;

use bg_model::dynamics::Machine;
use bg_model::mechanism::ModelVisitor;
use bg_model::nalgebra::SVector;
use bg_model::scalar::Dual;
use bg_model::system::Model;

use super::machine::Stood;
use super::signals::Signals;

/// How fast rates, outputs and guards change along a direction.
#[derive(Clone, Debug, Default)]
pub(crate) struct Along {
    pub rates: Vec<f64>,
    pub outputs: Vec<f64>,
    pub guards: Vec<f64>,
}

/// A model that knows its derivatives.
pub(crate) trait Slopes {
    /// Along `states` and so much time, where `machine` stands.
    fn changes(&self, machine: &Stood, states: &[f64], time: f64) -> Along;

    /// Another one.
    fn twin(&self) -> Box<dyn Slopes>;

    /// Along `states` and `inputs`, where `machine` stands, whose inputs are `signals`.
    fn along(&self, machine: &Stood, signals: &Signals, states: &[f64], inputs: &[f64]) -> Along {
        let is_driven = inputs.iter().any(|&slope| slope != 0.0);
        inputs.iter().enumerate().for_each(|(index, &slope)| signals.set_along(index, slope));
        let mut along = self.changes(machine, states, if is_driven { 1.0 } else { 0.0 });
        (0..inputs.len()).for_each(|index| signals.set_along(index, 0.0));
        if is_driven {
            let alone = self.changes(machine, &vec![0.0; states.len()], 1.0);
            let less = |of: &mut Vec<f64>, by: &[f64]| of.iter_mut().zip(by).for_each(|(of, by)| *of -= by);
            less(&mut along.rates, &alone.rates);
            less(&mut along.outputs, &alone.outputs);
            less(&mut along.guards, &alone.guards);
        }
        along
    }
}

fn slopes(values: &[Dual]) -> Vec<f64> {
    values.iter().map(|value| value.slope).collect()
}

/// Makes [`Slopes`] of a model in dual numbers.
pub(crate) struct InDuals;

impl ModelVisitor<Dual> for InDuals {
    type Output = Box<dyn Slopes>;

    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Self::Output
    where
        Mo: Model<Dual, N, G, M> + Clone + 'static,
    {
        Box::new(OfModel::<Mo, N, G, M>(model.clone()))
    }
}

/// A compiled model, of which nothing else is compiled in these numbers.
#[derive(Clone)]
struct OfModel<Mo, const N: usize, const G: usize, const M: usize>(Mo);

impl<Mo, const N: usize, const G: usize, const M: usize> Slopes for OfModel<Mo, N, G, M>
where
    Mo: Model<Dual, N, G, M> + Clone + 'static,
{
    fn changes(&self, machine: &Stood, states: &[f64], time: f64) -> Along {
        let Self(model) = self;
        let (x, branches) = (machine.states(), machine.branches());
        let (t, x) = (Dual::new(machine.time(), time), SVector::from_fn(|row, _| Dual::new(x[row], states[row])));
        let negative: [bool; G] = std::array::from_fn(|index| branches[index]);
        let zero = Dual::new(0.0, 0.0);
        let (mut rates, mut outputs, mut guards) =
            (SVector::<Dual, N>::repeat(zero), SVector::<Dual, M>::repeat(zero), SVector::<Dual, G>::repeat(zero));
        model.rate(t, &x, &negative, &mut rates);
        model.outputs(t, &x, &negative, &mut outputs);
        model.guards(t, &x, &negative, &mut guards);
        Along {
            rates: slopes(rates.as_slice()),
            outputs: slopes(outputs.as_slice()),
            guards: slopes(guards.as_slice()),
        }
    }

    fn twin(&self) -> Box<dyn Slopes> {
        Box::new(self.clone())
    }
}

impl Slopes for Rc<dyn Machine<Dual>> {
    fn changes(&self, machine: &Stood, states: &[f64], time: f64) -> Along {
        let (t, negative) = (Dual::new(machine.time(), time), machine.branches());
        let x: Vec<Dual> = machine.states().iter().zip(states).map(|(&x, &along)| Dual::new(x, along)).collect();
        let room = |count: usize| vec![Dual::new(0.0, 0.0); count];
        let (mut rates, mut guards) = (room(x.len()), room(negative.len()));
        let mut outputs = room(self.description().outputs.len());
        self.rate(t, &x, negative, &mut rates);
        self.outputs(t, &x, negative, &mut outputs);
        self.guards(t, &x, negative, &mut guards);
        Along { rates: slopes(&rates), outputs: slopes(&outputs), guards: slopes(&guards) }
    }

    fn twin(&self) -> Box<dyn Slopes> {
        Box::new(Self::clone(self))
    }
}
