//! Loops in closed form that come to their ends: poses in which links that follow may turn either way.
//!
//! In: the starts and ends of steps. Out: an end of the run in place of a wrong result. The pivot of such a loop is a
//! root, whose side a run keeps. Where nothing shows that it keeps away from zero the motion may pass a pose in which
//! it vanishes and should change its side; equations that keep it turn back there, or rest.

use alloc::vec;
use alloc::vec::Vec;

use crate::model::dynamics::Dynamics;

/// A pivot below this part of the largest so far is of a pose some 1e-4 rad from the end of its loop.
const NEAR: f64 = 1e-4;
/// The part of a step over which a slope is taken.
const AHEAD: f64 = 1e-5;
/// So many steps ahead of it an end is looked for: a step that ends just before it may err so much that it turns back.
const STEPS: f64 = 2.0;

/// What is looked at.
#[derive(Debug)]
pub(crate) struct EndMonitor {
    /// The joints that close the loops.
    joints: &'static [&'static str],
    /// The largest size of each pivot so far.
    largest: Vec<f64>,
    /// Room for pivots, at a point and a little later, and for a state.
    pivots: [Vec<f64>; 2],
    x: Vec<f64>,
}

impl EndMonitor {
    /// Room for what is looked at; none where no loop may come to its end.
    pub fn new(system: &dyn Dynamics) -> Option<Self> {
        let joints = system.turning();
        let room = || vec![0.0; joints.len()];
        (!joints.is_empty()).then(|| Self {
            joints,
            largest: room(),
            pivots: [room(), room()],
            x: vec![0.0; system.states()],
        })
    }

    /// The joint whose loop has come to its end at time `t` (s) and state `x`.
    pub fn reached(&mut self, system: &dyn Dynamics, (t, x): (f64, &[f64]), negative: &[bool]) -> Option<&'static str> {
        let Self { joints, largest, pivots: [now, _], .. } = self;
        system.pivots(t, x, negative, now);
        largest.iter_mut().zip(&*now).for_each(|(largest, now)| *largest = largest.max(now.abs()));
        let ended = now.iter().zip(&*largest).position(|(now, largest)| now.abs() < NEAR * largest);
        ended.map(|k| joints[k])
    }

    /// The joint whose loop seems to come to its end in a step of `h` (s) from time `t` (s), or soon after it: the
    /// tangent of its pivot leads through zero. That of one that only comes near does so no more in a shorter step.
    pub fn ahead(
        &mut self,
        system: &dyn Dynamics,
        (t, x, rate): (f64, &[f64], &[f64]),
        h: f64,
        negative: &[bool],
    ) -> Option<&'static str> {
        let Self { joints, pivots: [now, soon], x: there, .. } = self;
        let ahead = AHEAD * h;
        there.iter_mut().zip(x).zip(rate).for_each(|((there, x), rate)| *there = x + ahead * rate);
        system.pivots(t, x, negative, now);
        system.pivots(t + ahead, there, negative, soon);
        // What is no number soon leads through zero as well.
        let keeps_side = |(now, soon): (&f64, &f64)| now * (now + STEPS * (soon - now) / AHEAD) > 0.0;
        now.iter().zip(&*soon).position(|pivot| !keeps_side(pivot)).map(|k| joints[k])
    }
}
