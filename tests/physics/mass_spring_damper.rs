use bg_model::input::Input;
use bond_graph_tests::models::mass_spring_damper::{
    MassSpringDamper, MassSpringDamperInputs as Inputs, MassSpringDamperParameters as Parameters,
};
use bond_graph_tests::support::record::{instants, record};

use super::truth::{oscillator, within};

#[test]
fn a_step_of_the_force_moves_it_to_its_new_rest_as_the_closed_solution_does() {
    let p = Parameters::default();
    let force = 30.0;
    let model = MassSpringDamper::new(p.clone(), Inputs { force: Input::constant(force) }).unwrap();
    let run = record(&model, &instants(5.0, 200), 1e-11);
    let rest = force / p.stiffness;
    let truth = |t| oscillator(p.mass, p.damping, p.stiffness, (p.stretch - rest, p.speed), t);
    within("x", run.deviation("x", |t| rest + truth(t).0), 1e-10);
    within("v", run.deviation("v", |t| truth(t).1), 1e-9);
    within("energy", run.imbalance(), 1e-9);
}

#[test]
fn a_harmonic_force_gives_the_frequency_response() {
    let p = Parameters::default();
    let (force, w) = (6.0, 7.0);
    let model = MassSpringDamper::new(p.clone(), Inputs { force: Input::function(move |t| force * (w * t).sin()) });
    let run = record(&model.unwrap(), &instants(4.0, 100), 1e-11);
    // x = Im(X e^(iwt)) + free part, X = F / (k - m w^2 + i c w).
    let (re, im) = (p.stiffness - p.mass * w * w, p.damping * w);
    let size = force / (re * re + im * im);
    let forced = |t: f64| size * (re * (w * t).sin() - im * (w * t).cos());
    let forced_rate = |t: f64| size * w * (re * (w * t).cos() + im * (w * t).sin());
    let free = (p.stretch - forced(0.0), p.speed - forced_rate(0.0));
    let truth = |t| forced(t) + oscillator(p.mass, p.damping, p.stiffness, free, t).0;
    within("x", run.deviation("x", truth), 1e-10);
    within("energy", run.imbalance(), 1e-9);
}
