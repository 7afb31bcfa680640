//! The crate diffsol: Tsitouras' explicit method of order 5(4), variable-order BDF, and the diagonally implicit TR-BDF2
//! and ESDIRK34, with dense matrices.
//!
//! The slip velocity is its root function: it stops at each root, the branch changes, it goes on from there. Products
//! with the Jacobian are central differences of the rate, two evaluations each. The limits of failures are raised: by
//! default the implicit methods give up after 50 failures of the nonlinear solver in a run.

use std::rc::Rc;
use std::time::Instant;

use diffsol::{NalgebraLU, NalgebraMat, NalgebraVec, OdeBuilder, OdeEquations, OdeSolverMethod, OdeSolverStopReason};

use super::{Run, Solver, Source, Work, by_tolerance};
use crate::poses;
use crate::problem::{ABSOLUTE, Branch, Problem, SAMPLES, T_END, instant};
use hacksaw_planar::State;

type Matrix = NalgebraMat<f64>;
type Lu = NalgebraLU<f64>;

/// The crate's lines. `$method` makes a solver of the problem.
macro_rules! line {
    ($name:literal, $exponents:expr, $problem:ident, |$equations:ident| $method:expr) => {
        by_tolerance(Source::Diffsol, $name, true, $exponents, |rtol| {
            let branch = Rc::new(Branch::new($problem));
            let (rhs, product, guard) = (branch.clone(), branch.clone(), branch.clone());
            let start = $problem.start;
            let mut $equations = OdeBuilder::<Matrix>::new()
                .rtol(rtol)
                .atol([ABSOLUTE * rtol; 24])
                .rhs_implicit(
                    move |x, _p, _t, rate| rate.copy_from_slice(&rhs.rate(state(x))),
                    move |x, _p, _t, v, jv| jv.copy_from_slice(&derivative(&product, state(x), state(v))),
                )
                .root(move |x, _p, t, root| root[0] = guard.guard(t, state(x)), 1)
                .init(move |_p, _t, x| x.copy_from_slice(&start), 24)
                .build()
                .map_err(|fault| fault.to_string())?;
            $equations.ode_options.max_nonlinear_solver_failures = usize::MAX;
            $equations.ode_options.max_error_test_failures = usize::MAX;
            let clock = Instant::now();
            let solver = $method.map_err(|fault| fault.to_string())?;
            run(clock, solver, &branch)
        })
    };
}

/// The crate's lines.
pub fn all(problem: &Problem) -> Vec<Box<dyn Solver + '_>> {
    vec![
        line!("diffsol Tsit45", 3..=12, problem, |equations| equations.tsit45()),
        line!("diffsol BDF", 3..=9, problem, |equations| equations.bdf::<Lu>()),
        line!("diffsol TR-BDF2", 3..=7, problem, |equations| equations.tr_bdf2::<Lu>()),
        line!("diffsol ESDIRK34", 3..=8, problem, |equations| equations.esdirk34::<Lu>()),
    ]
}

fn state(x: &[f64]) -> &State {
    x.try_into().expect("24 states")
}

/// The derivative of the rate at `x` along `v`.
fn derivative(branch: &Branch, x: &State, v: &State) -> State {
    // The cube root of the rounding unit, over the largest change.
    let h = 6e-6 / v.iter().fold(f64::MIN_POSITIVE, |largest, v| largest.max(v.abs()));
    let at = |h: f64| branch.rate(&std::array::from_fn(|i| x[i] + h * v[i]));
    let (after, before) = (at(h), at(-h));
    std::array::from_fn(|i| (after[i] - before[i]) / (2.0 * h))
}

fn run<'a, Eqn, S>(clock: Instant, mut solver: S, branch: &Branch) -> Result<Run, String>
where
    Eqn: OdeEquations<T = f64, V = NalgebraVec<f64>> + 'a,
    S: OdeSolverMethod<'a, Eqn>,
{
    let text = |fault: diffsol::error::DiffsolError| fault.to_string();
    let (mut poses, mut events) = (Vec::with_capacity(SAMPLES), 0);
    solver.set_stop_time(T_END).map_err(text)?;
    let mut sample = solver.state().y.clone();
    while poses.len() < SAMPLES {
        let stop = solver.step().map_err(text)?;
        let reached = if let OdeSolverStopReason::RootFound(t, _) = stop { t } else { solver.state().t };
        while poses.len() < SAMPLES && instant(poses.len()) <= reached {
            solver.interpolate_inplace(instant(poses.len()), &mut sample).map_err(text)?;
            poses.push(poses::of(state(sample.batch_as_slice(0))));
        }
        if let OdeSolverStopReason::RootFound(t, _) = stop {
            solver.state_mut_back(t).map_err(text)?;
            branch.switch(t, state(solver.state().y.batch_as_slice(0)));
            solver.set_stop_time(T_END).map_err(text)?;
            events += 1;
        }
    }
    let wall = clock.elapsed();
    let statistics = solver.get_statistics();
    let work = Work {
        steps: Some(statistics.number_of_steps as u64),
        rejected: Some((statistics.number_of_error_test_failures + statistics.number_of_nonlinear_solver_fails) as u64),
        rates: None,
        events: Some(events),
    };
    Ok(Run { wall, poses, work, compiled: None })
}
