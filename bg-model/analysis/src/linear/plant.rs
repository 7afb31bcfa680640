//! The plant: what is linearised, a mechanism at one time with its inputs held, seen without its type.
//!
//! In: a mechanism, a time and states. Out: rates, outputs and their derivatives by states and inputs, exact to
//! rounding; the states after a finite move along the kinematics.
//! Method: numbers with slopes along [`WIDTH`] states at once, and along time for an input whose tangent is 1.

use std::rc::Rc;

use bg_model::description::{Description, StateKind};
use bg_model::dynamics::{Machine, branches};
use bg_model::input::Input;
use bg_model::mechanism::Differentiable;
use bg_model::nalgebra::{DMatrix, DVector};
use bg_model::parameters::ParameterError;
use bg_model::scalar::{Gradient, Scalar};

use super::carry::{Carry, carried};
use super::sloped::look;

/// How many directions a number has slopes along.
const WIDTH: usize = Gradient::WIDTH;

/// Rates at a state, with their derivatives and those of the outputs by the states.
#[derive(Clone)]
pub(super) struct Derivatives {
    /// dx/dt.
    pub rates: DVector<f64>,
    /// Row: rate, column: state.
    pub rates_by_state: DMatrix<f64>,
    /// Row: output, column: state.
    pub outputs_by_state: DMatrix<f64>,
    /// Row: a motion that rigid joints hold, column: state. The derivatives of its flow.
    pub flows_by_state: DMatrix<f64>,
}

/// The derivatives of rates and outputs by the inputs, a column for each.
pub(super) struct ByInputs {
    pub rates: DMatrix<f64>,
    pub outputs: DMatrix<f64>,
}

/// A mechanism whose inputs keep the values that they have at a time.
pub(super) struct Plant {
    /// Its tables.
    pub description: &'static Description,
    t: f64,
    /// The branches of the switches, where they are known.
    negative: Option<Vec<bool>>,
    model: Rc<dyn Machine<Gradient>>,
    /// The same with a tangent of one unit a second for each input in turn.
    growing: Vec<Rc<dyn Machine<Gradient>>>,
}

impl Plant {
    /// The names of the states that only instants change: what memories keep and samples hold.
    pub fn held(&self) -> Vec<String> {
        let delays = self.model.delays();
        let of_delay = |state: &usize| {
            delays.iter().any(|delay| {
                let mut signals = delay.states.signals.iter();
                delay.states.window.contains(state) || signals.any(|signal| signal.coefficients.contains(state))
            })
        };
        let held = self.model.memories().into_iter().filter(|state| !of_delay(state));
        let held = held.map(|state| self.description.states[state].name.to_owned());
        held.chain((!delays.is_empty()).then(|| "what `delay` gives".to_owned())).collect()
    }

    /// `mechanism` at time `t` (s). Where its switches are in branches that are not known the signs of their guards
    /// decide.
    pub fn at(model: &dyn Differentiable, t: f64, negative: Option<Vec<bool>>) -> Result<Self, ParameterError> {
        let values: Vec<f64> = model.inputs().iter().map(|input| input.value(t)).collect();
        let growing = (0..values.len()).map(|index| model.sloped(&held(&values, Some(index))));
        let growing = growing.collect::<Result<_, ParameterError>>()?;
        Ok(Self { description: model.description(), t, negative, model: model.sloped(&held(&values, None))?, growing })
    }

    /// Rates, outputs and derivatives at state `x`.
    pub fn derivatives(&self, x: &DVector<f64>) -> Derivatives {
        let time = Gradient::from_f64(self.t);
        let at = along(x, &[]);
        let negative = self.branches(&*self.model, &at);
        let here = look(&*self.model, time, &at, &negative);
        let states = x.len();
        let mut found = Derivatives {
            rates: DVector::from_iterator(states, here.rates.iter().map(|rate| rate.value)),
            rates_by_state: DMatrix::zeros(states, states),
            outputs_by_state: DMatrix::zeros(here.outputs.len(), states),
            flows_by_state: DMatrix::zeros(here.flows.len(), states),
        };
        let all: Vec<usize> = (0..states).collect();
        for some in all.chunks(WIDTH) {
            let look = look(&*self.model, time, &along(x, some), &negative);
            for (l, &state) in some.iter().enumerate() {
                found.rates_by_state.set_column(state, &slopes(&look.rates, l));
                found.outputs_by_state.set_column(state, &slopes(&look.outputs, l));
                found.flows_by_state.set_column(state, &slopes(&look.flows, l));
            }
        }
        found
    }

    /// Derivatives by the inputs at state `x`.
    pub fn by_inputs(&self, x: &DVector<f64>) -> ByInputs {
        let x = along(x, &[]);
        let by_time = |model: &dyn Machine<Gradient>| {
            let negative = self.branches(model, &x);
            let look = look(model, Gradient::new(self.t, [1.0; WIDTH]), &x, &negative);
            (slopes(&look.rates, 0), slopes(&look.outputs, 0))
        };
        let (rates, outputs) = by_time(&*self.model);
        let grown: Vec<_> = self.growing.iter().map(|model| by_time(&**model)).collect();
        ByInputs {
            rates: DMatrix::from_fn(rates.len(), grown.len(), |row, k| grown[k].0[row] - rates[row]),
            outputs: DMatrix::from_fn(outputs.len(), grown.len(), |row, k| grown[k].1[row] - outputs[row]),
        }
    }

    fn branches(&self, model: &dyn Machine<Gradient>, x: &[Gradient]) -> Vec<bool> {
        self.negative.clone().unwrap_or_else(|| branches(model, self.t, x))
    }

    /// The state that a finite move leads to.
    pub fn carried(&self, x: &DVector<f64>, carry: &Carry) -> DVector<f64> {
        carried(&*self.model, self.t, x, carry)
    }
}

/// Inputs that keep these values; one has a tangent of one unit a second, which no law can read as a rate.
fn held(values: &[f64], growing: Option<usize>) -> Vec<Input> {
    let input = |(k, &value): (usize, &f64)| {
        if growing == Some(k) { Input::with_tangent(move |_| value, |_| 1.0) } else { Input::constant(value) }
    };
    values.iter().enumerate().map(input).collect()
}

/// The states as numbers of which these change, each along a direction of its own.
fn along(x: &DVector<f64>, some: &[usize]) -> Vec<Gradient> {
    let slope = |state: usize| std::array::from_fn(|l| if some.get(l) == Some(&state) { 1.0 } else { 0.0 });
    x.iter().enumerate().map(|(state, &value)| Gradient::new(value, slope(state))).collect()
}

fn slopes(of: &[Gradient], l: usize) -> DVector<f64> {
    DVector::from_iterator(of.len(), of.iter().map(|number| number.slopes()[l]))
}

/// Which states are momenta.
pub(super) fn momenta(description: &Description) -> Vec<bool> {
    description.states.iter().map(|state| matches!(state.kind, StateKind::Momentum(_))).collect()
}

/// The state at the same place with all momenta zero.
pub(super) fn at_rest(description: &Description, x: &DVector<f64>) -> DVector<f64> {
    let momenta = momenta(description);
    DVector::from_fn(x.len(), |state, _| if momenta[state] { 0.0 } else { x[state] })
}
