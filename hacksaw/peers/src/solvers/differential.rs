//! The crate differential-equations: Dormand and Prince's methods, and Verner's explicit pairs with their interpolants.
//!
//! Its own event location returns points that are no zeros of the guard (97 events instead of 60 at loose tolerances,
//! errors of 1e-5 at rtol 1e-10), so its output hook does it here: it finds the zero of the slip velocity on the
//! crate's interpolant, changes the branch and hands the state there back, from which the crate goes on. Tolerances are
//! given per state: scalar ones are ignored.

use std::ops::RangeInclusive;
use std::time::Instant;

use differential_equations::control::ControlFlag;
use differential_equations::interpolate::Interpolation;
use differential_equations::ode::{ODE, OrdinaryNumericalMethod, solve_ode};
use differential_equations::prelude::ExplicitRungeKutta;
use differential_equations::solout::Solout;
use differential_equations::solution::Solution;

use super::{Run, Solver, Source, Work, by_tolerance};
use crate::poses::{self, Poses};
use crate::problem::{ABSOLUTE, Branch, Problem, SAMPLES, T_END, instant};
use hacksaw_planar::State;

/// A method of the crate at a tolerance. `rtol` and `atol` are methods of each type, not of a trait.
macro_rules! line {
    ($name:literal, $exponents:expr, $problem:ident, $method:ident) => {
        by_method($name, $exponents, $problem, |rtol| {
            ExplicitRungeKutta::$method().rtol([rtol; 24]).atol([ABSOLUTE * rtol; 24]).max_steps(usize::MAX)
        })
    };
}

/// The crate's lines.
pub fn all(problem: &Problem) -> Vec<Box<dyn Solver + '_>> {
    vec![
        line!("differential-equations dopri5", 3..=12, problem, dopri5),
        line!("differential-equations dop853", 3..=13, problem, dop853),
        line!("differential-equations rkv656e", 3..=13, problem, rkv656e),
        line!("differential-equations rkv767e", 3..=13, problem, rkv767e),
        line!("differential-equations rkv878e", 3..=13, problem, rkv878e),
        line!("differential-equations rkv989e", 3..=13, problem, rkv989e),
    ]
}

struct Rhs<'a>(&'a Branch<'a>);

impl ODE<f64, State> for Rhs<'_> {
    #[inline(always)]
    fn diff(&self, _t: f64, x: &State, rate: &mut State) {
        *rate = self.0.rate(x);
    }
}

/// The output hook: takes the samples and stops at the zeros of the guard.
struct Hook<'a> {
    branch: &'a Branch<'a>,
    poses: Poses,
    events: u64,
}

impl Hook<'_> {
    /// The zero of the guard in a step at whose end it has another sign than at its beginning, s; by the Illinois
    /// variant of the false position.
    fn locate<I>(&self, t_prev: f64, t_curr: f64, guards: (f64, f64), interpolant: &mut I) -> (f64, State)
    where
        I: Interpolation<f64, State> + ?Sized,
    {
        let (mut a, mut b, (mut fa, mut fb)) = (t_prev, t_curr, guards);
        loop {
            let t = b - fb * (b - a) / (fb - fa);
            let x = interpolant.interpolate(t).expect("an instant of the last step");
            let f = self.branch.guard(t, &x);
            if f == 0.0 || (t - b).abs() < 1e-13 || (t - a).abs() < 1e-13 {
                return (t, x);
            }
            if (f < 0.0) == (fb < 0.0) {
                fa *= 0.5;
            } else {
                (a, fa) = (b, fb);
            }
            (b, fb) = (t, f);
        }
    }
}

impl Solout<f64, State> for Hook<'_> {
    fn solout<I>(
        &mut self,
        t_curr: f64,
        t_prev: f64,
        x_curr: &State,
        x_prev: &State,
        interpolant: &mut I,
        _solution: &mut Solution<f64, State>,
    ) -> ControlFlag<f64, State>
    where
        I: Interpolation<f64, State> + ?Sized,
    {
        let guards = (self.branch.guard(t_prev, x_prev), self.branch.guard(t_curr, x_curr));
        let event = ((guards.0 < 0.0) != (guards.1 < 0.0)).then(|| self.locate(t_prev, t_curr, guards, interpolant));
        let (until, x_until) = event.unwrap_or((t_curr, *x_curr));
        while self.poses.len() < SAMPLES && instant(self.poses.len()) <= until {
            let at = instant(self.poses.len());
            let x =
                if at == until { x_until } else { interpolant.interpolate(at).expect("an instant of the last step") };
            self.poses.push(poses::of(&x));
        }
        if event.is_some() {
            self.branch.switch(until, &x_until);
            self.events += 1;
            ControlFlag::ModifyState(until, x_until)
        } else {
            ControlFlag::Continue
        }
    }
}

fn by_method<'a, M>(
    name: &str,
    exponents: RangeInclusive<i32>,
    problem: &'a Problem,
    method: impl Fn(f64) -> M + 'a,
) -> Box<dyn Solver + 'a>
where
    M: OrdinaryNumericalMethod<f64, State> + Interpolation<f64, State>,
{
    by_tolerance(Source::DifferentialEquations, name, true, exponents, move |rtol| run(problem, method(rtol)))
}

fn run<M>(problem: &Problem, mut method: M) -> Result<Run, String>
where
    M: OrdinaryNumericalMethod<f64, State> + Interpolation<f64, State>,
{
    let branch = Branch::new(problem);
    let rhs = Rhs(&branch);
    let mut hook = Hook { branch: &branch, poses: Vec::with_capacity(SAMPLES), events: 0 };
    let clock = Instant::now();
    let outcome = solve_ode(&mut method, &rhs, 0.0, T_END, &problem.start, &mut hook);
    let wall = clock.elapsed();
    let solution = outcome.map_err(|fault| {
        // The state in it is of no use to a reader.
        let text = format!("{fault:?}");
        text.lines().next().unwrap_or_default().chars().take(80).collect::<String>()
    })?;
    let work = Work {
        steps: Some(solution.steps.accepted as u64),
        rejected: Some(solution.steps.rejected as u64),
        rates: Some(solution.evals.function as u64),
        events: Some(hook.events),
    };
    Ok(Run { wall, poses: hook.poses, work, compiled: None })
}
