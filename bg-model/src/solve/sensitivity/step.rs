//! One step of a state with its derivatives along some directions.
//!
//! In: the start of a step that a run has made, a rate that takes numbers with slopes. Out: the state at its end, with slopes.
//! Method: DOP853 on the state with its slopes, which is the same method on S' = J S + df/dp with the exact J and df/dp of every
//! stage: of a run by DOP853 the exact derivative of its steps, which is as exact as the run is. The step is divided into equal parts
//! until the estimated error of the slopes is what is allowed: for a change of the direction by its size, what is allowed of the
//! state (as in A. C. Hindmarsh and others, SUNDIALS, ACM TOMS 31 (2005), section 2.6).
//!
//! A step has vectors of its own: those of the machine, in which nothing else is calculated. All around it is [`Gradient`].

use nalgebra::SVector;
use pulp::NullaryFnOnce;

use crate::model::scalar::gradient::GradientIn;
#[cfg(target_arch = "x86_64")]
use crate::model::scalar::slopes::Avx2;
#[cfg(not(target_arch = "x86_64"))]
use crate::model::scalar::slopes::Everywhere;
use crate::model::scalar::slopes::{Slopes, WIDTH};
use crate::model::scalar::{Gradient, Scalar};
use crate::model::system::System;
use crate::solve::integrator::{DormandPrince, Row, Scale, Tableau, both};

/// A state with slopes.
pub(super) type Sloped<const N: usize> = SVector<Gradient, N>;
/// The same in the vectors of a step.
type SlopedIn<V, const N: usize> = SVector<GradientIn<V>, N>;

/// The fastest vectors that a machine of this kind may have.
#[cfg(target_arch = "x86_64")]
pub(super) type Fastest = Avx2;
/// The fastest vectors that a machine of this kind may have.
#[cfg(not(target_arch = "x86_64"))]
pub(super) type Fastest = Everywhere;

/// The same number in other vectors.
#[inline(always)]
pub(super) fn among<V: Slopes, W: Slopes>(number: GradientIn<V>) -> GradientIn<W> {
    GradientIn::new(number.value, number.slopes())
}

/// The stages of a step.
const STAGES: usize = DormandPrince::END;
/// Parts of a step at most.
const MOST_PARTS: u32 = 1 << 16;
/// Errors below this let the next step have half as many parts: a twofold step errs 2^8 times as much.
const SMALL: f64 = 1.0 / 512.0;

/// Steps of a system, whatever its vectors.
pub(super) trait Steps<const N: usize, const G: usize> {
    /// Writes the state at the time `to` (s), from `x` at `from`, into `end`, projected, in the branches `negative`. Gives whether it
    /// did: not where the slopes stay too inexact or are not finite.
    fn cross(&mut self, negative: &[bool; G], from: f64, to: f64, x: &Sloped<N>, end: &mut Sloped<N>) -> bool;
}

/// The method with its work space.
#[derive(Debug)]
pub(super) struct Stepper<V, Sys, const N: usize> {
    system: Sys,
    k: Box<Stages<V, N>>,
    /// The parts of the last step.
    parts: u32,
    /// What is allowed of a state.
    scale: Scale<N>,
    /// The size of each direction, in its unit.
    sizes: V,
}

/// The rates of all stages: values and slopes apart, so that values fill vectors of their own.
#[derive(Debug)]
struct Stages<V, const N: usize> {
    values: [[f64; N]; STAGES],
    slopes: [[V; N]; STAGES],
}

impl<V: Slopes, Sys, const N: usize> Stepper<V, Sys, N> {
    pub fn new(system: Sys, scale: Scale<N>, sizes: [f64; WIDTH]) -> Self {
        let k = Box::new(Stages { values: [[0.0; N]; STAGES], slopes: [[V::new([0.0; WIDTH]); N]; STAGES] });
        Self { system, k, parts: 1, scale, sizes: V::new(sizes) }
    }

    #[inline(always)]
    fn crossed<const G: usize>(
        &mut self,
        negative: &[bool; G],
        from: f64,
        to: f64,
        x: &Sloped<N>,
        end: &mut Sloped<N>,
    ) -> bool
    where
        Sys: System<GradientIn<V>, N, G>,
    {
        while self.parts <= MOST_PARTS {
            let h = (to - from) / f64::from(self.parts);
            let mut state: SlopedIn<V, N> = x.map(among);
            let mut worst = 0.0_f64;
            for part in 0..self.parts {
                let t = from + f64::from(part) * h;
                let error = self.attempt(negative, t, h, &mut state);
                worst = if error <= worst { worst } else { error };
                if worst.is_nan() || worst > 1.0 {
                    break;
                }
            }
            if worst <= 1.0 {
                if worst < SMALL && self.parts > 1 {
                    self.parts /= 2;
                }
                let to = GradientIn::from_f64(to);
                if V::MUST_BE_INLINED {
                    self.system.inlined_project(to, negative, &mut state);
                } else {
                    self.system.project(to, negative, &mut state);
                }
                *end = state.map(among);
                return true;
            }
            self.parts *= 2;
        }
        false
    }

    /// Replaces the state by that at the end of one part; gives the norm of its slopes' error.
    #[inline(always)]
    fn attempt<const G: usize>(&mut self, negative: &[bool; G], t: f64, h: f64, x: &mut SlopedIn<V, N>) -> f64
    where
        Sys: System<GradientIn<V>, N, G>,
    {
        let mut state = *x;
        let mut rate = state;
        for stage in 0..STAGES {
            macro_rules! written_out {
                ($($stage:literal)*) => {
                    match stage {
                        $( $stage => self.k.move_by(x, h, const { DormandPrince::A[$stage] }, &mut state), )*
                        _ => {}
                    }
                };
            }
            written_out!(1 2 3 4 5 6 7 8 9 10 11);
            let t = GradientIn::from_f64(t + DormandPrince::C[stage] * h);
            if V::MUST_BE_INLINED {
                self.system.always_inlined_rate(t, &state, negative, &mut rate);
            } else {
                self.system.rate(t, &state, negative, &mut rate);
            }
            self.k.store(stage, &rate);
        }
        self.k.move_by(x, h, DormandPrince::B, &mut state);
        let error = self.error(h, x, &state);
        x.copy_from(&state);
        error
    }

    /// The norm of the slopes' error: DOP853's, of its two differences to embedded methods. Not a number where a slope is none.
    #[inline(always)]
    fn error(&self, h: f64, start: &SlopedIn<V, N>, end: &SlopedIn<V, N>) -> f64 {
        let none = self.sizes.filled(0.0);
        let (mut first, mut second, mut watched) = (none, none, none);
        for i in 0..N {
            let (from, to) = (&start.data.0[0][i], &end.data.0[0][i]);
            let error = self.k.slope(DormandPrince::ERROR, i);
            // The step's own mean slope, less that of the method of order 3.
            let other = to.slopes.minus(from.slopes).minus(self.k.slope(DormandPrince::SECOND, i).times(h));
            let changed = from.slopes.abs().max(to.slopes.abs()).times_each(self.sizes);
            let (absolute, relative) = (self.scale.absolute.data.0[0][i], self.scale.relative);
            let size = changed.max(self.sizes.filled(to.value.abs())).times(relative);
            let part = self.sizes.over_each(self.sizes.filled(absolute).plus(size));
            first = first.max(error.abs().times_each(part));
            second = second.max(other.abs().times_each(part));
            watched = watched.plus(other.minus(other));
        }
        if watched.numbers() != [0.0; WIDTH] {
            return f64::NAN;
        }
        let [first, second] = [first, second].map(|of| of.numbers().into_iter().fold(0.0, f64::max));
        both(h.abs(), first, second / h.abs())
    }
}

impl<V: Slopes, const N: usize> Stages<V, N> {
    #[inline(always)]
    fn store(&mut self, stage: usize, rate: &SlopedIn<V, N>) {
        for (i, rate) in rate.data.0[0].iter().enumerate() {
            self.values[stage][i] = rate.value;
            self.slopes[stage][i] = rate.slopes;
        }
    }

    /// Writes the state `x`, moved by `h` times a combination of the stages, into `moved`.
    #[inline(always)]
    fn move_by(&self, x: &SlopedIn<V, N>, h: f64, row: Row, moved: &mut SlopedIn<V, N>) {
        let mut values = [0.0; N];
        for (i, value) in values.iter_mut().enumerate() {
            *value = row.iter().fold(0.0, |sum, &(stage, weight)| sum + weight * self.values[stage][i]);
        }
        for (i, moved) in moved.data.0[0].iter_mut().enumerate() {
            let x = &x.data.0[0][i];
            let slopes = x.slopes.plus(self.slope(row, i).times(h));
            *moved = GradientIn { value: x.value + h * values[i], slopes };
        }
    }

    /// The slopes of entry `i` of a combination of the stages, summed in their order.
    #[inline(always)]
    fn slope(&self, row: Row, i: usize) -> V {
        let (&(stage, weight), others) = row.split_first().expect("a combination has a stage");
        let first = self.slopes[stage][i].times(weight);
        others.iter().fold(first, |sum, &(stage, weight)| sum.plus(self.slopes[stage][i].times(weight)))
    }
}

impl<V, Sys, const N: usize, const G: usize> Steps<N, G> for Stepper<V, Sys, N>
where
    V: Slopes,
    Sys: System<GradientIn<V>, N, G>,
{
    fn cross(&mut self, negative: &[bool; G], from: f64, to: f64, x: &Sloped<N>, end: &mut Sloped<N>) -> bool {
        V::vectorized(Crossing { stepper: self, negative, from, to, x, end })
    }
}

/// A step, to be compiled for vectors.
struct Crossing<'a, V, Sys, const N: usize, const G: usize> {
    stepper: &'a mut Stepper<V, Sys, N>,
    negative: &'a [bool; G],
    from: f64,
    to: f64,
    x: &'a Sloped<N>,
    end: &'a mut Sloped<N>,
}

impl<V, Sys, const N: usize, const G: usize> NullaryFnOnce for Crossing<'_, V, Sys, N, G>
where
    V: Slopes,
    Sys: System<GradientIn<V>, N, G>,
{
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let Self { stepper, negative, from, to, x, end } = self;
        stepper.crossed(negative, from, to, x, end)
    }
}
