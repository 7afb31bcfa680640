//! Whether the reactions of rigid joints keep unique values in a run.
//!
//! In: the ends of accepted steps, states between them. Out: the joints that have come to hold the same motion, at the
//! end of a step or inside it. A mechanism in a singular pose, such as a parallelogram that lies flat, is there for an
//! instant only, and steps pass over it: what one row of the constraints has beyond those before it then goes through
//! zero and comes out on the other side.

use nalgebra::SVector;

use super::factors::Factors;
use super::{Held, Hold, Redundancy};
use crate::model::capability::Joints;

/// The cosine down to which a row may turn without being looked at more closely: a third of a half turn.
const TURNED: f64 = 0.5;

/// A row that turns by more than that within this part of a step has jumped. The states in between are not exact, so that
/// a row on its way through zero passes it aside, by far less than this part.
const JUMP: f64 = 1.0 / 256.0;

/// What has been seen of the constraints so far.
pub(crate) struct Independence {
    hold: Hold<f64>,
    factors: Factors<f64>,
    /// What each row has beyond those before it at the start of the step, in terms of the moved states; row after row.
    before: Vec<f64>,
    /// The same at its end.
    after: Vec<f64>,
    /// The same in between.
    between: Vec<f64>,
    /// One row of it.
    here: Vec<f64>,
}

impl Independence {
    /// Room for what is held; nothing where no rigid joint holds anything.
    pub fn new(held: Held) -> Option<Self> {
        let (n, width) = (held.rigid.len(), held.moved.len());
        let [before, after, between] = [(); 3].map(|()| vec![0.0; n * width]);
        let here = vec![0.0; width];
        (n > 0).then(|| Self { hold: Hold::new(held), factors: Factors::new(n), before, after, between, here })
    }

    /// Looks at the start of a run. Allocates only where something is wrong, as [`Independence::check`].
    pub fn begin<J, const N: usize, const G: usize>(
        &mut self,
        joints: &J,
        (t, x): (f64, &SVector<f64, N>),
        negative: &[bool; G],
    ) -> Option<Redundancy>
    where
        J: Joints<f64, N, G>,
    {
        let Self { hold, factors, before, .. } = self;
        look(joints, (t, x), negative, hold, factors, before);
        factors.redundancy(hold.held.rigid)
    }

    /// Looks at a step that ends at time `t` (s) and state `x`; `inside` gives time and state after a part of it. Gives
    /// the time (s), too.
    pub fn check<J, const N: usize, const G: usize>(
        &mut self,
        joints: &J,
        (t, x): (f64, &SVector<f64, N>),
        negative: &[bool; G],
        mut inside: impl FnMut(f64) -> (f64, SVector<f64, N>),
    ) -> Option<(f64, Redundancy)>
    where
        J: Joints<f64, N, G>,
    {
        let Self { hold, factors, before, after, between, here } = self;
        let rigid = hold.held.rigid;
        look(joints, (t, x), negative, hold, factors, after);
        if let Some(redundancy) = factors.redundancy(rigid) {
            return Some((t, redundancy));
        }
        let width = hold.held.moved.len();
        for row in 0..rigid.len() {
            let own = row * width..(row + 1) * width;
            if !has_turned(&before[own.clone()], &after[own.clone()]) {
                continue;
            }
            // Goes along the step in parts over which the row does not turn far.
            let (mut from, mut part) = (0.0_f64, 0.5);
            here.copy_from_slice(&before[own.clone()]);
            while from < 1.0 {
                let to = (from + part).min(1.0);
                let (t, x) = inside(to);
                look(joints, (t, &x), negative, hold, factors, between);
                if !has_turned(here, &between[own.clone()]) {
                    here.copy_from_slice(&between[own.clone()]);
                    (from, part) = (to, 2.0 * part);
                } else if part <= JUMP {
                    return Some((t, factors.shared(rigid, &[row])));
                } else {
                    part *= 0.5;
                }
            }
        }
        std::mem::swap(before, after);
        None
    }
}

/// Whether the directions of a row are far apart.
fn has_turned(from: &[f64], to: &[f64]) -> bool {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    dot(from, to) < TURNED * (dot(from, from) * dot(to, to)).sqrt()
}

/// Reads what is held at a state: the factors, and what each row has beyond those before it.
fn look<J, const N: usize, const G: usize>(
    joints: &J,
    (t, x): (f64, &SVector<f64, N>),
    negative: &[bool; G],
    hold: &mut Hold<f64>,
    factors: &mut Factors<f64>,
    remainders: &mut [f64],
) where
    J: Joints<f64, N, G>,
{
    hold.read(joints, t, x, negative);
    factors.factor(hold.matrix());
    let width = hold.held.moved.len();
    for row in 0..hold.held.rigid.len() {
        let (above, rest) = remainders.split_at_mut(row * width);
        let own = &mut rest[..width];
        own.copy_from_slice(hold.moves(row));
        for (other, beyond) in above.chunks_exact(width.max(1)).enumerate() {
            let part = factors.lower(row, other);
            own.iter_mut().zip(beyond).for_each(|(own, beyond)| *own -= part * beyond);
        }
    }
}
