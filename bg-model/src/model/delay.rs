//! Delays: signals of a while ago, as polynomials among the states.
//!
//! In: a system's clocks with the states of its delays. Out: which delays there are. A delayed signal is a polynomial
//! in the place in a window of time, -1 at its start, 1 at its end, which is not longer than the delay: there the
//! signal of a while ago is known. The coefficients and both times are states of rate 0, so a rate depends on time and
//! state only; a run writes them, window by window.

use alloc::vec::Vec;

use crate::model::clock::Clock;
use crate::model::scalar::Scalar;

/// Where the states of the delays by one time are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct States {
    /// The index of its clock among those of the system; its period is the time of the delay.
    pub clock: usize,
    /// The times from which and until which the polynomials hold, s.
    pub window: [usize; 2],
    /// The delayed signals.
    pub signals: &'static [Signal],
}

/// Where a delayed signal is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signal {
    /// The coefficients of its polynomial, in the signal's unit, from that of power 0 on. A projection in the negative
    /// branch of the clock's switch reads the signal, as it is now, into the first one.
    pub coefficients: &'static [usize],
    /// Whether what the signal was before the start is given; else it is what it is at the start.
    pub is_given: bool,
}

/// The delays by one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Delay<S = f64> {
    /// The switch in whose negative branch a projection reads the signals.
    pub switch: usize,
    /// How long it is, s, above 0.
    pub time: S,
    /// Its states.
    pub states: States,
}

/// The delays among `clocks`.
#[must_use]
pub fn listed<S: Scalar>(clocks: &[Clock<S>], delays: &[States]) -> Vec<Delay<S>> {
    let of =
        |&states: &States| Delay { switch: clocks[states.clock].switch, time: clocks[states.clock].period, states };
    delays.iter().map(of).collect()
}

/// The other clocks.
#[must_use]
pub fn without<S: Scalar>(clocks: Vec<Clock<S>>, delays: &[States]) -> Vec<Clock<S>> {
    let is_other = |(index, _): &(usize, Clock<S>)| delays.iter().all(|delay| delay.clock != *index);
    clocks.into_iter().enumerate().filter(is_other).map(|(_, clock)| clock).collect()
}
