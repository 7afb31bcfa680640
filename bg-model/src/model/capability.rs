//! Capabilities: what a system knows of itself beyond its rate.
//!
//! In: nothing. Out: a trait for each capability, which [`System`](crate::system::System) hands over where it has it.
//! What a system lacks is `None` of the type [`Absent`], which has no values: an absent capability cannot be called,
//! and the compiler removes the code that would call it.

use core::ops::Range;

use nalgebra::SVector;

use crate::model::delay::States;
use crate::model::description::StateInfo;
use crate::model::holding::{Held, Stops};
use crate::model::linear::{Field, Sparsity};
use crate::model::origin::Origin;
use crate::model::scalar::Scalar;

/// A system that names what messages speak of.
pub trait Named<S: Scalar, const N: usize, const G: usize> {
    /// The name of state `index`.
    fn state_name(&self, index: usize) -> &'static str;

    /// The comparison of switch `index` and whose it is, such as ``if v < 0` of `valve``; by default none.
    fn switch_name(&self, _index: usize) -> Option<&'static str> {
        None
    }

    /// The first input or element, in the order of evaluation, whose value at time `t` (s) and state `x` is not finite;
    /// asked for where a run stops. By default none is known.
    fn not_finite(&self, _t: S, _x: &SVector<S, N>, _negative: &[S::Switch; G]) -> Option<Origin> {
        None
    }
}

/// A system whose rate is inlined where it is compiled for the vectors of a machine: where not every build is for that
/// machine, operations of these vectors are calls elsewhere.
pub trait Inlined<S: Scalar, const N: usize, const G: usize> {
    /// Whether the rate is short enough to be inlined wherever a step calls it.
    const IS_SHORT: bool;

    /// [`System::rate`](crate::system::System::rate), inlined whatever its length.
    fn rate(&self, t: S, x: &SVector<S, N>, negative: &[S::Switch; G], dx: &mut SVector<S, N>);

    /// The same in pairs of operations where that pays; by default without.
    #[inline(always)]
    fn paired_rate(&self, t: S, x: &SVector<S, N>, negative: &[S::Switch; G], dx: &mut SVector<S, N>) {
        self.rate(t, x, negative, dx);
    }

    /// [`System::project`](crate::system::System::project), inlined whatever its length.
    fn project(&self, t: S, negative: &[S::Switch; G], x: &mut SVector<S, N>);

    /// Whether numbers of several runs side by side give in each place what a run gives by itself, and faster: not
    /// where something is found by iteration, where an input is more than a number, or where the rate is too long.
    fn runs_in_lanes(&self) -> bool {
        Self::IS_SHORT
    }
}

/// A system with states that [`System::project`](crate::system::System::project) sets to what they follow, by which it
/// moves them far: what memories keep, samples hold and delays read.
pub trait Memories<S: Scalar> {
    /// These states, as memories keep and samples hold them.
    fn states(&self) -> &'static [usize];

    /// The switches of clocks: their guards are 1, and projection computes samples in their negative branches, in which
    /// they are at the instants of [`Memories::instants`] only. None by default.
    fn clocks(&self) -> &'static [usize] {
        &[]
    }

    /// Writes of each clock the time from one instant to the next, s, above 0, and its first instant, s.
    fn instants(&self, _instants: &mut [S]) {}

    /// The delays of signals. Their clocks are among [`Memories::clocks`], with the time of the delay as the period: in
    /// their negative branches projection reads the signals into the first of their states. None by default.
    fn delays(&self) -> &'static [States] {
        &[]
    }
}

/// A system with loops in closed form for links which might come to a pose where they turn either way: nothing shows
/// that the pivots of these loops keep away from zero.
pub trait Turning<S: Scalar, const N: usize, const G: usize> {
    /// The joints that close these loops.
    fn joints(&self) -> &'static [&'static str];

    /// Writes the pivots of the loops, m or m^2, into `pivots`. Each keeps the sign that it has at the start.
    fn pivots(&self, t: S, x: &SVector<S, N>, negative: &[S::Switch; G], pivots: &mut [S]);
}

/// A system that knows its Jacobian.
pub trait Linearised<S: Scalar, const N: usize, const G: usize> {
    /// Where df/dx can differ from zero; everywhere by default.
    fn sparsity(&self) -> Sparsity {
        Sparsity::Full
    }

    /// Writes df/dx in the order of the sparsity into `entries` and df/dt, per s, into `slope`. With unknowns beside
    /// the states, df/dt is that of the rates with what the unknowns change in it.
    fn jacobian(
        &self,
        t: S,
        x: &SVector<S, N>,
        negative: &[S::Switch; G],
        entries: &mut [S],
        slope: &mut SVector<S, N>,
    );

    /// Where [`Linearised::damping`] can differ from zero. By default as [`Linearised::sparsity`].
    fn damping_sparsity(&self) -> Sparsity {
        self.sparsity()
    }

    /// Writes the entries of df/dx that say what dampers do, in the order of [`Linearised::damping_sparsity`], into
    /// `entries`: at least those among states that are not of second order. By default all of them.
    fn damping(&self, t: S, x: &SVector<S, N>, negative: &[S::Switch; G], entries: &mut [S]) {
        let mut slope = *x;
        self.jacobian(t, x, negative, entries, &mut slope);
    }

    /// An elimination made for the sparsity; none by default.
    #[inline]
    fn elimination(&self) -> Option<&impl Elimination<S, N>> {
        None::<&Absent>
    }
}

/// A solution of (I - c J) y = b along the pattern of J, in a fixed order and without a search for pivots.
pub trait Elimination<S: Scalar, const N: usize> {
    /// How many numbers the factors of I - c J are.
    fn factors(&self) -> usize;

    /// Writes the factors of I - `c` J into `factors`; `entries` is J in the order of its sparsity. Gives whether it
    /// did: not where a pivot cancels to below [`SMALLEST_PIVOT`](crate::linear::SMALLEST_PIVOT) of the largest value
    /// its place has had.
    fn eliminate<F: Field<S>>(&self, c: F, entries: &[S], factors: &mut [F]) -> bool;

    /// Replaces `b` by the solution y of (I - c J) y = b, with the `factors` of I - c J.
    fn substitute<F: Field<S>>(&self, factors: &[F], b: &mut [F; N]);

    /// [`Elimination::eliminate`] in little code, for machines that are rare: the same values, in more time.
    fn eliminate_compactly<F: Field<S>>(&self, c: F, entries: &[S], factors: &mut [F]) -> bool {
        self.eliminate(c, entries, factors)
    }

    /// [`Elimination::substitute`], likewise.
    fn substitute_compactly<F: Field<S>>(&self, factors: &[F], b: &mut [F; N]) {
        self.substitute(factors, b);
    }
}

/// A system some of whose states are of second order: displacements and orientations, whose rates are smooth functions
/// of states alone.
pub trait SecondOrder<S: Scalar, const N: usize, const G: usize> {
    /// The states of second order, side by side.
    fn states(&self) -> Range<usize>;

    /// Replaces the rates `dx` of these states at state `x` by their second derivatives with respect to time, per s^2.
    fn second_derivatives(&self, x: &SVector<S, N>, dx: &mut SVector<S, N>);

    /// Writes the rates at time `t` (s) and state `x` into `dx`, in the places of the states of second order their
    /// second derivatives: what the rate and then [`SecondOrder::second_derivatives`] give, to rounding.
    fn forces(&self, t: S, x: &SVector<S, N>, negative: &[S::Switch; G], dx: &mut SVector<S, N>);

    /// The operations of a rate and of [`SecondOrder::forces`]; none by default. `auto` compares methods by them.
    fn operations(&self) -> Option<[u32; 2]> {
        None
    }
}

/// A system that knows the Taylor series of its states.
pub trait Series<S: Scalar, const N: usize, const G: usize> {
    /// How many numbers each order takes as work space.
    fn width(&self) -> usize;

    /// What a series costs beside a rate; none by default. `auto` compares methods by it.
    fn operations(&self) -> Option<Operations> {
        None
    }

    /// Writes the Taylor series of the states from time `t` (s) on: `series[0]` is the state there, `series[k]` becomes
    /// the coefficient of the k-th power of (time - `t`) / `h`, which has the state's unit. `rows` has at least
    /// [`Series::width`] numbers for each `k` but the last.
    fn expand(&self, t: S, h: S, negative: &[S::Switch; G], rows: &mut [S], series: &mut [SVector<S, N>]);
}

/// Operations of a rate and of its Taylor series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operations {
    /// Of a rate.
    pub rate: u32,
    /// Of each order of the series, without what follows.
    pub order: u32,
    /// The products that each order sums over all lower ones, side by side.
    pub products: u32,
    /// The same, one after the other: for quotients and functions.
    pub sums: u32,
}

/// What a Taylor series takes.
#[derive(Clone, Copy, Debug)]
pub struct SeriesSize {
    /// How many numbers each order takes as work space.
    pub width: usize,
    /// What a series costs beside a rate, where that has been counted.
    pub operations: Option<Operations>,
}

/// A system whose joints hold motions.
pub trait Joints<S: Scalar, const N: usize, const G: usize> {
    /// What they hold.
    fn held(&self) -> Held;

    /// For each motion of [`Held::closing`] 1, or 0 where it follows from the others and takes no part.
    fn kept(&self) -> &[f64] {
        &[]
    }

    /// Writes the relative flows of these motions, and what the reactions of rigid joints change, into `entries`: in
    /// the order and of the length of [`Held`].
    fn hold(&self, t: S, x: &SVector<S, N>, negative: &[S::Switch; G], entries: &mut [S]);

    /// Whether [`Joints::inlined_hold`] is inlined: not where it is too long.
    fn is_hold_inlined(&self) -> bool {
        false
    }

    /// As [`Joints::hold`], inlined where that is short enough: where numbers are vectors of a machine that not every
    /// build is for, its operations are calls elsewhere.
    #[inline(always)]
    fn inlined_hold(&self, t: S, x: &SVector<S, N>, negative: &[S::Switch; G], entries: &mut [S]) {
        self.hold(t, x, negative, entries);
    }
}

/// A system with stops that give back a part of the speed with which something hits them.
pub trait Impacts<S: Scalar, const N: usize, const G: usize> {
    /// The stops, and the states that impulses change.
    fn stops(&self) -> Stops;

    /// For each motion of [`Stops::closing`] 1, or 0 where it follows from the others and takes no part.
    fn kept(&self) -> &[f64] {
        &[]
    }

    /// Writes what an impact at time `t` (s) and state `x` is calculated from into `entries`: in the order and of the
    /// length of [`Stops`].
    fn impact(&self, t: S, x: &SVector<S, N>, negative: &[S::Switch; G], entries: &mut [S]);
}

/// A system that knows what its storages store.
pub trait Storages<S: Scalar, const N: usize, const G: usize> {
    /// What each state is.
    fn states(&self) -> &'static [StateInfo];

    /// The stored energy E at time `t` (s) and state `x`, J, as far as it is known; writes d2E/dx2 by each momentum and
    /// displacement, in J per the state's unit squared, into `curvatures`, and 0 for other states.
    fn energy(&self, t: S, x: &SVector<S, N>, negative: &[S::Switch; G], curvatures: &mut SVector<S, N>) -> S;
}

/// A model that knows its reverse sweeps: how a weighted sum of what a function gives depends on all that the function
/// reads, at the cost of a few evaluations of it. What depends on the parameters only is a table of constants, by which
/// each sweep adds its derivatives to `by_constants`: in the weights' unit times the result's, per the constant's.
/// Branches are given.
pub trait Reversed<S: Scalar, const N: usize, const G: usize, const M: usize> {
    /// The table of constants.
    fn constants(&self) -> &[S];

    /// The sweep of the rate at time `t` (s) and state `x`: writes the derivatives by the states into `by_state`.
    fn reverse_rate(
        &self,
        t: S,
        x: &SVector<S, N>,
        negative: &[S::Switch; G],
        weights: &SVector<S, N>,
        by_state: &mut SVector<S, N>,
        by_constants: &mut [S],
    );

    /// The sweep of the projection of the state `x`: replaces the weights of the projected states by those of the
    /// states before. By default nothing is projected.
    #[inline]
    fn reverse_project(
        &self,
        _t: S,
        _x: &SVector<S, N>,
        _negative: &[S::Switch; G],
        _weights: &mut SVector<S, N>,
        _by_constants: &mut [S],
    ) {
    }

    /// The sweep of the outputs, as that of the rate. Gives whether there is one: by default, and where outputs read
    /// reactions that joints share, there is none.
    #[inline]
    fn reverse_outputs(
        &self,
        _t: S,
        _x: &SVector<S, N>,
        _negative: &[S::Switch; G],
        _weights: &SVector<S, M>,
        _by_state: &mut SVector<S, N>,
        _by_constants: &mut [S],
    ) -> bool {
        false
    }
}

/// A capability that is not there.
#[derive(Clone, Copy, Debug)]
pub enum Absent {}

impl<S: Scalar, const N: usize, const G: usize> Named<S, N, G> for Absent {
    fn state_name(&self, _: usize) -> &'static str {
        match *self {}
    }
}

impl<S: Scalar, const N: usize, const G: usize> Inlined<S, N, G> for Absent {
    const IS_SHORT: bool = false;
    fn rate(&self, _: S, _: &SVector<S, N>, _: &[S::Switch; G], _: &mut SVector<S, N>) {
        match *self {}
    }
    fn project(&self, _: S, _: &[S::Switch; G], _: &mut SVector<S, N>) {
        match *self {}
    }
}

impl<S: Scalar> Memories<S> for Absent {
    fn states(&self) -> &'static [usize] {
        match *self {}
    }
}

impl<S: Scalar, const N: usize, const G: usize> Turning<S, N, G> for Absent {
    fn joints(&self) -> &'static [&'static str] {
        match *self {}
    }
    fn pivots(&self, _: S, _: &SVector<S, N>, _: &[S::Switch; G], _: &mut [S]) {
        match *self {}
    }
}

impl<S: Scalar, const N: usize, const G: usize> Linearised<S, N, G> for Absent {
    fn jacobian(&self, _: S, _: &SVector<S, N>, _: &[S::Switch; G], _: &mut [S], _: &mut SVector<S, N>) {
        match *self {}
    }
}

impl<S: Scalar, const N: usize> Elimination<S, N> for Absent {
    fn factors(&self) -> usize {
        match *self {}
    }
    fn eliminate<F: Field<S>>(&self, _: F, _: &[S], _: &mut [F]) -> bool {
        match *self {}
    }
    fn substitute<F: Field<S>>(&self, _: &[F], _: &mut [F; N]) {
        match *self {}
    }
}

impl<S: Scalar, const N: usize, const G: usize> SecondOrder<S, N, G> for Absent {
    fn states(&self) -> Range<usize> {
        match *self {}
    }
    fn second_derivatives(&self, _: &SVector<S, N>, _: &mut SVector<S, N>) {
        match *self {}
    }
    fn forces(&self, _: S, _: &SVector<S, N>, _: &[S::Switch; G], _: &mut SVector<S, N>) {
        match *self {}
    }
}

impl<S: Scalar, const N: usize, const G: usize> Series<S, N, G> for Absent {
    fn width(&self) -> usize {
        match *self {}
    }
    fn expand(&self, _: S, _: S, _: &[S::Switch; G], _: &mut [S], _: &mut [SVector<S, N>]) {
        match *self {}
    }
}

impl<S: Scalar, const N: usize, const G: usize> Joints<S, N, G> for Absent {
    fn held(&self) -> Held {
        match *self {}
    }
    fn hold(&self, _: S, _: &SVector<S, N>, _: &[S::Switch; G], _: &mut [S]) {
        match *self {}
    }
}

impl<S: Scalar, const N: usize, const G: usize> Impacts<S, N, G> for Absent {
    fn stops(&self) -> Stops {
        match *self {}
    }
    fn impact(&self, _: S, _: &SVector<S, N>, _: &[S::Switch; G], _: &mut [S]) {
        match *self {}
    }
}

impl<S: Scalar, const N: usize, const G: usize> Storages<S, N, G> for Absent {
    fn states(&self) -> &'static [StateInfo] {
        match *self {}
    }
    fn energy(&self, _: S, _: &SVector<S, N>, _: &[S::Switch; G], _: &mut SVector<S, N>) -> S {
        match *self {}
    }
}

impl<S: Scalar, const N: usize, const G: usize, const M: usize> Reversed<S, N, G, M> for Absent {
    fn constants(&self) -> &[S] {
        match *self {}
    }
    fn reverse_rate(
        &self,
        _: S,
        _: &SVector<S, N>,
        _: &[S::Switch; G],
        _: &SVector<S, N>,
        _: &mut SVector<S, N>,
        _: &mut [S],
    ) {
        match *self {}
    }
}
