//! Recordings: the samples of a run as columns by name.

use bg_model::bond_graph;
use bg_model::integrator::Dop853;
use bg_model::mechanism::Mechanism;
use bg_model::simulation::{EachStep, Part, Recorder, Samples, Settings, Span, integrate};
use bg_model::system::Model;

bond_graph! {
    graph Slide {
        param k: N/m = 50;
        1 slide: translation; I body = 2; C spring = k start 0.1; R damper(v) = if v < 0 { 1 * v } else { 2 * v };
        slide -> body; slide -> spring; slide -> damper;
        observe { x: m = spring.q; v: m/s = slide.flow; lost: J = integral(dissipated_power) }
    }
}

#[test]
fn columns_have_the_names_and_units_of_the_model_in_the_order_asked_for() {
    let model = Slide::new(SlideParameters::default()).expect("no parameter is out of range");
    let start = model.start().expect("nothing has to close");
    let mut steps = 0;
    let parts = [Part::Energy, Part::Outputs, Part::States, Part::Powers];
    let machine = model.machine();
    let mut observer = (Recorder::new(&*machine, &parts), EachStep(|_| steps += 1));
    let settings = Settings { samples: Samples::Every(0.25), ..Settings::default() };
    let span = Span { t0: 0.0, t_end: 2.0 };
    let finish = integrate(&model, &mut Dop853::new(), &start, span, &settings, &mut observer).expect("the run ends");
    let recording = observer.0.recording;
    let names = recording.columns.iter().map(|column| (column.name.as_str(), column.unit.as_str()));
    let columns: Vec<(&str, &str)> = names.collect();
    let states = model.description().states.iter().map(|state| (state.name, state.unit));
    let expected: Vec<(&str, &str)> = [("stored energy", "J"), ("x", "m"), ("v", "m/s"), ("lost", "J")]
        .into_iter()
        .chain(states)
        .chain([("supplied power", "W"), ("dissipated power", "W")])
        .collect();
    assert_eq!(columns, expected);
    assert_eq!(recording.times, (0..=8).map(|k| 0.25 * f64::from(k)).collect::<Vec<_>>());
    assert!(recording.columns.iter().all(|column| column.values.len() == recording.times.len()));
    assert_eq!(steps, finish.statistics.steps);
    assert_eq!(recording.events.len() as u64, finish.statistics.events);
    assert!(finish.statistics.events > 0);

    let column = |name: &str| recording.column(name).expect("a column of this name");
    assert_eq!(column("x")[0], 0.1);
    for (stored, lost) in column("stored energy").iter().zip(column("lost")) {
        assert!((stored + lost - 0.25).abs() < 1e-8, "{stored} {lost}");
    }
    assert_eq!(recording.column("y"), None);
}
