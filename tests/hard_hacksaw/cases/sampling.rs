//! Samples finer than the steps: what the dense output gives between the steps' ends.
//!
//! In: an integrator and a tolerance. Out: the error at the ends of the steps, the error of samples 1e-6 s apart, and
//! by how much poses jump at a step's end. Truth: DOP853 with steps of 1e-6 s, which ends one at each sample and
//! has no error but rounding.

use bg_model::failure::Cause;
use bg_model::integrator::Integrator;
use bg_model::simulation::Samples;

use super::machine::{Scale, planar, planar_names};
use super::request;
use crate::hardcases::case::larger;
use crate::hardcases::integrator;
use crate::hardcases::problem::{Followable, Request};

/// The distance of the samples, s.
pub const FINE: f64 = 1e-6;

/// What finely sampled poses are like; m, and entries of orientations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampled {
    /// Accepted steps.
    pub steps: u64,
    /// The largest error at the ends of the steps.
    pub ends: f64,
    /// The largest error of the samples.
    pub between: f64,
    /// The largest difference between a step's end and the instants one rounding before and after it.
    pub jump: f64,
}

/// The paper's case up to `end` (s), sampled finely and held against a run of steps as fine.
///
/// # Errors
/// The run fails.
pub fn sampled(by: Integrator, tolerance: f64, end: f64) -> Result<Sampled, Cause> {
    let problem = planar(&[], Scale::Fixed(1.0));
    let instants = [end];
    let asked = Request { fixed_step: 1e-4, ..request(tolerance, &instants, 1_000_000) };
    let fine = Request { forced_step: Some(FINE), ..request(1e-9, &instants, 10_000_000) };
    let poses = |by: Integrator, asked: &Request, samples: Samples| follow(&*problem, by, asked, samples);
    let truth = |samples: Samples| poses(integrator("dop853"), &fine, samples).map(|(_, rows)| rows);

    let (ends, at_ends) = poses(by, &asked, Samples::Steps)?;
    let every: Vec<f64> = (0..=(end / FINE) as u32).map(|k| f64::from(k) * FINE).filter(|t| *t <= end).collect();
    let (_, at_every) = poses(by, &asked, Samples::At(every.clone()))?;
    let inner = &ends[1..ends.len() - 1];
    let around: Vec<f64> = inner.iter().flat_map(|t| [t.next_down(), *t, t.next_up()]).collect();
    let (_, at_around) = poses(by, &asked, Samples::At(around))?;
    let jump = at_around.chunks(3).map(|rows| difference(&rows[0], &rows[1]).max(difference(&rows[1], &rows[2])));
    Ok(Sampled {
        steps: ends.len() as u64 - 1,
        ends: largest(&at_ends, &truth(Samples::At(ends.clone()))?),
        between: largest(&at_every, &truth(Samples::At(every))?),
        jump: jump.fold(0.0, larger),
    })
}

/// Times and poses.
type Rows = (Vec<f64>, Vec<Vec<f64>>);

/// Runs without the residuals.
fn follow(problem: &dyn Followable, by: Integrator, asked: &Request, samples: Samples) -> Result<Rows, Cause> {
    let count = planar_names().len();
    let (mut times, mut rows) = (Vec::new(), Vec::new());
    let followed = problem.follow(by, asked, samples, &mut |t, mut row| {
        row.truncate(count);
        times.push(t);
        rows.push(row);
    });
    followed.failure.map_or(Ok((times, rows)), Err)
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, larger)
}

fn largest(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| difference(a, b)).fold(0.0, larger)
}
