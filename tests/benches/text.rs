//! What a model of text costs beside the same model compiled by rustc: prints a table.
//!
//! `cargo bench -p bond-graph-tests --bench text [-- WORD]`, for all models or those whose name contains the word.
//! Times are those of the processor, minima of [`ROUNDS`] rounds in which the back ends take turns.
#![allow(missing_docs)]

#[path = "../loaded/texts.rs"]
mod texts;

use std::hint::black_box;
use std::rc::Rc;
use std::sync::Arc;

use bg_loaded::{BackEnd, Blueprint, Interpreted, load};
use bg_model::dynamics::{Machine, branches};
use bg_model::integrator::Integrator;
use bg_model::mechanism::{Mechanism, MechanismVisitor, Scenes};
use bg_model::parameters::Parameters;
use bg_model::run::{Request, Simulation};
use bg_model::simulation::Samples;
use bg_workbench::tables::table;
use bond_graph_tests::models::nonlinear::Pendulum;
use cpu_time::ThreadTime;
use hacksaw::mechanism::Hacksaw;

const ROUNDS: usize = 7;
/// Evaluations of a rate in a round.
const RATES: u32 = 20_000;
/// Which models of the hacksaw.
const SCENES: [&str; 2] = ["motion", "paper"];

const HEAD: [&str; 8] = [
    "model",
    "operations",
    "to machine code, ms",
    "rate, ns: rustc, machine code, interpreter",
    "rate / rustc's",
    "method",
    "1 s, ms: rustc, machine code, interpreter",
    "run / rustc's",
];

fn main() {
    // `cargo test` runs benches without this argument.
    if !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    let words: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let is_wanted = |name: &str| words.is_empty() || words.iter().any(|word| name.contains(word));
    let mut rows = vec![HEAD.map(str::to_owned)];
    if is_wanted("pendulum") {
        measure::<Pendulum>("nonlinear.rs", &|_| true, &mut rows);
    }
    let scene = |name: &str| SCENES.contains(&&*name.to_lowercase()) && is_wanted(&name.to_lowercase());
    measure::<Hacksaw>("hacksaw.bond", &scene, &mut rows);
    print!("{}", table(&rows));
}

/// A row for each method and each model of a text that is wanted.
fn measure<Me: Scenes>(file: &str, is_wanted: &dyn Fn(&str) -> bool, rows: &mut Vec<[String; 8]>) {
    let graphs = load(&texts::of(file, Me::describe().name)).unwrap_or_else(|faults| panic!("{}", faults[0]));
    let graph = graphs.into_iter().find(|graph| graph.name == Me::describe().name).expect("the text has the graph");
    for (index, model) in graph.models.into_iter().enumerate().filter(|(_, model)| is_wanted(model.description.name)) {
        let blueprint = model.blueprint.expect("all scenes were asked for");
        rows.extend(Me::model(index, Beside { blueprint }));
    }
}

struct Beside {
    blueprint: Arc<Blueprint>,
}

impl MechanismVisitor for Beside {
    type Output = Vec<[String; 8]>;

    fn visit<Me: Mechanism + 'static>(self) -> Self::Output {
        let parameters = Me::Parameters::default();
        let loaded = |back_end| -> Rc<dyn Machine> {
            let model = Interpreted::<f64>::new(&self.blueprint, &parameters.values(), &[]);
            Rc::new(model.expect("defaults are possible").by(back_end))
        };
        // Programs that are made when they are first asked for are there before.
        let machine = loaded(BackEnd::Interpreter);
        black_box((machine.damping_sparsity(), machine.operations_of_forces(), machine.series().is_some()));
        let begin = ThreadTime::now();
        self.blueprint.translate();
        let translation = 1e3 * begin.elapsed().as_secs_f64();
        let machines = [
            Me::make(parameters.clone(), &[]).expect("defaults are possible").machine(),
            loaded(BackEnd::default()),
            loaded(BackEnd::Interpreter),
        ];
        let rates = of_rates(&machines);
        let runs = [Integrator::Dop853, Integrator::Taylor, Integrator::Auto].map(|method| {
            let runs = of_runs(&machines, method);
            [
                Me::describe().name.to_owned(),
                Me::describe().operations[0].1.total().to_string(),
                format!("{translation:.2}"),
                three(&rates, 1e9),
                ratios(&rates),
                method.name().to_owned(),
                three(&runs, 1e3),
                ratios(&runs),
            ]
        });
        runs.to_vec()
    }
}

/// Seconds of a rate of each machine.
fn of_rates(machines: &[Rc<dyn Machine>; 3]) -> [f64; 3] {
    let x = machines[0].start().expect("a start");
    let negative = branches(&*machines[0], 0.0, &x);
    least(machines, |machine| {
        let mut dx = vec![0.0; x.len()];
        (0..RATES).for_each(|_| machine.rate(0.0, black_box(&x), &negative, black_box(&mut dx)));
    })
    .map(|seconds| seconds / f64::from(RATES))
}

/// Seconds of a run of 1 s of each machine.
fn of_runs(machines: &[Rc<dyn Machine>; 3], method: Integrator) -> [f64; 3] {
    let request = || Request { method, t_end: 1.0, samples: Samples::Every(0.01), ..Request::default() };
    least(machines, |machine| {
        black_box(Simulation::over(Rc::clone(machine), request()).run().expect("a run"));
    })
}

/// Seconds that `of` takes with each machine, the least of all rounds.
fn least(machines: &[Rc<dyn Machine>; 3], mut of: impl FnMut(&Rc<dyn Machine>)) -> [f64; 3] {
    let mut least = [f64::INFINITY; 3];
    for _ in 0..ROUNDS {
        for (machine, least) in machines.iter().zip(&mut least) {
            let begin = ThreadTime::now();
            of(machine);
            *least = least.min(begin.elapsed().as_secs_f64());
        }
    }
    least
}

fn three(seconds: &[f64; 3], unit: f64) -> String {
    seconds.map(|seconds| format!("{:.3}", seconds * unit)).join(", ")
}

/// Machine code and interpreter beside rustc's code.
fn ratios([rustc, machine_code, interpreter]: &[f64; 3]) -> String {
    format!("{:.2}, {:.1}", machine_code / rustc, interpreter / rustc)
}
