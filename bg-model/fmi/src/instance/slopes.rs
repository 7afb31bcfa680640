//! Exact derivatives of a model along a direction, without the numbers of its states in its type.
//!
//! In: a time, a state, branches, how fast states and inputs are to change. Out: how fast rates, outputs and guards change with
//! them. Method: dual numbers along the states, and along time for inputs, which are made to grow with time; nothing else in a
//! model depends on time.

use bg_model::mechanism::ModelVisitor;
use bg_model::nalgebra::SVector;
use bg_model::scalar::Dual;
use bg_model::system::Model;

use super::machine::Machine;
use super::signals::Signals;

/// Directions are as much smaller as rates of inputs must be so that a model which reads these does not see them. A power of two:
/// what is linear in it loses nothing.
const SMALL: f64 = f64::from_bits((1023 - 200) << 52);

/// How fast rates, outputs and guards change along a direction.
#[derive(Clone, Debug, Default)]
pub(crate) struct Along {
    pub rates: Vec<f64>,
    pub outputs: Vec<f64>,
    pub guards: Vec<f64>,
}

/// A model that knows its derivatives.
pub(crate) trait Slopes {
    /// Along `states` and `inputs`, where `machine` stands, whose inputs are `signals`.
    fn along(&self, machine: &dyn Machine, signals: &Signals, states: &[f64], inputs: &[f64]) -> Along;
    /// Another one.
    fn twin(&self) -> Box<dyn Slopes>;
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

#[derive(Clone)]
struct OfModel<Mo, const N: usize, const G: usize, const M: usize>(Mo);

impl<Mo, const N: usize, const G: usize, const M: usize> Slopes for OfModel<Mo, N, G, M>
where
    Mo: Model<Dual, N, G, M> + Clone + 'static,
{
    fn along(&self, machine: &dyn Machine, signals: &Signals, states: &[f64], inputs: &[f64]) -> Along {
        let Self(model) = self;
        let (x, branches) = (machine.states(), machine.branches());
        let x: SVector<Dual, N> = SVector::from_fn(|row, _| Dual::new(x[row], SMALL * states[row]));
        let negative: [bool; G] = std::array::from_fn(|index| branches[index]);
        let is_driven = inputs.iter().any(|&slope| slope != 0.0);
        let t = Dual::new(machine.time(), if is_driven { 1.0 } else { 0.0 });
        let grow = |by: f64| inputs.iter().enumerate().for_each(|(index, slope)| signals.set_rate(index, by * slope));
        let zero = Dual::new(0.0, 0.0);
        let (mut rates, mut outputs, mut guards) =
            (SVector::<Dual, N>::repeat(zero), SVector::<Dual, M>::repeat(zero), SVector::<Dual, G>::repeat(zero));
        grow(SMALL);
        model.rate(t, &x, &negative, &mut rates);
        model.outputs(t, &x, &negative, &mut outputs);
        model.guards(t, &x, &negative, &mut guards);
        grow(0.0);
        let slopes = |values: &[Dual]| values.iter().map(|value| value.slope / SMALL).collect();
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
