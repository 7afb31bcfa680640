//! The dense output of a step in two halves, for samples inside of a step where that of the whole errs.
//!
//! In: a step whose end and dense output are known. Out: the same path by two steps of half the size, where that is
//! better. Beyond what is stable a dense output errs by a hundred times what its step does.

use alloc::vec::Vec;

use super::stages::Stages;
use super::{COEFFICIENTS, Tableau, interpolate};
use crate::solve::integrator::dense::{FROM_ENDS, Polynomial};
use crate::solve::integrator::side_by_side::{Padded, SIDE_BY_SIDE};
use crate::solve::integrator::steps::Begin;
use crate::solve::integrator::tolerances::largest_of;
use crate::solve::integrator::{Arch, Flow, PointRef, Scale, is_finite};

/// The most that a dense output may err by, in parts of what a step may.
const LIMIT: f64 = 20.0;
/// From here on a step is so far beyond what is stable that two of its halves are worse, in the same parts.
const HOPELESS: f64 = 1e5;

/// Both halves of the last step that was looked at, with room for them.
#[derive(Clone, Debug)]
pub(super) struct Halves<T> {
    stages: Stages<T, f64, SIDE_BY_SIDE>,
    polynomials: [Polynomial<COEFFICIENTS>; 2],
    /// The state between them and its rate.
    middle: Padded<f64, SIDE_BY_SIDE>,
    rate: Vec<f64>,
    /// Room for a state, and for the way there.
    there: Vec<f64>,
    way: Padded<f64, SIDE_BY_SIDE>,
    /// Whether they are better than the whole step.
    are_better: bool,
}

impl<T: Tableau> Halves<T> {
    /// Room for so many states.
    pub fn new(states: usize) -> Self {
        let polynomial = || Polynomial::new(states);
        let room = || alloc::vec![0.0; states];
        Self {
            stages: Stages::new(states),
            polynomials: [polynomial(), polynomial()],
            middle: Padded::new(states, 0.0),
            rate: room(),
            there: room(),
            way: Padded::new(states, 0.0),
            are_better: false,
        }
    }

    /// Looks at a step of size `h` (s) with these stages and this dense output; where that errs, makes its halves.
    pub fn look(
        &mut self,
        (flow, scale, arch): (&Flow<'_>, &Scale, Arch),
        [start, end]: [PointRef<'_>; 2],
        h: f64,
        (stages, polynomial): (&Stages<T, f64, SIDE_BY_SIDE>, &Polynomial<COEFFICIENTS>),
    ) {
        self.are_better = false;
        let allowed = |i: usize| scale.allowed_between(i, start.x[i], end.x[i]);
        let whole = error((stages, polynomial), arch, start, h, &allowed, (&mut self.there, &mut self.way));
        if !(LIMIT..HOPELESS).contains(&whole) {
            return;
        }
        let Self { stages, polynomials: [first, second], middle, rate, there, way, .. } = self;
        let half = 0.5 * h;
        stages.begin(start.rate);
        stages.evaluate(flow, &Begin::of(start, half), 1..T::END, &mut ());
        stages.write(T::B, half, middle);
        middle.iter_mut().zip(start.x).for_each(|(x, start)| *x += start);
        flow.rate(start.t + half, middle, rate);
        let between = PointRef { t: start.t + half, x: middle, rate };
        interpolate((stages, first), flow, start, half, between);
        let mut halves = error((stages, first), arch, start, half, &allowed, (&mut *there, &mut *way));
        stages.begin(between.rate);
        stages.evaluate(flow, &Begin::of(between, half), 1..T::END, &mut ());
        interpolate((stages, second), flow, between, half, end);
        halves += error((stages, second), arch, between, half, &allowed, (&mut *there, &mut *way));
        self.are_better = halves < whole;
    }

    /// Writes the state at the part `theta` (0 to 1) of the step from `start` into `x`; false where the whole step's
    /// dense output is to be taken.
    pub fn evaluate(&self, arch: Arch, start: PointRef<'_>, h: f64, theta: f64, x: &mut [f64]) -> bool {
        if !self.are_better {
            return false;
        }
        let [first, second] = &self.polynomials;
        let terms = FROM_ENDS + T::DENSE.len();
        if theta < 0.5 {
            first.evaluate(arch, terms, start, 2.0 * theta, x);
        } else {
            let middle = PointRef { t: start.t + 0.5 * h, x: &self.middle, rate: &self.rate };
            second.evaluate(arch, terms, middle, 2.0 * theta - 1.0, x);
        }
        true
    }
}

/// What the dense output of a step of size `h` (s) errs by, in parts of what a step may; infinite where it is no
/// number, zero where the method does not say.
fn error<T: Tableau>(
    (stages, polynomial): (&Stages<T, f64, SIDE_BY_SIDE>, &Polynomial<COEFFICIENTS>),
    arch: Arch,
    start: PointRef<'_>,
    h: f64,
    allowed: &impl Fn(usize) -> f64,
    (there, way): (&mut [f64], &mut Padded<f64, SIDE_BY_SIDE>),
) -> f64 {
    let Some((stage, times)) = T::DENSE_ERROR else { return 0.0 };
    polynomial.evaluate(arch, FROM_ENDS + T::DENSE.len(), start, T::C[stage], there);
    if !is_finite(there) {
        return f64::INFINITY;
    }
    stages.write(T::A[stage], h, way);
    let off = |i: usize| (there[i] - (start.x[i] + way[i])).abs();
    times * largest_of(there.len(), |i| off(i) / allowed(i))
}
