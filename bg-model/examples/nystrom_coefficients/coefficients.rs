//! A method's coefficients, and the unknowns that they follow from.

use bg_model::scalar::Scalar;

use crate::{STAGES, start};

/// The coefficients of the stages and, in the last row, of the end of the step.
pub struct Coefficients<S> {
    pub instants: Vec<S>,
    pub first: Vec<Vec<S>>,
    pub second: Vec<Vec<S>>,
}

impl Coefficients<f64> {
    /// The unknowns at the start: the weights of rates, then those of second derivatives without a stage's first one.
    pub fn start() -> Vec<f64> {
        start::FIRST.iter().chain(&start::SECOND).flat_map(|row| row.iter().copied()).collect()
    }
}

impl<S: Scalar> Coefficients<S> {
    /// A stage's instant is the sum of its weights of rates. Its first weight of second derivatives makes their sum
    /// half the instant's square.
    pub fn from_unknowns(unknowns: &[S]) -> Self {
        let mut left = unknowns.iter().copied();
        let first: Vec<Vec<S>> = (0..=STAGES).map(|row| left.by_ref().take(row).collect()).collect();
        let instants: Vec<S> = first[..STAGES].iter().map(|row| sum(row)).collect();
        let mut second = vec![Vec::new()];
        for c in &instants[1..] {
            let others: Vec<S> = left.by_ref().take(second.len() - 1).collect();
            let rest = S::from_f64(0.5) * *c * *c - sum(&others);
            second.push([vec![rest], others].concat());
        }
        second.push(left.collect());
        Self { instants, first, second }
    }

    /// The same coefficients in another scalar.
    pub fn map<T>(&self, of: impl Fn(S) -> T) -> Coefficients<T> {
        let row = |row: &Vec<S>| row.iter().map(|value| of(*value)).collect();
        Coefficients {
            instants: row(&self.instants),
            first: self.first.iter().map(row).collect(),
            second: self.second.iter().map(row).collect(),
        }
    }
}

fn sum<S: Scalar>(row: &[S]) -> S {
    row.iter().fold(S::from_f64(0.0), |sum, value| sum + *value)
}
