//! One step of a state with its derivatives along some directions.
//!
//! In: the start of a step that a run has made, a rate that takes numbers with slopes. Out: the state at its end, with slopes.
//! Method: DOP853 on the state with its slopes, which is the same method on S' = J S + df/dp with the exact J and df/dp of every
//! stage. The step is divided into equal parts until the estimated error of the slopes is what is allowed: that of a state,
//! for a change of the direction by its size (A. C. Hindmarsh and others, SUNDIALS, ACM TOMS 31 (2005), section 2.6).

use nalgebra::SVector;
use pulp::{Arch, NullaryFnOnce};

use crate::model::scalar::Gradient;
use crate::model::system::System;
use crate::solve::integrator::{DormandPrince, Row, Scale, Tableau};

/// A state with slopes.
pub(super) type Sloped<const W: usize, const N: usize> = SVector<Gradient<W>, N>;

/// Parts of a step at most.
const MOST_PARTS: u32 = 1 << 16;
/// Errors below this let the next step have half as many parts: a twofold step errs 2^8 times as much.
const SMALL: f64 = 1.0 / 512.0;

/// The method with its work space.
#[derive(Debug)]
pub(super) struct Stepper<const W: usize, const N: usize> {
    k: Vec<Sloped<W, N>>,
    /// The parts of the last step.
    parts: u32,
    /// What is allowed of a state.
    scale: Scale<N>,
    /// The size of each direction, in its unit.
    sizes: [f64; W],
    arch: Arch,
}

impl<const W: usize, const N: usize> Stepper<W, N> {
    pub fn new(scale: Scale<N>, sizes: [f64; W]) -> Self {
        let k = vec![SVector::repeat(Gradient::new(0.0, [0.0; W])); DormandPrince::END];
        Self { k, parts: 1, scale, sizes, arch: Arch::new() }
    }

    /// The state at the time `to` (s), from `x` at `from`; none where the slopes stay too inexact or are not finite.
    pub fn cross<Sys, const G: usize>(
        &mut self,
        system: &Sys,
        negative: &[bool; G],
        from: f64,
        to: f64,
        x: &Sloped<W, N>,
    ) -> Option<Sloped<W, N>>
    where
        Sys: System<Gradient<W>, N, G>,
    {
        while self.parts <= MOST_PARTS {
            let h = (to - from) / f64::from(self.parts);
            let (mut reached, mut worst) = (*x, 0.0_f64);
            for part in 0..self.parts {
                let t = from + f64::from(part) * h;
                let attempt = Attempt { stepper: self, system, negative, t, h, x: &reached };
                let (end, error) = attempt.stepper.arch.dispatch(attempt);
                reached = end;
                worst = if error <= worst { worst } else { error };
                if worst.is_nan() || worst > 1.0 {
                    break;
                }
            }
            if worst <= 1.0 {
                if worst < SMALL && self.parts > 1 {
                    self.parts /= 2;
                }
                return Some(reached);
            }
            self.parts *= 2;
        }
        None
    }

    /// The state at the end of one part, and the norm of its slopes' error.
    #[inline(always)]
    fn attempt<Sys, const G: usize>(
        &mut self,
        system: &Sys,
        negative: &[bool; G],
        t: f64,
        h: f64,
        x: &Sloped<W, N>,
    ) -> (Sloped<W, N>, f64)
    where
        Sys: System<Gradient<W>, N, G>,
    {
        for stage in 0..DormandPrince::END {
            let state = moved(x, h, DormandPrince::A[stage], &self.k);
            let t = Gradient::new(t + DormandPrince::C[stage] * h, [0.0; W]);
            system.rate(t, &state, negative, &mut self.k[stage]);
        }
        let end = moved(x, h, DormandPrince::B, &self.k);
        let error = self.error(h, x, &end);
        (end, error)
    }

    /// The norm of the slopes' error: DOP853's, of its two differences to embedded methods.
    fn error(&self, h: f64, start: &Sloped<W, N>, end: &Sloped<W, N>) -> f64 {
        let (mut first, mut second) = (0.0_f64, 0.0_f64);
        for i in 0..N {
            let [slope, error, other] =
                [DormandPrince::B, DormandPrince::ERROR, DormandPrince::SECOND].map(|row| combined(row, &self.k, i));
            for l in 0..W {
                let (from, to) = (start[i].slopes[l].abs(), end[i].slopes[l].abs());
                let allowed = self.scale.absolute[i] / self.sizes[l] + self.scale.relative * from.max(to);
                let larger = |largest: f64, part: f64| if part <= largest { largest } else { part };
                first = larger(first, (error.slopes[l] / allowed).abs());
                second = larger(second, ((slope.slopes[l] - other.slopes[l]) / allowed).abs());
            }
        }
        let both = first * first + 0.01 * second * second;
        if both == 0.0 { 0.0 } else { h.abs() * first * first / both.sqrt() }
    }
}

/// One part of a step, for the vectors of the machine.
struct Attempt<'a, Sys, const W: usize, const N: usize, const G: usize> {
    stepper: &'a mut Stepper<W, N>,
    system: &'a Sys,
    negative: &'a [bool; G],
    t: f64,
    h: f64,
    x: &'a Sloped<W, N>,
}

impl<Sys, const W: usize, const N: usize, const G: usize> NullaryFnOnce for Attempt<'_, Sys, W, N, G>
where
    Sys: System<Gradient<W>, N, G>,
{
    type Output = (Sloped<W, N>, f64);

    #[inline(always)]
    fn call(self) -> Self::Output {
        self.stepper.attempt(self.system, self.negative, self.t, self.h, self.x)
    }
}

/// The state `x` moved by `h` times a combination of the stages.
#[inline(always)]
fn moved<const W: usize, const N: usize>(x: &Sloped<W, N>, h: f64, row: Row, k: &[Sloped<W, N>]) -> Sloped<W, N> {
    let mut moved = *x;
    for (i, moved) in moved.data.0[0].iter_mut().enumerate() {
        let change = combined(row, k, i);
        moved.value += h * change.value;
        moved.slopes.iter_mut().zip(change.slopes).for_each(|(slope, change)| *slope += h * change);
    }
    moved
}

/// Entry `i` of a combination of the stages, summed in their order.
#[inline(always)]
fn combined<const W: usize, const N: usize>(row: Row, k: &[Sloped<W, N>], i: usize) -> Gradient<W> {
    let mut sum = Gradient::new(0.0, [0.0; W]);
    for &(stage, weight) in row {
        let rate = &k[stage].data.0[0][i];
        sum.value += weight * rate.value;
        sum.slopes.iter_mut().zip(rate.slopes).for_each(|(sum, slope)| *sum += weight * slope);
    }
    sum
}
