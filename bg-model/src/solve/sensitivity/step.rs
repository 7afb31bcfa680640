//! One step of a state with its derivatives along some directions.
//!
//! In: the start of a step that a run has made, a rate that takes numbers with slopes. Out: the state at its end, with
//! slopes. Method: DOP853 on the state with its slopes, which is the same method on S' = J S + df/dp with the exact J
//! and df/dp of every stage: of a run by DOP853 the exact derivative of its steps, which is as exact as the run is, but
//! for a state at rest: its steps grow until they are unstable, which leaves it at rest but not its slopes. A step of
//! DOP853 in which slopes lose half of their digits is divided into equal parts; one of another method is until the
//! estimated error of the slopes is what is allowed: for a change of the direction by its whole size, what is allowed
//! of the state (as in A. C. Hindmarsh and others, SUNDIALS, ACM TOMS 31 (2005), section 2.6).
//!
//! A step has vectors of its own: those of the machine, in which nothing else is calculated, and it keeps the state in
//! them from step to step. All around it is [`Gradient`]. It is compiled once for each kind of vectors, whatever the
//! model: what is asked of that is compiled for the same vectors ([`Rates`]).

use pulp::NullaryFnOnce;

use crate::model::dynamics::Rates;
use crate::model::scalar::slopes::{Slopes, WIDTH};
use crate::model::scalar::{Gradient, GradientIn, Scalar};
use crate::solve::integrator::{DormandPrince, Point, Row, Scale, Tableau, both};

/// The stages of a step.
const STAGES: usize = DormandPrince::END;
/// Parts of a step at most.
const MOST_PARTS: u32 = 1 << 16;
/// Errors below this let the next step have half as many parts: a twofold step errs 2^8 times as much.
const SMALL: f64 = 1.0 / 512.0;

/// A state that follows the steps of a run, whatever its vectors. Its slopes are seen in parts, each those of a
/// [`Gradient`].
pub(super) trait Steps {
    /// Has come to the state `x`, as far as the slopes of this part are concerned.
    fn set(&mut self, part: usize, x: &[Gradient]);

    /// What is allowed of a state from here on.
    fn measure(&mut self, scale: &Scale);

    /// The state `x` with the slopes of this part where it has come to.
    fn now(&self, part: usize, x: &[f64]) -> Vec<Gradient>;

    /// Goes on by a step of the run, from one state to the other, whose values it takes, in the branches `negative`.
    /// Gives whether it did: not where the slopes stay too inexact or are not finite.
    fn pass(&mut self, negative: &[bool], start: &Point, end: &Point) -> bool;

    /// Looks at the time `to` (s) inside the last step, which started at `from`. Gives whether it could.
    fn look(&mut self, negative: &[bool], from: f64, to: f64) -> bool;

    /// The state `x` with the slopes of this part where it has looked at last.
    fn looked_at(&self, part: usize, x: &[f64]) -> Vec<Gradient>;
}

/// The method with its work space.
pub(super) struct Stepper<V> {
    system: Box<dyn Rates<V>>,
    /// The state at the start of the last step, at its end, and at a sample in it.
    from: Vec<GradientIn<V>>,
    now: Vec<GradientIn<V>>,
    between: Vec<GradientIn<V>>,
    work: Work<V>,
}

/// What a step is made with.
#[derive(Debug)]
struct Work<V> {
    k: Stages<V>,
    /// A rate, filled up to whole vectors of values.
    rate: Vec<GradientIn<V>>,
    /// The state at the start of a part of a step.
    begin: Vec<GradientIn<V>>,
    /// The parts of the last step.
    parts: u32,
    /// Whether the run's steps are of the same method.
    is_own: bool,
    /// What is allowed of a state.
    scale: Scale,
    /// The size of each direction, in its unit.
    sizes: V,
}

/// The rates of all stages: values and slopes apart, so that values fill vectors of their own.
#[derive(Debug)]
struct Stages<V> {
    /// Of as many states each as a vector has places.
    values: Vec<[V; STAGES]>,
    /// Of each state.
    slopes: Vec<[V; STAGES]>,
}

impl<V: Slopes> Stepper<V> {
    /// Steps of this system of so many states; `is_own`: of a run by DOP853. The error of slopes is measured with the
    /// scale of the states and the size of each direction.
    pub fn new(system: Box<dyn Rates<V>>, states: usize, is_own: bool, (scale, of_each): (Scale, &[f64])) -> Self {
        let nothing = vec![GradientIn::from_f64(0.0); states];
        let none = [V::filled(0.0); STAGES];
        let k = Stages { values: vec![none; states.div_ceil(V::LANES)], slopes: vec![none; states] };
        let mut sizes = V::filled(1.0).numbers();
        sizes.as_mut()[..of_each.len()].copy_from_slice(of_each);
        let rate = vec![GradientIn::from_f64(0.0); states.next_multiple_of(V::LANES)];
        let work = Work { k, rate, begin: nothing.clone(), parts: 1, is_own, scale, sizes: V::new(sizes) };
        Self { system, from: nothing.clone(), now: nothing.clone(), between: nothing, work }
    }
}

/// The state `x` gets these values.
pub(super) fn set_values<V>(x: &mut [GradientIn<V>], values: &[f64]) {
    x.iter_mut().zip(values).for_each(|(x, &value)| x.value = value);
}

/// The slopes of this part.
fn of_part<V: Slopes>(slopes: &[GradientIn<V>], part: usize, x: &[f64]) -> Vec<Gradient> {
    let of = |(slopes, &x): (&GradientIn<V>, &f64)| {
        let mut of_state = [0.0; WIDTH];
        of_state.copy_from_slice(&slopes.slopes().as_ref()[part * WIDTH..][..WIDTH]);
        Gradient::new(x, of_state)
    };
    slopes.iter().zip(x).map(of).collect()
}

impl<V: Slopes> Steps for Stepper<V> {
    fn set(&mut self, part: usize, x: &[Gradient]) {
        for (now, x) in self.now.iter_mut().zip(x) {
            let mut slopes = now.slopes();
            slopes.as_mut()[part * WIDTH..][..WIDTH].copy_from_slice(&x.slopes());
            *now = GradientIn::new(x.value, slopes);
        }
    }

    fn measure(&mut self, scale: &Scale) {
        self.work.scale = scale.clone();
    }

    fn now(&self, part: usize, x: &[f64]) -> Vec<Gradient> {
        of_part(&self.now, part, x)
    }

    fn pass(&mut self, negative: &[bool], start: &Point, end: &Point) -> bool {
        let Self { system, from, now, work, .. } = self;
        let system = &**system;
        core::mem::swap(from, now);
        set_values(from, start.x.as_slice());
        let is_exact = V::vectorized(Crossing { work, system, negative, span: [start.t, end.t], x: from, end: now });
        set_values(now, end.x.as_slice());
        is_exact
    }

    fn look(&mut self, negative: &[bool], from: f64, to: f64) -> bool {
        let Self { system, from: start, between, work, .. } = self;
        let system = &**system;
        V::vectorized(Crossing { work, system, negative, span: [from, to], x: start, end: between })
    }

    fn looked_at(&self, part: usize, x: &[f64]) -> Vec<Gradient> {
        of_part(&self.between, part, x)
    }
}

/// A step, to be compiled for vectors.
struct Crossing<'a, V> {
    work: &'a mut Work<V>,
    system: &'a dyn Rates<V>,
    negative: &'a [bool],
    /// From when to when, s.
    span: [f64; 2],
    x: &'a [GradientIn<V>],
    end: &'a mut [GradientIn<V>],
}

impl<V: Slopes> NullaryFnOnce for Crossing<'_, V> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let Self { work, system, negative, span, x, end } = self;
        work.cross(system, negative, span, x, end)
    }
}

impl<V: Slopes> Work<V> {
    /// Writes the state at the end of the time `from`..`to` (s), at whose start it is `x`, into `end`, projected.
    #[inline(always)]
    fn cross(
        &mut self,
        system: &dyn Rates<V>,
        negative: &[bool],
        [from, to]: [f64; 2],
        x: &[GradientIn<V>],
        end: &mut [GradientIn<V>],
    ) -> bool {
        while self.parts <= MOST_PARTS {
            let h = (to - from) / f64::from(self.parts);
            let mut worst = 0.0;
            for part in 0..self.parts {
                if part == 0 {
                    self.begin.copy_from_slice(x);
                } else {
                    self.begin.copy_from_slice(end);
                }
                let error = self.attempt(system, negative, from + f64::from(part) * h, h, end);
                worst = if error <= worst { worst } else { error };
                if worst.is_nan() || worst > 1.0 {
                    break;
                }
            }
            if worst <= 1.0 {
                if worst < SMALL && self.parts > 1 {
                    self.parts /= 2;
                }
                system.project(to, negative, end);
                return true;
            }
            self.parts *= 2;
        }
        false
    }

    /// Writes the state at the end of one part, from the start that this has, into `end`; gives the norm of its slopes'
    /// error.
    #[inline(always)]
    fn attempt(&mut self, system: &dyn Rates<V>, negative: &[bool], t: f64, h: f64, end: &mut [GradientIn<V>]) -> f64 {
        let none = self.sizes.alike(0.0);
        for stage in 0..STAGES {
            // In the machine's widest vectors the sums are written out, so that each finds its weights as constants.
            if V::MUST_BE_INLINED {
                macro_rules! written_out {
                    ($($stage:literal)*) => {
                        match stage {
                            $( $stage => {
                                self.k.move_by(none, &self.begin, h, const { DormandPrince::A[$stage] }, end);
                            } )*
                            _ => {}
                        }
                    };
                }
                written_out!(1 2 3 4 5 6 7 8 9 10 11);
            } else if stage > 0 {
                self.k.move_by(none, &self.begin, h, DormandPrince::A[stage], end);
            }
            let state = if stage == 0 { &self.begin[..] } else { &*end };
            system.rate(t + DormandPrince::C[stage] * h, state, negative, &mut self.rate[..self.begin.len()]);
            self.k.store(stage, &self.rate);
        }
        self.k.move_by(none, &self.begin, h, DormandPrince::B, end);
        if !self.is_finite(end) { f64::NAN } else { self.error(h, end) }
    }

    /// Whether all slopes are.
    #[inline(always)]
    fn is_finite(&self, x: &[GradientIn<V>]) -> bool {
        let nothing = x.iter().fold(self.sizes.alike(0.0), |sum, x| sum.plus(x.slopes.minus(x.slopes)));
        nothing.numbers().as_ref().iter().all(|&number| number == 0.0)
    }

    /// The norm of the slopes' error, above 1 where a step is to be divided. Of another method's steps the difference
    /// to DOP853's embedded method of order 5: together with that to order 3, as of a run's own steps, it says a
    /// hundred times too little where a joint rings. Of DOP853's own steps both, where they take half of the digits.
    #[inline(always)]
    fn error(&self, h: f64, end: &[GradientIn<V>]) -> f64 {
        let none = self.sizes.alike(0.0);
        let (mut first, mut second) = (none, none);
        for (((from, to), k), &absolute) in self.begin.iter().zip(end).zip(&self.k.slopes).zip(&self.scale.absolute) {
            let [error, other_error] =
                [DormandPrince::ERROR, DormandPrince::OTHER_ERROR].map(|row| combined(k, row).abs());
            // The step's own mean slope, less that of the method of order 3.
            let other = to.slopes.minus(from.slopes).minus(combined(k, DormandPrince::SECOND).scaled(h));
            let changed = from.slopes.abs().larger(to.slopes.abs()).times(self.sizes);
            let size = changed.larger(none.alike(to.value.abs())).scaled(self.scale.relative);
            let part = self.sizes.over(none.alike(absolute).plus(size));
            first = first.larger(other_error.larger(error).times(part));
            second = second.larger(other.abs().times(part));
        }
        let [first, second] = [first, second].map(|of| of.numbers().as_ref().iter().copied().fold(0.0, f64::max));
        if self.is_own { both(1.0, h.abs() * first, second) * self.scale.relative.sqrt() } else { h.abs() * first }
    }
}

impl<V: Slopes> Stages<V> {
    #[inline(always)]
    fn store(&mut self, stage: usize, rate: &[GradientIn<V>]) {
        // Whole chunks: so the numbers of one go from registers into a vector, and not through memory.
        for (k, rates) in self.values.iter_mut().zip(rate.chunks_exact(V::LANES)) {
            let mut values = V::filled(0.0).numbers();
            values.as_mut().iter_mut().zip(rates).for_each(|(value, rate)| *value = rate.value);
            k[stage] = V::new(values);
        }
        for (k, rate) in self.slopes.iter_mut().zip(rate) {
            k[stage] = rate.slopes;
        }
    }

    /// Writes the state `x`, moved by `h` times a combination of the stages, into `moved`; `none` is zero.
    #[inline(always)]
    fn move_by(&self, none: V, x: &[GradientIn<V>], h: f64, row: Row, moved: &mut [GradientIn<V>]) {
        for ((k, x), moved) in self.values.iter().zip(x.chunks(V::LANES)).zip(moved.chunks_mut(V::LANES)) {
            let values = row.iter().fold(none, |sum, &(stage, weight)| sum.plus(k[stage].scaled(weight))).numbers();
            let each = moved.iter_mut().zip(x).zip(values.as_ref());
            each.for_each(|((moved, x), value)| moved.value = x.value + h * value);
        }
        for ((k, x), moved) in self.slopes.iter().zip(x).zip(moved) {
            moved.slopes = x.slopes.plus(combined(k, row).scaled(h));
        }
    }
}

/// A combination of the stages of one state's slopes, summed in their order.
#[inline(always)]
fn combined<V: Slopes>(k: &[V; STAGES], row: Row) -> V {
    let (&(stage, weight), others) = row.split_first().expect("a combination has a stage");
    others.iter().fold(k[stage].scaled(weight), |sum, &(stage, weight)| sum.plus(k[stage].scaled(weight)))
}
