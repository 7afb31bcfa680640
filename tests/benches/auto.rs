//! What `auto` takes beside the best method by name, and how far its result is off: prints a table.
//!
//! `cargo bench -p bond-graph-tests --bench auto [-- WORD]`, for all models or those whose name contains the word.
//! Times are those of the processor, minima of [`ROUNDS`] rounds in which the methods take turns. Runs of less than a
//! millisecond show what the trials cost. The error is the largest difference of an output to a run at [`TIGHT`] at 21
//! instants, over the largest value in its unit, in parts of the tolerance; that of the fastest method by name stands
//! beside it. Forces and torques do not count: reactions near a dead centre have spikes as narrow as a step.
#![allow(missing_docs)]

use bg_model::integrator::Integrator;
use bg_model::mechanism::Mechanism;
use bg_model::run::{Request, Simulation, Trajectory};
use bg_model::simulation::{Recording, Samples};
use bg_workbench::compare::{Deviation, deviations};
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
/// The relative tolerance of the run that errors are measured by, and its instants.
const TIGHT: f64 = 1e-13;
const INSTANTS: f64 = 20.0;
/// `auto`, then those that it is held against: where nothing is strongly damped, and where something is. The last is
/// right at [`TIGHT`].
const EXPLICIT: &[Integrator] =
    &[Integrator::Auto, Integrator::Dop853, Integrator::Cfmr7, Integrator::Nystrom, Integrator::Taylor];
const IMPLICIT: &[Integrator] = &[Integrator::Auto, Integrator::Ark5, Integrator::Radau9];

fn main() {
    // `cargo test` runs benches without this argument.
    if !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    let words: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let mut measured = Table { rows: vec![HEAD.map(str::to_owned)], words };
    measured.add("paper", 5.0, EXPLICIT, &Paper::new(PaperParameters::default()).expect("defaults"));
    measured.add("motion", 5.0, EXPLICIT, &Motion::new(MotionParameters::default()).expect("defaults"));
    measured.add("full", 5.0, EXPLICIT, &Full::new(FullParameters::default()).expect("defaults"));
    let off = FullParameters { rod_offset: 0.025, ..FullParameters::default() };
    measured.add("full, rod off", 5.0, IMPLICIT, &Full::new(off).expect("in range"));
    measured.add("rigid", 5.0, EXPLICIT, &Rigid::new(RigidParameters::default()).expect("defaults"));
    let slider = PlanarSliderCrankParameters::default();
    let soft = PlanarSliderCrankParameters { stiffness: 5e4, damping: 50.0, ..slider.clone() };
    measured.add("slider-crank", 10.0, EXPLICIT, &PlanarSliderCrank::new(slider).expect("defaults"));
    measured.add("softer slider-crank", 10.0, EXPLICIT, &PlanarSliderCrank::new(soft).expect("in range"));
    let rigid = RigidSliderCrank::new(RigidSliderCrankParameters::default()).expect("defaults");
    measured.add("rigid slider-crank", 10.0, EXPLICIT, &rigid);
    let compliant = RodAngles::new(RodAnglesParameters::default()).expect("defaults");
    measured.add("double pendulum", 10.0, EXPLICIT, &compliant);
    let rigid = RigidPendulum::new(RigidPendulumParameters::default()).expect("defaults");
    measured.add("rigid double pendulum", 20.0, EXPLICIT, &rigid);
    print!("{}", table(&measured.rows));
}

const HEAD: [&str; 7] =
    ["model", "s", "rtol", "ms: auto, then by name", "auto / best", "error / rtol: auto, best", "at the end"];

/// The rows that are printed, and the words that choose models; none for all.
struct Table {
    rows: Vec<[String; 7]>,
    words: Vec<String>,
}

impl Table {
    /// A row for each tolerance.
    fn add(&mut self, name: &str, t_end: f64, methods: &[Integrator], model: &impl Mechanism) {
        if !self.words.is_empty() && !self.words.iter().any(|word| name.contains(word)) {
            return;
        }
        let run = |method: Integrator, rtol, every| {
            let request = Request { method, t_end, rtol, samples: Samples::Every(every), ..Request::default() };
            Simulation::of(model, request).run()
        };
        let [.., best_at_tight] = methods else { return };
        let tight = run(*best_at_tight, TIGHT, t_end / INSTANTS).expect("runs at the tightest tolerance");
        for rtol in TOLERANCES {
            let mut least = vec![f64::INFINITY; methods.len()];
            for _ in 0..ROUNDS {
                for (least, method) in least.iter_mut().zip(methods) {
                    let clock = ThreadTime::now();
                    if run(*method, rtol, t_end).is_ok() {
                        *least = least.min(1e3 * clock.elapsed().as_secs_f64());
                    }
                }
            }
            let best = (1..methods.len()).min_by(|a, b| least[*a].total_cmp(&least[*b])).expect("a method by name");
            let sampled = |method| run(method, rtol, t_end / INSTANTS).ok();
            let error = |run: &Option<Trajectory>| {
                run.as_ref().map_or(f64::INFINITY, |run| distance(&run.recording, &tight.recording) / rtol)
            };
            let (auto, by_name) = (sampled(methods[0]), sampled(methods[best]));
            let last = auto.as_ref().and_then(|run| run.methods.last());
            let times = least.iter().map(|ms| if ms.is_finite() { format!("{ms:.3}") } else { "-".to_owned() });
            let ratio = format!("{:.2}", least[0] / least[best]);
            let times = times.collect::<Vec<_>>().join(", ");
            self.rows.push([
                name.to_owned(),
                format!("{t_end}"),
                format!("{rtol:e}"),
                times,
                ratio,
                format!("{:.1}, {:.1}", error(&auto), error(&by_name)),
                last.map_or_else(String::new, |change| change.method.to_owned()),
            ]);
        }
    }
}

/// The largest difference of a motion, over the largest value in its unit.
fn distance(run: &Recording, reference: &Recording) -> f64 {
    let is_motion = |deviation: &Deviation| !deviation.unit.starts_with('N');
    let found: Vec<Deviation> = deviations(run, reference).into_iter().filter(is_motion).collect();
    let size = |unit: &str| {
        let of_unit = found.iter().filter(|deviation| deviation.unit == unit);
        of_unit.map(|deviation| deviation.magnitude).fold(f64::MIN_POSITIVE, f64::max)
    };
    found.iter().map(|deviation| deviation.largest / size(&deviation.unit)).fold(0.0, f64::max)
}
