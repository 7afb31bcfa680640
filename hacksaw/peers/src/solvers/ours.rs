//! Our own methods: on the generated scenes `Paper` and `Motion`, and on the hand-written right-hand sides. Switches
//! are located.
//!
//! [`all`] lists them, one line each.

use std::ops::RangeInclusive;
use std::time::Instant;

use bg_model::integrator::{Auto, Bs5, Cfmr7, Dop853, Method, Nystrom, Radau9, Rk4, Taylor, Tolerances};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Column, EachSample, Recording, Samples, Settings, Span, integrate};
use bg_model::statistics::Statistics;
use bg_model::system::{Model, System, switches, values};
use hacksaw::mechanism::{Motion, MotionParameters, Paper, PaperParameters};

use super::{Entry, Line, Run, Setting, Solver, Source, Work, by_tolerance};
use crate::poses::{self, Poses};
use crate::problem::{ABSOLUTE, Problem, T_END, instants, slip};
use hacksaw_planar::State;

/// Our absolute tolerance over the relative one, as `hacksaw precision` has it.
const SCENE_ABSOLUTE: f64 = 0.1;

/// All our lines.
pub fn all(problem: &Problem) -> Vec<Box<dyn Solver + '_>> {
    vec![
        on_scene(Source::Ours, "auto, the default", 3..=13, paper, Auto::new),
        on_scene(Source::Ours, "CFMR7osc", 3..=11, paper, Cfmr7::new),
        on_scene(Source::Ours, "Nystrom", 3..=9, paper, Nystrom::new),
        on_scene(Source::Ours, "DOP853", 3..=13, paper, Dop853::new),
        on_scene(Source::Ours, "Taylor", 3..=13, paper, Taylor::new),
        on_scene(Source::Ours, "BS5", 3..=9, paper, Bs5::new),
        on_scene(Source::Ours, "Radau IIA 9", 3..=9, paper, Radau9::new),
        on_scene_by_steps("RK4, fixed step", &[2e-4, 1e-4, 5e-5, 2e-5], Rk4::new),
        on_scene(Source::Motion, "auto, poses only", 3..=13, motion, Auto::new),
        on_scene(Source::Motion, "CFMR7osc, poses only", 3..=11, motion, Cfmr7::new),
        on_scene(Source::Motion, "Nystrom, poses only", 3..=9, motion, Nystrom::new),
        on_scene(Source::Motion, "DOP853, poses only", 3..=13, motion, Dop853::new),
        on_scene(Source::Motion, "Taylor, poses only", 3..=13, motion, Taylor::new),
        by_hand("CFMR7osc by hand, plain", 3..=11, Cfmr7::new, Plain(problem)),
        by_hand("DOP853 by hand, plain", 3..=13, Dop853::new, Plain(problem)),
        by_hand("DOP853 by hand, tuned", 3..=13, Dop853::new, Tuned(problem)),
    ]
}

/// The poses of the scene's run with `method`.
pub fn scene_poses(method: &mut impl Method, tolerances: Tolerances) -> Result<Poses, String> {
    run_scene(&paper(), method, tolerances).map(|run| run.poses)
}

fn paper() -> Paper {
    Paper::new(PaperParameters::default()).expect("defaults are in their ranges")
}

fn motion() -> Motion {
    Motion::new(MotionParameters::default()).expect("defaults are in their ranges")
}

fn on_scene<Mo, Me, const N: usize, const M: usize>(
    source: Source,
    name: &str,
    exponents: RangeInclusive<i32>,
    model: fn() -> Mo,
    method: fn() -> Me,
) -> Box<dyn Solver>
where
    Mo: Model<f64, N, 1, M> + 'static,
    Me: Method + 'static,
{
    by_tolerance(source, name, true, exponents, move |rtol| {
        run_scene(&model(), &mut method(), Tolerances::new(rtol, SCENE_ABSOLUTE * rtol))
    })
}

fn on_scene_by_steps<Me: Method + 'static>(name: &str, steps: &[f64], method: fn(f64) -> Me) -> Box<dyn Solver> {
    let line = Line { name: name.to_owned(), source: Source::Ours, locates_events: true, setting: Setting::Step };
    let run = move |step| run_scene(&paper(), &mut method(step), Tolerances::default());
    Box::new(Entry { line, settings: steps.to_vec(), run })
}

fn by_hand<'a, Me: Method + 'static>(
    name: &str,
    exponents: RangeInclusive<i32>,
    method: fn() -> Me,
    system: impl System<f64, 24, 1> + Problemed + 'a,
) -> Box<dyn Solver + 'a> {
    by_tolerance(Source::ByHand, name, true, exponents, move |rtol| {
        let start = SVector::from(system.problem().start);
        let samples = run(&system, &mut method(), &start, Tolerances::new(rtol, ABSOLUTE * rtol))?;
        Ok(samples.into_run(|states| states.iter().map(|(_, x, _)| poses::of(&x.data.0[0])).collect()))
    })
}

fn run_scene<Mo, Me, const N: usize, const M: usize>(
    model: &Mo,
    method: &mut Me,
    tolerances: Tolerances,
) -> Result<Run, String>
where
    Mo: Model<f64, N, 1, M>,
    Me: Method,
{
    let start = model.start().map_err(|fault| fault.to_string())?;
    let samples = run(model, method, &start, tolerances)?;
    let columns = model.description().outputs.iter();
    let mut recording = Recording::new(columns.map(|output| Column::new(output.name, output.unit)).collect());
    for (t, x, negative) in &samples.states {
        let mut outputs = SVector::<f64, M>::zeros();
        model.outputs(*t, x, negative, &mut outputs);
        recording.push(*t, outputs.iter().copied());
    }
    let poses = poses::from_run(&recording)?;
    Ok(samples.into_run(|_| poses))
}

/// A sample: time, state, branches.
type Sample<const N: usize, const G: usize> = (f64, SVector<f64, N>, [bool; G]);

struct Sampled<const N: usize, const G: usize> {
    states: Vec<Sample<N, G>>,
    wall: std::time::Duration,
    statistics: Statistics,
}

impl<const N: usize, const G: usize> Sampled<N, G> {
    fn into_run(self, poses: impl FnOnce(&[Sample<N, G>]) -> Poses) -> Run {
        let Statistics { steps, rejected, rate_evaluations, events, .. } = self.statistics;
        let work =
            Work { steps: Some(steps), rejected: Some(rejected), rates: Some(rate_evaluations), events: Some(events) };
        Run { wall: self.wall, poses: poses(&self.states), work, compiled: None }
    }
}

/// The timed part.
fn run<Sys, Me, const N: usize, const G: usize>(
    system: &Sys,
    method: &mut Me,
    start: &SVector<f64, N>,
    tolerances: Tolerances,
) -> Result<Sampled<N, G>, String>
where
    Sys: System<f64, N, G>,
    Me: Method,
{
    let settings = Settings { tolerances, samples: Samples::At(instants()), ..Settings::default() };
    let mut states = Vec::with_capacity(crate::problem::SAMPLES);
    let mut observer =
        EachSample(|t: f64, x: &[f64], negative: &[bool]| states.push((t, *values(x), *switches(negative))));
    let clock = Instant::now();
    let finish = integrate(system, method, start, Span { t0: 0.0, t_end: T_END }, &settings, &mut observer);
    let wall = clock.elapsed();
    let statistics = finish.map_err(|failure| failure.to_string())?.statistics;
    Ok(Sampled { states, wall, statistics })
}

/// A hand-written system that knows its problem.
trait Problemed {
    fn problem(&self) -> &Problem;
}

/// The hand-written right-hand side as most engineers write it.
struct Plain<'a>(&'a Problem);

/// The same with everything taken out that a patient one finds.
struct Tuned<'a>(&'a Problem);

macro_rules! by_hand {
    ($system:ident, $rate:ident) => {
        impl System<f64, 24, 1> for $system<'_> {
            #[inline(always)]
            fn rate(&self, _t: f64, x: &SVector<f64, 24>, negative: &[bool; 1], dx: &mut SVector<f64, 24>) {
                let rate: State = self.0.planar.$rate(&x.data.0[0], negative[0]);
                dx.data.0[0] = rate;
            }

            fn guards(&self, _t: f64, x: &SVector<f64, 24>, _negative: &[bool; 1], guards: &mut SVector<f64, 1>) {
                guards[0] = slip(&x.data.0[0]);
            }
        }

        impl Problemed for $system<'_> {
            fn problem(&self) -> &Problem {
                self.0
            }
        }
    };
}

by_hand!(Plain, rate);
by_hand!(Tuned, tuned_rate);
