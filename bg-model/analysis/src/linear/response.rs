//! Frequency responses of a linear model.
//!
//! In: a linear model, inputs, outputs, frequencies. Out: magnitude and phase of each output for each input.
//! Method: C (i w - A)^-1 B + D by complex factors of the balanced matrix.

use bg_model::nalgebra::{Complex, DMatrix};
use serde::Serialize;

use super::eigen::Balanced;
use super::error::LinearError;
use super::state_space::{Named, StateSpace};

/// How an output answers a sine of an input.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Response {
    /// The input.
    pub input: Named,
    /// The output.
    pub output: Named,
    /// Angular frequencies, rad/s.
    pub frequency: Vec<f64>,
    /// Amplitude of the output over that of the input, in the output's unit per the input's; infinite at an undamped
    /// frequency.
    pub magnitude: Vec<f64>,
    /// Phase of the output before the input, rad, without jumps of a whole turn.
    pub phase: Vec<f64>,
}

/// `points` angular frequencies from `first` to `last` (rad/s), each the same factor after the one before.
#[must_use]
pub fn logarithmic(first: f64, last: f64, points: usize) -> Vec<f64> {
    let step = if points > 1 { (last / first).ln() / (points - 1) as f64 } else { 0.0 };
    let value = |k: usize| if k + 1 == points && k > 0 { last } else { first * (step * k as f64).exp() };
    (0..points).map(value).collect()
}

impl StateSpace {
    /// The range of angular frequencies, rad/s, in which something happens: from a tenth of the slowest mode to ten
    /// times the fastest, free motions apart; 0.1 to 100 where there is none.
    #[must_use]
    pub fn band(&self) -> (f64, f64) {
        let sizes = self.modes.iter().map(|mode| mode.natural).filter(|&natural| natural > 0.0);
        let (slowest, fastest) = sizes.fold((f64::INFINITY, 0.0_f64), |(a, b), size| (a.min(size), b.max(size)));
        if fastest > 0.0 { (0.1 * slowest, 10.0 * fastest) } else { (0.1, 100.0) }
    }

    /// The responses of `outputs` to `inputs`, by name, each output to each input, at these angular frequencies
    /// (rad/s). No names are all names.
    ///
    /// # Errors
    /// [`LinearError::Unknown`]: a name that the model does not have.
    pub fn responses(
        &self,
        inputs: &[&str],
        outputs: &[&str],
        frequency: &[f64],
    ) -> Result<Vec<Response>, LinearError> {
        let inputs = places(&self.inputs, inputs, "input")?;
        let outputs = places(&self.outputs, outputs, "output")?;
        let transfer = self.transfer(frequency);
        let pairs = inputs.iter().flat_map(|&input| outputs.iter().map(move |&output| (input, output)));
        let response = |(input, output): (usize, usize)| {
            let values: Vec<Complex<f64>> = transfer.iter().map(|gains| gains[(output, input)]).collect();
            Response {
                input: self.inputs[input].clone(),
                output: self.outputs[output].clone(),
                frequency: frequency.to_vec(),
                magnitude: values.iter().map(|value| value.norm()).collect(),
                phase: unwrapped(values.iter().map(|value| value.arg())),
            }
        };
        Ok(pairs.map(response).collect())
    }

    /// Outputs by inputs at each frequency.
    fn transfer(&self, frequency: &[f64]) -> Vec<DMatrix<Complex<f64>>> {
        let size = self.a.nrows();
        let balanced = Balanced::of(&self.a);
        let complex = |matrix: &DMatrix<f64>| matrix.map(|entry| Complex::new(entry, 0.0));
        let a = complex(&balanced.matrix);
        let b = complex(&DMatrix::from_fn(size, self.b.ncols(), |row, column| {
            self.b[(row, column)] / balanced.scales[row]
        }));
        let c = complex(&DMatrix::from_fn(self.c.nrows(), size, |row, column| {
            self.c[(row, column)] * balanced.scales[column]
        }));
        let d = complex(&self.d);
        let at = |&w: &f64| {
            let states = (DMatrix::from_diagonal_element(size, size, Complex::new(0.0, w)) - &a).lu().solve(&b);
            states.map_or(d.map(|_| Complex::new(f64::INFINITY, 0.0)), |states| &c * states + &d)
        };
        frequency.iter().map(at).collect()
    }
}

/// The indices of these names; of all where none is given.
fn places(known: &[Named], names: &[&str], kind: &'static str) -> Result<Vec<usize>, LinearError> {
    let place = |name: &&str| {
        known.iter().position(|named| named.name == *name).ok_or_else(|| {
            let list: Vec<String> = known.iter().map(|named| format!("`{}`", named.name)).collect();
            let known = if list.is_empty() { "none".to_owned() } else { list.join(", ") };
            LinearError::Unknown { kind, name: (*name).to_owned(), known }
        })
    };
    if names.is_empty() { Ok((0..known.len()).collect()) } else { names.iter().map(place).collect() }
}

/// Phases without jumps of a whole turn.
fn unwrapped(phases: impl Iterator<Item = f64>) -> Vec<f64> {
    let turn = std::f64::consts::TAU;
    let mut unwrapped: Vec<f64> = Vec::new();
    for phase in phases {
        let before = unwrapped.last().copied().unwrap_or(phase);
        unwrapped.push(phase + turn * ((before - phase) / turn).round());
    }
    unwrapped
}
