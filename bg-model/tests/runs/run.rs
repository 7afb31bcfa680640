//! Runs asked for without const generics: columns by name, going on, saved states, conditions.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use bg_model::bond_graph;
use bg_model::failure::Cause;
use bg_model::integrator::{Dop853, Integrator, Tolerances};
use bg_model::mechanism::{Mechanism, MechanismVisitor, Scenes};
use bg_model::run::{Interrupt, Progress, Request, RunError, Simulation, State};
use bg_model::simulation::{Ended, Part, Settings, Span, integrate};
use bg_model::system::Model;

bond_graph! {
    graph Slide {
        param mass: kg = 2, above 0;
        param k: N/m = 50;
        input push: N;
        1 slide: translation; I body = mass; C spring = k start 0.1; Se force = push;
        slide -> body; slide -> spring; force -> slide;
        observe { x: m = spring.q; v: m/s = slide.flow }
        /// Without the place.
        scene Fast { observe { v: m/s = slide.flow } tune { mass } }
    }
}

fn slide(mass: f64) -> Slide {
    Slide::make(SlideParameters { mass, ..SlideParameters::default() }, &[]).expect("no parameter is out of range")
}

/// rad/s, with a mass of 2 kg.
const FREQUENCY: f64 = 5.0;

#[test]
fn a_run_gives_columns_by_name_that_are_those_of_the_generic_path() {
    let model = slide(2.0);
    let run =
        Simulation::new(&model).method(Integrator::Dop853).rtol(1e-10).atol(1e-11).every(0.1).until(1.0).run().unwrap();
    assert_eq!(run.times, [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]);
    assert_eq!(run.columns.iter().map(|column| column.unit.as_str()).collect::<Vec<_>>(), ["m", "m/s"]);
    for (t, x) in run.times.iter().zip(&run["x"]) {
        assert!((x - 0.1 * (FREQUENCY * t).cos()).abs() < 1e-9, "{t}");
    }
    let settings = Settings { tolerances: Tolerances::new(1e-10, 1e-11), ..Settings::default() };
    let span = Span { t0: 0.0, t_end: 1.0 };
    let start = model.start().unwrap();
    let finish = integrate(&model, &mut Dop853::new(), &start, span, &settings, &mut ()).unwrap();
    assert_eq!(run.last.states.iter().map(|(_, value)| *value).collect::<Vec<_>>(), finish.x.as_slice());
    assert_eq!((run.ended, run.statistics.steps), (Ended::AtEnd, finish.statistics.steps));
    let mut csv = Vec::new();
    run.write_csv(&mut csv).unwrap();
    assert!(String::from_utf8(csv).unwrap().starts_with("t,x,v\n0.0,0.1,0.0\n0.1,"));
}

#[test]
fn a_run_goes_on_from_where_it_has_come_to() {
    let model = slide(2.0);
    let all = Simulation::new(&model).every(0.25).until(2.0).run().unwrap();
    let mut parts = Simulation::new(&model).with_peaks().every(0.25).until(0.9).run().unwrap();
    let steps = parts.statistics.steps;
    parts.continue_until(&model, 2.0).unwrap();
    assert_eq!(parts.times, [0.0, 0.25, 0.5, 0.75, 0.9, 1.0, 1.25, 1.5, 1.75, 2.0]);
    assert!((parts["x"][9] - all["x"][8]).abs() < 1e-8);
    // The speed is largest after three quarters of a turn, when it has gone on.
    let fastest = parts.peaks("v").expect("they were asked for").largest;
    assert!((fastest.value - 0.5).abs() < 1e-8 && (fastest.t - 0.3 * PI).abs() < 1e-4, "{fastest:?}");
    assert!(parts.statistics.steps > steps && parts.request.t_end == 2.0);
    // Another mass: the momentum stays, so the velocity is another.
    let mut changed = Simulation::new(&model).every(0.25).until(0.25).run().unwrap();
    changed.continue_until(&slide(4.0), 0.5).unwrap();
    let heavy = Simulation::new(&slide(4.0)).from(&parts.last).every(1.0).until(2.0).run().unwrap();
    assert_eq!(heavy["v"][0], parts["v"][9] / 2.0);
}

#[test]
fn a_saved_state_reads_back_to_the_bit_and_is_refused_where_it_does_not_fit() {
    let run = Simulation::new(&slide(2.0)).until(0.3).run().unwrap();
    let text = run.last.to_json().unwrap();
    let state = State::from_json(&text).unwrap();
    assert_eq!(state, run.last);
    assert_eq!(state.t, 0.3);
    let fault = |change: fn(&mut State)| {
        let mut state = run.last.clone();
        change(&mut state);
        Simulation::new(&slide(2.0)).from(&state).until(1.0).run().unwrap_err().to_string()
    };
    assert_eq!(fault(|state| state.model = "Other".to_owned()), "this is a state of `Other`, not of `Slide`");
    assert!(fault(|state| state.version = "0.0.9".to_owned()).contains("compiled by version 0.0.9"));
    assert!(fault(|state| state.states[1].0 = "y".to_owned()).contains("do not fit"));
    assert!(fault(|state| drop(state.states.pop())).contains("do not fit"));
    assert!(fault(|state| state.states[0].1 = f64::NAN).contains("is NaN, not a finite number"));
    assert!(State::from_json("{}").unwrap_err().to_string().starts_with("this is no saved state: "));
    let fault = Simulation::new(&slide(2.0)).from(&run.last).until(0.1).run().unwrap_err().to_string();
    assert!(fault.contains("0.3"), "{fault}");
}

#[test]
fn a_condition_ends_a_run_where_it_passes_through_zero() {
    let model = slide(2.0);
    let run = Simulation::new(&model).rtol(1e-12).every(0.1).until(5.0).stop_when(|now| now["x"] - 0.05).run().unwrap();
    let expected = (0.5_f64).acos() / FREQUENCY;
    assert_eq!(run.ended, Ended::ByCondition);
    assert!((run.last.t - expected).abs() < 1e-10, "{}", run.last.t - expected);
    assert_eq!((run.times.len(), run.times[3]), (4, run.last.t));
    assert!((run["x"][3] - 0.05).abs() < 1e-12);
}

#[test]
fn a_run_is_stopped_from_its_steps() {
    let (model, mut steps) = (slide(2.0), 0);
    let stop = |_: f64| {
        steps += 1;
        if steps < 3 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let run = Simulation::new(&model).every(10.0).until(50.0).each_step(stop).run().unwrap();
    assert_eq!((run.ended, run.statistics.steps), (Ended::ByObserver, 3));
    assert_eq!(run.times, [0.0, run.last.t]);
}

#[test]
fn a_run_is_interrupted_from_outside() {
    let interrupt = Interrupt::default();
    let request = Request { t_end: 50.0, interrupt: interrupt.clone(), ..Request::default() };
    let run = |mut told: Box<dyn FnMut()>| {
        let told = move |_: f64| {
            told();
            ControlFlow::Continue(())
        };
        Simulation::of(&slide(2.0), request.clone()).each_step(told).run()
    };
    let mut steps = 0;
    let ended = run(Box::new(move || {
        steps += 1;
        if steps == 3 {
            interrupt.interrupt();
        }
    }));
    let Err(RunError::Stopped(stopped)) = ended else { panic!("{ended:?}") };
    let (reached, steps) = (stopped.trajectory.last.t, stopped.trajectory.statistics.steps);
    assert!(matches!(stopped.cause, Cause::Interrupted { t } if t == reached && t < 50.0), "{stopped}");
    assert_eq!((steps, stopped.trajectory.ended), (3, Ended::ByFailure));
    // What begins later ends with its first step.
    let Err(RunError::Stopped(stopped)) = run(Box::new(|| ())) else { panic!("it goes on") };
    assert_eq!(stopped.trajectory.statistics.steps, 1);
}

#[test]
fn who_waits_for_a_run_is_told_how_far_it_is() {
    let progress = Progress::default();
    let request = |t_end: f64| Request { t_end, progress: progress.clone(), ..Request::default() };
    let (model, mut steps) = (slide(2.0), 0);
    let first = Simulation::of(&model, request(1.0)).run().unwrap();
    assert_eq!(progress.done(), 1.0);
    // One that goes on from 1 s.
    let told = |t: f64| {
        steps += 1;
        let part = (t - 1.0) / 3.0;
        assert!((progress.done() - part).abs() < 1e-6, "{part}: {}", progress.done());
        ControlFlow::Continue(())
    };
    Simulation::of(&model, request(4.0)).from(&first.last).each_step(told).run().unwrap();
    assert!(steps > 3, "{steps}");
}

#[test]
fn a_run_that_fails_has_what_it_reached() {
    let push = bg_model::input::Input::function(|t| if t < 0.5 { 0.0 } else { f64::NAN });
    let model = Slide::make(SlideParameters::default(), &[push]).unwrap();
    let Err(RunError::Stopped(stopped)) = Simulation::new(&model).every(0.1).until(1.0).run() else { panic!() };
    assert!(stopped.to_string().contains("`push`"), "{stopped}");
    assert!(stopped.trajectory.times.len() >= 5 && stopped.trajectory.ended == Ended::ByFailure);
}

#[test]
fn states_and_energies_are_recorded_where_they_are_asked_for() {
    let parts = [Part::States, Part::Energy];
    let run = Simulation::new(&slide(2.0)).recording(&parts).every(0.5).until(1.0).run().unwrap();
    assert_eq!(run.columns.len(), 3);
    assert!(run["stored energy"].iter().all(|energy| (energy - 0.25).abs() < 1e-8));
}

#[test]
fn a_graph_lists_its_scenes() {
    struct Name;
    impl MechanismVisitor for Name {
        type Output = &'static str;
        fn visit<Me: Mechanism>(self) -> &'static str {
            Me::describe().name
        }
    }
    assert_eq!((0..Slide::MODELS).map(|index| Slide::model(index, Name)).collect::<Vec<_>>(), ["Slide", "Fast"]);
    assert_eq!((Fast::MODELS, Fast::model(0, Name)), (1, "Fast"));
    assert_eq!((Slide::only::<1, _>(Name), Fast::only::<0, _>(Name)), ("Fast", "Fast"));
}

#[test]
#[should_panic(expected = "the run has no column `y`; it has x, v")]
fn a_column_that_is_not_there_is_named() {
    let run = Simulation::new(&slide(2.0)).until(0.1).run().unwrap();
    let _ = &run["y"];
}
