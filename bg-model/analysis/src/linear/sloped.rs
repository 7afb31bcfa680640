//! A model in numbers with slopes, seen without the numbers of its states, switches and outputs.
//!
//! In: a mechanism. Out: its rates, outputs, guards and what its rigid joints hold, of states as slices, in
//! [`Gradient`]. What linearises is compiled once, not once for each mechanism.

use bg_model::capability::Joints;
use bg_model::mechanism::{Mechanism, ModelVisitor};
use bg_model::nalgebra::{DMatrix, DVector, SVector};
use bg_model::scalar::{Gradient, Scalar};
use bg_model::system::{Model, branches};

/// What one evaluation gives.
pub(super) struct Look {
    pub rates: Vec<Gradient>,
    pub outputs: Vec<Gradient>,
    /// The flow of each motion that rigid joints hold.
    pub flows: Vec<Gradient>,
}

/// What the rigid joints of a model hold, at one state.
pub(super) struct HeldNow {
    /// The flow of each motion.
    pub flows: Vec<Gradient>,
    /// The gap of each motion.
    pub gaps: DVector<f64>,
    /// How much each reaction (column) changes the rate of each flow (row).
    pub matrix: DMatrix<f64>,
    /// How much each reaction (column) changes the rate of each state (row).
    pub moves: DMatrix<f64>,
}

/// A model in numbers with slopes. States and branches have the numbers of its description.
pub(super) trait Sloped {
    /// The branches of the switches at time `t` (s).
    fn branches(&self, t: f64, x: &[Gradient]) -> Vec<bool>;
    /// dx/dt.
    fn rates(&self, t: Gradient, x: &[Gradient], negative: &[bool]) -> Vec<Gradient>;
    /// All that a linear model asks for.
    fn look(&self, t: Gradient, x: &[Gradient], negative: &[bool]) -> Look;
    /// What the rigid joints hold; none where there is no rigid joint.
    fn held(&self, t: Gradient, x: &[Gradient], negative: &[bool]) -> Option<HeldNow>;
    /// The state moved onto what joints and orientations ask for.
    fn projected(&self, t: Gradient, x: &[Gradient], negative: &[bool]) -> Vec<Gradient>;
}

/// `mechanism` in numbers with slopes.
pub(super) fn sloped<Me: Mechanism>(mechanism: &Me) -> Box<dyn Sloped> {
    mechanism.visit(Whole)
}

struct Whole;

impl ModelVisitor<Gradient> for Whole {
    type Output = Box<dyn Sloped>;
    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Self::Output
    where
        Mo: Model<Gradient, N, G, M> + Clone + 'static,
    {
        Box::new(Of::<Mo, N, G, M>(model.clone()))
    }
}

struct Of<Mo, const N: usize, const G: usize, const M: usize>(Mo);

impl<Mo: Model<Gradient, N, G, M>, const N: usize, const G: usize, const M: usize> Sloped for Of<Mo, N, G, M> {
    fn branches(&self, t: f64, x: &[Gradient]) -> Vec<bool> {
        branches(&self.0, t, &SVector::from_column_slice(x)).to_vec()
    }

    fn rates(&self, t: Gradient, x: &[Gradient], negative: &[bool]) -> Vec<Gradient> {
        let mut rates = SVector::repeat(zero());
        self.0.rate(t, &SVector::from_column_slice(x), &of_switches(negative), &mut rates);
        rates.as_slice().to_vec()
    }

    fn look(&self, t: Gradient, x: &[Gradient], negative: &[bool]) -> Look {
        let mut outputs = SVector::repeat(zero());
        self.0.outputs(t, &SVector::from_column_slice(x), &of_switches(negative), &mut outputs);
        Look {
            rates: self.rates(t, x, negative),
            outputs: outputs.as_slice().to_vec(),
            flows: self.held(t, x, negative).map_or(Vec::new(), |held| held.flows),
        }
    }

    fn held(&self, t: Gradient, x: &[Gradient], negative: &[bool]) -> Option<HeldNow> {
        let joints = self.0.joints()?;
        let held = joints.held();
        let reactions = held.rigid.len();
        if reactions == 0 {
            return None;
        }
        let mut entries = vec![zero(); held.entries()];
        joints.hold(t, &SVector::from_column_slice(x), &of_switches(negative), &mut entries);
        let now = held.read(&entries);
        let matrix = DMatrix::from_fn(reactions, reactions, |i, j| {
            let (row, column) = (i.max(j), i.min(j));
            now.lower[row * (row + 1) / 2 + column].value
        });
        let mut by_state = DMatrix::zeros(N, reactions);
        for reaction in 0..reactions {
            for (place, &state) in held.moved.iter().enumerate() {
                by_state[(state, reaction)] = now.moves[reaction * held.moved.len() + place].value;
            }
        }
        let gaps = DVector::from_iterator(reactions, now.gaps.iter().map(|gap| gap.value));
        Some(HeldNow { flows: now.flows[..reactions].to_vec(), gaps, matrix, moves: by_state })
    }

    fn projected(&self, t: Gradient, x: &[Gradient], negative: &[bool]) -> Vec<Gradient> {
        let mut x = SVector::from_column_slice(x);
        self.0.project(t, &of_switches(negative), &mut x);
        x.as_slice().to_vec()
    }
}

fn zero() -> Gradient {
    Gradient::from_f64(0.0)
}

fn of_switches<const G: usize>(negative: &[bool]) -> [bool; G] {
    negative.try_into().expect("a branch for each switch")
}
