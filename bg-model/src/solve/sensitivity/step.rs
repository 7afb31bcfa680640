//! One step of a state with its derivatives along some directions.
//!
//! In: the start of a step that a run has made, a rate that takes numbers with slopes. Out: the state at its end, with slopes.
//! Method: DOP853 on the state with its slopes, which is the same method on S' = J S + df/dp with the exact J and df/dp of every
//! stage. The step is divided into equal parts until the estimated error of the slopes is what is allowed: for a change of the
//! direction by its size, what is allowed of the state (as in A. C. Hindmarsh and others, SUNDIALS, ACM TOMS 31 (2005), section 2.6).

use nalgebra::SVector;

use crate::model::scalar::{Gradient, Scalar};
use crate::model::system::System;
use crate::solve::integrator::{DormandPrince, Row, Scale, Tableau};

/// The directions that are followed at once.
pub(super) const WIDTH: usize = Gradient::WIDTH;

/// A state with slopes.
pub(super) type Sloped<const N: usize> = SVector<Gradient, N>;

/// The stages of a step.
const STAGES: usize = DormandPrince::END;
/// Parts of a step at most.
const MOST_PARTS: u32 = 1 << 16;
/// Errors below this let the next step have half as many parts: a twofold step errs 2^8 times as much.
const SMALL: f64 = 1.0 / 512.0;

/// The method with its work space.
#[derive(Debug)]
pub(super) struct Stepper<const N: usize> {
    k: Box<[Sloped<N>; STAGES]>,
    /// The parts of the last step.
    parts: u32,
    /// What is allowed of a state.
    scale: Scale<N>,
    /// The size of each direction, in its unit.
    sizes: [f64; WIDTH],
}

impl<const N: usize> Stepper<N> {
    pub fn new(scale: Scale<N>, sizes: [f64; WIDTH]) -> Self {
        let k = Box::new([SVector::repeat(Gradient::from_f64(0.0)); STAGES]);
        Self { k, parts: 1, scale, sizes }
    }

    /// The state at the time `to` (s), from `x` at `from`; none where the slopes stay too inexact or are not finite.
    pub fn cross<Sys, const G: usize>(
        &mut self,
        system: &Sys,
        negative: &[bool; G],
        from: f64,
        to: f64,
        x: &Sloped<N>,
    ) -> Option<Sloped<N>>
    where
        Sys: System<Gradient, N, G>,
    {
        while self.parts <= MOST_PARTS {
            let h = (to - from) / f64::from(self.parts);
            let (mut reached, mut worst) = (*x, 0.0_f64);
            for part in 0..self.parts {
                let t = from + f64::from(part) * h;
                let error = self.attempt(system, negative, t, h, &mut reached);
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

    /// Replaces the state by that at the end of one part; gives the norm of its slopes' error.
    fn attempt<Sys, const G: usize>(
        &mut self,
        system: &Sys,
        negative: &[bool; G],
        t: f64,
        h: f64,
        x: &mut Sloped<N>,
    ) -> f64
    where
        Sys: System<Gradient, N, G>,
    {
        for stage in 0..DormandPrince::END {
            let mut state = *x;
            macro_rules! written_out {
                ($($stage:literal)*) => {
                    match stage {
                        $( $stage => move_by(&mut state, h, const { DormandPrince::A[$stage] }, &self.k), )*
                        _ => {}
                    }
                };
            }
            written_out!(1 2 3 4 5 6 7 8 9 10 11);
            let t = Gradient::new(t + DormandPrince::C[stage] * h, [0.0; WIDTH]);
            system.rate(t, &state, negative, &mut self.k[stage]);
        }
        let mut end = *x;
        move_by(&mut end, h, DormandPrince::B, &self.k);
        let error = self.error(h, x, &end);
        *x = end;
        error
    }

    /// The norm of the slopes' error: DOP853's, of its two differences to embedded methods.
    #[inline(always)]
    fn error(&self, h: f64, start: &Sloped<N>, end: &Sloped<N>) -> f64 {
        let (mut first, mut second) = ([0.0_f64; WIDTH], [0.0_f64; WIDTH]);
        let larger = |largest: f64, part: f64| if part <= largest { largest } else { part };
        for i in 0..N {
            let (from, to) = (&start.data.0[0][i], &end.data.0[0][i]);
            let error = combined(DormandPrince::ERROR, &self.k, i).slopes();
            // The step's own mean slope, less that of the method of order 3.
            let other = (*to - *from).plus(-h, &combined(DormandPrince::SECOND, &self.k, i)).slopes();
            let (from, value, to) = (from.slopes(), to.value.abs(), to.slopes());
            let (absolute, relative) = (self.scale.absolute.data.0[0][i], self.scale.relative);
            for l in 0..WIDTH {
                let changed = self.sizes[l] * larger(from[l].abs(), to[l].abs());
                let part = self.sizes[l] / (absolute + relative * larger(changed, value));
                first[l] = larger(first[l], (error[l] * part).abs());
                second[l] = larger(second[l], (other[l] * part).abs() / h.abs());
            }
        }
        let [first, second] = [first, second].map(|of| of.into_iter().fold(0.0, larger));
        let both = first * first + 0.01 * second * second;
        if both == 0.0 { 0.0 } else { h.abs() * first * first / both.sqrt() }
    }
}

/// Moves the state `x` by `h` times a combination of the stages, summed in their order.
#[inline(always)]
fn move_by<const N: usize>(x: &mut Sloped<N>, h: f64, row: Row, k: &[Sloped<N>; STAGES]) {
    for (i, x) in x.data.0[0].iter_mut().enumerate() {
        *x = x.plus(h, &combined(row, k, i));
    }
}

/// Entry `i` of a combination of the stages.
#[inline(always)]
fn combined<const N: usize>(row: Row, k: &[Sloped<N>; STAGES], i: usize) -> Gradient {
    let mut sum = Gradient::from_f64(0.0);
    for &(stage, weight) in row {
        sum = sum.plus(weight, &k[stage].data.0[0][i]);
    }
    sum
}
