use bg_model::dynamics::{Machine, Over};
use bg_model::extended::{self, Accuracy};
use bg_model::integrator::{Integrator, Tolerances};
use bg_model::nalgebra::SVector;
use bg_model::scalar::{DoubleDouble, Scalar};
use bg_model::simulation::{Settings, Span, integrate};
use bg_model::system::Model;
use bond_graph_tests::models::orifice::{Orifice, OrificeParameters as Parameters};

use super::truth::within;

const N: usize = Orifice::STATES;
const M: usize = Orifice::OUTPUTS;
const METHODS: [Integrator; 5] =
    [Integrator::Radau9, Integrator::Radau5, Integrator::Rodas5p, Integrator::Taylor, Integrator::Dop853];

fn outputs(model: &Orifice, t: f64, x: &SVector<f64, N>) -> SVector<f64, M> {
    let mut outputs = SVector::zeros();
    model.outputs(t, x, &[], &mut outputs);
    outputs
}

/// The outputs at the end of a run from rest.
fn run(model: &Orifice, integrator: Integrator, t_end: f64) -> SVector<f64, M> {
    let start = model.start().expect("nothing has to close");
    let settings = Settings { tolerances: Tolerances::new(1e-9, 1e-22), step_limit: 100_000, ..Settings::default() };
    let span = Span { t0: 0.0, t_end };
    let finish = integrate(model, &mut integrator.method(0.0), &start, span, &settings, &mut ())
        .unwrap_or_else(|failure| panic!("{}: {failure}", integrator.name()));
    outputs(model, t_end, finish.state())
}

/// Under a pressure that rises evenly the tank comes to take in rise * capacity, at the drop p with p^4 = (p^2 + l^2)
/// r^4, where r is the root of the drop that the flow asks for.
#[test]
fn it_starts_at_rest_and_comes_to_the_flow_that_the_tank_takes() {
    let p = Parameters::default();
    let model = Orifice::new(p.clone()).unwrap();
    let coefficient = p.discharge * p.area * (2.0 / p.density).sqrt();
    let square = (p.rise * p.capacity / coefficient).powi(4);
    let drop = (0.5 * (square + (square * square + 4.0 * square * p.laminar * p.laminar).sqrt())).sqrt();
    for integrator in METHODS {
        let end = run(&model, integrator, 8.0);
        let name = integrator.name();
        within(name, (end[0] / drop - 1.0).abs(), 1e-8);
        within(name, (end[1] / (p.rise * p.capacity) - 1.0).abs(), 1e-8);
        within(name, (end[3] + end[5] - end[4]).abs() / end[4], 1e-8);
    }
}

/// In the laminar range, beside double-double arithmetic.
#[test]
fn all_methods_leave_the_rest_alike() {
    let p = Parameters::default();
    let exact: Orifice<DoubleDouble> = Orifice::in_scalar(p.clone()).unwrap();
    let exact = Over::<_, { Orifice::STATES }, { Orifice::SWITCHES }, { Orifice::OUTPUTS }>(&exact);
    let accuracy = Accuracy { columns: 8, tolerance: 1e-28 };
    let start = exact.start().unwrap();
    let span = Span { t0: 0.0, t_end: 2e-3 };
    let finish = extended::integrate(&exact, &start, span, accuracy, &[], &mut |_, _, _| {}).unwrap();
    let model = Orifice::new(p).unwrap();
    let reference = outputs(&model, 2e-3, &SVector::from_fn(|state, _| finish.x[state].to_f64()));
    assert!((50.0..200.0).contains(&reference[0]), "in the laminar range: {reference}");
    for integrator in METHODS {
        let end = run(&model, integrator, 2e-3);
        within(integrator.name(), (end[0] / reference[0] - 1.0).abs(), 1e-7);
        within(integrator.name(), (end[2] / reference[2] - 1.0).abs(), 1e-7);
    }
}
