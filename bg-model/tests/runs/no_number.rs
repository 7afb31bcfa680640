//! What cannot be calculated is no row: the run ends and says what it is.

use bg_model::bond_graph;
use bg_model::failure::{BadInput, Cause};
use bg_model::mechanism::Mechanism;
use bg_model::run::{RunError, Simulation, Stopped};
use bg_model::simulation::{Ended, Part};

bond_graph! {
    /// A resistor and a conductance under 1 N, beside an oscillator: v^2 + v + two - 1 = 0, which only an output needs.
    graph Unsolved {
        param k: N/m = 50;
        param two: N = 2;
        param one: N*s^2/m^2 = 1;
        Se push = 1; 1 line: translation; R d(f) = one * f * f + two; R c = 1; push -> line -> d; line -> c;
        1 slide: translation; I body = 2; C spring = k start 0.1; slide -> body; slide -> spring;
        observe { x: m = spring.q; v: m/s = line.flow }
    }
    /// An output that has no value while the spring is pressed by more than the limit.
    graph Rooted {
        param k: N/m = 50;
        param limit: m = 0.05;
        1 slide: translation; I body = 2; C spring = k start 0.1; slide -> body; slide -> spring;
        observe { x: m = spring.q; root: 1 = sqrt((spring.q + limit) / limit) }
    }
}

fn stopped(fault: RunError) -> Stopped {
    let RunError::Stopped(stopped) = fault else { panic!("{fault}") };
    *stopped
}

#[test]
fn a_loop_without_a_solution_ends_the_run_with_its_name() {
    let make = |two: f64| Unsolved::make(UnsolvedParameters { two, ..UnsolvedParameters::default() }, &[]).unwrap();
    let Stopped { cause, trajectory } = stopped(Simulation::new(&make(2.0)).every(0.1).until(1.0).run().unwrap_err());
    let text = cause.to_string();
    assert!(text.starts_with("`v` = `line.flow` is NaN at t = 0.0 s, since algebraic loop `"), "{text}");
    assert!(trajectory.times.is_empty() && trajectory.ended == Ended::ByFailure, "{:?}", trajectory.times);
    let run = Simulation::new(&make(1.0)).every(0.1).until(1.0).run().unwrap();
    assert!(run["v"].iter().all(|v| v.abs() < 1e-7), "{:?}", &run["v"]);
}

#[test]
fn an_output_that_is_no_number_ends_the_run_with_its_law_and_time() {
    let model = Rooted::make(RootedParameters::default(), &[]).unwrap();
    let Stopped { cause, trajectory } = stopped(Simulation::new(&model).every(0.1).until(1.0).run().unwrap_err());
    let text = cause.to_string();
    let Cause::NoNumber(fault) = cause else { panic!("{text}") };
    // x = 0.1 cos(5 t) is below -0.05 from t = 0.4189 s on.
    assert_eq!((fault.name.as_str(), fault.t), ("root", 0.5));
    assert!(text.starts_with("`root` = `sqrt((spring.q + limit) / limit)` is NaN at t = 0.5 s"), "{text}");
    assert_eq!(trajectory.times, [0.0, 0.1, 0.2, 0.3, 0.4]);
    assert!(trajectory["root"].iter().all(|root| root.is_finite()));
    let states = Simulation::new(&model).recording(&[Part::States, Part::Energy]).every(0.1).until(1.0).run().unwrap();
    assert_eq!(states.times.len(), 11);
}

#[test]
fn instants_that_cannot_be_sampled_are_refused() {
    let model = Rooted::make(RootedParameters { limit: 1.0, ..RootedParameters::default() }, &[]).unwrap();
    for (instants, index) in [(&[0.1, f64::NAN, 0.3][..], 1), (&[-0.1, 0.3], 0), (&[0.3, 0.1], 1), (&[0.1, 2.0], 1)] {
        let Stopped { cause, trajectory } = stopped(Simulation::new(&model).at(instants).until(1.0).run().unwrap_err());
        assert!(
            matches!(cause, Cause::BadInput(BadInput::SampleInstant { index: own, .. }) if own == index),
            "{cause}"
        );
        assert!(trajectory.times.is_empty());
    }
    let mut run = Simulation::new(&model).at(&[0.1, 0.5]).until(0.6).run().unwrap();
    let fault = Simulation::new(&model).from(&run.last).at(&[0.5, 0.7]).until(1.0).run().unwrap_err();
    assert!(fault.to_string().starts_with("sample instant 0, t = 0.5 s, is outside the span"), "{fault}");
    run.continue_until(&model, 1.0).unwrap();
    assert_eq!(run.times, [0.1, 0.5]);
}
