//! Models with parameters, inputs and starts that cannot be.

use bg_model::assembly::{AssemblyError, Gap, close};
use bg_model::failure::{Cause, Quantity};
use bg_model::input::Input;
use bg_model::simulation::{Settings, Span, integrate};
use bg_model::system::Model;
use bond_graph_tests::hardcases::integrators_of_rates;
use bond_graph_tests::models::mass_spring_damper::{
    MassSpringDamper, MassSpringDamperInputs, MassSpringDamperParameters,
};
use bond_graph_tests::models::slider_crank::{SliderCrank, SliderCrankParameters};

const BAD: [f64; 4] = [f64::NAN, f64::INFINITY, 0.0, -1.0];

/// The messages of refused parameters and starts, by name.
pub fn messages() -> Vec<(String, String)> {
    let mut messages: Vec<(String, String)> =
        BAD.iter().map(|value| (format!("mass {value:?}"), mass(*value))).collect();
    messages.push(("stretch NaN".to_owned(), stretch(f64::NAN)));
    messages.push(("a rod of 0.05 m on a crank of 0.1 m".to_owned(), assembly(0.05).to_string()));
    messages.push(("a guess that is NaN".to_owned(), guess(f64::NAN).to_string()));
    messages
}

fn spring(parameters: MassSpringDamperParameters) -> Result<(), String> {
    let inputs = MassSpringDamperInputs::default();
    MassSpringDamper::new(parameters, inputs).map(|_| ()).map_err(|error| error.to_string())
}

fn mass(mass: f64) -> String {
    spring(MassSpringDamperParameters { mass, ..Default::default() }).expect_err("the mass is refused")
}

fn stretch(stretch: f64) -> String {
    spring(MassSpringDamperParameters { stretch, ..Default::default() }).expect_err("the stretch is refused")
}

fn assembly(rod_length: f64) -> AssemblyError {
    let parameters = SliderCrankParameters { rod_length, crank_angle: 1.5, ..Default::default() };
    let model: SliderCrank = SliderCrank::new(parameters).expect("parameters in range");
    model.start().expect_err("the rod is too short")
}

fn guess(guess: f64) -> AssemblyError {
    static GAPS: [Gap; 1] = [Gap { joint: "pin", component: "x", unit: "m" }];
    close(&[guess], &GAPS, &|q, r| r[0] = q[0] - 1.0, &|_, extents| extents.fill(1.0))
        .expect_err("the guess is refused")
}

#[test]
fn parameters_are_refused_by_name() {
    for value in BAD {
        assert!(mass(value).contains("`mass`") && stretch(f64::NEG_INFINITY).contains("`stretch`"));
    }
    assert!(spring(MassSpringDamperParameters { mass: 1e-300, stiffness: 1e300, ..Default::default() }).is_ok());
}

#[test]
fn starts_that_cannot_close_are_refused_by_joint() {
    assert!(matches!(assembly(0.05), AssemblyError::Open { .. }), "{}", assembly(0.05));
    for value in [f64::NAN, f64::INFINITY] {
        assert!(matches!(guess(value), AssemblyError::NonFinite { .. }), "{}", guess(value));
    }
}

/// The force is no number from 0.5 s on: of all states only the momentum's rate has it.
#[test]
fn an_input_that_stops_being_a_number_is_named_with_the_state_that_it_moves() {
    for integrator in integrators_of_rates() {
        let force = Input::function(|t| if t > 0.5 { f64::NAN } else { 1.0 });
        let model: MassSpringDamper =
            MassSpringDamper::new(Default::default(), MassSpringDamperInputs { force }).expect("parameters in range");
        let start = model.start().expect("nothing has to close");
        let span = Span { t0: 0.0, t_end: 1.0 };
        let settings = Settings { step_limit: 10_000, ..Settings::default() };
        let name = integrator.name();
        let failure =
            integrate(&model, &mut integrator.method(0.01), &start, span, &settings, &mut ()).expect_err(name);
        let Cause::NonFinite { origin, quantity, name: state, t, .. } = &failure.cause else {
            panic!("{name}: {failure}")
        };
        assert!(matches!(quantity, Quantity::Rate | Quantity::Derivative), "{name}: {failure}");
        let origin = origin.map(|origin| (origin.kind, origin.name));
        assert_eq!(origin, Some(("input", "force")), "{name}: {failure}");
        assert!(state.starts_with("inertia") && (0.48..=0.5).contains(t), "{name}: {failure}");
        assert_eq!(failure.last.t, *t, "{name}");
    }
}
