//! Guards of runs side by side: in which of them nothing happens in a step, beyond doubt.
//!
//! In: steps side by side. Out: the readings at their ends and in the middle, and the places at which all guards keep
//! to their sides as [`EventMonitor::inspect`](super::EventMonitor::inspect) finds without a closer look.

use nalgebra::SVector;

use super::AHEAD;
use super::detect::{FAR, enclosing};
use crate::model::scalar::Scalar;
use crate::model::scalar::lanes::{Lanes, Vector};
use crate::model::system::System;
use crate::solve::integrator::{Side, between};

/// Values of all guards, side by side.
type Guards<V, const G: usize> = SVector<Lanes<V>, G>;

/// Guards, and their derivatives along the flow (per s), at both ends of steps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Readings<V, const G: usize> {
    /// At the start.
    pub start: [Guards<V, G>; 2],
    /// At the end.
    pub end: [Guards<V, G>; 2],
    /// The guards in the middle.
    pub middle: Guards<V, G>,
}

/// Steps: their starts, sizes (s), states and rates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Steps<'a, V, const N: usize> {
    /// Times at the start, s.
    pub t: Lanes<V>,
    /// Sizes, s.
    pub h: Lanes<V>,
    /// Times at the end, s.
    pub t_end: Lanes<V>,
    /// States at both ends.
    pub x: [&'a SVector<Lanes<V>, N>; 2],
    /// Rates at both ends.
    pub rate: [&'a SVector<Lanes<V>, N>; 2],
}

impl<V: Vector, const G: usize> Readings<V, G> {
    /// Nothing read.
    pub fn new() -> Self {
        let none = SVector::from([Lanes::from_f64(0.0); G]);
        Self { start: [none; 2], end: [none; 2], middle: none }
    }

    /// Reads the guards in steps; gives the places at which they are clear.
    #[inline(always)]
    pub fn read<Sys, const N: usize>(&mut self, side: &Side<'_, Sys, V, N, G>, steps: &Steps<'_, V, N>) -> V::Mask
    where
        Sys: System<Lanes<V>, N, G>,
    {
        let Steps { t, h, t_end, x, rate } = *steps;
        let ahead = h.times(AHEAD);
        let (mut moved, mut middle) = (*x[1], *x[1]);
        for i in 0..N {
            let ends = [x[0].data.0[0][i], x[1].data.0[0][i]];
            let rates = [rate[0].data.0[0][i], rate[1].data.0[0][i]];
            moved.data.0[0][i] = ends[1] + rates[1] * ahead;
            middle.data.0[0][i] = between(h, 0.5, ends, rates);
        }
        let mut slope = self.middle;
        side.system.guards(t_end, x[1], side.negative, &mut self.end[0]);
        side.system.guards(t_end + ahead, &moved, side.negative, &mut slope);
        side.system.guards(t + h.times(0.5), &middle, side.negative, &mut self.middle);
        let mut clear = u8::MAX;
        for k in 0..G {
            self.end[1].data.0[0][k] = (slope.data.0[0][k] - self.end[0].data.0[0][k]) / ahead;
            clear &= V::bits(self.clear(side.negative[k], k, h));
        }
        V::mask(clear)
    }

    /// Where guard `k` keeps to its side.
    #[inline(always)]
    fn clear(&self, negative: V::Mask, k: usize, h: Lanes<V>) -> V::Mask {
        let [from, leaving] = [clearance(&self.start[0], k, negative), clearance(&self.start[1], k, negative)];
        let [to, arriving] = [clearance(&self.end[0], k, negative), clearance(&self.end[1], k, negative)];
        let middle = clearance(&self.middle, k, negative);
        let (mut low, mut high) = (h.alike(f64::INFINITY), h.alike(f64::NEG_INFINITY));
        for coefficient in &enclosing([from, to], middle, [h * leaving, h * arriving]) {
            low = Lanes::select(V::below(coefficient.0, low.0), *coefficient, low);
            high = high.larger(*coefficient);
        }
        let is_far = V::below((high - low).times(FAR).0, low.0);
        let is_finite = V::below(to.abs().0, h.alike(f64::INFINITY).0);
        V::mask(V::bits(is_far) & V::bits(is_finite))
    }
}

/// The clearance of guard `k`: positive on the side of its branch.
#[inline(always)]
fn clearance<V: Vector, const G: usize>(of: &Guards<V, G>, k: usize, negative: V::Mask) -> Lanes<V> {
    Lanes::select(negative, -of.data.0[0][k], of.data.0[0][k])
}
