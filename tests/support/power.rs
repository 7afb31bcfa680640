//! The power balance of a model at states drawn at random.

use bg_model::description::{StateInfo, StateKind};
use bg_model::dynamics::Machine;
use bg_model::scalar::Dual;
use bg_model::system::Powers;

use crate::support::example::Twin;
use crate::support::rotation::matrix;

/// Numbers that look random and are the same every time (SplitMix64, Steele, Lea and Flood 2014).
#[derive(Clone, Debug)]
pub struct Draw(u64);

impl Draw {
    /// The sequence of this seed.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next number, between -1 and 1.
    pub fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        (z >> 11) as f64 * 2.0_f64.powi(-52) - 1.0
    }

    /// A rotation matrix, row by row: that of a random quaternion.
    fn rotation(&mut self) -> [f64; 9] {
        let quaternion = std::array::from_fn(|_| self.number() + 1e-3);
        let [a, b, c, d] = quaternion;
        let square = a * a + b * b + c * c + d * d;
        matrix(quaternion).map(|entry| entry / square)
    }

    /// A rotation matrix about z.
    fn turn(&mut self) -> [f64; 9] {
        let (sine, cosine) = libm::sincos(4.0 * self.number());
        [cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0]
    }
}

/// Whether two states are components of one orientation.
fn is_of_one_rotation(one: &StateInfo, other: &StateInfo) -> bool {
    one.element == other.element && [one, other].iter().all(|state| matches!(state.kind, StateKind::Orientation(..)))
}

/// A state drawn at random: storages and positions anywhere near their start, orientations any rotation; about z, where
/// a scene integrates less than the whole matrix.
#[must_use]
pub fn state(model: &dyn Machine, draw: &mut Draw) -> Vec<f64> {
    let mut x = model.start().expect("the mechanism closes");
    let mut index = 0;
    for of_one in model.description().states.chunk_by(is_of_one_rotation) {
        let rotation = if of_one.len() == 9 { draw.rotation() } else { draw.turn() };
        for state in of_one {
            match state.kind {
                StateKind::Orientation(row, column) => x[index] = rotation[3 * row + column],
                _ => x[index] += (1.0 + x[index].abs()) * draw.number(),
            }
            index += 1;
        }
    }
    x
}

/// |d(stored)/dt - supplied + dissipated| at time `t` and state `x`, divided by the sum of the magnitudes of all powers
/// into single states: what rounding leaves of a balance that holds.
///
/// The rate of the energy is a sum of exact derivatives: one pass with dual numbers for each state, and one for the
/// time.
#[must_use]
pub fn imbalance(model: &dyn Machine, twin: &dyn Twin, t: f64, x: &[f64]) -> f64 {
    let mut guards = vec![0.0; model.switches()];
    model.guards(t, x, &vec![false; model.switches()], &mut guards);
    let negative: Vec<bool> = guards.iter().map(|&guard| guard < 0.0).collect();
    let mut rate = vec![0.0; x.len()];
    model.rate(t, x, &negative, &mut rate);
    let Powers { supplied, dissipated } = model.powers(t, x, &negative);
    let along = |index: Option<usize>| {
        let slope = |k: usize| if Some(k) == index { 1.0 } else { 0.0 };
        let seeded: Vec<Dual> = x.iter().enumerate().map(|(k, &x)| Dual::new(x, slope(k))).collect();
        let time = Dual::new(t, if index.is_none() { 1.0 } else { 0.0 });
        twin.stored_energy(time, &seeded, &negative).slope * index.map_or(1.0, |k| rate[k])
    };
    let parts: Vec<f64> = (0..x.len()).map(Some).chain([None]).map(along).collect();
    let change: f64 = parts.iter().sum();
    let scale = parts.iter().map(|part| part.abs()).sum::<f64>() + supplied.abs() + dissipated.abs();
    if scale == 0.0 { 0.0 } else { (change - supplied + dissipated).abs() / scale }
}
