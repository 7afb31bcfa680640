//! The past of the signals that a system delays, and the windows of time in which it knows them.
//!
//! In: the accepted steps of a run. Out: the states of its delays for the next window. Method of steps: a window is not
//! longer than the shortest delay, so all that is asked for has been. Of each step the signals are kept as polynomials,
//! of parts of the step where one of them is too coarse. In a window a delayed signal is one polynomial through its
//! past, as exact as the tolerances ask; the window is shortened to that. It ends where the signal had a kink or a jump
//! the delay before, so that steps end there: such an instant comes again after each delay, one derivative higher each
//! time.

use alloc::collections::VecDeque;
use alloc::vec;
use alloc::vec::Vec;
use core::f64::consts::PI;

use crate::model::clock;
use crate::model::delay::{Delay, Signal};
use crate::model::delayed;
use crate::solve::stepper::{Stepper, rounded_otherwise};

/// How much of the tolerance a polynomial of a step may err by, and one of a window.
const OF_STEP: f64 = 0.05;
const OF_WINDOW: f64 = 0.5;
/// By how many times what rounding does to a signal a polynomial may err.
const ROUNDING: f64 = 16.0;
/// How often a step is halved at most for its polynomials.
const HALVINGS: u32 = 6;
/// The order of the derivative whose jump no method's error shows.
const SMOOTH: u8 = 9;
const LOOKS: usize = 6;
/// Where polynomials are held against the signal: places in them.
const LOOKED_AT: [f64; LOOKS] = [-0.98, -0.71, -0.23, 0.31, 0.64, 0.97];

/// The past of all delayed signals.
#[derive(Clone, Debug)]
pub(crate) struct History {
    delays: Vec<Delay>,
    pasts: Vec<Past>,
    /// Places in a polynomial at which it is what its signal is: as many as a delayed signal has coefficients.
    nodes: Vec<f64>,
    relative: f64,
    /// Until when the delayed signals are known, s; none before the start.
    until: Option<f64>,
    /// The order of the derivative that jumps where the next step starts, if one does.
    jump: Option<u8>,
    /// The same where the window ends.
    jump_at_end: Option<u8>,
}

/// The past of a delayed signal.
#[derive(Clone, Debug)]
struct Past {
    /// By how much it is delayed, s.
    time: f64,
    coefficients: &'static [usize],
    /// Where the run starts, s, and what it was before.
    start: f64,
    before: f64,
    pieces: VecDeque<Piece>,
    /// The largest absolute value so far.
    largest: f64,
    /// What rounding of the states changes of it.
    noise: f64,
}

/// A polynomial of a signal over a part of a step.
#[derive(Clone, Debug)]
struct Piece {
    from: f64,
    until: f64,
    /// The order of the derivative that jumps at its start.
    jump: Option<u8>,
    coefficients: Vec<f64>,
}

impl History {
    /// Nothing yet, of signals with these delays; none where there is none.
    pub fn of(delays: Vec<Delay>, relative: f64) -> Option<Self> {
        let past = |time: f64, Signal { coefficients, .. }: &Signal| Past {
            time,
            coefficients,
            start: 0.0,
            before: 0.0,
            pieces: VecDeque::new(),
            largest: 0.0,
            noise: 0.0,
        };
        let of_delay = |delay: &Delay| {
            let time = delay.time;
            delay.states.signals.iter().map(move |signal| past(time, signal))
        };
        let pasts: Vec<Past> = delays.iter().flat_map(of_delay).collect();
        let count = pasts.first()?.coefficients.len();
        debug_assert!(pasts.iter().all(|past| past.coefficients.len() == count), "the compiler has one degree for all");
        let nodes = nodes(count);
        Some(Self { delays, pasts, nodes, relative, until: None, jump: Some(0), jump_at_end: None })
    }

    /// The past of a run that starts at `t` (s) in state `x`, which has what the signals were before; one that goes on
    /// has an instant at which something may have jumped.
    pub fn begin(&mut self, t: f64, x: &[f64]) {
        self.jump = Some(0);
        if self.until.is_some() {
            return;
        }
        for past in &mut self.pasts {
            (past.start, past.before) = (t, x[past.coefficients[0]]);
            past.largest = past.before.abs();
        }
    }

    /// Until when the signals are known, s.
    pub fn until(&self) -> f64 {
        self.until.unwrap_or(f64::INFINITY)
    }

    /// Whether a window is to be opened at `t` (s).
    pub fn is_over(&self, t: f64) -> bool {
        self.until.is_none_or(|until| t >= until - clock::rounding(until))
    }

    /// Something jumps where the next step starts.
    pub const fn jumps(&mut self) {
        self.jump = Some(0);
    }

    /// Keeps the signals during the step that has been made; states inside of it are projected so often at most.
    pub fn record(&mut self, stepper: &mut Stepper<'_>, projections: usize) {
        let Self { delays, pasts, nodes, relative, .. } = self;
        let places = pasts.iter().map(|past| past.coefficients[0]).collect();
        let mut reader = Reader { state: vec![0.0; stepper.start.x.len()], stepper, delays, places, projections };
        let exact = reader.values(1.0);
        let otherwise = reader.otherwise();
        for ((past, exact), otherwise) in pasts.iter_mut().zip(exact).zip(otherwise) {
            past.noise = (exact - otherwise).abs();
            past.largest = past.largest.max(exact.abs());
        }
        let mut jump = self.jump.take();
        // Parts of the step from the first on: their ends, and how often they can be halved.
        let mut parts = vec![([0.0, 1.0], HALVINGS)];
        while let Some((ends, halvings)) = parts.pop() {
            let values: Vec<Vec<f64>> = reader.at(ends, nodes);
            let looked_at = reader.at(ends, &LOOKED_AT);
            let of_signal = |k: usize| values.iter().map(|values| values[k]).collect::<Vec<f64>>();
            let found: Vec<Vec<f64>> = (0..pasts.len()).map(|k| polynomial(&of_signal(k))).collect();
            let is_close = pasts.iter().zip(&found).enumerate().all(|(k, (past, of))| {
                let error = LOOKED_AT.iter().zip(&looked_at).map(|(&at, values)| (evaluated(of, at) - values[k]).abs());
                largest(error) <= past.allowed(OF_STEP * *relative)
            });
            if !is_close && halvings > 0 {
                let [from, until] = ends;
                let middle = 0.5 * (from + until);
                parts.extend([([middle, until], halvings - 1), ([from, middle], halvings - 1)]);
                continue;
            }
            let [from, until] = ends.map(|part| reader.time(part));
            for (past, coefficients) in pasts.iter_mut().zip(found) {
                past.pieces.push_back(Piece { from, until, jump, coefficients });
            }
            jump = None;
        }
    }

    /// Opens a window at `t` (s), which the steps have led to: writes the states of the delays.
    pub fn open(&mut self, t: f64, x: &mut [f64]) {
        let mut window = self.delays.iter().map(|delay| delay.time).fold(f64::INFINITY, f64::min);
        for past in &mut self.pasts {
            past.forget(t - past.time);
            window = window.min(past.to_jump(t));
        }
        let relative = OF_WINDOW * self.relative;
        let polynomials = loop {
            let found: Vec<_> = self.pasts.iter().map(|past| past.over(t - past.time, window, &self.nodes)).collect();
            let shorter = |(past, of): (&Past, &Vec<f64>)| past.shorter(t - past.time, window, of, relative);
            match self.pasts.iter().zip(&found).find_map(shorter) {
                Some(shorter) => window = shorter,
                None => break found,
            }
        };
        let end = t + window;
        let jumps = self.pasts.iter().filter_map(|past| past.jump_at(end)).min();
        self.jump = [self.jump, self.jump_at_end.take()].into_iter().flatten().min();
        self.jump_at_end = jumps.map(|order| order + 1).filter(|order| *order < SMOOTH);
        self.until = Some(end);
        for Delay { states, .. } in &self.delays {
            (x[states.window[0]], x[states.window[1]]) = (t, end);
        }
        for (past, polynomial) in self.pasts.iter().zip(polynomials) {
            past.coefficients.iter().zip(polynomial).for_each(|(&place, coefficient)| x[place] = coefficient);
        }
    }
}

impl Past {
    /// By how much a polynomial may err at this part of the largest value.
    fn allowed(&self, relative: f64) -> f64 {
        let rounding = ROUNDING * (self.noise + f64::EPSILON * self.largest);
        rounding.max(relative * self.largest)
    }

    /// Two times before `t` (s) plus the delay that are this close are one.
    fn rounding(&self, t: f64) -> f64 {
        4.0 * clock::rounding(t.abs() + self.time)
    }

    /// What nothing asks for after `t` (s), which has been, is no longer kept.
    fn forget(&mut self, t: f64) {
        while self.pieces.front().is_some_and(|piece| piece.until < t - self.rounding(t)) {
            self.pieces.pop_front();
        }
    }

    /// How long it is from `t` (s) to where a jump comes again, s; infinity where none is kept.
    fn to_jump(&self, t: f64) -> f64 {
        let now = t - self.time;
        let ahead = self.jumps().map(|(jump, _)| jump - now);
        ahead.filter(|ahead| *ahead > self.rounding(now)).fold(f64::INFINITY, f64::min)
    }

    /// The order of the derivative that jumps the delay before `t` (s).
    fn jump_at(&self, t: f64) -> Option<u8> {
        let then = t - self.time;
        self.jumps().find(|(jump, _)| (jump - then).abs() <= self.rounding(then)).map(|(_, order)| order)
    }

    /// Where its derivatives jump, s, and the order of the first that does.
    fn jumps(&self) -> impl Iterator<Item = (f64, u8)> {
        let of_pieces = self.pieces.iter().filter_map(|piece| Some((piece.from, piece.jump?)));
        core::iter::once((self.start, 0)).chain(of_pieces)
    }

    /// The value at `t` (s), of the time before it where there are two.
    fn value(&self, t: f64) -> f64 {
        let first = self.pieces.partition_point(|piece| piece.until < t);
        let piece = self.pieces.get(first).or(self.pieces.back()).filter(|_| t >= self.start);
        let Some(piece) = piece else { return self.before };
        let part = (t - piece.from) / (piece.until - piece.from);
        evaluated(&piece.coefficients, 2.0 * part - 1.0)
    }

    /// The polynomial through `nodes` over `window` (s) from `from` (s) on.
    fn over(&self, from: f64, window: f64, nodes: &[f64]) -> Vec<f64> {
        let inside = self.inside(from, window);
        polynomial(&nodes.iter().map(|&node| self.value(inside(node))).collect::<Vec<f64>>())
    }

    /// Times in a window that rounding leaves in it.
    fn inside(&self, from: f64, window: f64) -> impl Fn(f64) -> f64 {
        let (within, rounding) = (0.5 * window, self.rounding(from).min(1e-3 * window));
        move |place: f64| from + rounding + (within - rounding) * (1.0 + place)
    }

    /// A shorter window than this one, for its polynomial to be as exact as is asked for; none where it is.
    fn shorter(&self, from: f64, window: f64, of: &[f64], relative: f64) -> Option<f64> {
        let inside = self.inside(from, window);
        let errors = LOOKED_AT.iter().map(|&place| (evaluated(of, place) - self.value(inside(place))).abs());
        if largest(errors) <= self.allowed(relative) {
            return None;
        }
        // One piece is a polynomial.
        let piece = self.pieces.iter().find(|piece| piece.until > from + self.rounding(from))?;
        let rest = piece.until - from;
        (rest < window * (1.0 - 1e-9)).then(|| rest.max(0.5 * window))
    }
}

/// Reads signals during a step.
struct Reader<'a, 'b> {
    stepper: &'a mut Stepper<'b>,
    delays: &'a [Delay],
    /// The states that they are read into.
    places: Vec<usize>,
    projections: usize,
    state: Vec<f64>,
}

impl Reader<'_, '_> {
    /// The time at this part of the step, s.
    fn time(&self, part: f64) -> f64 {
        match part {
            1.0 => self.stepper.end.t,
            _ => self.stepper.start.t + part * self.stepper.h,
        }
    }

    /// The signals at places between two parts of the step.
    fn at(&mut self, [from, until]: [f64; 2], places: &[f64]) -> Vec<Vec<f64>> {
        let part = |place: f64| match place {
            -1.0 => from,
            1.0 => until,
            _ => from + 0.5 * (until - from) * (1.0 + place),
        };
        places.iter().map(|&place| self.values(part(place))).collect()
    }

    /// The signals at this part of the step.
    fn values(&mut self, part: f64) -> Vec<f64> {
        let t = self.time(part);
        let Self { stepper, state, .. } = self;
        match part {
            0.0 => state.copy_from_slice(stepper.start.x.as_slice()),
            1.0 => state.copy_from_slice(stepper.end.x.as_slice()),
            _ => stepper.projected_sample(part, t, self.projections, state),
        }
        self.read(t)
    }

    /// Those at the end of the step, with the states rounded otherwise.
    fn otherwise(&mut self) -> Vec<f64> {
        self.state.copy_from_slice(rounded_otherwise(&self.stepper.end.x).as_slice());
        self.read(self.stepper.end.t)
    }

    fn read(&mut self, t: f64) -> Vec<f64> {
        delayed::read(self.stepper.system, self.delays, t, &self.stepper.negative, &mut self.state);
        self.places.iter().map(|&place| self.state[place]).collect()
    }
}

fn largest(of: impl Iterator<Item = f64>) -> f64 {
    of.fold(0.0, |largest, value| if value <= largest { largest } else { value })
}

/// The polynomial with these coefficients, from that of power 0 on.
fn evaluated(coefficients: &[f64], at: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, coefficient| coefficient + at * sum)
}

/// The polynomial through values at [`nodes`], from the coefficient of power 0 on: that in Chebyshev's polynomials by a
/// cosine transform, whose terms fall off, then in powers. Source: Trefethen, Approximation Theory and Approximation
/// Practice, chapter 3.
fn polynomial(values: &[f64]) -> Vec<f64> {
    let degree = values.len() - 1;
    let n = degree as f64;
    let half = |k: usize| if k == 0 || k == degree { 0.5 } else { 1.0 };
    let of_chebyshev = |k: usize| {
        let term = |(j, value): (usize, &f64)| half(j) * value * libm::cos(PI * (j * k) as f64 / n);
        half(k) * 2.0 / n * values.iter().enumerate().map(term).sum::<f64>()
    };
    let mut powers = vec![0.0; values.len()];
    let mut add = |factor: f64, of: &[f64]| powers.iter_mut().zip(of).for_each(|(sum, value)| *sum += factor * value);
    // T of the last two degrees, in powers.
    let (mut before, mut now) = (vec![0.0; values.len()], vec![0.0; values.len()]);
    (before[0], now[1]) = (1.0, 1.0);
    add(of_chebyshev(0), &before);
    for k in 1..=degree {
        add(of_chebyshev(k), &now);
        let mut next: Vec<f64> = before.iter().map(|value| -value).collect();
        for power in 1..=degree {
            next[power] += 2.0 * now[power - 1];
        }
        (before, now) = (now, next);
    }
    powers
}

/// The places at which a polynomial of so many coefficients is known, from 1 to -1: the extrema of Chebyshev's
/// polynomial.
fn nodes(count: usize) -> Vec<f64> {
    let degree = count - 1;
    let place = |j: usize| match j {
        0 => 1.0,
        _ if j == degree => -1.0,
        _ => libm::cos(PI * j as f64 / degree as f64),
    };
    (0..count).map(place).collect()
}
