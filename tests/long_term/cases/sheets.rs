//! Long-term behaviour as tables for the report.
//!
//! In: a number of periods. Out: drift against step, and drift against time.

use serde_json::{Value, json};

use super::drift::{Drift, Exactness, drift};
use super::scenes::{Scene, scenes};
use crate::hardcases::integrator;
use crate::hardcases::sheet::Sheet;

/// How exactly each integrator runs; the middle one is that of the longest run.
#[must_use]
pub fn settings() -> Vec<(&'static str, [Exactness; 3])> {
    let steps = |counts: [f64; 3]| counts.map(Exactness::StepsPerPeriod);
    let tolerances = [1e-5, 1e-7, 1e-9].map(Exactness::Tolerance);
    vec![
        ("gauss6", steps([8.0, 16.0, 32.0])),
        ("rk4", steps([20.0, 40.0, 80.0])),
        ("dop853", tolerances),
        ("cfmr7", tolerances),
        ("radau9", tolerances),
        ("auto", tolerances),
    ]
}

/// The drift after `periods` with three steps or tolerances, and the order in which the energy's falls with the mean
/// step.
#[must_use]
pub fn against_step(periods: f64, progress: &mut dyn FnMut(&str)) -> Sheet {
    let mut rows = Vec::new();
    for scene in scenes() {
        for (name, exactnesses) in settings() {
            progress(&format!("{} {name}", scene.name));
            let mut before: Option<Drift> = None;
            for exactness in exactnesses {
                let of = drift(&scene, integrator(name), exactness, periods);
                let order = before.as_ref().map(|before| order(before, &of));
                rows.push([cells(&scene, name, exactness, periods, &of), vec![json!(order), failure(&of)]].concat());
                before = Some(of);
            }
        }
    }
    Sheet {
        name: "drift-against-step",
        about: "conservative scenes: the largest deviation of the energy and of the angular momentum over their sizes, \
                max |R R^T - 1|, and the order with which the energy's deviation falls with the mean step",
        head: &[
            "scene",
            "integrator",
            "exactness",
            "periods",
            "steps",
            "energy",
            "momentum",
            "orthogonality",
            "order",
            "failure",
        ],
        rows,
    }
}

/// The drift in the hundredth, the tenth and the whole of `periods`, and its growth.
#[must_use]
pub fn against_time(periods: f64, progress: &mut dyn FnMut(&str)) -> Sheet {
    let mut rows = Vec::new();
    for scene in scenes() {
        for (name, [_, exactness, _]) in settings() {
            progress(&format!("{} {name}", scene.name));
            let of = drift(&scene, integrator(name), exactness, periods);
            let energy = of.energy();
            let early = [energy.hundredth, energy.tenth, energy.growth()].map(|value| json!(value));
            let mut row = cells(&scene, name, exactness, periods, &of);
            row.extend(early);
            row.extend([json!(of.momentum().map(|of| of.growth())), failure(&of)]);
            rows.push(row);
        }
    }
    Sheet {
        name: "drift-against-time",
        about: "the same over the longest run, the energy also in its first hundredth and tenth; \
                growth is the power of the time in the last nine tenths: 0 bounded, 1/2 a random walk, 1 linear",
        head: &[
            "scene",
            "integrator",
            "exactness",
            "periods",
            "steps",
            "energy",
            "momentum",
            "orthogonality",
            "hundredth",
            "tenth",
            "growth",
            "of momentum",
            "failure",
        ],
        rows,
    }
}

/// The order with which the energy's deviation falls with the mean step.
#[must_use]
pub fn order(coarse: &Drift, fine: &Drift) -> f64 {
    let steps = fine.statistics.steps as f64 / coarse.statistics.steps as f64;
    libm::log(coarse.energy().whole / fine.energy().whole) / libm::log(steps)
}

fn cells(scene: &Scene, name: &str, exactness: Exactness, periods: f64, of: &Drift) -> Vec<Value> {
    let exactness = match exactness {
        Exactness::StepsPerPeriod(count) => format!("{count} steps a period"),
        Exactness::Tolerance(relative) => format!("rtol {relative:e}"),
    };
    vec![
        json!(scene.name),
        json!(name),
        json!(exactness),
        json!(periods as u64),
        json!(of.statistics.steps),
        json!(of.energy().whole),
        json!(of.momentum().map(|of| of.whole)),
        json!(of.orthogonality()),
    ]
}

fn failure(of: &Drift) -> Value {
    of.failure.as_ref().map_or(Value::Null, |cause| json!(cause.to_string()))
}
