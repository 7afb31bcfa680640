//! Rigid joints that hold the same motion: which rows take no part, and how the reactions are shared.
//!
//! In: a system whose joints close loops ([`Held::closing`]). Out: for each of these rows whether it follows from the
//! others in all poses, as one of two hinges of a door does; reactions of least norm; the joints by name.
//!
//! Rows follow from others in a singular pose, too, such as that of a parallelogram that lies flat; there they do for
//! an instant only. So what follows at the start has to follow in poses near it as well: the mechanism is moved a
//! little, with velocities that its joints allow, and closed again.

use alloc::vec;
use alloc::vec::Vec;

use super::factors::Factors;
use super::{Hold, at_start, dropped};
use crate::model::dynamics::{Dynamics, branches};
use crate::model::holding::{Held, Redundancy};
use crate::model::scalar::Scalar;

/// How far a mechanism is moved, rad; m where nothing turns, since all that joints hold is linear there.
const FAR: f64 = 1e-3;
/// Velocities that are smaller beside those without joints are rounding, of what turns and of what moves straight
/// each: nothing can move.
const STILL: f64 = 1e-9;
/// How often gaps are closed after a move; each time squares what is left.
const CLOSINGS: usize = 6;

/// For each number of [`Held::closing`] 1 where its row takes part, 0 where it follows from the others; all 1 without a
/// pose. Allocates.
pub(crate) fn kept(system: &dyn Dynamics, pose: Option<Vec<f64>>) -> Vec<f64> {
    let held = system.held().unwrap_or(Held::NOTHING);
    let numbers = held.closing.iter().map(|&(_, number)| number + 1).max();
    let mut kept = vec![1.0; numbers.unwrap_or(0)];
    let Some(pose) = pose else { return kept };
    let start = Start { system, held, negative: branches(system, 0.0, &pose), pose };
    let mut following = start.following(&start.pose);
    for seed in [1, 2] {
        let Some(near) = following.contains(&true).then(|| start.moved(seed)).flatten() else { break };
        let there = start.following(&near);
        following.iter_mut().zip(there).for_each(|(follows, there)| *follows &= there);
    }
    for &(row, number) in start.held.closing {
        kept[number] = f64::from(u8::from(!following[row]));
    }
    kept
}

/// A system in its start pose.
struct Start<'a> {
    system: &'a dyn Dynamics,
    held: Held,
    negative: Vec<bool>,
    pose: Vec<f64>,
}

impl Start<'_> {
    fn hold(&self, x: &[f64]) -> Hold<f64> {
        let mut hold = Hold::new(self.held);
        hold.read(self.system, 0.0, x, &self.negative);
        hold
    }

    /// The rows that follow from those before them.
    fn following(&self, x: &[f64]) -> Vec<bool> {
        let factors = Factors::of(self.hold(x).matrix());
        (0..self.held.rigid.len()).map(|row| factors.follows(row)).collect()
    }

    /// The pose a little further along a motion that the joints allow; none where nothing can move.
    fn moved(&self, seed: u64) -> Option<Vec<f64>> {
        let Held { pose, turning, .. } = self.held;
        let pushed = self.pushed(seed);
        let free = self.velocities(&pushed);
        let allowed = self.velocities(&self.fitted(pushed));
        let fastest = |is_turning: bool| {
            let states = pose.iter().filter(|&state| turning.contains(state) == is_turning);
            let [free, allowed] = states.fold([0.0_f64; 2], |[free_so_far, allowed_so_far], &state| {
                [free_so_far.max(free[state].abs()), allowed_so_far.max(allowed[state].abs())]
            });
            (allowed > STILL * free).then_some(allowed)
        };
        let fastest = fastest(true).or_else(|| fastest(false))?;
        let part = FAR / fastest;
        let mut near: Vec<f64> = self.pose.iter().zip(&allowed).map(|(x, allowed)| x + allowed * part).collect();
        for _ in 0..CLOSINGS {
            self.system.project(0.0, &self.negative, &mut near);
        }
        Some(near)
    }

    /// The state with momenta that point anywhere.
    fn pushed(&self, seed: u64) -> Vec<f64> {
        let mut pushed = self.pose.clone();
        let mut number = seed;
        for &state in self.held.moved {
            // The generator MMIX of Knuth, The Art of Computer Programming, vol. 2, 3.3.4.
            number = number.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            pushed[state] = (number >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
        }
        pushed
    }

    /// The state after the impulses of the joints.
    fn fitted(&self, x: Vec<f64>) -> Vec<f64> {
        let hold = self.hold(&x);
        let impulses = Factors::of(hold.matrix()).solved(&hold.flows()[..self.held.rigid.len()]);
        hold.struck(x, &impulses)
    }

    /// How the pose changes by the momenta of `pushed`, beyond what changes at rest.
    fn velocities(&self, pushed: &[f64]) -> Vec<f64> {
        let mut still = self.pose.clone();
        self.held.moved.iter().for_each(|&state| still[state] = 0.0);
        let mut velocities = vec![0.0; still.len()];
        let [mut with, mut without] = [velocities.clone(), velocities.clone()];
        self.system.rate(0.0, pushed, &self.negative, &mut with);
        self.system.rate(0.0, &still, &self.negative, &mut without);
        self.held.pose.iter().for_each(|&state| velocities[state] = with[state] - without[state]);
        velocities
    }
}

/// Makes `reactions`, zero for the rows that take no part, those of least norm: joints that hold the same motion share
/// what it takes. Those of dry friction, after them, stay. N and N m count alike. Allocates where rows take no part.
pub(crate) fn share<S: Scalar>(joints: &dyn Dynamics<S>, t: S, x: &[S], negative: &[S::Switch], reactions: &mut [S]) {
    if !joints.kept().contains(&0.0) {
        return;
    }
    let mut hold = Hold::new(joints.held().unwrap_or(Held::NOTHING));
    hold.read(joints, t, x, negative);
    let factors = Factors::without(hold.matrix(), &dropped(joints));
    let reactions = &mut reactions[..hold.held.rigid.len()];
    let rows = (0..reactions.len()).filter(|&row| factors.follows(row));
    let mut basis: Vec<Vec<S>> = Vec::new();
    for row in rows {
        let mut vector = factors.null_vector(row);
        basis.iter().for_each(|other| take(&mut vector, other));
        let length = dot(&vector, &vector).sqrt();
        vector.iter_mut().for_each(|part| *part = *part / length);
        basis.push(vector);
    }
    basis.iter().for_each(|vector| take(reactions, vector));
}

/// Takes away the part along a vector of length 1.
fn take<S: Scalar>(from: &mut [S], along: &[S]) {
    let part = dot(from, along);
    from.iter_mut().zip(along).for_each(|(value, &along)| *value = *value - part * along);
}

fn dot<S: Scalar>(a: &[S], b: &[S]) -> S {
    a.iter().zip(b).fold(S::from_f64(0.0), |sum, (&a, &b)| sum + a * b)
}

/// The joints that hold what others hold already, in all poses; `x` is one of them. Allocates.
pub(crate) fn redundant<S: Scalar>(system: &dyn Dynamics<S>, x: &[S]) -> Vec<Redundancy> {
    let (held, dropped) = (system.held().unwrap_or(Held::NOTHING), dropped(system));
    let mut hold = Hold::new(held);
    hold.read(system, S::from_f64(0.0), x, &at_start(system, x));
    let factors = Factors::without(hold.matrix(), &dropped);
    let mut rows: Vec<usize> = (0..dropped.len()).filter(|&row| dropped[row]).collect();
    let mut found = Vec::new();
    while let Some(&first) = rows.first() {
        let joint = held.rigid[first].joint;
        let (own, others): (Vec<usize>, _) = rows.iter().partition(|&&row| held.rigid[row].joint == joint);
        rows = others;
        found.push(factors.shared(held.rigid, &own));
    }
    found
}
