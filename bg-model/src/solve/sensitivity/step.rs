//! One step of a state with its derivatives along some directions.
//!
//! In: the start of a step that a run has made, a rate that takes numbers with slopes. Out: the state at its end, with
//! slopes. Method: DOP853 on the state with its slopes, which is the same method on S' = J S + df/dp with the exact J
//! and df/dp of every stage: of a run by DOP853 the exact derivative of its steps, which is as exact as the run is.
//! Steps of another method are divided into equal parts until the estimated error of the slopes is what is allowed: for
//! a change of the direction by its size, what is allowed of the state (as in A. C. Hindmarsh and others, SUNDIALS, ACM
//! TOMS 31 (2005), section 2.6).
//!
//! A step has vectors of its own: those of the machine, in which nothing else is calculated, and it keeps the state in
//! them from step to step. All around it is [`Gradient`].

use nalgebra::SVector;
use pulp::NullaryFnOnce;

use crate::model::scalar::gradient::GradientIn;
use crate::model::scalar::slopes::{Slopes, WIDTH};
use crate::model::scalar::{Gradient, Scalar};
use crate::model::system::System;
use crate::solve::integrator::{DormandPrince, Point, Row, Scale, Tableau, both};

/// A state with slopes.
pub(super) type Sloped<const N: usize> = SVector<Gradient, N>;
/// The same in the vectors of a step.
type SlopedIn<V, const N: usize> = SVector<GradientIn<V>, N>;

/// The value of some numbers with the slopes of all of them side by side.
pub(super) fn joined<V: Slopes>(numbers: &[Gradient]) -> GradientIn<V> {
    let mut slopes = V::filled(0.0).numbers();
    let places = slopes.as_mut().chunks_exact_mut(WIDTH);
    places.zip(numbers).for_each(|(place, number)| place.copy_from_slice(&number.slopes()));
    GradientIn::new(numbers[0].value, slopes)
}

/// The stages of a step.
const STAGES: usize = DormandPrince::END;
/// Parts of a step at most.
const MOST_PARTS: u32 = 1 << 16;
/// Errors below this let the next step have half as many parts: a twofold step errs 2^8 times as much.
const SMALL: f64 = 1.0 / 512.0;

/// A state that follows the steps of a run, whatever its vectors. Its slopes are seen in parts, each those of a
/// [`Gradient`].
pub(super) trait Steps<const N: usize, const G: usize> {
    /// Has come to the state `x`, as far as the slopes of this part are concerned.
    fn set(&mut self, part: usize, x: &Sloped<N>);

    /// What is allowed of a state from here on.
    fn measure(&mut self, scale: &Scale);

    /// The state `x` with the slopes of this part where it has come to.
    fn now(&self, part: usize, x: &[f64]) -> Sloped<N>;

    /// Goes on by a step of the run, from one state to the other, whose values it takes, in the branches `negative`.
    /// Gives whether it did: not where the slopes stay too inexact or are not finite.
    fn pass(&mut self, negative: &[bool; G], start: &Point, end: &Point) -> bool;

    /// Looks at the time `to` (s) inside the last step, which started at `from`. Gives whether it could.
    fn look(&mut self, negative: &[bool; G], from: f64, to: f64) -> bool;

    /// The state `x` with the slopes of this part where it has looked at last.
    fn looked_at(&self, part: usize, x: &[f64]) -> Sloped<N>;
}

/// The method with its work space.
#[derive(Debug)]
pub(super) struct Stepper<V, Sys, const N: usize> {
    system: Box<Sys>,
    /// The state at the start of the last step, at its end, and at a sample in it.
    from: Box<SlopedIn<V, N>>,
    now: Box<SlopedIn<V, N>>,
    between: Box<SlopedIn<V, N>>,
    work: Work<V, N>,
}

/// What a step is made with.
#[derive(Debug)]
struct Work<V, const N: usize> {
    k: Box<Stages<V, N>>,
    /// The parts of the last step.
    parts: u32,
    /// Whether errors are estimated: not where the run's steps are of the same method.
    is_estimated: bool,
    /// What is allowed of a state.
    scale: Scale,
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
    /// Steps of this system. Errors, where they are estimated, are measured with the scale of the states and the size
    /// of each direction.
    pub fn new(system: Box<Sys>, is_estimated: bool, (scale, of_each): (Scale, &[f64])) -> Self {
        let nothing: Box<SlopedIn<V, N>> = Box::new(SVector::repeat(GradientIn::from_f64(0.0)));
        let k = Box::new(Stages { values: [[0.0; N]; STAGES], slopes: [[V::filled(0.0); N]; STAGES] });
        let mut sizes = V::filled(1.0).numbers();
        sizes.as_mut()[..of_each.len()].copy_from_slice(of_each);
        let work = Work { k, parts: 1, is_estimated, scale, sizes: V::new(sizes) };
        Self { system, from: nothing.clone(), now: nothing.clone(), between: nothing, work }
    }
}

/// The state `x` gets these values.
pub(super) fn set_values<V, const N: usize>(x: &mut SlopedIn<V, N>, values: &[f64]) {
    x.data.0[0].iter_mut().zip(values).for_each(|(x, &value)| x.value = value);
}

/// The slopes of this part.
fn of_part<V: Slopes, const N: usize>(slopes: &SlopedIn<V, N>, part: usize, x: &[f64]) -> Sloped<N> {
    SVector::from_fn(|i, _| {
        let mut of_state = [0.0; WIDTH];
        of_state.copy_from_slice(&slopes[i].slopes().as_ref()[part * WIDTH..][..WIDTH]);
        Gradient::new(x[i], of_state)
    })
}

impl<V, Sys, const N: usize, const G: usize> Steps<N, G> for Stepper<V, Sys, N>
where
    V: Slopes,
    Sys: System<GradientIn<V>, N, G>,
{
    fn set(&mut self, part: usize, x: &Sloped<N>) {
        for (now, x) in self.now.iter_mut().zip(x) {
            let mut slopes = now.slopes();
            slopes.as_mut()[part * WIDTH..][..WIDTH].copy_from_slice(&x.slopes());
            *now = GradientIn::new(x.value, slopes);
        }
    }

    fn measure(&mut self, scale: &Scale) {
        self.work.scale = scale.clone();
    }

    fn now(&self, part: usize, x: &[f64]) -> Sloped<N> {
        of_part(&self.now, part, x)
    }

    fn pass(&mut self, negative: &[bool; G], start: &Point, end: &Point) -> bool {
        let Self { system, from, now, work, .. } = self;
        let system = &**system;
        core::mem::swap(from, now);
        set_values(from, start.x.as_slice());
        let is_exact = V::vectorized(Crossing { work, system, negative, span: [start.t, end.t], x: from, end: now });
        set_values(now, end.x.as_slice());
        is_exact
    }

    fn look(&mut self, negative: &[bool; G], from: f64, to: f64) -> bool {
        let Self { system, from: start, between, work, .. } = self;
        let system = &**system;
        V::vectorized(Crossing { work, system, negative, span: [from, to], x: start, end: between })
    }

    fn looked_at(&self, part: usize, x: &[f64]) -> Sloped<N> {
        of_part(&self.between, part, x)
    }
}

/// A step, to be compiled for vectors.
struct Crossing<'a, V, Sys, const N: usize, const G: usize> {
    work: &'a mut Work<V, N>,
    system: &'a Sys,
    negative: &'a [bool; G],
    /// From when to when, s.
    span: [f64; 2],
    x: &'a SlopedIn<V, N>,
    end: &'a mut SlopedIn<V, N>,
}

impl<V, Sys, const N: usize, const G: usize> NullaryFnOnce for Crossing<'_, V, Sys, N, G>
where
    V: Slopes,
    Sys: System<GradientIn<V>, N, G>,
{
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let Self { work, system, negative, span, x, end } = self;
        work.cross(system, negative, span, x, end)
    }
}

impl<V: Slopes, const N: usize> Work<V, N> {
    /// Writes the state at the end of the time `from`..`to` (s), at whose start it is `x`, into `end`, projected.
    #[inline(always)]
    fn cross<Sys, const G: usize>(
        &mut self,
        system: &Sys,
        negative: &[bool; G],
        [from, to]: [f64; 2],
        x: &SlopedIn<V, N>,
        end: &mut SlopedIn<V, N>,
    ) -> bool
    where
        Sys: System<GradientIn<V>, N, G>,
    {
        while self.parts <= MOST_PARTS {
            let h = (to - from) / f64::from(self.parts);
            let mut worst = self.attempt(system, negative, from, h, x, end);
            for part in 1..self.parts {
                if worst.is_nan() || worst > 1.0 {
                    break;
                }
                let (t, begin) = (from + f64::from(part) * h, *end);
                let error = self.attempt(system, negative, t, h, &begin, end);
                worst = if error <= worst { worst } else { error };
            }
            if worst <= 1.0 {
                if worst < SMALL && self.parts > 1 {
                    self.parts /= 2;
                }
                let to = GradientIn::from_f64(to);
                if V::MUST_BE_INLINED {
                    system.inlined_project(to, negative, end);
                } else {
                    system.project(to, negative, end);
                }
                return true;
            }
            self.parts *= 2;
        }
        false
    }

    /// Writes the state at the end of one part, at whose start it is `x`, into `end`; gives the norm of its slopes'
    /// error.
    #[inline(always)]
    fn attempt<Sys, const G: usize>(
        &mut self,
        system: &Sys,
        negative: &[bool; G],
        t: f64,
        h: f64,
        x: &SlopedIn<V, N>,
        end: &mut SlopedIn<V, N>,
    ) -> f64
    where
        Sys: System<GradientIn<V>, N, G>,
    {
        let none = GradientIn { value: 0.0, slopes: self.sizes.alike(0.0) };
        let mut rate = SVector::repeat(none);
        for stage in 0..STAGES {
            // In the machine's widest vectors the sums are written out, so that each finds its weights as constants.
            if V::MUST_BE_INLINED {
                macro_rules! written_out {
                    ($($stage:literal)*) => {
                        match stage {
                            $( $stage => self.k.move_by(x, h, const { DormandPrince::A[$stage] }, end), )*
                            _ => {}
                        }
                    };
                }
                written_out!(1 2 3 4 5 6 7 8 9 10 11);
            } else if stage > 0 {
                self.k.move_by(x, h, DormandPrince::A[stage], end);
            }
            let (t, state) =
                (GradientIn::from_f64(t + DormandPrince::C[stage] * h), if stage == 0 { x } else { &*end });
            if V::MUST_BE_INLINED {
                system.always_inlined_rate(t, state, negative, &mut rate);
            } else {
                system.rate(t, state, negative, &mut rate);
            }
            self.k.store(stage, &rate);
        }
        self.k.move_by(x, h, DormandPrince::B, end);
        if !self.is_finite(end) {
            f64::NAN
        } else if self.is_estimated {
            self.error(h, x, end)
        } else {
            0.0
        }
    }

    /// Whether all slopes are.
    #[inline(always)]
    fn is_finite(&self, x: &SlopedIn<V, N>) -> bool {
        let [x] = &x.data.0;
        let nothing = x.iter().fold(self.sizes.alike(0.0), |sum, x| sum.plus(x.slopes.minus(x.slopes)));
        nothing.numbers().as_ref().iter().all(|&number| number == 0.0)
    }

    /// The norm of the slopes' error: DOP853's, of its two differences to embedded methods.
    #[inline(always)]
    fn error(&self, h: f64, start: &SlopedIn<V, N>, end: &SlopedIn<V, N>) -> f64 {
        let none = self.sizes.alike(0.0);
        let (mut first, mut second) = (none, none);
        for i in 0..N {
            let (from, to) = (&start.data.0[0][i], &end.data.0[0][i]);
            let error = self.k.slope(DormandPrince::ERROR, i);
            // The step's own mean slope, less that of the method of order 3.
            let other = to.slopes.minus(from.slopes).minus(self.k.slope(DormandPrince::SECOND, i).scaled(h));
            let changed = from.slopes.abs().larger(to.slopes.abs()).times(self.sizes);
            let (absolute, relative) = (self.scale.absolute[i], self.scale.relative);
            let size = changed.larger(none.alike(to.value.abs())).scaled(relative);
            let part = self.sizes.over(none.alike(absolute).plus(size));
            first = first.larger(error.abs().times(part));
            second = second.larger(other.abs().times(part));
        }
        let [first, second] = [first, second].map(|of| of.numbers().as_ref().iter().copied().fold(0.0, f64::max));
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
            let slopes = x.slopes.plus(self.slope(row, i).scaled(h));
            *moved = GradientIn { value: x.value + h * values[i], slopes };
        }
    }

    /// The slopes of entry `i` of a combination of the stages, summed in their order.
    #[inline(always)]
    fn slope(&self, row: Row, i: usize) -> V {
        let (&(stage, weight), others) = row.split_first().expect("a combination has a stage");
        let first = self.slopes[stage][i].scaled(weight);
        others.iter().fold(first, |sum, &(stage, weight)| sum.plus(self.slopes[stage][i].scaled(weight)))
    }
}
