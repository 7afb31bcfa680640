//! Guards of runs side by side: in which of them nothing happens in a step, beyond doubt.
//!
//! In: steps side by side. Out: the readings at their ends and in the middle, and the places at which all guards keep
//! to their sides as [`EventMonitor::inspect`](super::EventMonitor::inspect) finds without a closer look.

use super::AHEAD;
use super::detect::{FAR, enclosing};
use crate::model::scalar::Scalar;
use crate::model::scalar::lanes::{Lanes, Vector};
use crate::solve::integrator::{Side, between};

/// Guards, and their derivatives along the flow (per s), at both ends of steps.
#[derive(Clone, Debug)]
pub(crate) struct Readings<V> {
    /// At the start.
    pub start: [Vec<Lanes<V>>; 2],
    /// At the end.
    pub end: [Vec<Lanes<V>>; 2],
    /// The guards in the middle.
    pub middle: Vec<Lanes<V>>,
    /// A state close behind the end, and one in the middle.
    states: [Vec<Lanes<V>>; 2],
}

/// Steps: their starts, sizes (s), states and rates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Steps<'a, V> {
    /// Times at the start, s.
    pub t: Lanes<V>,
    /// Sizes, s.
    pub h: Lanes<V>,
    /// Times at the end, s.
    pub t_end: Lanes<V>,
    /// States at both ends.
    pub x: [&'a [Lanes<V>]; 2],
    /// Rates at both ends.
    pub rate: [&'a [Lanes<V>]; 2],
}

impl<V: Vector> Readings<V> {
    /// Nothing read; room for so many switches and states.
    pub fn new(switches: usize, states: usize) -> Self {
        let none = || vec![Lanes::from_f64(0.0); switches];
        let room = || vec![Lanes::from_f64(0.0); states];
        Self { start: [none(), none()], end: [none(), none()], middle: none(), states: [room(), room()] }
    }

    /// Reads the guards in steps; gives the places at which they are clear.
    #[inline(always)]
    pub fn read(&mut self, side: Side<'_, V>, steps: &Steps<'_, V>) -> V::Mask {
        let Steps { t, h, t_end, x, rate } = *steps;
        let ahead = h.times(AHEAD);
        let [moved, middle] = &mut self.states;
        for i in 0..moved.len() {
            let (ends, rates) = ([x[0][i], x[1][i]], [rate[0][i], rate[1][i]]);
            moved[i] = ends[1] + rates[1] * ahead;
            middle[i] = between(h, 0.5, ends, rates);
        }
        let [end, slope] = &mut self.end;
        let Side { system, negative } = side;
        system.guards(t_end, x[1], negative, end);
        system.guards(t_end + ahead, moved, negative, slope);
        system.guards(t + h.times(0.5), middle, negative, &mut self.middle);
        let mut clear = u8::MAX;
        for (k, negative) in negative.iter().enumerate() {
            self.end[1][k] = (self.end[1][k] - self.end[0][k]) / ahead;
            clear &= V::bits(self.clear(*negative, k, h));
        }
        V::mask(clear)
    }

    /// Where guard `k` keeps to its side.
    #[inline(always)]
    fn clear(&self, negative: V::Mask, k: usize, h: Lanes<V>) -> V::Mask {
        let [from, leaving] = [clearance(self.start[0][k], negative), clearance(self.start[1][k], negative)];
        let [to, arriving] = [clearance(self.end[0][k], negative), clearance(self.end[1][k], negative)];
        let middle = clearance(self.middle[k], negative);
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

/// The clearance of a guard: positive on the side of its branch.
#[inline(always)]
fn clearance<V: Vector>(guard: Lanes<V>, negative: V::Mask) -> Lanes<V> {
    Lanes::select(negative, -guard, guard)
}
