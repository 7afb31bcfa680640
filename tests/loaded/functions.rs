//! Two machines of one model side by side: their functions and runs.

use std::rc::Rc;

use bg_model::dynamics::{Machine, branches};
use bg_model::integrator::Integrator;
use bg_model::nalgebra::Complex;
use bg_model::run::{Request, RunError, Simulation, Trajectory};
use bg_model::simulation::Samples;
use bg_model::statistics::Statistics;

/// How numbers are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compared {
    /// To the bit.
    Exactly,
    /// To the bit, of zeros without their signs: where rustc's code takes two operations at once, a sum may begin with
    /// the other sign.
    WithoutSignsOfZeros,
}

impl Compared {
    pub fn bits(self, of: &[f64]) -> Vec<u64> {
        let zero = if self == Self::Exactly { -0.0 } else { 0.0 };
        // What is no number has many forms.
        of.iter().map(|value| if value.is_nan() { u64::MAX } else { (value + zero).to_bits() }).collect()
    }

    pub fn filled(self, length: usize, fill: impl FnOnce(&mut [f64])) -> Vec<u64> {
        let mut values = vec![0.0; length];
        fill(&mut values);
        self.bits(&values)
    }
}

/// The functions at the start and at places near it.
pub fn same_functions(compiled: &dyn Machine, loaded: &dyn Machine, compared: Compared) {
    let bits = |of: &[f64]| compared.bits(of);
    let name = compiled.description().name;
    assert_eq!([compiled.states(), compiled.switches()], [loaded.states(), loaded.switches()], "{name}");
    assert_eq!(bits(&compiled.decided()), bits(&loaded.decided()), "{name}");
    assert_eq!(compiled.redundant(), loaded.redundant(), "{name}");
    let (start, other) = (compiled.start(), loaded.start());
    assert_eq!(start.is_ok(), other.is_ok(), "{name}: {start:?} {other:?}");
    let (Ok(start), Ok(other)) = (start, other) else { return };
    assert_eq!(bits(&start), bits(&other), "{name}");
    let energies = [compiled, loaded].map(|of| of.impulse_energy().map(f64::to_bits));
    assert_eq!(energies[0], energies[1], "{name}");
    let mut random = fastrand::Rng::with_seed(7);
    for round in 0..16 {
        let x: Vec<f64> = start.iter().map(|x| x + f64::from(round) * 1e-3 * (random.f64() - 0.5)).collect();
        same_at(compiled, loaded, 0.1 * f64::from(round), &x, compared);
    }
}

/// Everything that a run asks for, at one moment.
fn same_at(compiled: &dyn Machine, loaded: &dyn Machine, t: f64, x: &[f64], compared: Compared) {
    let bits = |of: &[f64]| compared.bits(of);
    let name = compiled.description().name;
    let negative = branches(compiled, t, x);
    assert_eq!(negative, branches(loaded, t, x), "{name}");
    let (n, g) = (compiled.states(), compiled.switches());
    let both = |what: &str, of: &dyn Fn(&dyn Machine) -> Vec<u64>| {
        assert_eq!(of(compiled), of(loaded), "{name}: {what} at {t} s");
    };
    both("rate", &|of| compared.filled(n, |dx| of.rate(t, x, &negative, dx)));
    both("guards", &|of| compared.filled(g, |guards| of.guards(t, x, &negative, guards)));
    both("project", &|of| {
        let mut x = x.to_vec();
        of.project(t, &negative, &mut x);
        bits(&x)
    });
    both("outputs", &|of| compared.filled(of.description().outputs.len(), |y| of.outputs(t, x, &negative, y)));
    both("energies", &|of| {
        let powers = of.powers(t, x, &negative);
        bits(&[of.stored_energy(t, x, &negative), powers.supplied, powers.dissipated])
    });
    both("sizes", &|of| {
        let mut curvatures = vec![0.0; n];
        let energy = of.energy(t, x, &negative, &mut curvatures);
        bits(&[&[energy], &curvatures[..]].concat())
    });
    both("shown", &|of| {
        let mut shown = Vec::new();
        of.shown(t, x, &negative, &mut shown);
        bits(&shown)
    });
    assert_eq!(compiled.sparsity(), loaded.sparsity(), "{name}");
    assert_eq!(compiled.damping_sparsity(), loaded.damping_sparsity(), "{name}");
    let entries = compiled.sparsity().len(n);
    both("jacobian", &|of| {
        let mut slope = vec![0.0; n];
        let mut all = compared.filled(entries, |entries| of.jacobian(t, x, &negative, entries, &mut slope));
        all.extend(bits(&slope));
        all
    });
    both("damping", &|of| {
        compared.filled(of.damping_sparsity().len(n), |entries| of.damping(t, x, &negative, entries))
    });
    assert_eq!(compiled.series().is_some(), loaded.series().is_some(), "{name}");
    // Of rustc's code they differ in the last places: where it takes two products at once it may change places of
    // factors, and so the order in which an inner sum is made.
    if compared == Compared::Exactly {
        both("series", &|of| bits(&expanded(of, t, x, &negative)));
    }
    both("elimination", &|of| bits(&eliminated(of, t, x, &negative)));
    assert_eq!(compiled.second(), loaded.second(), "{name}");
    both("forces", &|of| compared.filled(n, |dx| of.forces(t, x, &negative, dx)));
    assert_eq!(compiled.operations_of_forces(), loaded.operations_of_forces(), "{name}");
    assert_eq!(compiled.held(), loaded.held(), "{name}");
    assert_eq!(bits(compiled.kept()), bits(loaded.kept()), "{name}");
    let held = compiled.held().map_or(0, |held| held.entries());
    both("hold", &|of| compared.filled(held, |entries| of.hold(t, x, &negative, entries)));
    assert_eq!(compiled.stops(), loaded.stops(), "{name}");
    let stops = compiled.stops().map_or(0, |stops| stops.entries());
    both("impact", &|of| compared.filled(stops, |entries| of.impact(t, x, &negative, entries)));
    assert_eq!(compiled.next_break(t).to_bits(), loaded.next_break(t).to_bits(), "{name}");
    let origin = |of: &dyn Machine| format!("{:?}", of.not_finite(t, x, &negative));
    assert_eq!(origin(compiled), origin(loaded), "{name}");
}

/// The series from there.
fn expanded(of: &dyn Machine, t: f64, x: &[f64], negative: &[bool]) -> Vec<f64> {
    const ORDER: usize = 12;
    let Some(size) = of.series() else { return Vec::new() };
    let (mut rows, mut series) = (vec![0.0; ORDER * size.width], vec![0.0; (ORDER + 1) * x.len()]);
    series[..x.len()].copy_from_slice(x);
    of.expand(t, 1e-3, negative, &mut rows, &mut series);
    series
}

/// One right side solved for, by a real and by a complex number.
fn eliminated(of: &dyn Machine, t: f64, x: &[f64], negative: &[bool]) -> Vec<f64> {
    let Some(count) = of.factors() else { return Vec::new() };
    let n = of.states();
    let mut entries = vec![0.0; of.sparsity().len(n)];
    of.jacobian(t, x, negative, &mut entries, &mut vec![0.0; n]);
    let mut factors = vec![0.0; count];
    let is_regular = of.eliminate(1e-4, &entries, &mut factors);
    let mut b: Vec<f64> = (0..n).map(|k| 1.0 + k as f64).collect();
    of.substitute(&factors, &mut b);
    let mut complex = vec![Complex::new(0.0, 0.0); count];
    of.eliminate_complex(Complex::new(1e-4, 2e-4), &entries, &mut complex);
    let mut c: Vec<Complex<f64>> = (0..n).map(|k| Complex::new(1.0, k as f64)).collect();
    of.substitute_complex(&complex, &mut c);
    let parts = c.iter().flat_map(|c| [c.re, c.im]);
    factors.into_iter().chain(b).chain(parts).chain([f64::from(u8::from(is_regular))]).collect()
}

/// A run of both, as far as it comes. One with steps by series, whose last places may differ at some orders (see
/// [`same_at`]), has the same counts and, to rounding, the same values.
pub fn same_runs(compiled: &Rc<dyn Machine>, loaded: &Rc<dyn Machine>, method: Integrator, compared: Compared) {
    let request =
        || Request { method, t_end: 0.05, samples: Samples::Every(0.01), step_limit: 400, ..Request::default() };
    let run = |of: &Rc<dyn Machine>| match Simulation::over(Rc::clone(of), request()).run() {
        Ok(run) => Ok((String::new(), run)),
        Err(RunError::Stopped(stopped)) => Ok((stopped.cause.to_string(), stopped.trajectory)),
        Err(fault) => Err(fault.to_string()),
    };
    let told = |run: &Result<(String, Trajectory), String>| match run {
        Ok((cause, run)) => format!("{cause}\n{}", told(run, compared)),
        Err(fault) => fault.clone(),
    };
    let [ours, theirs] = [run(compiled), run(loaded)];
    if let [Ok((_, ours)), Ok((_, theirs))] = [&ours, &theirs]
        && compared == Compared::WithoutSignsOfZeros
        && ours.statistics.series_orders > 0
    {
        return near(ours, theirs, &format!("{}: {}", compiled.description().name, method.name()));
    }
    assert_eq!(told(&ours), told(&theirs), "{}: {}", compiled.description().name, method.name());
}

/// That two runs have the same counts and, to rounding, the same values.
fn near(ours: &Trajectory, theirs: &Trajectory, name: &str) {
    const ROUNDING: f64 = 1e-12;
    let counts = |run: &Trajectory| Statistics { smallest_step: 0.0, largest_step: 0.0, ..run.statistics };
    assert_eq!(format!("{:?}", counts(ours)), format!("{:?}", counts(theirs)), "{name}");
    // A step is as long as the last orders allow: small numbers, of which rounding leaves few places.
    let alike = |ours: f64, theirs: f64| (ours - theirs).abs() <= 0.01 * ours.abs();
    let (own, other) = (&ours.statistics, &theirs.statistics);
    assert!(alike(own.smallest_step, other.smallest_step) && alike(own.largest_step, other.largest_step), "{name}");
    assert_eq!(ours.recording.times, theirs.recording.times, "{name}");
    for (ours, theirs) in ours.recording.columns.iter().zip(&theirs.recording.columns) {
        let size = ours.values.iter().fold(1.0_f64, |size, value| size.max(value.abs()));
        let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= ROUNDING * size;
        assert!(ours.values.iter().zip(&theirs.values).all(is_near), "{name}: {ours:?} {theirs:?}");
    }
}

/// Every number of a run.
fn told(run: &Trajectory, compared: Compared) -> String {
    let text = format!("{:?}\n{:?}\n{:?}\n{:?}", run.recording, run.statistics, run.last, run.methods);
    if compared == Compared::Exactly {
        return text;
    }
    ["-0.0,", "-0.0]", "-0.0)"].iter().fold(text, |text, zero| text.replace(zero, &zero[1..]))
}
