//! Algebraic loops that are not linear, while a model runs: by every integrator, in more digits, with events, and
//! without a solution.

use bg_model::bond_graph;
use bg_model::integrator::Integrator;
use bg_model::nalgebra::SVector;
use bg_model::run::{Simulation, Trajectory};
use bg_model::scalar::{DoubleDouble, Scalar};
use bg_model::system::Model;

bond_graph! {
    /// Two diodes between resistors, no capacitor between them: two unknowns. A coil takes what is left.
    graph Ladder {
        param amplitude: V = 10;
        param thermal: V = 0.5, above 0;
        MSe source = amplitude * cos(3 * t);
        1 first: electrical; R R1 = 5; 0 left: electrical; R D1(effort u) = 0.01 * (exp(u / thermal) - 1) * scale;
        param scale: A = 1;
        1 second: electrical; R R2 = 3; 0 right: electrical; R D2(effort u) = 0.02 * (exp(u / thermal) - 1) * scale;
        1 third: electrical; R R3 = 1; I coil = 0.5;
        source -> first -> R1; first -> left -> D1; left -> second -> R2; second -> right -> D2;
        right -> third -> R3; third -> coil;
        observe { left: V = left.effort; right: V = right.effort; source: V = source.effort; current: A = third.flow }
        scene Watched { observe { current: A = third.flow } tune {} }
    }
    /// e + 2 g e^2 = u, which has no solution for u below -1 / (8 g).
    graph Square {
        param g: m/N^2/s = 1; param fall: N/s = 1; param unit: N = 1;
        MSe source = unit - fall * t; 1 line: translation; R damper = 2; R square(effort e) = g * e * e;
        source -> line -> damper; line -> square;
        MSe push = 3 * square.effort; 1 slide: translation; I mass = 2; push -> slide -> mass;
        observe { effort: N = square.effort; v: m/s = slide.flow }
    }
    /// A mass that is pushed harder once the unknown is above a threshold.
    graph Threshold {
        param rise: N/s = 1; param g: m/N^2/s = 1;
        MSe source = rise * t; 1 line: translation; R damper = 2; R square(effort e) = g * e * abs(e);
        source -> line -> damper; line -> square;
        MSe push = if square.effort < 0.5 { 1 } else { 5 }; 1 slide: translation; I mass = 2; push -> slide -> mass;
        observe { effort: N = square.effort; v: m/s = slide.flow }
    }
}

fn ladder(method: Integrator) -> Trajectory {
    let model = Ladder::new(LadderParameters::default()).unwrap();
    Simulation::new(&model).method(method).rtol(1e-9).every(0.1).until(3.0).run().unwrap()
}

#[test]
fn every_integrator_finds_the_same_and_kirchhoff_agrees() {
    let truth = ladder(Integrator::Dop853);
    let diode = |size: f64, voltage: f64| size * ((voltage / 0.5).exp() - 1.0);
    let columns = ["source", "left", "right", "current"].map(|name| &truth[name]);
    for (((source, left), right), current) in columns[0].iter().zip(columns[1]).zip(columns[2]).zip(columns[3]) {
        let through = (left - right) / 3.0;
        let at_left = (source - left) / 5.0 - diode(0.01, *left) - through;
        let at_right = through - diode(0.02, *right) - current;
        assert!(at_left.abs() < 1e-13 && at_right.abs() < 1e-13, "{at_left:e} {at_right:e}");
    }
    for method in [Integrator::Auto, Integrator::Bs5, Integrator::Taylor, Integrator::Rodas5p, Integrator::Radau9] {
        let run = ladder(method);
        let apart = run["current"].iter().zip(&truth["current"]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-7, "{method:?}: {apart:e}");
    }
}

#[test]
fn a_scene_has_the_loop_of_its_graph() {
    let scene = Watched::new(WatchedParameters::default()).unwrap();
    let run = Simulation::new(&scene).method(Integrator::Dop853).rtol(1e-9).every(0.1).until(3.0).run().unwrap();
    let apart = run["current"]
        .iter()
        .zip(&ladder(Integrator::Dop853)["current"])
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    assert!(apart < 1e-9, "{apart:e}");
}

#[test]
fn more_digits_are_there_where_they_are_asked_for() {
    let model = Square::<DoubleDouble>::in_scalar(SquareParameters::default()).unwrap();
    let x = SVector::from_element(DoubleDouble::from_f64(0.0));
    let mut y = SVector::from_element(DoubleDouble::from_f64(0.0));
    let t = DoubleDouble::from_f64(0.25);
    model.outputs(t, &x, &[], &mut y);
    let (e, two) = (y[0], DoubleDouble::from_f64(2.0));
    let left = e + two * e * e - (DoubleDouble::from_f64(1.0) - t);
    assert!(left.to_f64().abs() < 1e-30, "{:e}", left.to_f64());
}

#[test]
fn a_loop_without_a_solution_ends_the_run_with_its_name() {
    let model = Square::new(SquareParameters::default()).unwrap();
    let failure =
        Simulation::new(&model).every(0.1).until(3.0).run().expect_err("no solution from 1.125 s on").to_string();
    assert!(failure.starts_with("algebraic loop `square, damper` gives NaN"), "{failure}");
    assert!(failure.contains("Newton's iteration finds no solution"), "{failure}");
    let until = Simulation::new(&model).every(0.1).until(1.1).run().unwrap();
    let (found, expected) = (until["effort"].last().unwrap(), (f64::sqrt(1.0 - 8.0 * 0.1) - 1.0) / 4.0);
    assert!((found - expected).abs() < 1e-12, "{found}");
}

#[test]
fn an_event_is_where_the_unknown_crosses() {
    // e + 2 e^2 = t is 0.5 at t = 1; v = (1 * 1 + 5 * 1) / 2 at t = 2.
    let model = Threshold::new(ThresholdParameters::default()).unwrap();
    let run = Simulation::new(&model).rtol(1e-10).every(0.5).until(2.0).run().unwrap();
    let v = run["v"].last().unwrap();
    assert!((v - 3.0).abs() < 1e-12, "{v}");
    assert_eq!(run.statistics.events, 1);
}
