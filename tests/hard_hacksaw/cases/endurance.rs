//! A long run of the paper's case: what is left of the energy balance and of the orthogonality, and what it costs.
//!
//! In: an integrator, a tolerance, a length. Out: the largest residuals over the samples, each second, and the cost of
//! each tenth of the run, which stays the same where nothing builds up.

use bg_model::failure::Cause;
use bg_model::integrator::Integrator;
use bg_model::simulation::Samples;
use bg_model::statistics::Statistics;

use super::machine::{Scale, planar, planar_names};
use super::request;
use crate::hardcases::case::larger;

/// What a long run is like.
#[derive(Clone, Debug)]
pub struct Endurance {
    /// The largest |stored - supplied + dissipated| over the sum of the energies, at the seconds.
    pub imbalance: f64,
    /// The largest max |R R^T - 1| of the links.
    pub orthogonality: f64,
    /// Switchings in each fifth of the run.
    pub events: [usize; 5],
    /// What the run cost.
    pub statistics: Statistics,
    /// Why it stopped before its end.
    pub failure: Option<Cause>,
}

/// Runs the paper's case for `seconds`; `progress` is told the time, s.
#[must_use]
pub fn endurance(by: Integrator, tolerance: f64, seconds: u32, mut progress: impl FnMut(f64)) -> Endurance {
    let problem = planar(&[], Scale::Present);
    let end = f64::from(seconds);
    let instants = [end];
    let asked = request(tolerance, &instants, u64::MAX);
    let samples = Samples::At((1..=seconds).map(f64::from).collect());
    let count = planar_names().len();
    let (mut imbalance, mut orthogonality) = (0.0, 0.0);
    let followed = problem.follow(by, &asked, samples, &mut |t, row| {
        imbalance = larger(imbalance, row[count].abs());
        orthogonality = larger(orthogonality, row[count + 1]);
        progress(t);
    });
    let mut events = [0; 5];
    followed.events.iter().for_each(|t| events[((5.0 * t / end) as usize).min(4)] += 1);
    Endurance { imbalance, orthogonality, events, statistics: followed.statistics, failure: followed.failure }
}
