//! Orifices at rest: laws with an infinite derivative at zero, by every kind of method, against closed forms.

use crate::problems::{Record, settings};
use bg_model::bond_graph;
use bg_model::integrator::{AnyMethod, Auto, Bs5, Dop853, Gauss6, Radau5, Radau9, Rodas5p, Ros2, Taylor};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Samples, Settings, Span, integrate};
use bg_model::statistics::Statistics;
use bg_model::system::{Model, System};

bond_graph! {
    /// A tank, empty at the start, with a pump and an orifice in its floor.
    graph Filling {
        /// Floor area over specific weight.
        param capacity: m^3/Pa = 1, above 0;
        /// The pump's volume flow.
        param pumped: m^3/s = 1, at least 0;
        0 tank: hydraulic;
        Sf pump = pumped;
        C water = capacity;
        R orifice(effort p) = 0.5 * sqrt(p);
        pump -> tank -> water;
        tank -> orifice;
        observe { level: m^3 = water.q }
    }

    /// Two empty tanks with an orifice between them, the first one with a pump.
    graph Tanks {
        /// Floor area over specific weight.
        param capacity: m^3/Pa = 1, above 0;
        0 first: hydraulic;
        0 second: hydraulic;
        1 pipe: hydraulic;
        Sf pump = 1;
        C water = capacity;
        C other = capacity;
        R orifice(effort p) = 0.5 * sqrt(p);
        pump -> first -> water;
        first -> pipe -> second -> other;
        pipe -> orifice;
        observe { level: m^3 = water.q }
    }

    /// A tank that an orifice fills from another one that is never empty, until both are at rest.
    graph Levelling {
        /// Floor area over specific weight.
        param capacity: m^3/Pa = 1, above 0;
        /// The other tank's pressure.
        param supply: Pa = 1;
        Se reservoir = supply;
        1 pipe: hydraulic;
        0 tank: hydraulic;
        C water = capacity;
        R orifice(effort p) = if p < 0 { -0.5 * sqrt(-p) } else { 0.5 * sqrt(p) };
        reservoir -> pipe -> orifice;
        pipe -> tank -> water;
        observe { level: m^3 = water.q }
    }
}

fn methods() -> [AnyMethod; 8] {
    [
        Radau5::new().into(),
        Radau9::new().into(),
        Rodas5p::new().into(),
        Auto::new().into(),
        Dop853::new().into(),
        Bs5::new().into(),
        Taylor::new().into(),
        Gauss6::adaptive().into(),
    ]
}

fn fixed_steps() -> [AnyMethod; 2] {
    [Gauss6::new(0.01).into(), Ros2::new(0.01).into()]
}

fn name(method: &AnyMethod) -> String {
    let shown = format!("{method:?}");
    shown.split('(').next().unwrap_or_default().to_owned()
}

/// A run from 0 to `t_end` (s) with ten samples a second, from an empty tank.
fn run<Sys: System<f64, N, G>, const N: usize, const G: usize>(
    system: &Sys,
    mut method: AnyMethod,
    t_end: f64,
    tolerance: f64,
) -> (Record<N, G>, Statistics) {
    let settings = Settings { samples: Samples::Every(0.1), step_limit: 200_000, ..settings(tolerance) };
    let mut record = Record::default();
    let span = Span { t0: 0.0, t_end };
    let outcome = integrate(system, &mut method, &SVector::zeros(), span, &settings, &mut record);
    let finish = outcome.unwrap_or_else(|failure| panic!("{} at {tolerance:e}: {failure}", name(&method)));
    (record, finish.statistics)
}

/// Of V' = q - k sqrt V with V(0) = 0: with s = sqrt V, t = -(2 / k) (s + (q / k) ln(1 - k s / q)); by Newton's method.
fn filled(t: f64, q: f64, k: f64) -> f64 {
    let mut s = (q * t).sqrt();
    for _ in 0..100 {
        let time = -2.0 / k * (s + q / k * libm::log1p(-k * s / q));
        s = (s - (time - t) * (q - k * s) / (2.0 * s.max(1e-300))).clamp(0.0, 0.999_999 * q / k);
    }
    s * s
}

#[test]
fn a_tank_fills_from_empty() {
    let model: Filling = Filling::new(FillingParameters::default()).expect("in range");
    assert_eq!(model.start().expect("nothing to close")[0], 0.0);
    let worst = |record: &Record<1, 0>| {
        record.samples.iter().map(|(t, x, _)| (x[0] - filled(*t, 1.0, 0.5)).abs()).fold(0.0, f64::max)
    };
    for tolerance in [1e-4, 1e-6, 1e-9] {
        for method in methods() {
            let name = name(&method);
            let (record, statistics) = run(&model, method, 3.0, tolerance);
            let error = worst(&record);
            assert!(error < 30.0 * tolerance && record.samples.len() == 31, "{name} at {tolerance:e}: {error:e}");
            assert!(statistics.steps + statistics.rejected < 2000, "{name} at {tolerance:e}: {statistics}");
        }
    }
    for method in fixed_steps() {
        let (record, _) = run(&model, method, 3.0, 1e-6);
        assert!(worst(&record) < 1e-3, "{}", worst(&record));
    }
}

#[test]
fn a_tank_at_rest_stays_at_rest() {
    let empty: Filling = Filling::new(FillingParameters { pumped: 0.0, ..Default::default() }).expect("in range");
    for method in methods().into_iter().chain(fixed_steps()) {
        let (record, statistics) = run(&empty, method, 3.0, 1e-8);
        assert!(record.samples.iter().all(|(_, x, _)| x[0] == 0.0), "{record:?}");
        assert!(statistics.steps <= 300 && statistics.rejected == 0, "{statistics}");
    }
}

#[test]
fn two_tanks_come_to_rest() {
    // With u = 1 - V, u' = -sqrt(u) / 2: V = 1 - (1 - t / 4)^2 up to 4 s, then 1.
    let model: Levelling = Levelling::new(LevellingParameters::default()).expect("in range");
    let level = |t: f64| 1.0 - (1.0 - t / 4.0).max(0.0).powi(2);
    for tolerance in [1e-4, 1e-6, 1e-9] {
        for method in methods() {
            let name = name(&method);
            let (record, _) = run(&model, method, 6.0, tolerance);
            let error = record.samples.iter().map(|(t, x, _)| (x[0] - level(*t)).abs()).fold(0.0, f64::max);
            assert!(error < 30.0 * tolerance, "{name} at {tolerance:e}: {error:e}");
        }
    }
}

#[test]
fn a_tank_fills_another_one() {
    // The states' own rates differ at the start: that of the second tank is zero. With w = V1 - V2, w' = 1 - sqrt w,
    // and V1 + V2 = t.
    let model: Tanks = Tanks::new(TanksParameters::default()).expect("in range");
    for tolerance in [1e-4, 1e-6, 1e-9] {
        for method in methods() {
            let name = name(&method);
            let (record, statistics) = run(&model, method, 3.0, tolerance);
            let deviation = |(t, x, _): &(f64, SVector<f64, 2>, _)| {
                (x[0] - x[1] - filled(*t, 1.0, 1.0)).abs().max((x[0] + x[1] - t).abs())
            };
            let error = record.samples.iter().map(deviation).fold(0.0, f64::max);
            assert!(error < 60.0 * tolerance, "{name} at {tolerance:e}: {error:e}");
            assert!(statistics.steps + statistics.rejected < 2000, "{name} at {tolerance:e}: {statistics}");
        }
    }
}
