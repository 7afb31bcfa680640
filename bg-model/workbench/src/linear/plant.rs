//! The plant: what is linearised, a mechanism at one time with its inputs held, seen without the numbers of its states.
//!
//! In: a mechanism, a time and states. Out: rates, outputs and their derivatives by states and inputs, exact to
//! rounding; the states after a finite move along the kinematics.
//! Method: dual numbers along one state after the other, and along time for an input that is made to grow with time.

use bg_model::description::{Description, StateKind};
use bg_model::input::Input;
use bg_model::mechanism::{Mechanism, ModelVisitor};
use bg_model::nalgebra::{DMatrix, DVector, SVector};
use bg_model::parameters::ParameterError;
use bg_model::scalar::{Dual, Scalar};
use bg_model::system::{Model, branches_by_sign};

use super::carry::{Carry, carried};

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

/// What is linearised.
pub(super) trait Plant {
    /// Its tables.
    fn description(&self) -> &'static Description;
    /// Rates, outputs and derivatives at state `x`.
    fn derivatives(&self, x: &DVector<f64>) -> Derivatives;
    /// Derivatives by the inputs at state `x`.
    fn by_inputs(&self, x: &DVector<f64>) -> Result<ByInputs, ParameterError>;
    /// The state that a finite move leads to.
    fn carried(&self, x: &DVector<f64>, carry: &Carry) -> DVector<f64>;
}

/// A mechanism whose inputs keep the values that they have at a time.
pub(super) struct Frozen<Me: Mechanism> {
    mechanism: Me,
    t: f64,
    values: Vec<f64>,
}

impl<Me: Mechanism> Frozen<Me> {
    /// `mechanism` at time `t` (s).
    pub fn at(mechanism: &Me, t: f64) -> Result<Self, ParameterError> {
        let values: Vec<f64> = mechanism.inputs().iter().map(|input| input.value(t)).collect();
        let inputs: Vec<Input> = values.iter().map(|&value| Input::constant(value)).collect();
        Ok(Self { mechanism: Me::make(mechanism.parameters().clone(), &inputs)?, t, values })
    }

    /// The same with input `index` growing by one unit a second.
    fn growing(&self, index: usize) -> Result<Me, ParameterError> {
        let inputs = self.values.iter().enumerate().map(|(k, &value)| {
            if k == index { Input::with_rate(move |_| value, |_| 1.0) } else { Input::constant(value) }
        });
        Me::make(self.mechanism.parameters().clone(), &inputs.collect::<Vec<_>>())
    }
}

impl<Me: Mechanism> Plant for Frozen<Me> {
    fn description(&self) -> &'static Description {
        Me::describe()
    }
    fn derivatives(&self, x: &DVector<f64>) -> Derivatives {
        self.mechanism.visit(ByStates { t: self.t, x })
    }
    fn by_inputs(&self, x: &DVector<f64>) -> Result<ByInputs, ParameterError> {
        let (rates, outputs) = self.mechanism.visit(ByTime { t: self.t, x });
        let slopes = (0..self.values.len()).map(|index| {
            let (of_rates, of_outputs) = self.growing(index)?.visit(ByTime { t: self.t, x });
            Ok((of_rates - &rates, of_outputs - &outputs))
        });
        let slopes = slopes.collect::<Result<Vec<_>, ParameterError>>()?;
        let columns = slopes.len();
        Ok(ByInputs {
            rates: DMatrix::from_fn(rates.len(), columns, |row, column| slopes[column].0[row]),
            outputs: DMatrix::from_fn(outputs.len(), columns, |row, column| slopes[column].1[row]),
        })
    }
    fn carried(&self, x: &DVector<f64>, carry: &Carry) -> DVector<f64> {
        self.mechanism.visit(Carried { t: self.t, x, carry })
    }
}

struct ByStates<'a> {
    t: f64,
    x: &'a DVector<f64>,
}

impl ModelVisitor<Dual> for ByStates<'_> {
    type Output = Derivatives;
    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Derivatives
    where
        Mo: Model<Dual, N, G, M>,
    {
        derivatives(model, self.t, self.x)
    }
}

struct ByTime<'a> {
    t: f64,
    x: &'a DVector<f64>,
}

impl ModelVisitor<Dual> for ByTime<'_> {
    type Output = (DVector<f64>, DVector<f64>);
    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Self::Output
    where
        Mo: Model<Dual, N, G, M>,
    {
        let x = lifted::<N>(self.x, None);
        let negative = branches(model, self.t, &x);
        let look = look(model, Dual::new(self.t, 1.0), &x, &negative);
        (slopes(look.rates.as_slice()), slopes(look.outputs.as_slice()))
    }
}

struct Carried<'a> {
    t: f64,
    x: &'a DVector<f64>,
    carry: &'a Carry,
}

impl ModelVisitor<Dual> for Carried<'_> {
    type Output = DVector<f64>;
    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> DVector<f64>
    where
        Mo: Model<Dual, N, G, M>,
    {
        carried(model, self.t, self.x, self.carry)
    }
}

/// What one evaluation gives.
struct Look<const N: usize, const M: usize> {
    rates: SVector<Dual, N>,
    outputs: SVector<Dual, M>,
    flows: Vec<Dual>,
}

fn look<Mo, const N: usize, const G: usize, const M: usize>(
    model: &Mo,
    t: Dual,
    x: &SVector<Dual, N>,
    negative: &[bool; G],
) -> Look<N, M>
where
    Mo: Model<Dual, N, G, M>,
{
    let zero = Dual::new(0.0, 0.0);
    let mut look = Look { rates: SVector::repeat(zero), outputs: SVector::repeat(zero), flows: Vec::new() };
    model.rate(t, x, negative, &mut look.rates);
    model.outputs(t, x, negative, &mut look.outputs);
    look.flows = held(model, t, x, negative).map_or(Vec::new(), |held| held.flows);
    look
}

/// What the rigid joints of a model hold, at one state.
pub(super) struct HeldNow {
    /// The flow of each motion.
    pub flows: Vec<Dual>,
    /// The gap of each motion.
    pub gaps: DVector<f64>,
    /// How much each reaction (column) changes the rate of each flow (row).
    pub matrix: DMatrix<f64>,
    /// How much each reaction (column) changes the rate of each state (row).
    pub moves: DMatrix<f64>,
}

/// What the rigid joints hold; none where there is no rigid joint.
pub(super) fn held<Mo, const N: usize, const G: usize, const M: usize>(
    model: &Mo,
    t: Dual,
    x: &SVector<Dual, N>,
    negative: &[bool; G],
) -> Option<HeldNow>
where
    Mo: Model<Dual, N, G, M>,
{
    use bg_model::capability::Joints;
    let joints = model.joints()?;
    let held = joints.held();
    let reactions = held.rigid.len();
    if reactions == 0 {
        return None;
    }
    let mut entries = vec![Dual::new(0.0, 0.0); held.entries()];
    joints.hold(t, x, negative, &mut entries);
    let (gaps, triangle) = entries[reactions + held.compliant.len()..].split_at(reactions);
    let (triangle, moves) = triangle.split_at(reactions * (reactions + 1) / 2);
    let matrix = DMatrix::from_fn(reactions, reactions, |i, j| {
        let (row, column) = (i.max(j), i.min(j));
        triangle[row * (row + 1) / 2 + column].value
    });
    let mut by_state = DMatrix::zeros(N, reactions);
    for reaction in 0..reactions {
        for (place, &state) in held.moved.iter().enumerate() {
            by_state[(state, reaction)] = moves[reaction * held.moved.len() + place].value;
        }
    }
    Some(HeldNow { flows: entries[..reactions].to_vec(), gaps: values(gaps), matrix, moves: by_state })
}

/// Rates, outputs and their derivatives by states, column by column.
fn derivatives<Mo, const N: usize, const G: usize, const M: usize>(model: &Mo, t: f64, x: &DVector<f64>) -> Derivatives
where
    Mo: Model<Dual, N, G, M>,
{
    let time = Dual::new(t, 0.0);
    let negative = branches(model, t, &lifted::<N>(x, None));
    let here = look(model, time, &lifted::<N>(x, None), &negative);
    let mut found = Derivatives {
        rates: values(here.rates.as_slice()),
        rates_by_state: DMatrix::zeros(N, N),
        outputs_by_state: DMatrix::zeros(M, N),
        flows_by_state: DMatrix::zeros(here.flows.len(), N),
    };
    for state in 0..N {
        let along = look(model, time, &lifted::<N>(x, Some(state)), &negative);
        found.rates_by_state.set_column(state, &slopes(along.rates.as_slice()));
        found.outputs_by_state.set_column(state, &slopes(along.outputs.as_slice()));
        found.flows_by_state.set_column(state, &slopes(&along.flows));
    }
    found
}

/// The branches of the switches at time `t` (s) and state `x`.
pub(crate) fn branches<S: Scalar<Switch = bool>, Mo, const N: usize, const G: usize, const M: usize>(
    model: &Mo,
    t: f64,
    x: &SVector<S, N>,
) -> [bool; G]
where
    Mo: Model<S, N, G, M>,
{
    let guards = |negative: &[bool; G]| {
        let mut guards = SVector::repeat(S::from_f64(0.0));
        model.guards(S::from_f64(t), x, negative, &mut guards);
        guards
    };
    branches_by_sign(model.first_branches(), guards).0
}

/// The states as dual numbers that change along state `along`, or along none.
fn lifted<const N: usize>(x: &DVector<f64>, along: Option<usize>) -> SVector<Dual, N> {
    SVector::from_fn(|state, _| Dual::new(x[state], if along == Some(state) { 1.0 } else { 0.0 }))
}

fn values(of: &[Dual]) -> DVector<f64> {
    DVector::from_iterator(of.len(), of.iter().map(|number| number.value))
}

fn slopes(of: &[Dual]) -> DVector<f64> {
    DVector::from_iterator(of.len(), of.iter().map(|number| number.slope))
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
