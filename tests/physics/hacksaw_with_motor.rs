use bg_model::input::Input;
use bond_graph_tests::models::hacksaw_with_motor::{
    HacksawWithMotor, HacksawWithMotorInputs as Inputs, HacksawWithMotorParameters as Parameters,
};
use bond_graph_tests::support::record::{instants, record};

use super::truth::within;

#[test]
fn electrical_energy_becomes_heat_motion_and_cut_and_the_current_falls_as_the_crank_speeds_up() {
    let p = Parameters::default();
    let voltage = 24.0;
    let model = HacksawWithMotor::new(p.clone(), Inputs { voltage: Input::constant(voltage) }).unwrap();
    let run = record(&model, &instants(0.4, 400), 1e-8);
    within("energy", run.imbalance() / run.last("electrical_energy"), 1e-7);
    // What the battery gave is what the shaft took over, the heat, and what coil, rotor and shaft store.
    let stored = 0.5 * p.coil * run.last("current").powi(2)
        + 0.5 * p.rotor_inertia * run.last("motor_speed").powi(2)
        + 0.5 * run.last("spring_torque").powi(2) / p.shaft_stiffness;
    let given = run.last("heat") + run.last("friction") + run.last("shaft_energy") + stored;
    within("domains", (given / run.last("electrical_energy") - 1.0).abs(), 1e-7);
    assert!(run.last("shaft_energy") > 0.05 * run.last("electrical_energy"));
    // The starting current is nearly that of the blocked motor, then the back electromotive force takes over.
    let current = run.series("current");
    let peak = current.iter().copied().fold(0.0, f64::max);
    println!(
        "peak {peak} A of {}, at the end {} A, crank {} rad/s",
        voltage / p.winding,
        run.last("current"),
        run.last("crank_speed")
    );
    assert!((0.5..1.0).contains(&(peak * p.winding / voltage)), "{peak}");
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (early, late) = (mean(&current[20..120]), mean(&current[300..]));
    let speed = run.series("crank_speed");
    assert!(mean(&speed[300..]) > 1.5 * mean(&speed[20..120]));
    assert!(late < 0.8 * early, "{early} {late}");
    // Kirchhoff's law of the armature on average over time: U = R i + k w + L (i(T) - i(0)) / T. The limit is the error
    // of the trapezoidal rule.
    let motor_speed = run.series("motor_speed");
    let trapezoid = |values: &[f64]| values.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).sum::<f64>() / 400.0;
    let drop = p.winding * trapezoid(&current) + p.constant * trapezoid(&motor_speed) + p.coil * current[400] / 0.4;
    within("Kirchhoff", (drop / voltage - 1.0).abs(), 1e-3);
}
