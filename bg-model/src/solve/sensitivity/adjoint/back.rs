//! One step of a run made again and followed backwards.
//!
//! In: the start of a step that a run has made, how the objective depends on the state at its end. Out: how it depends
//! on the state at its start, and on the model's constants. Method: the step made again by DOP853, and its stages in
//! reverse with the transposed tableau: with x_i = x + h sum a_ij k_j, k_i = f(x_i), y = x + h sum b_i k_i and a weight
//! l of y, that of k_i is h (b_i l + sum a_ji m_j), where m_j is the sweep of the rate at x_j with the weight of k_j; x
//! gets l + sum m_j. That is the exact derivative of what the step calculates, by as many sweeps as there are stages
//! (E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), section VI.4; W. W. Hager, Numer. Math. 87
//! (2000)). An integral over the run is the step's quadrature h sum b_i g(x_i).
//!
//! As forward slopes do, it divides a step into equal parts where DOP853 is far too inexact: of a run by DOP853 never.

use nalgebra::SVector;
use pulp::NullaryFnOnce;

use super::lifted::{Lifted, Sloped, weighted};
use crate::model::capability::Reversed;
use crate::model::scalar::{Gradient, Scalar};
use crate::model::system::Model;
use crate::solve::integrator::{Arch, DormandPrince, Row, Scale, Tableau, both};

/// The stages of a step.
const STAGES: usize = DormandPrince::END;
/// Parts of a step at most.
const MOST_PARTS: u32 = 1 << 16;
/// The estimated error of a part, in parts of what is allowed, from which on it is divided. A run by DOP853 has none
/// above 1, or hardly more where a projection takes the error away.
const FAR: f64 = 100.0;

/// The state at the end of a step, before and after its projection.
pub(super) struct End<const N: usize> {
    pub raw: SVector<f64, N>,
    pub projected: SVector<f64, N>,
}

/// A step between two instants, s, in branches of the switches, from a state.
#[derive(Clone, Copy)]
pub(super) struct Crossing<'a, const N: usize, const G: usize> {
    pub from: f64,
    pub to: f64,
    pub negative: &'a [bool; G],
    pub x: &'a SVector<f64, N>,
}

/// The method with its work space.
pub(super) struct Back<'a, Mo, Re, Li, const N: usize, const M: usize> {
    model: &'a Mo,
    pub sweeps: &'a Re,
    /// The model in numbers with slopes, for what has no sweeps.
    pub lifted: Lifted<Li>,
    scale: Scale,
    arch: Arch,
    stages: Box<Stages<N>>,
    /// The start of each part of the last step.
    starts: Vec<SVector<f64, N>>,
    parts: u32,
    /// The factors of the outputs' integrals over the run; none where there are no integrals.
    pub integrand: Option<SVector<f64, M>>,
    /// The integral of the steps that were followed backwards.
    pub integral: f64,
    /// How the objective depends on each constant, as far as it was followed.
    pub by_constants: Vec<f64>,
}

/// The states and the rates of all stages, and the weights of the rates.
struct Stages<const N: usize> {
    states: [SVector<f64, N>; STAGES],
    rates: [SVector<f64, N>; STAGES],
    weights: [SVector<f64, N>; STAGES],
}

impl<'a, Mo, Re, Li, const N: usize, const M: usize> Back<'a, Mo, Re, Li, N, M> {
    pub fn new<const G: usize>(
        (model, sweeps, lifted): (&'a Mo, &'a Re, Lifted<Li>),
        scale: Scale,
        integrals: &[(usize, f64)],
    ) -> Self
    where
        Re: Reversed<f64, N, G, M>,
        Li: Model<Gradient, N, G, M>,
    {
        let none = [SVector::zeros(); STAGES];
        let mut factors = SVector::zeros();
        integrals.iter().for_each(|&(output, factor)| factors[output] += factor);
        Self {
            model,
            sweeps,
            lifted,
            scale,
            arch: Arch::new(),
            stages: Box::new(Stages { states: none, rates: none, weights: none }),
            starts: Vec::new(),
            parts: 1,
            integrand: (!integrals.is_empty()).then_some(factors),
            integral: 0.0,
            by_constants: vec![0.0; sweeps.constants().len()],
        }
    }

    /// Makes a step again; its last part stays in the work space. None where it is not finite, however it is divided.
    pub fn cross<const G: usize>(&mut self, step: Crossing<N, G>) -> Option<End<N>>
    where
        Mo: Model<f64, N, G, M>,
    {
        while self.parts <= MOST_PARTS {
            self.starts.clear();
            let h = (step.to - step.from) / f64::from(self.parts);
            let (mut x, mut worst) = (*step.x, 0.0_f64);
            for part in 0..self.parts {
                self.starts.push(x);
                let (arch, t) = (self.arch, step.from + f64::from(part) * h);
                let error = arch.dispatch(Forwards { back: self, negative: step.negative, t, h, x: &mut x });
                worst = if error <= worst { worst } else { error };
                if worst.is_nan() || worst > FAR {
                    break;
                }
            }
            if worst <= FAR {
                let mut projected = x;
                self.model.project(step.to, step.negative, &mut projected);
                return Some(End { raw: x, projected });
            }
            self.parts *= 2;
        }
        None
    }

    /// Follows a step backwards: replaces the `weights` of the state at its end by those of the state at its start.
    /// Gives whether it did. Only a whole step adds to the integral.
    pub fn follow<const G: usize>(
        &mut self,
        step: Crossing<N, G>,
        is_whole: bool,
        weights: &mut SVector<f64, N>,
    ) -> bool
    where
        Mo: Model<f64, N, G, M>,
        Re: Reversed<f64, N, G, M>,
        Li: Model<Gradient, N, G, M>,
    {
        let Some(end) = self.cross(step) else { return false };
        self.sweeps.reverse_project(step.to, &end.raw, step.negative, weights, &mut self.by_constants);
        let (arch, h) = (self.arch, (step.to - step.from) / f64::from(self.parts));
        for part in (0..self.parts).rev() {
            let t = step.from + f64::from(part) * h;
            if part + 1 < self.parts {
                let mut x = self.starts[part as usize];
                arch.dispatch(Forwards { back: self, negative: step.negative, t, h, x: &mut x });
            }
            arch.dispatch(Backwards { back: self, negative: step.negative, t, h, is_whole, weights });
        }
        self.parts = (self.parts / 2).max(1);
        weights.iter().all(|weight| weight.is_finite())
    }

    /// How a weighted sum of the outputs at `t` (s) depends on the state `x` there.
    pub fn by_outputs<const G: usize>(
        &mut self,
        t: f64,
        x: &SVector<f64, N>,
        negative: &[bool; G],
        weights: &SVector<f64, M>,
    ) -> SVector<f64, N>
    where
        Re: Reversed<f64, N, G, M>,
        Li: Model<Gradient, N, G, M>,
    {
        let mut by_state = SVector::zeros();
        if self.sweeps.reverse_outputs(t, x, negative, weights, &mut by_state, &mut self.by_constants) {
            return by_state;
        }
        let slopes = |system: &Li, x: &Sloped<N>| {
            let mut outputs = SVector::repeat(Gradient::from_f64(0.0));
            system.outputs(Gradient::from_f64(t), x, negative, &mut outputs);
            weighted(outputs.as_slice(), weights.as_slice())
        };
        self.lifted.add_by_parameters(1.0, |system| slopes(system, &x.map(Gradient::from_f64)));
        self.lifted.by_states(x, slopes)
    }

    /// Replaces the state by that at the end of one part; gives the norm of its error, DOP853's.
    #[inline(always)]
    fn forwards<const G: usize>(&mut self, negative: &[bool; G], t: f64, h: f64, x: &mut SVector<f64, N>) -> f64
    where
        Mo: Model<f64, N, G, M>,
    {
        let Stages { states, rates, .. } = &mut *self.stages;
        for stage in 0..STAGES {
            states[stage] = *x;
            macro_rules! written_out {
                ($($stage:literal)*) => {
                    match stage {
                        $( $stage => add(&mut states[stage], h, const { DormandPrince::A[$stage] }, rates), )*
                        _ => {}
                    }
                };
            }
            written_out!(1 2 3 4 5 6 7 8 9 10 11);
            self.model.inlined_rate(t + DormandPrince::C[stage] * h, &states[stage], negative, &mut rates[stage]);
        }
        let start = *x;
        add(x, h, DormandPrince::B, rates);
        let (mut first, mut second) = (0.0_f64, 0.0_f64);
        for i in 0..N {
            let (from, to) = (start.data.0[0][i], x.data.0[0][i]);
            let allowed = self.scale.allowed_between(i, from, to);
            let other = (to - from) / h - combine(DormandPrince::SECOND, rates, i);
            first = first.max((combine(DormandPrince::ERROR, rates, i) / allowed).abs());
            second = second.max((other / allowed).abs());
        }
        if x.iter().all(|x| x.is_finite()) { both(h.abs(), first, second) } else { f64::NAN }
    }

    /// Replaces the weights of the state at the end of one part, whose stages are known, by those of the state at its
    /// start.
    #[inline(always)]
    fn backwards<const G: usize>(
        &mut self,
        negative: &[bool; G],
        t: f64,
        h: f64,
        is_whole: bool,
        by_end: &mut SVector<f64, N>,
    ) where
        Mo: Model<f64, N, G, M>,
        Re: Reversed<f64, N, G, M>,
        Li: Model<Gradient, N, G, M>,
    {
        let b: [f64; STAGES] = const { dense(DormandPrince::B) };
        for (weights, b) in self.stages.weights.iter_mut().zip(b) {
            *weights = *by_end * (h * b);
        }
        let mut by_stage = SVector::zeros();
        for stage in (0..STAGES).rev() {
            let t = t + DormandPrince::C[stage] * h;
            let Stages { states, weights, .. } = &mut *self.stages;
            self.sweeps.reverse_rate(
                t,
                &states[stage],
                negative,
                &weights[stage],
                &mut by_stage,
                &mut self.by_constants,
            );
            if let (Some(factors), true) = (self.integrand, is_whole && b[stage] != 0.0) {
                let (x, mut outputs) = (states[stage], SVector::zeros());
                self.model.outputs(t, &x, negative, &mut outputs);
                self.integral += h * b[stage] * factors.dot(&outputs);
                by_stage += self.by_outputs(t, &x, negative, &(factors * (h * b[stage])));
            }
            let weights = &mut self.stages.weights;
            *by_end += by_stage;
            macro_rules! written_out {
                ($($stage:literal)*) => {
                    match stage {
                        $( $stage => hand_on(&by_stage, h, const { DormandPrince::A[$stage] }, weights), )*
                        _ => {}
                    }
                };
            }
            written_out!(1 2 3 4 5 6 7 8 9 10 11);
        }
    }
}

/// A row with its zeros.
const fn dense(row: Row) -> [f64; STAGES] {
    let (mut all, mut k) = ([0.0; STAGES], 0);
    while k < row.len() {
        all[row[k].0] = row[k].1;
        k += 1;
    }
    all
}

/// Entry `i` of a combination of stages, summed in their order.
#[inline(always)]
fn combine<const N: usize>(row: Row, stages: &[SVector<f64, N>; STAGES], i: usize) -> f64 {
    row.iter().fold(-0.0, |sum, &(stage, weight)| sum + weight * stages[stage].data.0[0][i])
}

/// Adds to a state `h` times a combination of the rates.
#[inline(always)]
fn add<const N: usize>(x: &mut SVector<f64, N>, h: f64, row: Row, rates: &[SVector<f64, N>; STAGES]) {
    for (i, x) in x.data.0[0].iter_mut().enumerate() {
        *x += h * combine(row, rates, i);
    }
}

/// Hands the weights of a stage's state on to the rates that it is made of.
#[inline(always)]
fn hand_on<const N: usize>(by_state: &SVector<f64, N>, h: f64, row: Row, weights: &mut [SVector<f64, N>; STAGES]) {
    for &(stage, a) in row {
        let part = h * a;
        let weights = weights[stage].data.0[0].iter_mut();
        weights.zip(&by_state.data.0[0]).for_each(|(weight, by)| *weight += part * by);
    }
}

/// A part to be made again, compiled for vectors.
struct Forwards<'b, 'a, Mo, Re, Li, const N: usize, const G: usize, const M: usize> {
    back: &'b mut Back<'a, Mo, Re, Li, N, M>,
    negative: &'b [bool; G],
    t: f64,
    h: f64,
    x: &'b mut SVector<f64, N>,
}

impl<Mo, Re, Li, const N: usize, const G: usize, const M: usize> NullaryFnOnce for Forwards<'_, '_, Mo, Re, Li, N, G, M>
where
    Mo: Model<f64, N, G, M>,
{
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let Self { back, negative, t, h, x } = self;
        back.forwards(negative, t, h, x)
    }
}

/// A part to be followed backwards, compiled for vectors.
struct Backwards<'b, 'a, Mo, Re, Li, const N: usize, const G: usize, const M: usize> {
    back: &'b mut Back<'a, Mo, Re, Li, N, M>,
    negative: &'b [bool; G],
    t: f64,
    h: f64,
    is_whole: bool,
    weights: &'b mut SVector<f64, N>,
}

impl<Mo, Re, Li, const N: usize, const G: usize, const M: usize> NullaryFnOnce
    for Backwards<'_, '_, Mo, Re, Li, N, G, M>
where
    Mo: Model<f64, N, G, M>,
    Re: Reversed<f64, N, G, M>,
    Li: Model<Gradient, N, G, M>,
{
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { back, negative, t, h, is_whole, weights } = self;
        back.backwards(negative, t, h, is_whole, weights);
    }
}
