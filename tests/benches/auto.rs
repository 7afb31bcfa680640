//! What `auto` takes beside the best explicit method by name: prints a table.
//!
//! `cargo bench -p bond-graph-tests --bench auto [-- WORD]`, for all models or those whose name contains the word. Times are those of the
//! processor, minima of [`ROUNDS`] rounds in which the methods take turns. Runs of less than a millisecond show what the trials cost.
#![allow(missing_docs)]

use bg_model::integrator::Integrator;
use bg_model::mechanism::Mechanism;
use bg_model::run::{Request, Simulation};
use bg_model::simulation::Samples;
use bg_workbench::tables::table;
use bond_graph_tests::models::double_pendulum::{
    RigidPendulum, RigidPendulumParameters, RodAngles, RodAnglesParameters,
};
use bond_graph_tests::models::slider_crank::{
    PlanarSliderCrank, PlanarSliderCrankParameters, RigidSliderCrank, RigidSliderCrankParameters,
};
use cpu_time::ThreadTime;
use hacksaw::mechanism::{
    Full, FullParameters, Motion, MotionParameters, Paper, PaperParameters, Rigid, RigidParameters,
};

const ROUNDS: usize = 5;
const TOLERANCES: [f64; 10] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12];
/// `auto`, then those that it is held against.
const METHODS: [Integrator; 5] =
    [Integrator::Auto, Integrator::Dop853, Integrator::Cfmr7, Integrator::Nystrom, Integrator::Taylor];

fn main() {
    // `cargo test` runs benches without this argument.
    if !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    let words: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let mut measured = Table { rows: vec![HEAD.map(str::to_owned)], words };
    measured.add("paper", 5.0, &Paper::new(PaperParameters::default()).expect("defaults"));
    measured.add("motion", 5.0, &Motion::new(MotionParameters::default()).expect("defaults"));
    measured.add("full", 1.0, &Full::new(FullParameters::default()).expect("defaults"));
    measured.add("rigid", 5.0, &Rigid::new(RigidParameters::default()).expect("defaults"));
    let slider = PlanarSliderCrankParameters::default();
    let soft = PlanarSliderCrankParameters { stiffness: 5e4, damping: 50.0, ..slider.clone() };
    measured.add("slider-crank", 2.0, &PlanarSliderCrank::new(slider).expect("defaults"));
    measured.add("softer slider-crank", 2.0, &PlanarSliderCrank::new(soft).expect("in range"));
    let rigid = RigidSliderCrank::new(RigidSliderCrankParameters::default()).expect("defaults");
    measured.add("rigid slider-crank", 2.0, &rigid);
    measured.add("double pendulum", 2.0, &RodAngles::new(RodAnglesParameters::default()).expect("defaults"));
    let rigid = RigidPendulum::new(RigidPendulumParameters::default()).expect("defaults");
    measured.add("rigid double pendulum", 5.0, &rigid);
    print!("{}", table(&measured.rows));
}

const HEAD: [&str; 10] =
    ["model", "s", "rtol", "auto, ms", "dop853", "cfmr7", "nystrom", "taylor", "auto / best", "chosen"];

/// The rows that are printed, and the words that choose models; none for all.
struct Table {
    rows: Vec<[String; 10]>,
    words: Vec<String>,
}

impl Table {
    /// A row for each tolerance.
    fn add(&mut self, name: &str, t_end: f64, model: &impl Mechanism) {
        if !self.words.is_empty() && !self.words.iter().any(|word| name.contains(word)) {
            return;
        }
        for rtol in TOLERANCES {
            let mut least = [f64::INFINITY; METHODS.len()];
            let mut chosen = String::new();
            for _ in 0..ROUNDS {
                for (least, method) in least.iter_mut().zip(METHODS) {
                    let request = Request { method, t_end, rtol, samples: Samples::Every(t_end), ..Request::default() };
                    let clock = ThreadTime::now();
                    let Ok(run) = Simulation::of(model, request).run() else { continue };
                    *least = least.min(1e3 * clock.elapsed().as_secs_f64());
                    if method == Integrator::Auto {
                        chosen = run.methods.last().map_or_else(String::new, |change| change.method.to_owned());
                    }
                }
            }
            let [auto, others @ ..] = least;
            let best = others.into_iter().fold(f64::INFINITY, f64::min);
            let times = least.map(|ms| if ms.is_finite() { format!("{ms:.3}") } else { "-".to_owned() });
            let mut row = vec![name.to_owned(), format!("{t_end}"), format!("{rtol:e}")];
            row.extend(times);
            row.extend([format!("{:.2}", auto / best), chosen]);
            self.rows.push(row.try_into().expect("a cell for each column"));
        }
    }
}
