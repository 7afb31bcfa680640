//! One step of a run made again and followed backwards.
//!
//! In: the start of a step that a run has made, how the objective depends on the state at its end. Out: how it depends
//! on the state at its start, and on the model's constants. Method: the step made again by DOP853, and its stages in
//! reverse with the transposed tableau ([`Transposed`]), where the weight of a stage's state is the sweep of the rate
//! there; the start has all of these and that of the end. That is the exact derivative of what the step calculates, by
//! as many sweeps as there are stages (E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), section
//! VI.4; W. W. Hager, Numer. Math. 87 (2000)). An integral over the run is the step's quadrature h sum b_i g(x_i).
//!
//! As forward slopes do, it divides a step into equal parts: where DOP853 is far too inexact, which of a run by DOP853
//! it never is, and where the weights would be. A state at rest says nothing about these: a step by which DOP853 is
//! unstable leaves it at rest. So from time to time, and before longer steps, a step is followed in twice as many parts
//! as well.

use pulp::NullaryFnOnce;

use super::lifted::{Lifted, weighted};
use crate::model::dynamics::{Machine, Swept};
use crate::model::scalar::{Gradient, Scalar};
use crate::solve::integrator::{Arch, Dop853, DormandPrince, Flow, Method, PointRef, Scale, Tableau, Transposed};
use crate::solve::statistics::Statistics;

/// Parts of a step at most.
const MOST_PARTS: u32 = 1 << 16;
/// The estimated error of a part, in parts of what is allowed, from which on it is divided; also that of the weights,
/// in parts of the relative tolerance. A run by DOP853 has states of none above 1, or hardly more where a projection
/// takes the error away.
const FAR: f64 = 100.0;
/// So many steps of parts that are not longer follow without another look at the weights.
const LOOK: u32 = 8;

/// The state at the end of a step, before and after its projection.
pub(super) struct End {
    pub raw: Vec<f64>,
    pub projected: Vec<f64>,
}

/// A step between two instants, s, in branches of the switches, from a state.
#[derive(Clone, Copy)]
pub(super) struct Crossing<'a> {
    pub from: f64,
    pub to: f64,
    pub negative: &'a [bool],
    pub x: &'a [f64],
}

/// A part of a step: its start and its size, s.
#[derive(Clone, Copy)]
struct Substep {
    t: f64,
    h: f64,
}

/// What has been found so far.
struct Found {
    weights: Vec<f64>,
    by_constants: Vec<f64>,
    by_parameters: Vec<f64>,
    integral: f64,
}

/// The method with its work space.
pub(super) struct Back<'a> {
    model: &'a dyn Machine,
    pub sweeps: &'a dyn Swept,
    /// The model in numbers with slopes, for what has no sweeps.
    pub lifted: Lifted,
    scale: Scale,
    /// By how much weights in parts of a step may differ from those in twice as many, relatively. Of a run by DOP853
    /// half of the digits have to agree: they are exact for its steps, unless these are unstable.
    near: f64,
    method: Dop853,
    arch: Arch,
    transposed: Transposed<DormandPrince>,
    /// The start of each part of the last step.
    starts: Vec<Vec<f64>>,
    parts: u32,
    /// The longest part by which weights were seen to be exact, s, and how many steps ago.
    exact: f64,
    since: u32,
    /// The rate at the start of a part; how the objective depends on the state of a stage; the outputs there.
    rate: Vec<f64>,
    by_stage: Vec<f64>,
    outputs: Vec<f64>,
    /// The factors of the outputs' integrals over the run; none where there are no integrals.
    pub integrand: Option<Vec<f64>>,
    /// The integral of the steps that were followed backwards.
    pub integral: f64,
    /// How the objective depends on each constant, as far as it was followed.
    pub by_constants: Vec<f64>,
}

impl<'a> Back<'a> {
    /// `is_own`: of a run by DOP853.
    pub fn new(
        (model, sweeps, lifted): (&'a dyn Machine, &'a dyn Swept, Lifted),
        (scale, is_own): (Scale, bool),
        integrals: &[(usize, f64)],
    ) -> Self {
        let (states, outputs) = (model.states(), model.description().outputs.len());
        let mut factors = vec![0.0; outputs];
        integrals.iter().for_each(|&(output, factor)| factors[output] += factor);
        let mut method = Dop853::new();
        method.fit(states);
        Self {
            model,
            sweeps,
            lifted,
            near: if is_own { scale.relative.sqrt() } else { FAR * scale.relative },
            scale,
            method,
            arch: Arch::new(),
            transposed: Transposed::new(states),
            starts: Vec::new(),
            parts: 1,
            exact: 0.0,
            since: 0,
            rate: vec![0.0; states],
            by_stage: vec![0.0; states],
            outputs: vec![0.0; outputs],
            integrand: (!integrals.is_empty()).then_some(factors),
            integral: 0.0,
            by_constants: vec![0.0; model.constants().len()],
        }
    }

    /// Makes a step again; its last part stays in the work space. None where it is not finite, however it is divided.
    pub fn cross(&mut self, step: Crossing<'_>) -> Option<End> {
        while self.parts <= MOST_PARTS {
            self.starts.clear();
            let (mut x, mut worst) = (step.x.to_vec(), 0.0_f64);
            for part in 0..self.parts {
                self.starts.push(x.clone());
                let error = self.forwards(step.negative, self.part(step, part), &mut x);
                worst = if error <= worst { worst } else { error };
                if worst.is_nan() || worst > FAR {
                    break;
                }
            }
            if worst <= FAR {
                let mut projected = x.clone();
                self.model.project(step.to, step.negative, &mut projected);
                return Some(End { raw: x, projected });
            }
            self.parts *= 2;
        }
        None
    }

    fn part(&self, step: Crossing<'_>, part: u32) -> Substep {
        let h = (step.to - step.from) / f64::from(self.parts);
        Substep { t: step.from + f64::from(part) * h, h }
    }

    /// Follows a step backwards: replaces the `weights` of the state at its end by those of the state at its start.
    /// Gives whether it did. Only a whole step adds to the integral.
    pub fn follow(&mut self, step: Crossing<'_>, is_whole: bool, weights: &mut [f64]) -> bool {
        if self.since < LOOK && self.length(step) <= self.exact {
            self.since += 1;
            return self.follow_in_parts(step, is_whole, weights);
        }
        let before = self.found(weights);
        self.parts = (self.parts / 2).max(1);
        self.follow_in_parts(step, is_whole, weights);
        while self.parts <= MOST_PARTS {
            let (parts, coarse) = (self.parts, self.found(weights));
            self.restore(&before, weights);
            self.parts = 2 * parts;
            if self.follow_in_parts(step, is_whole, weights) && self.are_near(&coarse.weights, weights, step.x) {
                // In as many parts as the steps that follow.
                self.restore(&coarse, weights);
                self.parts = parts;
                (self.exact, self.since) = (self.length(step), 0);
                return true;
            }
        }
        false
    }

    fn found(&self, weights: &[f64]) -> Found {
        Found {
            weights: weights.to_vec(),
            by_constants: self.by_constants.clone(),
            by_parameters: self.lifted.by.clone(),
            integral: self.integral,
        }
    }

    fn restore(&mut self, found: &Found, weights: &mut [f64]) {
        weights.copy_from_slice(&found.weights);
        self.by_constants.copy_from_slice(&found.by_constants);
        self.lifted.by.copy_from_slice(&found.by_parameters);
        self.integral = found.integral;
    }

    /// How long the parts of a step are, s.
    fn length(&self, step: Crossing<'_>) -> f64 {
        (step.to - step.from).abs() / f64::from(self.parts)
    }

    /// Whether what these weights say of changes as large as is allowed of each state is nearly the same.
    fn are_near(&self, some: &[f64], others: &[f64], x: &[f64]) -> bool {
        let of = |(i, weight): (usize, f64)| weight.abs() * self.scale.allowed_between(i, x[i], x[i]);
        let most = others.iter().copied().enumerate().map(of).fold(0.0, f64::max);
        let differences = some.iter().zip(others).map(|(some, other)| some - other);
        differences.enumerate().map(of).all(|difference| difference <= self.near * most)
    }

    /// Follows a step backwards in as many parts as there are, or more where these are far too inexact.
    fn follow_in_parts(&mut self, step: Crossing<'_>, is_whole: bool, weights: &mut [f64]) -> bool {
        let Some(end) = self.cross(step) else { return false };
        self.sweeps.reverse_project(step.to, &end.raw, step.negative, weights, &mut self.by_constants);
        for number in (0..self.parts).rev() {
            let part = self.part(step, number);
            if number + 1 < self.parts {
                let mut x = self.starts[number as usize].clone();
                self.forwards(step.negative, part, &mut x);
            }
            let arch = self.arch;
            arch.dispatch(Backwards { back: self, negative: step.negative, part, is_whole, weights });
        }
        weights.iter().all(|weight| weight.is_finite())
    }

    /// How a weighted sum of the outputs at `t` (s) depends on the state `x` there.
    pub fn by_outputs(&mut self, t: f64, x: &[f64], negative: &[bool], weights: &[f64]) -> Vec<f64> {
        let mut by_state = vec![0.0; x.len()];
        if self.sweeps.reverse_outputs(t, x, negative, weights, &mut by_state, &mut self.by_constants) {
            return by_state;
        }
        let slopes = |system: &dyn Machine<Gradient>, x: &[Gradient]| {
            let mut outputs = vec![Gradient::from_f64(0.0); weights.len()];
            system.outputs(Gradient::from_f64(t), x, negative, &mut outputs);
            weighted(&outputs, weights)
        };
        let given: Vec<Gradient> = x.iter().copied().map(Gradient::from_f64).collect();
        self.lifted.add_by_parameters(1.0, |system| slopes(system, &given));
        self.lifted.by_states(x, slopes)
    }

    /// Replaces the state by that at the end of one part; gives the norm of its error.
    fn forwards(&mut self, negative: &[bool], Substep { t, h }: Substep, x: &mut [f64]) -> f64 {
        let mut statistics = Statistics::default();
        let flow = Flow::new(self.model, negative, &mut statistics);
        flow.rate(t, x, &mut self.rate);
        let start = x.to_vec();
        let error = self.method.attempt(&flow, PointRef { t, x: &start, rate: &self.rate }, h, &self.scale, x);
        if x.iter().all(|x| x.is_finite()) { error } else { f64::NAN }
    }

    /// Replaces the weights of the state at the end of one part, whose stages are known, by those of the state at its
    /// start.
    #[inline(always)]
    fn backwards(&mut self, negative: &[bool], Substep { t, h }: Substep, is_whole: bool, by_end: &mut [f64]) {
        self.transposed.begin(h, by_end);
        for stage in (0..DormandPrince::END).rev() {
            let t = t + DormandPrince::C[stage] * h;
            let x = self.method.stage(stage, h);
            let by_rate = self.transposed.by_rate(stage);
            self.sweeps.reverse_rate(t, x, negative, by_rate, &mut self.by_stage, &mut self.by_constants);
            let quadrature = h * Transposed::<DormandPrince>::quadrature(stage);
            if let (Some(factors), true) = (&self.integrand, is_whole && quadrature != 0.0) {
                let x = x.to_vec();
                self.model.outputs(t, &x, negative, &mut self.outputs);
                self.integral += quadrature * dot(factors, &self.outputs);
                let weights: Vec<f64> = factors.iter().map(|factor| factor * quadrature).collect();
                let by_outputs = self.by_outputs(t, &x, negative, &weights);
                add(&mut self.by_stage, &by_outputs);
            }
            add(by_end, &self.by_stage);
            if stage > 0 {
                self.transposed.hand_on(stage, h, &self.by_stage);
            }
        }
    }
}

/// The sum of the products.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Adds one to the other.
pub(super) fn add(to: &mut [f64], other: &[f64]) {
    to.iter_mut().zip(other).for_each(|(to, other)| *to += other);
}

/// A part to be followed backwards, compiled for vectors.
struct Backwards<'b, 'a> {
    back: &'b mut Back<'a>,
    negative: &'b [bool],
    part: Substep,
    is_whole: bool,
    weights: &'b mut [f64],
}

impl NullaryFnOnce for Backwards<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { back, negative, part, is_whole, weights } = self;
        back.backwards(negative, part, is_whole, weights);
    }
}
