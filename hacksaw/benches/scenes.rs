//! What every scene costs, and how the paper's compares with a hand-written model: prints a table.
//!
//! `cargo bench -p hacksaw --bench scenes`. Times are minima: of [`BATCHES`] batches of rate evaluations over states
//! along the scene's own trajectory, the models taking turns so that all see the same machine; of [`RUNS`] runs of 5 s.
#![allow(missing_docs)]

use std::hint::black_box;
use std::time::Instant;

use bg_model::integrator::{Dop853, Integrator, Tolerances};
use bg_model::mechanism::{Mechanism, MechanismVisitor, ModelVisitor};
use bg_model::nalgebra::SVector;
use bg_model::run::{Request, Simulation, sample_times};
use bg_model::simulation::{EachSample, Samples, Settings, Span, integrate};
use bg_model::system::{Model, switches, values};
use bg_workbench::tables::{rate_operations, table};
use hacksaw::agreement::{Job, Steps, compare, horizon};
use hacksaw::mechanism::{HacksawParameters, Paper, PaperParameters};
use hacksaw::scenes::Scene;
use hacksaw_planar::{self as planar, Comparison, Planar};

const BATCHES: usize = 400;
/// Passes over the states in a batch.
const PASSES: usize = 20;
const RUNS: usize = 5;
/// The end of the paper's run, s, and its tolerances.
const T_END: f64 = 5.0;
const RTOL: f64 = 1e-8;
const ATOL: f64 = 1e-9;
/// The names of the two hand-written rates and their operations, counted in the source; a sine and cosine pair is two.
const BY_HAND: [(&str, usize); 2] = [("by hand, plain", 295), ("by hand, tuned", 213)];
/// The part of the hand-written model's time that the paper's scene is to take at most.
const GOAL: f64 = 0.6;

/// One batch: nanoseconds for each rate evaluation.
type Batch = Box<dyn Fn() -> f64>;

fn main() {
    // `cargo test` runs benches without this argument.
    if !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    let mut batches: Vec<Batch> = Scene::ALL.into_iter().map(|scene| scene.visit(Rates)).collect();
    let (states, disagreement) = planar_states();
    batches.push(planar_batch(states.clone(), Planar::rate));
    batches.push(planar_batch(states, Planar::tuned_rate));
    let mut least = vec![f64::INFINITY; batches.len()];
    for _ in 0..BATCHES {
        for (least, batch) in least.iter_mut().zip(&batches) {
            *least = least.min(batch());
        }
    }
    let head = ["scene", "states", "operations", "ns a rate", "ms for 5 s", "steps", "largest deviation", "in"];
    let mut rows = vec![head.map(str::to_owned)];
    for (scene, nanoseconds) in Scene::ALL.into_iter().zip(&least) {
        let description = scene.description();
        let (milliseconds, steps) = scene.visit(Wall);
        let (deviation, column) = if scene.is_compliant() {
            let (deviation, column) = deviation(scene);
            (format!("{deviation:.1e}"), column)
        } else {
            ("other joints".to_owned(), String::new())
        };
        rows.push([
            scene.name(),
            description.states.len().to_string(),
            rate_operations(description).total().to_string(),
            format!("{nanoseconds:.1}"),
            format!("{milliseconds:.1}"),
            steps.to_string(),
            deviation,
            column,
        ]);
    }
    let by_hand = &least[Scene::ALL.len()..];
    for ((name, operations), nanoseconds) in BY_HAND.iter().zip(by_hand) {
        let cells = [*name, "24", &operations.to_string(), &format!("{nanoseconds:.1}"), "", "", "", ""];
        rows.push(cells.map(str::to_owned));
    }
    print!("{}", table(&rows));
    println!(
        "\nLargest deviation: of any output from the literal model's, over the largest value of its kind (1 where that \
         is less), rtol 1e-8, 51 instants (of 5 s; free-run: of 1 s, after which it is chaotic).\n\
         By hand: planar models in body poses; accelerations agree with the paper's scene to {disagreement:.1e}.\n\
         Paper's scene over by hand: plain {:.0} % (goal: at most {:.0} %), tuned {:.0} %.",
        100.0 * least[0] / by_hand[0],
        100.0 * GOAL,
        100.0 * least[0] / by_hand[1]
    );
}

/// States of `model` along its run, a prime number of them, with the branches there.
fn along<Mo, const N: usize, const G: usize, const M: usize>(model: &Mo) -> Vec<(SVector<f64, N>, [bool; G])>
where
    Mo: Model<f64, N, G, M>,
{
    let mut states = Vec::new();
    let settings = Settings {
        tolerances: Tolerances::new(RTOL, ATOL),
        samples: Samples::At(sample_times(0.0, T_END / 61.0, T_END)[1..].to_vec()),
        ..Settings::default()
    };
    let start = model.start().expect("the paper's mechanism closes");
    let mut observer = EachSample(|_, x: &[f64], negative: &[bool]| states.push((*values(x), *switches(negative))));
    let span = Span { t0: 0.0, t_end: T_END };
    integrate(model, &mut Dop853::new(), &start, span, &settings, &mut observer).expect("the paper's case runs");
    states
}

/// The least time of one evaluation, ns, in one batch over `states`.
fn batch<X>(states: &[X], evaluate: impl Fn(&X)) -> f64 {
    let clock = Instant::now();
    for _ in 0..PASSES {
        for state in states {
            evaluate(black_box(state));
        }
    }
    clock.elapsed().as_secs_f64() * 1e9 / (PASSES * states.len()) as f64
}

struct Rates;

impl MechanismVisitor for Rates {
    type Output = Batch;

    fn visit<Sc: Mechanism>(self) -> Batch {
        let model = Sc::make(Sc::Parameters::default(), &[]).expect("defaults are in their ranges");
        model.visit(self)
    }
}

impl ModelVisitor<f64> for Rates {
    type Output = Batch;

    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Batch
    where
        Mo: Model<f64, N, G, M> + Clone + 'static,
    {
        let (states, model) = (along(model), model.clone());
        Box::new(move || {
            let model = black_box(&model);
            batch(&states, |(x, negative)| {
                let mut rate = SVector::zeros();
                model.rate(0.0, x, negative, &mut rate);
                black_box(&rate);
            })
        })
    }
}

/// A hand-written rate over the states of the paper's scene.
fn planar_batch(
    states: Vec<(planar::State, bool)>,
    rate: impl Fn(&Planar, &planar::State, bool) -> planar::State + 'static,
) -> Batch {
    let planar = Planar::new(&PaperParameters::default());
    Box::new(move || {
        let planar = black_box(&planar);
        batch(&states, |(state, cutting)| {
            black_box(&rate(planar, state, *cutting));
        })
    })
}

/// The states of the paper's scene as poses, and how far the hand-written accelerations are from the scene's there.
fn planar_states() -> (Vec<(planar::State, bool)>, f64) {
    let model = Paper::new(PaperParameters::default()).expect("defaults are in their ranges");
    let states = along(&model);
    let mut comparison = Comparison::default();
    let poses = states
        .into_iter()
        .map(|(x, negative)| planar::beside(&model, model.parameters(), x, negative, &mut comparison));
    (poses.collect(), comparison.relative())
}

struct Wall;

impl MechanismVisitor for Wall {
    type Output = (f64, u64);

    fn visit<Sc: Mechanism>(self) -> (f64, u64) {
        let model = Sc::make(Sc::Parameters::default(), &[]).expect("defaults are in their ranges");
        let request =
            Request { method: Integrator::Dop853, t_end: T_END, rtol: RTOL, atol: Some(ATOL), ..Request::default() };
        let request = Request { samples: Samples::Every(0.002), ..request };
        let run = || Simulation::of(&model, request.clone()).run().expect("the paper's case runs");
        let runs = (0..RUNS).map(|_| run());
        runs.map(|run| (run.wall.as_secs_f64() * 1e3, run.statistics.steps))
            .fold((f64::INFINITY, 0), |least, run| if run.0 < least.0 { run } else { least })
    }
}

/// The largest deviation from the literal model over the magnitude of its kind, and its output.
fn deviation(scene: Scene) -> (f64, String) {
    let t_end = horizon(scene);
    // The paper's 51 instants, over as long as the comparison means something.
    let instants = sample_times(0.0, t_end / 50.0, t_end);
    let steps = Steps::ByError { rtol: RTOL, atol: ATOL };
    let agreement = compare(scene, &HacksawParameters::default(), Job { steps, t_end, instants: &instants });
    let agreement = agreement.expect("the paper's case runs");
    let relative = agreement.deviations.iter().map(|deviation| {
        (deviation.largest / deviation.magnitude.max(1.0), format!("{} at {} s", deviation.name, deviation.time))
    });
    relative.fold((0.0, String::new()), |most, this| if this.0 > most.0 { this } else { most })
}
