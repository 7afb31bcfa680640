//! Studies of models of text beside those of the same models compiled by rustc: derivatives of runs, parameters found
//! from columns, reference solutions.

use bg_analysis::identify::{Data, Identified, Measured, Variable, identify};
use bg_loaded::{Interpreted, load};
use bg_model::extended::{Accuracy, outputs};
use bg_model::input::Input;
use bg_model::integrator::Integrator;
use bg_model::mechanism::{Followed, Liftable, Mechanism, Reversible};
use bg_model::parameters::Parameters;
use bg_model::run::Request;
use bg_model::scalar::DoubleDouble;
use bg_model::sensitivity::{Direction, Objective, Sensitivities, differences, gradient, sensitivities};
use bg_model::simulation::Samples;
use bond_graph_tests::models::double_pendulum::DoublePendulum;
use bond_graph_tests::models::free_body::FreeBody;
use bond_graph_tests::models::mass_spring_damper::MassSpringDamper;
use bond_graph_tests::models::stick_slip::StickSlip;

use super::texts;

/// The literal model of a text and the compiled one, with the same values and inputs.
fn both<Me: Mechanism>(call: &str) -> (Me, Interpreted) {
    let parameters = Me::Parameters::default();
    let inputs: Vec<Input> = (1..=Me::describe().inputs.len()).map(|k| Input::constant(0.7 * k as f64)).collect();
    let graphs = load(&texts::of(call, Me::describe().name)).unwrap_or_else(|faults| panic!("{}", faults[0]));
    let graph = graphs.iter().find(|graph| graph.name == Me::describe().name);
    let blueprint =
        graph.expect("the text has the graph").models[0].blueprint.as_ref().expect("all scenes were asked for");
    let loaded = Interpreted::new(blueprint, &parameters.values(), &inputs).expect("defaults are possible");
    (Me::make(parameters, &inputs).expect("defaults are possible"), loaded)
}

/// Everything of two studies that is told; zeros have no sign.
fn told(found: &Sensitivities) -> String {
    let outputs = found.trajectory.recording.columns.len();
    let slopes = |direction: usize| (0..outputs).map(move |output| found.of(direction, output).to_vec());
    let slopes: Vec<_> = (0..found.directions.len()).flat_map(slopes).collect();
    let text = format!("{:?}\n{slopes:?}\n{:?}", found.trajectory.recording, found.states);
    text.replace("-0.0,", "0.0,").replace("-0.0]", "0.0]")
}

fn same_studies<Me: Mechanism>(call: &str, t_end: f64) {
    let (compiled, loaded) = both::<Me>(call);
    let (compiled, loaded): (&dyn Followed, &dyn Followed) = (&compiled, &loaded);
    let mut by = Direction::parameters::<Me>();
    by.extend((0..Me::describe().states.len()).map(Direction::Start));
    // More than fit into one vector, and as few as take the narrow ones; by the method of the slopes and by another.
    for (method, few) in [(Integrator::Dop853, &by[..]), (Integrator::Dop853, &by[..1]), (Integrator::default(), &by)] {
        let request = Request { method, t_end, samples: Samples::Every(0.5 * t_end), ..Request::default() };
        let [ours, theirs] = [loaded, compiled].map(|of| told(&sensitivities(of, &request, few).expect("slopes")));
        assert_eq!(ours, theirs, "{}: {method:?}", Me::describe().name);
        assert!(ours.contains("e-") || ours.contains("0.0"), "{ours}");
    }
}

#[test]
fn derivatives_of_runs_are_those_of_the_compiled_model() {
    same_studies::<DoublePendulum>("double_pendulum.rs", 0.005);
    same_studies::<MassSpringDamper>("mass_spring_damper.rs", 0.2);
    same_studies::<StickSlip>("stick_slip.rs", 2.0);
}

/// All derivatives of a number of both runs followed backwards, to the bit but for signs of zeros, and near to slopes.
fn same_gradients<Me: Mechanism>(call: &str, t_end: f64) {
    let (compiled, loaded) = both::<Me>(call);
    let mut by = Direction::parameters::<Me>();
    by.extend((0..Me::describe().states.len()).map(Direction::Start));
    let request = Request { method: Integrator::Dop853, t_end, rtol: 1e-10, ..Request::default() };
    let objective = Objective::last(0).plus(Objective::integral(0).times(0.1));
    let both: [&dyn Reversible; 2] = [&loaded, &compiled];
    let bits = |values: &[f64]| values.iter().map(|value| (value + 0.0).to_bits()).collect::<Vec<_>>();
    let [ours, theirs] = both.map(|of| gradient(of, &request, &objective, &by).expect("a gradient"));
    assert_eq!(bits(&ours.by), bits(&theirs.by), "{}", Me::describe().name);
    assert_eq!(bits(&[ours.value]), bits(&[theirs.value]), "{}", Me::describe().name);
    assert!(ours.by.iter().any(|&by| by != 0.0));
}

#[test]
fn gradients_are_those_of_the_compiled_model() {
    same_gradients::<MassSpringDamper>("mass_spring_damper.rs", 0.2);
    same_gradients::<StickSlip>("stick_slip.rs", 2.0);
    same_gradients::<FreeBody>("free_body.rs", 0.1);
    same_gradients::<DoublePendulum>("double_pendulum.rs", 0.02);
}

/// Of a model whose sweeps are too long to be compiled, a governor in joint coordinates: the last values of two outputs
/// against slopes.
#[test]
fn a_long_model_of_text_has_gradients() {
    let graphs = load(include_str!("../../bg-model/bond/examples/governor.bond")).expect("it is an example");
    let blueprint = graphs[0].models[0].blueprint.as_ref().expect("all scenes were asked for");
    let table = blueprint.description().parameters;
    let defaults: Vec<f64> = table.iter().map(|parameter| parameter.default).collect();
    let governor = Interpreted::new(blueprint, &defaults, &[]).expect("defaults are possible");
    let request = Request { method: Integrator::Dop853, t_end: 0.3, rtol: 1e-10, ..Request::default() };
    let by: Vec<Direction> = (0..table.len()).map(Direction::Parameter).collect();
    let slopes = sensitivities(&governor, &request, &by).expect("slopes");
    for output in 0..2 {
        let found = gradient(&governor, &request, &Objective::last(output), &by).expect("a gradient");
        let slope = |direction: usize| *slopes.of(direction, output).last().expect("samples");
        for (k, by) in found.by.iter().enumerate() {
            let size = slope(k).abs().max(1e-3);
            assert!((by - slope(k)).abs() <= 1e-8 * size, "{output} {k}: {by:e} {:e}", slope(k));
        }
        assert!(found.by.iter().filter(|by| by.abs() > 1e-3).count() > 4, "{:?}", found.by);
    }
}

#[test]
fn references_are_those_of_the_compiled_model() {
    let (compiled, loaded) = both::<DoublePendulum>("double_pendulum.rs");
    let (compiled, loaded): (&dyn Liftable<DoubleDouble>, &dyn Liftable<DoubleDouble>) = (&compiled, &loaded);
    let accuracy = Accuracy { columns: 6, tolerance: 1e-18 };
    let [ours, theirs] = [loaded, compiled].map(|model| {
        let start = model.machine().start().expect("a start");
        let values: Vec<DoubleDouble> = model.values().into_iter().map(DoubleDouble::from).collect();
        let exact = model.lifted(&values).expect("in range");
        let mut rows = Vec::new();
        let places: Vec<usize> = (0..model.description().outputs.len()).collect();
        let told = &mut |t: f64, values: &[f64]| rows.push((t, values.to_vec()));
        let finish = outputs(&*exact, &start, accuracy, &[0.0, 0.1, 0.3], &places, told).expect("a run");
        (rows, finish, differences(model, 0, 0.1, 1e-4, accuracy).expect("differences"))
    });
    assert_eq!(ours, theirs);
    assert!(ours.0.len() == 3 && ours.1.steps > 0);
}

#[test]
fn parameters_from_columns_are_those_of_the_compiled_model() {
    let (compiled, loaded) = both::<MassSpringDamper>("mass_spring_damper.rs");
    let info = MassSpringDamper::<f64>::describe()
        .parameters
        .iter()
        .find(|info| info.name == "stiffness")
        .expect("it has one");
    let times: Vec<f64> = (0..20).map(|k| 0.1 * f64::from(k)).collect();
    // No run of the model: something is left.
    let values = times.iter().map(|t| Some(0.02 * (4.0 * t).cos() + 1e-3 * (31.0 * t).sin())).collect();
    let data = Data { columns: vec![Measured { name: "x".to_owned(), output: 0, values }], times, ignored: Vec::new() };
    let variable = Variable { info, start: info.default, lower: 1.0, upper: 1e4 };
    let found = |of: &dyn Followed| -> (Identified, usize) {
        let mut runs = 0;
        let request = Request { method: Integrator::Dop853, ..Request::default() };
        let found = identify(of, &request, &data, std::slice::from_ref(&variable), &mut |_, _| runs += 1);
        (found.expect("a fit"), runs)
    };
    let (ours, theirs) = (found(&loaded), found(&compiled));
    assert_eq!(ours, theirs);
    assert!(ours.1 > 1 && ours.0.estimates[0].value != info.default);
}
