//! Problems with known solutions, and a recorder of what a run gives.
#![allow(dead_code)] // Each test file uses some of them.

use bg_model::capability::Named;
use bg_model::integrator::{Absolute, Method, Tolerances};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Finish, Observer, Samples, Settings, Span, integrate};
use bg_model::statistics::Statistics;
use bg_model::system::{System, switches, values};

/// A rate that catches nothing.
pub type Rate<const N: usize, const G: usize> = fn(f64, &SVector<f64, N>, &[bool; G]) -> [f64; N];

/// A system given by closures: rate, guards and the states' names.
pub struct Flow<F, const G: usize> {
    pub rate: F,
    pub guards: [fn(f64, &[f64]) -> f64; G],
    pub names: &'static [&'static str],
}

pub fn smooth<F, const N: usize>(rate: F) -> Flow<F, 0>
where
    F: Fn(f64, &SVector<f64, N>, &[bool; 0]) -> [f64; N],
{
    Flow { rate, guards: [], names: &[] }
}

pub fn switched<F, const N: usize, const G: usize>(guards: [fn(f64, &[f64]) -> f64; G], rate: F) -> Flow<F, G>
where
    F: Fn(f64, &SVector<f64, N>, &[bool; G]) -> [f64; N],
{
    Flow { rate, guards, names: &[] }
}

impl<F, const N: usize, const G: usize> System<f64, N, G> for Flow<F, G>
where
    F: Fn(f64, &SVector<f64, N>, &[bool; G]) -> [f64; N],
{
    fn rate(&self, t: f64, x: &SVector<f64, N>, negative: &[bool; G], dx: &mut SVector<f64, N>) {
        *dx = SVector::from((self.rate)(t, x, negative));
    }
    fn guards(&self, t: f64, x: &SVector<f64, N>, _: &[bool; G], guards: &mut SVector<f64, G>) {
        *guards = SVector::from(self.guards.map(|guard| guard(t, x.as_slice())));
    }
    fn named(&self) -> Option<&impl Named<f64, N, G>> {
        Some(self)
    }
}

impl<F, const N: usize, const G: usize> Named<f64, N, G> for Flow<F, G> {
    fn state_name(&self, index: usize) -> &'static str {
        self.names.get(index).copied().unwrap_or("state")
    }
}

/// Two bodies, the heavy one at rest: position and velocity in the plane; the period is 2 pi.
pub fn kepler() -> Flow<Rate<4, 0>, 0> {
    let rate: Rate<4, 0> = |_, x, _| {
        let square = x[0] * x[0] + x[1] * x[1];
        let cube = square * square.sqrt();
        [x[2], x[3], -x[0] / cube, -x[1] / cube]
    };
    smooth(rate)
}

/// Perihelion of an orbit of eccentricity 0.9 (Hairer, Lubich, Wanner, Geometric Numerical Integration).
pub fn kepler_start() -> SVector<f64, 4> {
    SVector::from([0.1, 0.0, 0.0, 19.0_f64.sqrt()])
}

/// The state of [`kepler`] at t = 20 in 25 digits, from Kepler's equation and two implicit methods in quad precision.
pub const KEPLER_AT_20: [f64; 4] =
    [-1.295_266_250_987_574_4, 0.400_393_896_379_232_2, -0.677_539_092_467_050_8, -0.127_083_815_427_868_72];

/// Van der Pol's equation with epsilon = 1e-6 (Hairer, Wanner, Solving Ordinary Differential Equations II, section
/// IV.1).
pub fn van_der_pol() -> Flow<Rate<2, 0>, 0> {
    let rate: Rate<2, 0> = |_, x, _| [x[1], ((1.0 - x[0] * x[0]) * x[1] - x[0]) * 1e6];
    smooth(rate)
}

pub const VAN_DER_POL_START: [f64; 2] = [2.0, 0.0];
/// The state of [`van_der_pol`] at t = 2, from implicit methods of orders 13 and 17 in quad precision.
pub const VAN_DER_POL_AT_2: [f64; 2] = [1.706_167_732_170_465, -0.892_809_701_024_816_5];

/// Arenstorf's orbit in the plane of earth and moon (Hairer, Norsett, Wanner I, section II.0; SciML's `threebody`).
pub fn arenstorf() -> Flow<Rate<4, 0>, 0> {
    const MOON: f64 = 0.012_277_471;
    const EARTH: f64 = 1.0 - MOON;
    let rate: Rate<4, 0> = |_, x, _| {
        let cube = |square: f64| square * square.sqrt();
        let to_earth = cube((x[0] + MOON) * (x[0] + MOON) + x[1] * x[1]);
        let to_moon = cube((x[0] - EARTH) * (x[0] - EARTH) + x[1] * x[1]);
        let ax = x[0] + 2.0 * x[3] - EARTH * (x[0] + MOON) / to_earth - MOON * (x[0] - EARTH) / to_moon;
        let ay = x[1] - 2.0 * x[2] - EARTH * x[1] / to_earth - MOON * x[1] / to_moon;
        [x[2], x[3], ax, ay]
    };
    smooth(rate)
}

pub const ARENSTORF_START: [f64; 4] = [0.994, 0.0, 0.0, -2.001_585_106_379_082_4];
pub const ARENSTORF_PERIOD: f64 = 17.065_216_560_157_964;

/// A harmonic oscillator: angular frequency 1 rad/s where x is positive, 2 rad/s where it is negative.
pub fn bilinear() -> Flow<Rate<2, 1>, 1> {
    let rate: Rate<2, 1> = |_, x, negative| [x[1], if negative[0] { -4.0 * x[0] } else { -x[0] }];
    switched([|_, x| x[0]], rate)
}

/// The observed orders: slopes of the errors over the steps in logarithms, from each step to half of it.
pub fn orders(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect()
}

/// Everything a run gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Record<const N: usize, const G: usize> {
    pub samples: Vec<(f64, SVector<f64, N>, [bool; G])>,
    pub events: Vec<(f64, SVector<f64, N>, usize, [bool; G])>,
    pub steps: Vec<f64>,
}

impl<const N: usize, const G: usize> Default for Record<N, G> {
    fn default() -> Self {
        Self { samples: vec![], events: vec![], steps: vec![] }
    }
}

impl<const N: usize, const G: usize> Record<N, G> {
    pub fn event_times(&self) -> Vec<f64> {
        self.events.iter().map(|event| event.0).collect()
    }
}

impl<const N: usize, const G: usize> Observer for Record<N, G> {
    fn sample(&mut self, t: f64, x: &[f64], negative: &[bool]) {
        self.samples.push((t, *values(x), *switches(negative)));
    }
    fn event(&mut self, t: f64, x: &[f64], switch: usize, negative: &[bool]) {
        self.events.push((t, *values(x), switch, *switches(negative)));
    }
    fn step(&mut self, t: f64, _: f64, _: &Statistics) {
        self.steps.push(t);
    }
}

pub fn settings(tolerance: f64) -> Settings {
    Settings {
        tolerances: Tolerances { relative: tolerance, absolute: Absolute::Scalar(tolerance) },
        ..Settings::default()
    }
}

/// Steps of the same size whatever the error.
pub fn fixed(step: f64) -> Settings {
    Settings {
        tolerances: Tolerances::new(1.0, 1e10),
        first_step: Some(step),
        largest_step: step,
        samples: Samples::Every(1e9),
        ..Settings::default()
    }
}

/// A run from t = 0 that must succeed.
pub fn run<Sys, M, const N: usize, const G: usize>(
    system: &Sys,
    mut method: M,
    start: impl Into<SVector<f64, N>>,
    t_end: f64,
    settings: &Settings,
) -> (Finish, Record<N, G>)
where
    Sys: System<f64, N, G>,
    M: Method,
{
    let mut record = Record::default();
    let span = Span { t0: 0.0, t_end };
    let finish = integrate(system, &mut method, &start.into(), span, settings, &mut record).unwrap();
    (finish, record)
}
