use bg_model::dynamics::{Machine, Over};
use bg_model::extended::{self, Accuracy};
use bg_model::integrator::Integrator;
use bg_model::run::{Simulation, State};
use bg_model::scalar::{DoubleDouble, Scalar};
use bg_model::simulation::Span;
use bond_graph_tests::models::brakes::{Carriage, CarriageParameters};
use bond_graph_tests::models::stick_slip::{StickSlip, StickSlipParameters as Parameters};

use super::truth::within;

/// When it lets go first, how long it slips, how long it sticks: until the spring pulls with the static friction, then
/// half an oscillation about the place of the kinetic one.
fn course(p: &Parameters) -> [f64; 3] {
    let frequency = (p.stiffness / p.mass).sqrt();
    let excess = (p.still - p.kinetic) / p.stiffness;
    let slips = 2.0 / frequency * (std::f64::consts::PI - libm::atan(excess * frequency / p.belt));
    [p.still / p.stiffness / p.belt, slips, 2.0 * excess / p.belt]
}

/// The events up to `end` (s): begins to slip, sticks, and so on.
fn events(p: &Parameters, end: f64) -> Vec<f64> {
    let [first, slips, sticks] = course(p);
    let begins = (0..).map(|k| first + f64::from(k) * (slips + sticks));
    begins.flat_map(|t| [t, t + slips]).take_while(|t| *t < end).collect()
}

#[test]
fn it_sticks_and_slips_with_the_period_of_its_closed_form() {
    for belt in [0.1, 0.02, 0.5] {
        let p = Parameters { belt, ..Parameters::default() };
        let model = StickSlip::new(p.clone()).unwrap();
        let expected = events(&p, 20.0);
        for integrator in [Integrator::Auto, Integrator::Dop853, Integrator::Taylor, Integrator::Radau9] {
            let run = Simulation::new(&model).method(integrator).rtol(1e-11).atol(1e-12).until(20.0).run().unwrap();
            assert_eq!(run.events.len(), expected.len(), "{}", integrator.name());
            for (found, expected) in run.events.iter().zip(&expected) {
                within(integrator.name(), (found - expected).abs(), 1e-8);
            }
            let last = |name: &str| *run[name].last().unwrap() - run[name][0];
            within("power balance", (last("stored") + last("dissipated") - last("supplied")).abs(), 1e-9);
        }
    }
}

/// The same events in double-double arithmetic. It sticks where the flow is that which the friction brakes in 1e-13 s.
#[test]
fn a_reference_solution_goes_over_the_same_events() {
    let p = Parameters::default();
    let exact: StickSlip<DoubleDouble> = StickSlip::in_scalar(p.clone()).unwrap();
    let exact = Over::<_, { StickSlip::STATES }, { StickSlip::SWITCHES }, { StickSlip::OUTPUTS }>(&exact);
    let accuracy = Accuracy { columns: 8, tolerance: 1e-26 };
    let span = Span { t0: 0.0, t_end: 5.0 };
    let finish = extended::integrate(&exact, &exact.start().unwrap(), span, accuracy, &[], &mut |_, _, _| {}).unwrap();
    let expected = events(&p, 5.0);
    assert_eq!(finish.events.len(), expected.len());
    for (event, expected) in finish.events.iter().zip(&expected) {
        within("an event", (event.t.to_f64() - expected).abs(), 1e-11);
    }
}

/// Saved while it sticks and while it slips: the run goes on as if it had not been interrupted.
#[test]
fn a_saved_state_goes_on_sticking_or_slipping() {
    let model = StickSlip::new(Parameters::default()).unwrap();
    let run = |from: Option<&State>, end: f64| {
        let run = Simulation::new(&model).rtol(1e-11).atol(1e-12);
        let run = if let Some(state) = from { run.from(state) } else { run };
        run.until(end).run().unwrap()
    };
    let whole = run(None, 6.0);
    for pause in [0.5, 1.5, 2.3, 3.0] {
        let parts = run(Some(&run(None, pause).last), 6.0);
        for name in ["x", "v", "force"] {
            let (whole, parts) = (whole[name].last().unwrap(), parts[name].last().unwrap());
            within(name, (whole - parts).abs(), 1e-9);
        }
    }
}

/// A load that lies on a carriage is dragged along until it sticks.
#[test]
fn what_rubs_inside_keeps_the_momentum() {
    let p = CarriageParameters { speed: 0.3, ..CarriageParameters::default() };
    let model = Carriage::new(p).unwrap();
    let run = Simulation::new(&model).rtol(1e-11).atol(1e-12).every(0.01).until(0.3).run().unwrap();
    // 3 v + u = 0.9 - t, with u' = 3, v' = -4 / 3 until they are equal; then both lose 1 / 4 a second.
    let together = 0.3 / (3.0 + 4.0 / 3.0);
    for (k, t) in run.times.iter().enumerate() {
        let common = 3.0 * together - 0.25 * (t - together);
        let (v, u) = if *t < together { (0.3 - 4.0 / 3.0 * t, 3.0 * t) } else { (common, common) };
        within("carriage", (run["v"][k] - v).abs(), 1e-8);
        within("load", (run["u"][k] - u).abs(), 1e-8);
        let holds = if *t < together { -3.0 } else { 0.25 };
        within("friction", (run["hold.effort"][k] - holds).abs(), 1e-7);
    }
}
