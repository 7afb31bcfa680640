//! A scene beside the model it was reduced from, in the same steps.

use bg_model::integrator::{Dop853, Tolerances};
use bg_model::nalgebra::SVector;
use bg_model::parameters::Parameters;
use bg_model::simulation::{EachSample, Samples, Settings, Span, integrate};
use bg_model::system::{Model, System, switches, values};

/// The outputs of a run at its sample times, by name.
pub struct Table {
    names: Vec<&'static str>,
    units: Vec<&'static str>,
    rows: Vec<Vec<f64>>,
    pub events: u64,
}

impl Table {
    /// Output `name` at every sample, if there is one.
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let column = self.names.iter().position(|known| *known == name)?;
        Some(self.rows.iter().map(|row| row[column]).collect())
    }

    /// The same under a name that must be there.
    pub fn series(&self, name: &str) -> Vec<f64> {
        self.column(name).unwrap_or_else(|| panic!("no output {name} in {:?}", self.names))
    }
}

/// A model whose switches stay in the branch of a positive guard: for laws that are the same in both branches.
pub struct Unswitched<Mo, const G: usize>(pub Mo);

impl<Mo, const N: usize, const G: usize> System<f64, N, 0> for Unswitched<Mo, G>
where
    Mo: System<f64, N, G>,
{
    fn rate(&self, t: f64, x: &SVector<f64, N>, _negative: &[bool; 0], dx: &mut SVector<f64, N>) {
        self.0.rate(t, x, &[false; G], dx);
    }

    fn project(&self, t: f64, _negative: &[bool; 0], x: &mut SVector<f64, N>) {
        self.0.project(t, &[false; G], x);
    }
}

/// Steps of `step`, shorter ones only before events; the error estimate has no say.
fn settings(step: f64, samples: &[f64]) -> Settings {
    Settings {
        tolerances: Tolerances::new(1e6, 1e6),
        first_step: Some(step),
        largest_step: step,
        samples: Samples::At(samples.to_vec()),
        ..Settings::default()
    }
}

/// Runs a model from its start with steps of `step` up to the last sample.
pub fn run<Mo, const N: usize, const G: usize, const M: usize>(model: &Mo, step: f64, samples: &[f64]) -> Table
where
    Mo: Model<f64, N, G, M>,
{
    run_as(model, model, step, samples, |negative| *negative)
}

/// The same without events.
pub fn run_unswitched<Mo, const N: usize, const G: usize, const M: usize>(
    model: Mo,
    step: f64,
    samples: &[f64],
) -> Table
where
    Mo: Model<f64, N, G, M>,
{
    let unswitched = Unswitched::<Mo, G>(model);
    run_as(&unswitched, &unswitched.0, step, samples, |_: &[bool; 0]| [false; G])
}

fn run_as<Sys, Mo, const N: usize, const S: usize, const G: usize, const M: usize>(
    system: &Sys,
    model: &Mo,
    step: f64,
    samples: &[f64],
    branches: impl Fn(&[bool; S]) -> [bool; G],
) -> Table
where
    Sys: System<f64, N, S>,
    Mo: Model<f64, N, G, M>,
{
    let mut rows = Vec::new();
    let mut observer = EachSample(|t: f64, x: &[f64], negative: &[bool]| {
        let mut y = SVector::<f64, M>::zeros();
        model.outputs(t, values(x), &branches(switches(negative)), &mut y);
        rows.push(y.as_slice().to_vec());
    });
    let start = model.start().expect("the mechanism closes");
    let span = Span { t0: 0.0, t_end: samples.last().copied().expect("a sample") };
    let finish = integrate(system, &mut Dop853::new(), &start, span, &settings(step, samples), &mut observer);
    let statistics = finish.unwrap_or_else(|failure| panic!("{failure}")).statistics;
    assert_eq!(statistics.rejected, 0, "a rejected step is not the same in both");
    let names = model.description().outputs.iter().map(|output| output.name).collect();
    let units = model.description().outputs.iter().map(|output| output.unit).collect();
    Table { names, units, rows, events: statistics.events }
}

/// `full` with the values of `own`, by name.
pub fn widened<P: Parameters, Q: Parameters>(own: &P) -> Q {
    let mut full = Q::default();
    for (index, info) in P::table().iter().enumerate() {
        full.set(info.name, own.value(index)).expect("the graph has the scene's parameters");
    }
    full
}

/// `P` with each value changed by up to a part `part`, another way for each `seed`; 0 leaves the defaults.
pub fn varied<P: Parameters>(seed: u64, part: f64) -> P {
    let mut draw = bond_graph_tests::support::power::Draw::new(seed);
    let mut parameters = P::default();
    for index in 0..P::table().len() {
        let value = parameters.value(index) * (1.0 + if seed == 0 { 0.0 } else { part * draw.number() });
        parameters.set_value(index, value);
    }
    parameters
}

/// The largest deviations of a scene, each with its column.
#[derive(Debug)]
pub struct Deviations {
    /// Of positions, orientations, angles, energies: a part of the column's largest magnitude, or of 1.
    pub motion: (f64, &'static str),
    /// Of momenta, speeds and currents, likewise: what a pose's rounding makes of a stiff joint is in them at once.
    pub rates: (f64, &'static str),
    /// Of forces, N: a joint's stiffness times the rounding of poses.
    pub forces: (f64, &'static str),
}

/// Compares each of the scene's columns with the full one's, by `of` where the full model has it under another name,
/// and prints the largest deviations.
pub fn compared(what: &str, full: &Table, scene: &Table, of: impl Fn(&str) -> Option<Vec<f64>>) -> Deviations {
    let mut worst = Deviations { motion: (0.0, ""), rates: (0.0, ""), forces: (0.0, "") };
    for (name, unit) in scene.names.iter().zip(&scene.units) {
        let expected = full.column(name).or_else(|| of(name));
        let expected = expected.unwrap_or_else(|| panic!("no column to compare {name} with"));
        let size = expected.iter().fold(1.0_f64, |size, value| size.max(value.abs()));
        let (kind, size) = match *unit {
            "m" | "1" | "" | "rad" | "J" => (&mut worst.motion, size),
            "N" | "N*m" => (&mut worst.forces, 1.0),
            _ => (&mut worst.rates, size),
        };
        for (value, expected) in scene.series(name).iter().zip(&expected) {
            let error = (value - expected).abs() / size;
            assert!(error.is_finite(), "{what}: {name}");
            if error > kind.0 {
                *kind = (error, name);
            }
        }
    }
    let Deviations { motion, rates, forces } = &worst;
    println!(
        "{what}: {} columns, {} events; motion {:.1e} ({}), rates {:.1e} ({}), forces {:.1e} N ({})",
        scene.names.len(),
        scene.events,
        motion.0,
        motion.1,
        rates.0,
        rates.1,
        forces.0,
        forces.1
    );
    worst
}

/// `count` + 1 instants up to `end`, a tenth of it in a debug build.
pub fn instants(end: f64, count: u32) -> Vec<f64> {
    bond_graph_tests::support::record::instants(if cfg!(debug_assertions) { 0.1 * end } else { end }, count)
}
