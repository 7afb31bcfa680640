//! How large states have been: what the absolute part of an error norm is measured by, where no other is asked for.
//!
//! In: the start of a run and its accepted steps. Out: for each state an error that no longer counts. It is a part of
//! the largest value of the state so far; or, where that is more, a very small part of the size at which the state
//! would count beside the others, or what rounding of all states makes of it in a step. All scale with the units and
//! with the size of the machine, so that the steps depend on neither.
//!
//! - A momentum or displacement x counts beside sqrt(2 E / (d2E/dx2)), E the largest energy so far; at the start at
//!   least the work of the forces there over the machine's length, or over a radian.
//! - A component of an orientation and an angle count beside 1, a position beside the machine's length.
//! - An integral, a way and what has no second derivative count beside the way that their rate leads in the time so far
//!   where the storages are displaced by their sizes.
//! - In a system that does not know what it stores, states count beside the largest of them.
//!
//! Of a first step, and of one from rest, the sizes are those of a way ahead on which the rates change little.
//!
//! The sizes are looked at anew where a state has outgrown them, or a step that of rounding: the steps between have one
//! norm.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{DVector, SVector};

use super::rounding::is_exposed;
use crate::model::description::StateKind;
use crate::model::dynamics::{Dynamics, Typed, branches};
use crate::model::reactions::Moved;
use crate::model::scalar::double::worse;
use crate::model::system::System;
use crate::solve::integrator::{Absolute, Dop853, Point, Scale, Tolerances, displaced, rounding};
use crate::solve::stepper::Stepper;

/// The part of a state's largest value that its absolute tolerance is, over the relative one. A smaller one costs steps
/// where states pass zero and gives no smaller an error for the same time.
const OWN: f64 = 0.1;
/// The same part of its size beside the others.
const BESIDE: f64 = 1e-9;
/// The same part of the largest state, in a system that does not know what it stores.
const AMONG: f64 = 1e-6;
/// What rounding of the states may change the error of a step, in parts of the step times the change of the rate: the
/// error estimates of explicit methods are two to four of them, and the next steps may be longer.
const NOISE: f64 = 64.0;
/// The part of a size beside the others that orientations, and projections onto what joints hold, leave of rounding:
/// they mix the states of all bodies, the more so the nearer a pose is to a singular one.
const MIXED: f64 = 1e-12;
/// By how much steps grow before rounding is looked at anew.
const LONGER: f64 = 4.0;
/// The part of a size beside the others that rounding is at most in methods which damp it, or take no differences of
/// rates.
const DAMPED: f64 = 1e-13;
/// By how much a state outgrows its size before the sizes are looked at anew.
const OUTGROWN: f64 = 2.0;
/// How far the rates of storages may change, in parts of themselves, on the way from which the sizes of a step from
/// rest are taken.
const LINEAR: f64 = 0.5;
/// Below this part of its size beside the others a state is rounding.
const ROUNDING: f64 = 1e-12;

/// How large states have been.
#[derive(Clone, Debug)]
struct Sizes {
    /// The largest magnitude of each, in its unit.
    own: DVector<f64>,
    /// Where each would count beside the others, in its unit.
    beside: DVector<f64>,
    /// The largest energy, J.
    energy: f64,
}

/// Follows the sizes of a run.
#[derive(Clone, Debug)]
pub(super) struct SizeMonitor {
    relative: f64,
    /// Whether the absolute tolerances follow the sizes: not where they were given.
    is_leading: bool,
    /// The start of the run, s.
    t0: f64,
    sizes: Sizes,
    /// The sizes before the next step, while those of a way ahead stand for its own.
    before: Option<Sizes>,
    /// What rounding makes of each state in a step.
    noise: DVector<f64>,
    /// The magnitude from which on each state has outgrown its size, and the step (s) that outgrows the noise.
    limit: DVector<f64>,
    longest: f64,
    /// The largest magnitude of each state at the end of a step.
    largest: DVector<f64>,
}

impl SizeMonitor {
    pub fn new(tolerances: &Tolerances, states: usize, t0: f64) -> Self {
        let none = || DVector::zeros(states);
        Self {
            relative: tolerances.relative,
            is_leading: tolerances.absolute == Absolute::OfSizes,
            t0,
            sizes: Sizes { own: none(), beside: none(), energy: 0.0 },
            before: None,
            noise: none(),
            limit: none(),
            longest: 0.0,
            largest: none(),
        }
    }

    /// Goes on with the tolerances of another one.
    pub fn go_on(&mut self, other: &Self, scale: &mut Scale) {
        if other.is_leading && !self.is_leading {
            // Of given tolerances nothing is known of rounding.
            self.longest = 0.0;
        }
        (self.relative, self.is_leading) = (other.relative, other.is_leading);
        self.lead(scale);
    }

    /// The states have been as large as `largest` before the start of the run, and their storages have stored that
    /// much.
    pub fn remember(&mut self, stepper: &Stepper<'_>, largest: &DVector<f64>) {
        let Point { t, x, .. } = &stepper.start;
        self.sizes.own.copy_from(largest);
        self.largest.copy_from(largest);
        if stepper.system.stored().is_some() && x.abs() != *largest {
            let mut curvatures = vec![0.0; x.len()];
            stepper.system.energy(*t, x.as_slice(), &stepper.negative, &mut curvatures);
            for i in (0..x.len()).filter(|&i| largest[i] > x[i].abs()) {
                self.sizes.energy = larger(0.5 * curvatures[i] * largest[i] * largest[i], self.sizes.energy);
            }
        }
    }

    /// Takes the sizes from the state at the start, whose rate is not known.
    pub fn start(&mut self, stepper: &mut Stepper<'_>) {
        raise(self.largest.as_mut_slice(), stepper.start.x.as_slice());
        self.measure(stepper.system, &stepper.start, &stepper.negative);
        self.lead(&mut stepper.scale);
    }

    /// The same where the rate is known.
    pub fn begin(&mut self, stepper: &mut Stepper<'_>) {
        self.sizes.energy = larger(self.sizes.energy, self.work(stepper.system, &stepper.start));
        self.measure(stepper.system, &stepper.start, &stepper.negative);
        self.lead(&mut stepper.scale);
    }

    /// Whether nothing has moved so far, so that no size is known.
    pub fn is_at_rest(&self, system: &dyn Dynamics) -> bool {
        let knows_energy = system.stored().is_some();
        self.is_leading && if knows_energy { self.sizes.energy == 0.0 } else { self.sizes.own.amax() == 0.0 }
    }

    /// Takes the sizes of the next step from a way ahead, at most `longest` (s) long.
    pub fn look_ahead(&mut self, stepper: &mut Stepper<'_>, longest: f64) {
        if !self.is_leading || !stepper.method.measures() {
            return;
        }
        if let Some(ahead) = self.way_ahead(stepper, longest) {
            self.before = Some(self.sizes.clone());
            self.measure(stepper.system, &ahead, &stepper.negative);
            self.drift(stepper, &ahead, ahead.t - self.t0);
            let start = stepper.start.clone();
            self.listen(stepper, &start, ahead.t - start.t);
            self.lead(&mut stepper.scale);
            // The step ends what stands for its sizes.
            self.limit.fill(-1.0);
        }
    }

    /// Takes the sizes of states of which none is known from an attempt that was rejected.
    pub fn guess(&mut self, end: &DVector<f64>, scale: &mut Scale) {
        for i in 0..end.len() {
            if self.is_leading && scale.absolute[i] == f64::MIN_POSITIVE {
                scale.absolute[i] = larger(self.relative * OWN * end[i].abs(), f64::MIN_POSITIVE);
            }
        }
    }

    /// Looks at the end of an accepted step; gives whether the scale has changed.
    pub fn follow(&mut self, stepper: &mut Stepper<'_>) -> bool {
        let outgrows = self.passes_limits(stepper.end.x.as_slice());
        let is_outgrown = outgrows || stepper.h > self.longest;
        if is_outgrown {
            self.renew(stepper);
        }
        is_outgrown
    }

    /// Takes note of the magnitudes of a state; gives whether one is above its limit.
    fn passes_limits(&mut self, x: &[f64]) -> bool {
        let mut passes = false;
        let known = self.largest.as_mut_slice().iter_mut().zip(self.limit.as_slice());
        for ((largest, limit), x) in known.zip(x) {
            let magnitude = x.abs();
            *largest = if magnitude > *largest { magnitude } else { *largest };
            passes |= magnitude > *limit;
        }
        passes
    }

    /// The magnitudes from which on states have outgrown their sizes, and the step (s) from which on it has outgrown
    /// the noise.
    #[cfg(feature = "std")]
    pub fn limits(&self) -> (DVector<f64>, f64) {
        (self.limit.clone(), self.longest)
    }

    /// How much has moved so far.
    pub fn moved(&self, system: &dyn Dynamics) -> Moved<'_> {
        Moved { energy: system.stored().map(|_| self.sizes.energy), states: self.sizes.own.as_slice() }
    }

    /// The absolute tolerance of state `i` in a run of this scale as it would be without noise.
    pub fn without_noise(&self, i: usize, scale: &Scale) -> f64 {
        if self.is_leading { larger(self.relative * self.size(i), f64::MIN_POSITIVE) } else { scale.absolute[i] }
    }

    /// Takes the sizes at the end of the step.
    pub fn renew(&mut self, stepper: &mut Stepper<'_>) {
        if let Some(before) = self.before.take() {
            self.sizes = before;
        }
        self.measure(stepper.system, &stepper.end, &stepper.negative);
        // Of given tolerances, and of projections alone, no rounding is asked for.
        if self.is_leading && stepper.method.measures() {
            let (end, h) = (stepper.end.clone(), stepper.h);
            self.drift(stepper, &end, end.t - self.t0);
            self.listen(stepper, &end, h);
        } else {
            self.noise = self.mixed(stepper.system);
            self.longest = f64::INFINITY;
        }
        self.lead(&mut stepper.scale);
    }

    /// States whose errors were never controlled, with the tolerances of this scale: above rounding, and below their
    /// tolerance all the time.
    pub fn uncontrolled(&self, scale: &Scale) -> Vec<bool> {
        let is_uncontrolled = |i: usize| {
            let rounding = ROUNDING * larger(self.sizes.beside[i], f64::MIN_POSITIVE);
            self.largest[i] > rounding && self.largest[i] < scale.absolute[i]
        };
        (0..self.largest.len()).map(is_uncontrolled).collect()
    }

    /// Raises the sizes to those of a point.
    fn measure(&mut self, system: &dyn Dynamics, Point { t, x, .. }: &Point, negative: &[bool]) {
        let Sizes { own, beside, energy } = &mut self.sizes;
        raise(own.as_mut_slice(), x.as_slice());
        let Some(states) = system.stored() else {
            let among = own.amax() * AMONG / BESIDE;
            beside.apply(|beside| *beside = beside.max(among));
            return;
        };
        let mut curvatures = vec![0.0; x.len()];
        *energy = larger(system.energy(*t, x.as_slice(), negative, &mut curvatures).abs(), *energy);
        let length = length(states.iter().map(|state| state.kind), own);
        for (i, state) in states.iter().enumerate() {
            let size = match state.kind {
                StateKind::Momentum(_) | StateKind::Displacement(_) if curvatures[i] != 0.0 => {
                    libm::sqrt(2.0 * *energy / curvatures[i].abs())
                }
                StateKind::Orientation(..) | StateKind::Angle => 1.0,
                StateKind::Way if state.unit == "rad" => 1.0,
                StateKind::Position(_) => length,
                StateKind::Momentum(_) | StateKind::Displacement(_) | StateKind::Way | StateKind::Integral => 0.0,
            };
            beside[i] = larger(size, beside[i]);
        }
    }

    /// The work of the forces at the start over the machine's length, and of the torques over a radian, J.
    fn work(&self, system: &dyn Dynamics, start: &Point) -> f64 {
        let Some(states) = system.stored() else { return 0.0 };
        let length = length(states.iter().map(|state| state.kind), &self.sizes.own);
        states.iter().zip(start.rate.iter()).fold(0.0, |work, (state, effort)| {
            let way = match (state.kind, state.unit) {
                (StateKind::Momentum(_), "kg*m/s") => length,
                (StateKind::Momentum(_), "kg*m^2/s") => 1.0,
                _ => 0.0,
            };
            larger(effort.abs() * way, work)
        })
    }

    /// A point ahead, so near that the rates on the way to it depend little on it: also on where it leads positions
    /// from rest.
    fn way_ahead(&self, stepper: &mut Stepper<'_>, longest: f64) -> Option<Point> {
        const TRIES: usize = 100;
        const SHORTER: [f64; 2] = [1e-6, 0.5];
        const SHORTER_BY_PLACE: f64 = 1e-2;
        let weights = weights(stepper);
        let norm = |rate: &DVector<f64>| {
            rate.iter().zip(&weights).fold(0.0, |most, (rate, weight)| worse((rate * weight).abs(), most))
        };
        let start = stepper.start.clone();
        let mut h = longest;
        for _ in 0..TRIES {
            let mut rate = |x: &DVector<f64>| stepper.rate(start.t + h, x.as_slice());
            let alone = rate(&start.x);
            let there = rate(&(&start.x + (&start.rate + &alone) * (0.5 * h)));
            let all = larger(norm(&alone), norm(&start.rate));
            // A spring that passes its rest: what storages have tells what is little.
            let all = if all == 0.0 { norm(&start.x) / h } else { all };
            let x = &start.x + (&start.rate + &there) * (0.5 * h);
            let [least, most] = SHORTER;
            let depends = |rate: &DVector<f64>| norm(&(rate - &alone));
            let mut shorter = 0.9 * LINEAR * all / depends(&there);
            if depends(&there) <= LINEAR * all && x.iter().all(|x| x.is_finite()) {
                // So far only what the rates at the start move has moved, from rest no position: here all has.
                let arrived = stepper.rate(start.t + h, x.as_slice());
                if depends(&arrived) <= LINEAR * all {
                    return Some(Point { t: start.t + h, x, rate: arrived });
                }
                // What moves from rest goes with the square of the time.
                shorter = larger(SHORTER_BY_PLACE, libm::sqrt(0.9 * LINEAR * all / depends(&arrived)));
            }
            h *= larger(least, shorter.min(most));
        }
        None
    }

    /// Raises the sizes of what has none by energy to the way of its rate in `elapsed` (s) where storages are displaced
    /// by theirs.
    fn drift(&mut self, stepper: &mut Stepper<'_>, point: &Point, elapsed: f64) {
        let Some(states) = stepper.system.stored() else { return };
        let is_stored = |i: usize| matches!(states[i].kind, StateKind::Momentum(_) | StateKind::Displacement(_));
        let drifts = |i: usize| matches!(states[i].kind, StateKind::Position(_) | StateKind::Way | StateKind::Integral);
        if !(0..states.len()).any(drifts) {
            return;
        }
        let displaced = DVector::from_fn(states.len(), |i, _| {
            let by = if is_stored(i) { self.sizes.beside[i] } else { 0.0 };
            point.x[i] + if i.count_ones() % 2 == 0 { by } else { -by }
        });
        let change = (stepper.rate(point.t, displaced.as_slice()) - &point.rate).abs();
        for i in (0..states.len()).filter(|&i| drifts(i) && change[i].is_finite()) {
            self.sizes.beside[i] = larger(change[i] * elapsed, self.sizes.beside[i]);
        }
    }

    /// Takes what rounding at a point makes of each state in a step of size `h` (s).
    fn listen(&mut self, stepper: &mut Stepper<'_>, point: &Point, h: f64) {
        let (is_exposed, mixed) = (is_exposed(stepper.method), self.mixed(stepper.system));
        let (_, flow, ..) = stepper.split();
        let [mut there, mut rate, mut own, mut in_turn] = [(); 4].map(|()| vec![0.0; point.x.len()]);
        rounding(&flow, point.borrowed(), [&mut there, &mut rate, &mut own]);
        let own = DVector::from_vec(own) * (NOISE * h);
        // What that moves in turn, as a position that follows a momentum.
        displaced(&flow, point.borrowed(), |i| own[i], [&mut there, &mut rate, &mut in_turn]);
        let noise = own.sup(&(DVector::from_vec(in_turn) * h));
        let noise = noise.zip_map(&self.sizes.beside, |noise, beside| {
            if is_exposed || beside == 0.0 { noise } else { noise.min(DAMPED * beside) }
        });
        self.noise = noise.sup(&mixed);
        self.longest = LONGER * h;
    }

    /// What orientations and projections leave of rounding.
    fn mixed(&self, system: &dyn Dynamics) -> DVector<f64> {
        let mixes = |kind: StateKind| matches!(kind, StateKind::Orientation(..) | StateKind::Position(_));
        let has_bodies = system.stored().is_some_and(|states| states.iter().any(|state| mixes(state.kind)));
        &self.sizes.beside * if has_bodies || system.held().is_some() { MIXED } else { 0.0 }
    }

    /// The limits of these sizes, and the absolute tolerances where they follow them.
    fn lead(&mut self, scale: &mut Scale) {
        for i in 0..self.limit.len() {
            self.limit[i] = OUTGROWN / OWN * self.size(i);
            if self.is_leading {
                scale.absolute[i] = larger(self.noise[i], self.without_noise(i, scale));
                scale.weights[i] = if self.sizes.beside[i] > 0.0 { 1.0 / self.sizes.beside[i] } else { 0.0 };
            }
        }
    }

    /// The size of a state over which its absolute tolerance is the relative one, in its unit.
    fn size(&self, i: usize) -> f64 {
        larger(OWN * self.sizes.own[i], BESIDE * self.sizes.beside[i])
    }
}

/// How large each state is to be taken for at time `t` (s) and state `x`, in its unit: where an error norm would take
/// it to count, by its own value, the stored energy and what present forces can do; of a start at rest by what happens
/// within a second. Zero where nothing is known. For the nominal values that other programs ask for.
pub fn sizes<Sys, const N: usize, const G: usize>(system: &Sys, t: f64, x: &SVector<f64, N>) -> DVector<f64>
where
    Sys: System<f64, N, G>,
{
    sizes_of(&Typed::system(system), t, x.as_slice())
}

/// The same over slices.
pub fn sizes_of(system: &dyn Dynamics, t: f64, x: &[f64]) -> DVector<f64> {
    // Of other programs nothing is known of how long they will go on.
    const SECOND: f64 = 1.0;
    let [own, beside] = sizes_within(system, t, x, SECOND);
    own.sup(&beside)
}

/// How large each state is by its own value, and beside the others; of a start at rest by what happens in so many
/// seconds.
pub(crate) fn sizes_within(system: &dyn Dynamics, t: f64, x: &[f64], ahead: f64) -> [DVector<f64>; 2] {
    let (mut method, tolerances) = (Dop853::new(), Tolerances::default());
    let start = Point::at(t, DVector::from_column_slice(x));
    let mut stepper = Stepper::new(system, &mut method, Scale::new(&tolerances, x.len()), start);
    stepper.negative = branches(system, t, x);
    stepper.evaluate_start();
    let mut monitor = SizeMonitor::new(&tolerances, x.len(), t);
    monitor.start(&mut stepper);
    monitor.begin(&mut stepper);
    monitor.look_ahead(&mut stepper, ahead);
    let Sizes { own, beside, .. } = monitor.sizes;
    let beside = if system.stored().is_some() { beside } else { own.map(|_| own.amax()) };
    [own, beside]
}

/// The size of the machine: its largest coordinate, m.
fn length(kinds: impl Iterator<Item = StateKind>, own: &DVector<f64>) -> f64 {
    let positions = kinds.zip(own.iter()).filter(|(kind, _)| matches!(kind, StateKind::Position(_)));
    positions.fold(0.0, |length, (_, &own)| larger(own, length))
}

/// What makes changes of storages comparable: the roots of the second derivatives of the energy. In a system that does
/// not know what it stores all states are alike.
fn weights(stepper: &Stepper<'_>) -> DVector<f64> {
    let Point { t, x, .. } = &stepper.start;
    let mut curvatures = x.map(|_| 1.0);
    if stepper.system.stored().is_none() {
        return curvatures;
    }
    stepper.system.energy(*t, x.as_slice(), &stepper.negative, curvatures.as_mut_slice());
    curvatures.map(|curvature| if curvature.is_finite() { libm::sqrt(curvature.abs()) } else { 0.0 })
}

/// Raises the `largest` magnitudes so far to those of `x`, each where that is more.
pub fn raise(largest: &mut [f64], x: &[f64]) {
    largest.iter_mut().zip(x).for_each(|(largest, x)| *largest = largest.max(x.abs()));
}

/// The larger number; `b` where `a` is none, or is infinite.
fn larger(a: f64, b: f64) -> f64 {
    if a > b && a < f64::INFINITY { a } else { b }
}
