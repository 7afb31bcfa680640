//! How far the first steps of runs err, in parts of what is allowed after them: a table of how often that is too much.
//!
//! `cargo run -p bond-graph-tests --example first_steps [-- METHOD]`: over all examples and scenes, from their starts,
//! from where they are at random instants, and from there at rest. What is allowed is what the run itself allows its
//! second step, as sizes of states are known then. Held against: DOP853 by steps of a sixteenth of the first one at
//! most, with a ten thousandth of the tolerances.
#![allow(missing_docs, clippy::print_stdout)]

use std::collections::BTreeMap;

use bg_model::description::{StateInfo, StateKind};
use bg_model::dynamics::{Dynamics, Machine};
use bg_model::input::Input;
use bg_model::integrator::{Dop853, Integrator, Point, Scale, Tolerances};
use bg_model::simulation::{Observer, Samples, Settings, Span, drive};
use bg_model::statistics::Statistics;
use bond_graph_tests::models::double_pendulum::{
    RigidPendulum, RigidPendulumParameters, RodAngles, RodAnglesParameters,
};
use bond_graph_tests::models::slider_crank::{
    PlanarSliderCrank, PlanarSliderCrankParameters, RigidSliderCrank, RigidSliderCrankParameters,
};
use bond_graph_tests::support::example::{Example, examples, scenes};

/// The span of the runs, s.
const T_END: f64 = 10.0;
/// Random instants of each model, and the seed.
const INSTANTS: usize = 3;
const SEED: u64 = 1;
/// An error above this is too much.
const MOST: f64 = 3.0;

/// A system in the branches of one step.
struct Frozen<'a> {
    machine: &'a dyn Machine,
    negative: &'a [bool],
}

impl Dynamics for Frozen<'_> {
    fn states(&self) -> usize {
        self.machine.states()
    }
    fn rate(&self, t: f64, x: &[f64], _: &[bool], dx: &mut [f64]) {
        self.machine.rate(t, x, self.negative, dx);
    }
    fn project(&self, t: f64, _: &[bool], x: &mut [f64]) {
        self.machine.project(t, self.negative, x);
    }
    fn stored(&self) -> Option<&'static [StateInfo]> {
        self.machine.stored()
    }
    fn energy(&self, t: f64, x: &[f64], _: &[bool], curvatures: &mut [f64]) -> f64 {
        self.machine.energy(t, x, self.negative, curvatures)
    }
}

/// Keeps the first step of a run, and ends it.
#[derive(Default)]
struct First {
    scale: Option<Scale>,
    step: Option<(Point, Point, Vec<bool>)>,
    is_done: bool,
}

impl Observer for First {
    fn measured(&mut self, scale: &Scale) {
        self.scale = Some(scale.clone());
    }
    fn passed(&mut self, start: &Point, end: &Point, negative: &[bool]) {
        self.step = Some((start.clone(), end.clone(), negative.to_vec()));
    }
    fn step(&mut self, _: f64, _: f64, _: &Statistics) {
        self.is_done = true;
    }
    fn is_done(&self) -> bool {
        self.is_done
    }
}

fn settings(rtol: f64) -> Settings {
    let samples = Samples::Every(f64::INFINITY);
    Settings { tolerances: Tolerances::relative(rtol), samples, step_limit: 20_000, ..Settings::default() }
}

/// The error of the first step of a run; none where it or what it is held against fails.
fn error(machine: &dyn Machine, method: Integrator, start: &[f64], rtol: f64) -> Option<f64> {
    let mut first = First::default();
    let span = Span { t0: 0.0, t_end: T_END };
    // A run that fails later has made its first step.
    let _ = drive(machine, &mut method.method(1.0), start, span, &settings(rtol), None, &mut first);
    let ((start, end, negative), scale) = (first.step?, first.scale?);
    let (system, h) = (Frozen { machine, negative: &negative }, end.t - start.t);
    let fine = settings((1e-4 * rtol).max(3e-15));
    let fine = Settings { first_step: Some(h / 256.0), largest_step: h / 16.0, ..fine };
    let span = Span { t0: start.t, t_end: end.t };
    let exact = drive(&system, &mut Dop853::new(), start.x.as_slice(), span, &fine, None, &mut ()).ok()?.x;
    let off = |i: usize| (exact[i] - end.x[i]).abs() / scale.allowed_between(i, start.x[i], end.x[i]);
    Some((0..exact.len()).map(off).fold(0.0, f64::max))
}

/// The starts of a model, each with its kind.
fn starts(machine: &dyn Machine, random: &mut fastrand::Rng) -> Vec<(&'static str, Vec<f64>)> {
    let Ok(start) = machine.start() else { return Vec::new() };
    let mut starts = vec![("its own", start.clone())];
    for _ in 0..INSTANTS {
        let span = Span { t0: 0.0, t_end: 2.0 * random.f64() };
        let run = drive(machine, &mut Dop853::new(), &start, span, &settings(1e-6), None, &mut ());
        let Ok(finish) = run else { continue };
        let moving = finish.x.as_slice().to_vec();
        if let Some(states) = machine.stored() {
            let is_momentum = |state: &StateInfo| matches!(state.kind, StateKind::Momentum(_));
            let at_rest = states.iter().zip(&moving).map(|(state, x)| if is_momentum(state) { 0.0 } else { *x });
            starts.push(("at rest", at_rest.collect()));
        }
        starts.push(("moving", moving));
    }
    starts
}

fn models() -> Vec<Example> {
    let constant = Input::constant(1.0);
    let mut models = Vec::new();
    macro_rules! add_examples {
        ($($name:ident: $module:ident $model:ident ($($rest:tt)*);)*) => {
            $( models.push(examples::$name(&constant)); )*
        };
    }
    macro_rules! add_scenes {
        ($($name:ident: $model:ident ($($rest:tt)*);)*) => {$( models.push(scenes::$name()); )*};
    }
    bond_graph_tests::each_example!(add_examples);
    bond_graph_tests::each_scene!(add_scenes);
    models.push(Example::of(&RodAngles::new(RodAnglesParameters::default()).expect("defaults")));
    models.push(Example::of(&RigidPendulum::new(RigidPendulumParameters::default()).expect("defaults")));
    models.push(Example::of(&PlanarSliderCrank::new(PlanarSliderCrankParameters::default()).expect("defaults")));
    models.push(Example::of(&RigidSliderCrank::new(RigidSliderCrankParameters::default()).expect("defaults")));
    models
}

fn main() {
    let method = std::env::args().nth(1).map_or(Integrator::Dop853, |name| name.parse().expect("an integrator"));
    let mut random = fastrand::Rng::with_seed(SEED);
    // Of each kind of start and decade: runs, those that err too much, the largest error.
    let mut found: BTreeMap<&str, BTreeMap<i32, (u32, u32, f64)>> = BTreeMap::new();
    for model in models() {
        for (kind, start) in starts(&*model.machine, &mut random) {
            for decade in 3..=12 {
                let rtol = 10.0_f64.powi(-decade);
                let Some(error) = error(&*model.machine, method, &start, rtol) else { continue };
                let (runs, too_much, largest) = found.entry(kind).or_default().entry(decade).or_default();
                (*runs, *too_much, *largest) = (*runs + 1, *too_much + u32::from(error > MOST), largest.max(error));
            }
        }
    }
    for (kind, decades) in found {
        let cells = decades.values().map(|(runs, too_much, largest)| format!("{too_much} of {runs}, {largest:.2}"));
        println!("| {kind} | {} |", cells.collect::<Vec<_>>().join(" | "));
    }
}
