//! Delays of signals at any time beside closed forms: polynomials by the method of steps, functions of time shifted.

use bg_model::dynamics::Machine;
use bg_model::integrator::{AnyMethod, Dop853, Integrator, Radau5, Taylor, Tolerances};
use bg_model::run::{Request, Simulation};
use bg_model::sensitivity::{Direction, sensitivities};
use bg_model::simulation::{EachSample, Ongoing, Samples, Settings, Span, drive};

use super::text::{graphs, model, outputs, said};

/// The outputs at these instants, and the steps.
fn at(text: &str, mut method: AnyMethod, instants: &[f64]) -> (Vec<Vec<f64>>, u64) {
    let model = model(&graphs(text), "Late", &[]);
    let start = model.start().expect("a start");
    let mut found = Vec::new();
    let tolerances = Tolerances::new(1e-12, 1e-13);
    let settings = Settings { tolerances, samples: Samples::At(instants.to_vec()), ..Settings::default() };
    let span = Span { t0: 0.0, t_end: instants[instants.len() - 1] };
    let mut told = EachSample(|t: f64, x: &[f64], negative: &[bool]| found.push(outputs(&*model, t, x, negative)));
    let finish = drive(&*model, &mut method, &start, span, &settings, None, &mut told);
    let finish = finish.unwrap_or_else(|failure| panic!("{failure}"));
    (found, finish.statistics.steps)
}

/// x' = -x(t - 1) with x = 1 up to the start: the sum of (-1)^k (t - k + 1)^k / k! up to k = floor(t) + 1.
fn steps(t: f64) -> f64 {
    let (mut sum, mut factorial, mut k) = (0.0, 1.0, 0);
    while f64::from(k) <= t + 1.0 {
        sum += (f64::from(k) - 1.0 - t).powi(k) / factorial;
        k += 1;
        factorial *= f64::from(k);
    }
    sum
}

#[test]
fn the_method_of_steps() {
    let text = "graph Late {
        state x: m = -delay(x, 1 s) / 1 s start 1;
        1 j: translation; I m = 1; MSe f = x * 1 N/m; f -> j -> m; observe { x: m = x; v: m/s = j.flow }
    }";
    let instants: Vec<f64> = (0..=100).map(|k| f64::from(k) * 0.1).collect();
    let methods = [Dop853::new().into(), Radau5::new().into(), Taylor::new().into(), Integrator::Auto.method(1.0)];
    for method in methods {
        let (found, taken) = at(text, method, &instants);
        for (t, found) in instants.iter().zip(&found) {
            assert!((found[0] - steps(*t)).abs() < 1e-9, "{t}: {} {}", found[0], steps(*t));
        }
        println!(
            "{taken} steps, {:e}",
            found.iter().zip(&instants).map(|(f, t)| (f[0] - steps(*t)).abs()).fold(0.0, f64::max)
        );
    }
}

/// What is given of a signal before the start, a jump that a delay hands on, a delay of a delay, two delays of one
/// signal.
#[test]
fn functions_of_time_are_shifted() {
    let text = "graph Late {
        let wave: 1 = sin(3 * t);
        let late: 1 = delay(wave, 300 ms);
        state y: m = delay(wave, 0.7 s, 0.25) * 1 m/s;
        1 j: translation; I m = 1; MSe f = y * 1 N/m; f -> j -> m;
        observe { y: m = y; twice: 1 = delay(late, 400 ms, 0); once: 1 = delay(wave, 700 ms, 0); v: m/s = j.flow }
    }";
    let instants: Vec<f64> = (1..=60).map(|k| f64::from(k) * 0.05 + 0.01).collect();
    let (found, _) = at(text, Dop853::new().into(), &instants);
    for (&t, found) in instants.iter().zip(&found) {
        let late = (t - 0.7).max(0.0);
        let y = 0.25 * t.min(0.7) + (1.0 - (3.0 * late).cos()) / 3.0;
        assert!((found[0] - y).abs() < 1e-10, "{t}: {found:?} {y}");
        for value in [found[1], found[2]] {
            assert!((value - (3.0 * late).sin()).abs() < 1e-10, "{t}: {found:?}");
        }
    }
}

/// A relay that sees late where the mass is: a triangle of period 4 s. Its corners come where the signal was zero the
/// delay before, so its guard depends on the past. A run in pieces takes its past along.
#[test]
fn a_relay_that_sees_late() {
    let text = "graph Late {
        state x: m = if delay(x, 1 s) > 0 { -1 m/s } else { 1 m/s } start 0.5;
        1 j: translation; I m = 1; MSe f = x * 1 N/m; f -> j -> m; observe { x: m = x; v: m/s = j.flow }
    }";
    let triangle = |t: f64| {
        let phase = (t + 0.5).rem_euclid(4.0);
        if phase < 2.0 { 1.0 - phase } else { phase - 3.0 }
    };
    let instants: Vec<f64> = (0..=110).map(|k| f64::from(k) * 0.1 + 0.05).collect();
    let (found, steps) = at(text, Dop853::new().into(), &instants);
    for (&t, found) in instants.iter().zip(&found) {
        assert!((found[0] - triangle(t)).abs() < 1e-10, "{t}: {found:?} {}", triangle(t));
    }
    assert!(steps < 200, "{steps}");
    let model = model(&graphs(text), "Late", &[]);
    let (mut run, mut method) = (Ongoing::at(0.0, &model.start().expect("a start")), Dop853::new());
    for k in 1..=70 {
        let t = f64::from(k) * 0.13;
        run.drive(&*model, &mut method, t, &Settings::default(), &mut ()).expect("a piece");
        let x = outputs(&*model, t, run.state(), run.negative())[0];
        assert!((x - triangle(t)).abs() < 1e-6, "{t}: {x} {}", triangle(t));
    }
}

/// A mistake, and what is said of it.
const MISTAKES: [(&str, &str); 7] = [
    ("delay(x)", "[BG0306] `delay` takes 2 arguments, not 1; write `delay(a, T)` or `delay(a, T, start)`"),
    ("delay(x, 0 s)", "[BG0701] the time of a `delay` is 0 s; it must be above 0; give a value above 0"),
    ("delay(x, 3 m)", "[BG0316] the time of a `delay` is in m, not in s; write a value in s"),
    (
        "delay(x, x / 1 m * 1 s)",
        "[BG0323] the time of a `delay` depends on the state `x`; use parameters and numbers only",
    ),
    ("delay(x, 1 s, 2 kg)", "[BG0316] the start of the delay is in kg, not in m; write a value in m"),
    (
        "delay(body.flow, 1 s)",
        "[BG0314] the signal of a delay must be a scalar; this is a vector; write a scalar, or take a component",
    ),
    ("later(x, 1 s)", "[BG0304] there is no function `later`"),
];

#[test]
fn beginners_are_told_what_to_do_about_delays() {
    for (wrong, expected) in MISTAKES {
        let text = format!(
            "graph Late {{
                state x: m = -{wrong} / 1 s start 1; 1 body[3]: translation; I mass = 1; body -> mass;
                1 j: translation; I m = 1; MSe f = x * 1 N/m; f -> j -> m; observe {{ x: m = x }}
            }}"
        );
        let found = said(&text);
        assert!(found.contains(expected), "{wrong}: {found}");
    }
}

/// Of a signal that a scene proves constant, of one that is seen twice, up to its sign, and of one that nothing sees.
#[test]
fn scenes_keep_what_is_delayed() {
    let text = "graph Late {
        param level: m = 2; state x: m = -delay(x, 1 s) / 1 s start 1;
        1 j: translation; I m = 1; MSe f = x * 1 N/m; f -> j -> m; observe { x: m = x; v: m/s = j.flow }
        scene Constant { observe { known: m = delay(level, 1 s, 2 m); x: m = x } tune {} }
        scene Twice { observe { once: m = delay(x, 0.5 s); twice: m = delay(x, 500 ms); minus: m = delay(-x, 0.5 s) } }
        1 k: translation; I n = 1; Se g = 1; g -> k -> n; scene Unseen { observe { w: m/s = k.flow } }
    }";
    let graphs = graphs(text);
    let of = |name: &str| {
        let model = model(&graphs, name, &[]);
        let run = Simulation::over(model.clone(), Request { t_end: 2.25, rtol: 1e-11, ..Request::default() }).run();
        (Machine::description(&*model).states.len(), run.expect("a run"))
    };
    let (_, run) = of("Constant");
    assert_eq!(run["known"].last(), Some(&2.0));
    assert!((run["x"].last().expect("a sample") - steps(2.25)).abs() < 1e-9);
    let (_, run) = of("Twice");
    for (name, sign) in [("once", 1.0), ("twice", 1.0), ("minus", -1.0)] {
        assert!((sign * run[name].last().expect("a sample") - steps(1.75)).abs() < 1e-9, "{name}");
    }
    assert_eq!(of("Unseen").0, 1);
}

/// What has no past says so.
#[test]
fn a_saved_state_and_derivatives_have_no_past() {
    let text = "graph Late {
        param late: s = 1, above 0; state x: m = -delay(x, late) / 1 s start 1;
        1 j: translation; I m = 1; MSe f = x * 1 N/m; f -> j -> m; observe { x: m = x }
    }";
    let model = model(&graphs(text), "Late", &[]);
    let request = Request { t_end: 0.5, ..Request::default() };
    let run = Simulation::over(model.clone(), request.clone()).run().expect("a run");
    let more = Simulation::over(model.clone(), Request { t_end: 1.5, ..request.clone() }).from(&run.last).run();
    let Err(fault) = more else { panic!("it has no past") };
    assert!(fault.to_string().starts_with("`Late` delays a signal, and this state does not have"), "{fault}");
    let late = [Direction::of(Machine::description(&*model), "late").expect("a parameter")];
    let fault = sensitivities(&*model, &request, &late).expect_err("no derivatives");
    assert!(fault.to_string().starts_with("`Late` delays a signal: what a run depends on"), "{fault}");
}
