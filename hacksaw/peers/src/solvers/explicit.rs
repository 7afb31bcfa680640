//! The crate ode_solvers: Dormand and Prince's methods of order 5(4) and 8(5,3) after Hairer's programs.
//!
//! It locates no events: the right-hand side chooses its branch by the sign of the slip. Its dense output is wrong at
//! the end point, so it integrates a little beyond. Its test for stiffness stops at the stability limit, where explicit
//! methods run on this problem: it is set to a step number that is not reached, as is the limit of steps.

use std::time::Instant;

use ode_solvers::dop_shared::{IntegrationError, OutputType, Stats};
use ode_solvers::{Dop853, Dopri5, SVector, System};

use super::{Run, Solver, Source, Work, by_tolerance};
use crate::poses::{self, Poses};
use crate::problem::{ABSOLUTE, INTERVAL, Problem, SAMPLES, T_END};
use hacksaw_planar::State;

type Vector = SVector<f64, 24>;

/// The end of the integration, s: between the last sample and the one that would follow.
const BEYOND: f64 = T_END + 0.4 * INTERVAL;
/// A number of steps that is not reached.
const NEVER: u32 = u32::MAX;

/// The crate's lines.
pub fn all(problem: &Problem) -> Vec<Box<dyn Solver + '_>> {
    /// A run by this method of the crate, with the crate's defaults for beta and the limits of a step's growth.
    macro_rules! run_by {
        ($method:ident, $beta:literal, $limits:expr) => {
            |rtol| {
                const SAFETY: f64 = 0.9;
                let (start, [least, most]) = (Vector::from(problem.start), $limits);
                let mut stepper = $method::from_param(
                    Rhs(problem),
                    0.0,
                    BEYOND,
                    INTERVAL,
                    start,
                    rtol,
                    ABSOLUTE * rtol,
                    SAFETY,
                    $beta,
                    least,
                    most,
                    BEYOND,
                    0.0,
                    NEVER,
                    NEVER,
                    OutputType::Dense,
                );
                let clock = Instant::now();
                let outcome = stepper.integrate();
                finish(clock, outcome, || stepper.y_out())
            }
        };
    }
    let dopri5 = run_by!(Dopri5, 0.04, [0.2, 10.0]);
    let dop853 = run_by!(Dop853, 0.0, [0.333, 6.0]);
    vec![
        by_tolerance(Source::OdeSolvers, "ode_solvers Dopri5", false, 3..=12, dopri5),
        by_tolerance(Source::OdeSolvers, "ode_solvers Dop853", false, 3..=13, dop853),
    ]
}

struct Rhs<'a>(&'a Problem);

impl System<f64, Vector> for Rhs<'_> {
    #[inline(always)]
    fn system(&self, _t: f64, x: &Vector, dx: &mut Vector) {
        let state: &State = &x.data.0[0];
        dx.data.0[0] = self.0.rate(state);
    }
}

fn finish<'a>(
    clock: Instant,
    outcome: Result<Stats, IntegrationError>,
    states: impl FnOnce() -> &'a Vec<Vector>,
) -> Result<Run, String> {
    let wall = clock.elapsed();
    let stats = outcome.map_err(|fault| fault.to_string())?;
    let poses: Poses = states().iter().take(SAMPLES).map(|x| poses::of(&x.data.0[0])).collect();
    let work = Work {
        steps: Some(stats.accepted_steps.into()),
        rejected: Some(stats.rejected_steps.into()),
        rates: Some(stats.num_eval.into()),
        events: None,
    };
    Ok(Run { wall, poses, work, compiled: None })
}
