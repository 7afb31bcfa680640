//! A method that is implicit in the states alone whose own damping is stiff, and explicit in all others.
//!
//! In: a step. Out: the state after it with an error estimate, and on request the states in between. The rate f is
//! split into B (x - r) of the damped states, with a matrix B and a straight line r(t), and the rest; the implicit
//! method of the pair in `tableau` takes the former, the explicit one the latter. B is the block of the Jacobian,
//! renewed now and then: any other one keeps the order. So one rate a stage and a product with a small matrix make a
//! step, where an implicit method solves systems of all states. The line leads through the ends of the last two steps:
//! with the last end alone the order falls to 2, as what damping has brought to equilibrium drifts.

mod block;
mod inverse;
mod pattern;
mod places;
mod stage;
mod tableau;

use crate::model::scalar::Scalar;

use self::block::Block;
pub(super) use self::tableau::KennedyCarpenter;
use super::explicit::{Explicit, Stages, Tableau};
use super::hand_on::hand_on;
use super::side_by_side::SIDE_BY_SIDE;
use super::steps::Begin;
use super::tolerances::largest;
use super::vectors::{Vectorised, attempt_in};
use super::{Arch, Flow, Method, PointRef, Scale, StepControl};

/// The pair `ARK5(4)8L[2]SAb` of Kennedy and Carpenter, implicit in the states alone whose own damping is stiff: eight
/// rates a step.
///
/// For mechanisms with strong dampers between few of many states, and tolerances from 1e-3 to 1e-8: looser ones count
/// as 1e-3.
#[derive(Clone, Debug)]
pub struct Ark5 {
    explicit: Explicit<KennedyCarpenter>,
    block: Block,
    /// The tolerances in place of looser ones.
    tight: Scale,
    arch: Arch,
}

impl Ark5 {
    /// The loosest relative tolerance: with steps for looser ones a switch changes without need.
    const LOOSEST: f64 = 1e-3;

    /// The method, its work space empty.
    #[must_use]
    pub fn new() -> Self {
        Self::in_vectors(Arch::new())
    }

    fn in_vectors(arch: Arch) -> Self {
        Self { explicit: Explicit::new(), block: Block::new(arch), tight: Scale::of_nothing(Self::LOOSEST), arch }
    }
}

impl Default for Ark5 {
    fn default() -> Self {
        Self::new()
    }
}

impl Vectorised for Ark5 {
    #[inline(always)]
    fn attempt_inlined(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64 {
        let Self { explicit, block, .. } = self;
        if block.invert() { step(&mut explicit.stages, block, flow, start, h, scale, end) } else { f64::INFINITY }
    }
}

/// The part that counts of a difference with the rate at the start of the step: where a step is smooth it stays below
/// the other one.
const AT_START: f64 = 0.02;

/// Writes the state at the end of a step of size `h` (s) whose stages `block` completes; gives its error norm.
#[inline(always)]
fn step(
    stages: &mut Stages<KennedyCarpenter, f64, SIDE_BY_SIDE>,
    block: &mut Block,
    flow: &Flow<'_>,
    start: PointRef<'_>,
    h: f64,
    scale: &Scale,
    end: &mut [f64],
) -> f64 {
    stages.begin(start.rate);
    stages.evaluate(flow, &Begin::of(start, h), 1..KennedyCarpenter::END, block);
    stages.write_rows([KennedyCarpenter::B, KennedyCarpenter::ERROR, KennedyCarpenter::START]);
    let Stages { end: slopes, differences: [difference, at_start], .. } = stages;
    for ((end, from), slope) in end.iter_mut().zip(start.x).zip(&**slopes) {
        *end = from + h * slope;
    }
    at_start.iter_mut().for_each(|at_start| *at_start *= AT_START);
    block.reduce([difference, at_start]);
    for (i, difference) in difference.iter_mut().enumerate() {
        let allowed = scale.allowed_between(i, start.x[i], end[i]);
        *difference = difference.abs().larger(at_start[i].abs()) / allowed;
    }
    h.abs() * largest(difference)
}

/// Calls the explicit method.
macro_rules! explicit {
    (($($borrow:tt)+) $ark:expr, $method:ident => $then:expr) => {{
        let $method = $($borrow)+ $ark.explicit;
        $then
    }};
}

impl Method for Ark5 {
    hand_on!(explicit);

    fn fit(&mut self, states: usize) {
        self.explicit.fit(states);
        self.block.fit(states);
    }

    fn attempt(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64 {
        if !self.block.prepare(flow, start, h, scale) {
            return f64::INFINITY;
        }
        let noise = self.block.noise(h) / scale.relative;
        if noise > 1.0 {
            return noise;
        }
        if scale.relative <= Self::LOOSEST {
            return attempt_in(self.arch, self, flow, start, h, scale, end);
        }
        let mut tight = core::mem::replace(&mut self.tight, Scale::of_nothing(Self::LOOSEST));
        tight.absolute.clone_from(&scale.absolute);
        tight.weights.clone_from(&scale.weights);
        (tight.coarsest, tight.growth) = (scale.coarsest, scale.growth);
        let norm = attempt_in(self.arch, self, flow, start, h, &tight, end);
        self.tight = tight;
        norm
    }

    fn advance(&mut self) {
        self.block.advance();
        self.explicit.advance();
    }

    fn restart(&mut self) {
        self.block.restart();
        self.explicit.restart();
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::SVector;

    use super::*;
    use crate::model::system::System;
    use crate::solve::integrator::Tolerances;
    use crate::solve::simulation::{Settings, Span, integrate};

    /// A row of five masses on springs with strong dampers between the first three.
    struct Row;

    impl System<f64, 10, 0> for Row {
        #[inline(always)]
        fn rate(&self, t: f64, x: &SVector<f64, 10>, _negative: &[bool; 0], dx: &mut SVector<f64, 10>) {
            let force = |i: usize| {
                let r = if i < 2 { 3e5 } else { 0.1 };
                r * (x[i + 1] - x[i]) + 20.0 * (x[6 + i] - x[5 + i])
            };
            for i in 0..5 {
                let (right, left) =
                    (if i < 4 { force(i) } else { t.sin() }, if i > 0 { force(i - 1) } else { 40.0 * x[5] });
                dx[i] = right - left;
                dx[5 + i] = x[i];
            }
        }
    }

    #[test]
    fn every_machine_gives_the_same_bytes() {
        let of = |arch: Arch| {
            let mut method = Ark5::in_vectors(arch);
            let start = SVector::from_fn(|i, _| 0.3 - 0.07 * i as f64);
            let settings = Settings { tolerances: Tolerances::new(1e-7, 1e-8), ..Settings::default() };
            let finish = integrate(&Row, &mut method, &start, Span { t0: 0.0, t_end: 10.0 }, &settings, &mut ());
            let finish = finish.expect("a smooth system");
            (finish.x.map(f64::to_bits), finish.statistics.steps)
        };
        let (everywhere, here) = (of(Arch::Scalar), of(Arch::new()));
        assert!((100..10_000).contains(&everywhere.1), "{}", everywhere.1);
        assert_eq!(everywhere, here);
    }
}
