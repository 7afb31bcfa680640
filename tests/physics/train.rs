use std::f64::consts::PI;

use bond_graph_tests::models::train::{EndsOfTheTrain, EndsOfTheTrainParameters, Train, TrainParameters as Parameters};
use bond_graph_tests::support::record::{instants, record};

use super::truth::within;

/// Angular frequency of a mode of twenty equal masses on equal springs with free ends.
fn frequency(p: &Parameters) -> f64 {
    2.0 * (p.coupler_stiffness / p.wagon_mass).sqrt() * (PI * p.mode / 40.0).sin()
}

/// How a wagon takes part in the mode.
fn shape(p: &Parameters, wagon: f64) -> f64 {
    p.amplitude * (PI * p.mode * (wagon + 0.5) / 20.0).cos()
}

#[test]
fn each_wagon_swings_with_its_part_of_the_mode() {
    for mode in [1.0, 3.0, 19.0] {
        let p = Parameters { mode, ..Parameters::default() };
        let w = frequency(&p);
        let run = record(&Train::new(p.clone()).unwrap(), &instants(3.0 * PI / w, 60), 1e-11);
        for wagon in 0..20 {
            let speeds = run.series(&format!("wagon[{wagon}].speed"));
            let travels = run.series(&format!("wagon[{wagon}].travel"));
            let most = run.times.iter().enumerate().fold(0.0_f64, |most, (k, t)| {
                let size = shape(&p, f64::from(wagon));
                let apart = (speeds[k] - size * (w * t).cos()).abs();
                most.max(apart).max((travels[k] - size * (w * t).sin() / w).abs() * w)
            });
            within(&format!("mode {mode}, wagon {wagon}"), most / p.amplitude, 1e-9);
        }
    }
}

#[test]
fn the_ends_swing_alike_in_the_scene() {
    let p = EndsOfTheTrainParameters { mode: 2.0, ..EndsOfTheTrainParameters::default() };
    let whole = Parameters { mode: 2.0, ..Parameters::default() };
    let w = frequency(&whole);
    let run = record(&EndsOfTheTrain::new(p).unwrap(), &instants(2.0 * PI / w, 40), 1e-11);
    for (name, wagon) in [("wagon[0].speed", 0.0), ("wagon[19].speed", 19.0)] {
        let size = shape(&whole, wagon);
        let most = run
            .series(name)
            .iter()
            .zip(&run.times)
            .fold(0.0_f64, |most, (speed, t)| most.max((speed - size * (w * t).cos()).abs()));
        within(name, most / whole.amplitude, 1e-9);
    }
}
