use std::f64::consts::TAU;

use bond_graph_tests::models::slider_crank::{SliderCrank, SliderCrankParameters as Parameters};
use bond_graph_tests::support::record::{Record, instants, record};

use super::truth::within;

/// Late enough for most of the vibration of the start to be gone; what is left of it is part of what beyond 1/k
/// remains.
fn run(parameters: &Parameters) -> Record {
    let mut times = vec![0.0];
    times.extend(instants(0.4, 40).iter().map(|t| 0.2 + t));
    record(&SliderCrank::new(parameters.clone()).unwrap(), &times, 1e-10)
}

/// The slider's place by its crank's angle, both of the run, minus that of the rigid mechanism.
fn departure(p: &Parameters, run: &Record) -> Vec<f64> {
    let rigid = |angle: f64| {
        let (x, y) = (p.crank_length * angle.cos(), p.crank_length * angle.sin());
        x + (p.rod_length * p.rod_length - y * y).sqrt()
    };
    run.series("angle").iter().zip(run.series("slider_x")).map(|(angle, x)| x - rigid(*angle)).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| value.abs().max(largest))
}

#[test]
fn the_start_is_closed_to_rounding() {
    let p = Parameters::default();
    let run = run(&p);
    within("slider", departure(&p, &run)[0].abs(), 1e-14);
    let angle = -(p.crank_length * p.crank_angle.sin() / p.rod_length).asin();
    within("rod", (run.series("rod_angle")[0] - angle).abs(), 1e-14);
}

#[test]
fn the_slider_follows_the_rigid_kinematics_the_closer_the_stiffer_the_joints_are() {
    let of = |factor: f64| {
        let p = Parameters { stiffness: factor * Parameters::default().stiffness, ..Parameters::default() };
        let run = run(&p);
        within("energy", run.imbalance() / run.last("supplied"), 1e-8);
        let turns = run.series("speed").iter().fold(0.0, |sum, speed| sum + speed * 0.01) / TAU;
        assert!(turns > 0.5, "{turns}");
        departure(&p, &run)[1..].to_vec()
    };
    let (soft, firm, stiff) = (of(1.0), of(2.0), of(4.0));
    // e(k) = c / k + d / k^2 + ...: doubling the stiffness halves the departure, 2 e(2k) - e(k) removes its first term.
    let beyond = |soft: &[f64], firm: &[f64]| -> Vec<f64> { soft.iter().zip(firm).map(|(a, b)| 2.0 * b - a).collect() };
    let (first, second) = (beyond(&soft, &firm), beyond(&firm, &stiff));
    println!("departures {:e} {:e} {:e}", largest(&soft), largest(&firm), largest(&stiff));
    println!("beyond 1/k {:e} {:e}", largest(&first), largest(&second));
    within("halved", (largest(&soft) / largest(&firm) - 2.0).abs(), 0.05);
    within("halved again", (largest(&firm) / largest(&stiff) - 2.0).abs(), 0.025);
    within("second order", (largest(&first) / largest(&second) - 4.0).abs(), 0.5);
}
