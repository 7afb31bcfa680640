//! A run of a model with its outputs by name.

use bg_model::dynamics::Machine;
use bg_model::integrator::{Dop853, Tolerances};
use bg_model::mechanism::Mechanism;
use bg_model::simulation::{EachSample, Part, Recorder, Recording, Samples, Settings, Span, drive};
use bg_model::statistics::Statistics;

/// The outputs of a run at its sample times.
#[derive(Clone, Debug)]
pub struct Record {
    /// Sample times, s.
    pub times: Vec<f64>,
    /// The times of the switchings, s.
    pub events: Vec<f64>,
    /// What the run has cost.
    pub statistics: Statistics,
    recording: Recording,
}

impl Record {
    /// Output `name` at every sample.
    ///
    /// # Panics
    /// There is no such output.
    #[must_use]
    pub fn series(&self, name: &str) -> Vec<f64> {
        let names = || self.recording.columns.iter().map(|column| column.name.as_str()).collect::<Vec<_>>();
        self.recording.column(name).unwrap_or_else(|| panic!("no output `{name}` in {:?}", names())).to_vec()
    }

    /// The vector output `name` at every sample.
    #[must_use]
    pub fn vectors(&self, name: &str) -> Vec<[f64; 3]> {
        let [x, y, z] = ["x", "y", "z"].map(|axis| self.series(&format!("{name}_{axis}")));
        (0..x.len()).map(|k| [x[k], y[k], z[k]]).collect()
    }

    /// Output `name` at the end.
    #[must_use]
    pub fn last(&self, name: &str) -> f64 {
        self.series(name).last().copied().unwrap_or(f64::NAN)
    }

    /// The largest deviation of output `name` from `truth` of time.
    pub fn deviation(&self, name: &str, truth: impl Fn(f64) -> f64) -> f64 {
        let pairs = self.times.iter().zip(self.series(name));
        pairs.map(|(&t, value)| (value - truth(t)).abs()).fold(0.0, f64::max)
    }

    /// The largest deviation of output `name` from its value at the start.
    #[must_use]
    pub fn drift(&self, name: &str) -> f64 {
        let first = self.series(name)[0];
        self.deviation(name, |_| first)
    }

    /// The largest magnitude of output `name`.
    #[must_use]
    pub fn largest(&self, name: &str) -> f64 {
        self.deviation(name, |_| 0.0)
    }

    /// The largest of |stored(t) - stored(0) - supplied(t) + dissipated(t)| by the outputs of these names, J. An output
    /// that the model does not have counts as zero.
    #[must_use]
    pub fn imbalance(&self) -> f64 {
        let series =
            |name: &str| self.recording.column(name).map_or_else(|| vec![0.0; self.times.len()], <[f64]>::to_vec);
        let (stored, supplied, dissipated) = (series("stored"), series("supplied"), series("dissipated"));
        let residual = |k: usize| (stored[k] - stored[0] - supplied[k] + dissipated[k]).abs();
        (0..self.times.len()).map(residual).fold(0.0, f64::max)
    }
}

/// `count` + 1 instants from 0 to `end`.
#[must_use]
pub fn instants(end: f64, count: u32) -> Vec<f64> {
    (0..=count).map(|k| end * f64::from(k) / f64::from(count)).collect()
}

/// Runs `model` from its start over `times` with relative and absolute tolerance `tolerance`.
///
/// # Panics
/// The start does not close, or the run fails.
#[must_use]
pub fn record<Me: Mechanism>(model: &Me, times: &[f64], tolerance: f64) -> Record {
    let machine = model.machine();
    run(&*machine, &machine.start().expect("the mechanism closes"), times, tolerance)
}

/// Runs `model` from the state `start`, otherwise as [`record`].
///
/// # Panics
/// The run fails.
#[must_use]
pub fn record_from<Me: Mechanism>(model: &Me, start: &[f64], times: &[f64], tolerance: f64) -> Record {
    run(&*model.machine(), start, times, tolerance)
}

fn run(machine: &dyn Machine, start: &[f64], times: &[f64], tolerance: f64) -> Record {
    let mut recorder = Recorder::new(machine, &[Part::Outputs]);
    let span = Span { t0: 0.0, t_end: times.last().copied().unwrap_or(0.0) };
    let settings = Settings {
        // Stretches and momenta of stiff joints are small numbers: the absolute tolerance lies well below them.
        tolerances: Tolerances::new(tolerance, 1e-3 * tolerance),
        samples: Samples::At(times.to_vec()),
        // The dense output of a step far beyond the fastest decay is worse than the step's end.
        largest_step: times.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max).max(1e-3),
        step_limit: 5_000_000,
        ..Settings::default()
    };
    let finish = drive(machine, &mut Dop853::new(), start, span, &settings, None, &mut recorder);
    let finish = finish.unwrap_or_else(|failure| panic!("{failure}"));
    let recording = recorder.recording;
    let (times, events) = (recording.times.clone(), recording.events.clone());
    Record { times, events, statistics: finish.statistics, recording }
}

/// Times, states and branches of switches at 20 even instants of a run by DOP853 from the start, the last one before
/// `end`, s.
///
/// # Panics
/// The start does not close, or the run fails.
#[must_use]
pub fn along(model: &dyn Machine, end: f64) -> Vec<(f64, Vec<f64>, Vec<bool>)> {
    let start = model.start().expect("the mechanism closes");
    let mut samples = Vec::new();
    let mut observer =
        EachSample(|t: f64, x: &[f64], negative: &[bool]| samples.push((t, x.to_vec(), negative.to_vec())));
    let times = (0..20).map(|k| end / 20.0 * f64::from(k)).collect();
    let settings = Settings { samples: Samples::At(times), ..Settings::default() };
    let span = Span { t0: 0.0, t_end: end };
    drive(model, &mut Dop853::new(), &start, span, &settings, None, &mut observer).expect("the run ends");
    assert_eq!(samples.len(), 20);
    samples
}
