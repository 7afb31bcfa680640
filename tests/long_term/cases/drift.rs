//! Drift: how far an invariant moves from its start in a long run.
//!
//! In: a scene, an integrator, how exact, how many periods. Out: the largest deviation of each invariant, looked at
//! after every step, in the first hundredth, the first tenth and the whole of the run. A deviation that is bounded is
//! the same in all three; one that grows as a random walk is 10^(1/2) times, one that grows linearly 10 times as large
//! each time.

use bg_model::failure::Cause;
use bg_model::integrator::Integrator;
use bg_model::simulation::Samples;
use bg_model::statistics::Statistics;

use super::scenes::Scene;
use crate::hardcases::problem::Request;

/// How exact a run is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exactness {
    /// Steps of a fixed-step method in one period of the fastest motion.
    StepsPerPeriod(f64),
    /// Relative tolerance; the absolute one is a thousandth of it, in each state's SI unit.
    Tolerance(f64),
}

/// The largest deviations of one invariant, over its size.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// In the first hundredth of the run.
    pub hundredth: f64,
    /// In the first tenth.
    pub tenth: f64,
    /// In all of it.
    pub whole: f64,
}

impl Deviation {
    /// The power of the time with which it grew in the last nine tenths: 0 bounded, 1/2 a random walk, 1 linear.
    #[must_use]
    pub fn growth(&self) -> f64 {
        libm::log10(self.whole / self.tenth)
    }
}

/// What became of the invariants in a run.
#[derive(Clone, Debug)]
pub struct Drift {
    /// Of each invariant, the last the orthogonality.
    pub deviations: Vec<Deviation>,
    /// What the run cost.
    pub statistics: Statistics,
    /// Why it stopped before its end.
    pub failure: Option<Cause>,
}

impl Drift {
    /// The deviation of the energy, which every scene has first.
    #[must_use]
    pub fn energy(&self) -> Deviation {
        self.deviations[0]
    }

    /// The largest deviations of the momenta; none where the scene conserves none.
    #[must_use]
    pub fn momentum(&self) -> Option<Deviation> {
        let of = &self.deviations[1..self.deviations.len() - 1];
        let largest = |value: fn(&Deviation) -> f64| of.iter().map(value).fold(0.0, f64::max);
        (!of.is_empty()).then(|| Deviation {
            hundredth: largest(|of| of.hundredth),
            tenth: largest(|of| of.tenth),
            whole: largest(|of| of.whole),
        })
    }

    /// The largest max |R R^T - 1|.
    #[must_use]
    pub fn orthogonality(&self) -> f64 {
        self.deviations.last().map_or(0.0, |of| of.whole)
    }
}

/// Runs `scene` for `periods` of its fastest motion.
#[must_use]
pub fn drift(scene: &Scene, integrator: Integrator, exactness: Exactness, periods: f64) -> Drift {
    let end = periods * scene.period;
    let (relative, fixed_step) = match exactness {
        // The default tolerance. It has no effect on the steps, but Gauss solves its equations with a view to it.
        Exactness::StepsPerPeriod(count) => (1e-8, scene.period / count),
        Exactness::Tolerance(relative) => (relative, f64::NAN),
    };
    let request = Request {
        relative,
        absolute: 1e-3 * relative,
        fixed_step,
        forced_step: None,
        instants: &[end],
        limit: 1_000_000_000,
    };
    let mut start: Vec<f64> = Vec::new();
    let mut deviations = vec![Deviation::default(); scene.invariants.len()];
    let mut each = |t: f64, row: Vec<f64>| {
        if start.is_empty() {
            start.clone_from(&row);
        }
        for ((of, value), start) in deviations.iter_mut().zip(&row).zip(&start) {
            let deviation = (value - start).abs();
            // Not a number is the largest of all.
            let keep = |largest: &mut f64| {
                if deviation > *largest || deviation.is_nan() {
                    *largest = deviation
                }
            };
            keep(&mut of.whole);
            if t <= 0.1 * end {
                keep(&mut of.tenth);
            }
            if t <= 0.01 * end {
                keep(&mut of.hundredth);
            }
        }
    };
    let followed = scene.problem.follow(integrator, &request, Samples::Steps, &mut each);
    Drift { deviations, statistics: followed.statistics, failure: followed.failure }
}
