//! Sampled controllers beside their exact discrete solutions: the plant between two instants by the matrix exponential,
//! the controller by its difference equations.

use std::f64::consts::PI;

use bg_model::dynamics::Machine;
use bg_model::integrator::{AnyMethod, Dop853, Radau5, Taylor, Tolerances};
use bg_model::nalgebra::{Matrix3, Vector3};
use bg_model::simulation::{EachSample, Ongoing, Samples, Settings, Span, drive};

use super::text::{graphs, model, outputs};

/// The outputs at these instants.
fn at(text: &str, values: &[(&str, f64)], method: AnyMethod, instants: &[f64]) -> Vec<Vec<f64>> {
    let model = model(&graphs(text), "Sampled", values);
    let start = model.start().expect("a start");
    let (mut method, mut found) = (method, Vec::new());
    let tolerances = Tolerances::new(1e-12, 1e-13);
    let settings = Settings { tolerances, samples: Samples::At(instants.to_vec()), ..Settings::default() };
    let span = Span { t0: 0.0, t_end: instants[instants.len() - 1] };
    let mut told = EachSample(|t: f64, x: &[f64], negative: &[bool]| found.push(outputs(&*model, t, x, negative)));
    drive(&*model, &mut method, &start, span, &settings, None, &mut told).unwrap_or_else(|failure| panic!("{failure}"));
    found
}

/// A wheel with friction, whose speed a PI controller of a computer is to keep.
const WHEEL: &str = "graph Sampled {
    param period: ms = 20, above 0; param wanted: rad/s = 10; param gain: N*m*s/rad = 3; param integral: N*m/rad = 9;
    param limit: N*m = 1000, above 0;
    every period {
        sample error: rad/s = wanted - shaft.flow;
        sample sum: rad = if abs(wish) < limit { sum.last + period * error } else { sum.last };
        sample wish: N*m = gain * error + integral * sum.last;
        sample command: N*m = if wish > limit { limit } else if wish < -limit { -limit } else { wish };
    }
    MSe motor = command; 1 shaft: rotation; I wheel = 0.5; R rub = 0.4; motor -> shaft -> wheel; shaft -> rub;
    observe { speed: rad/s = shaft.flow; torque: N*m = command; sum: rad = sum }
}";

/// Speed, torque and sum after the instants 0, 1, 2.. of the wheel.
fn wheel(period: f64, limit: f64, instants: usize) -> Vec<[f64; 3]> {
    let (inertia, rub) = (0.5, 0.4);
    let stays = (-rub * period / inertia).exp();
    let (mut speed, mut sum, mut found) = (0.0, 0.0, Vec::new());
    for _ in 0..instants {
        let error = 10.0 - speed;
        let wish: f64 = 3.0 * error + 9.0 * sum;
        let torque = wish.clamp(-limit, limit);
        if wish.abs() < limit {
            sum += period * error;
        }
        found.push([speed, torque, sum]);
        speed = stays * speed + (1.0 - stays) / rub * torque;
    }
    found
}

fn compare(found: &[Vec<f64>], expected: &[[f64; 3]], most: f64) {
    assert_eq!(found.len(), expected.len());
    for (k, (found, expected)) in found.iter().zip(expected).enumerate() {
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < most, "instant {k}: {found} {expected}");
        }
    }
}

#[test]
fn a_sampled_pi_controller_has_its_exact_discrete_solution() {
    let instants: Vec<f64> = (0..150).map(|k| f64::from(k) * 0.02).collect();
    let expected = wheel(0.02, 1000.0, 150);
    let methods: [AnyMethod; 3] = [Dop853::new().into(), Radau5::new().into(), Taylor::new().into()];
    for method in methods {
        compare(&at(WHEEL, &[], method, &instants), &expected, 1e-10);
    }
}

/// What is computed at an instant takes the branches of that instant, not those of the one before.
#[test]
fn a_limit_and_its_anti_windup_hold_from_the_first_instant_on() {
    let instants: Vec<f64> = (0..200).map(|k| f64::from(k) * 0.02).collect();
    let expected = wheel(0.02, 12.0, 200);
    assert!(expected[0][1] == 12.0 && expected[30][1] < 12.0);
    compare(&at(WHEEL, &[("limit", 12.0)], Dop853::new().into(), &instants), &expected, 1e-10);
}

/// 700 instants of 1 / 700 s: their sum would have missed the last ones.
#[test]
fn instants_do_not_add_up() {
    let period = 1.0 / 700.0;
    let expected = wheel(period, 1000.0, 701);
    let found = at(WHEEL, &[("period", 1000.0 * period)], Dop853::new().into(), &[1.0]);
    compare(&found, &expected[700..], 1e-10);
}

/// Between two instants the torque is held: just before one it is still that of the one before.
#[test]
fn values_are_held_between_instants() {
    let expected = wheel(0.02, 1000.0, 3);
    let found = at(WHEEL, &[], Dop853::new().into(), &[0.0, 0.0199, 0.02, 0.0201, 0.0399]);
    let torques: Vec<f64> = found.iter().map(|outputs| outputs[1]).collect();
    let [first, second] = [expected[0][1], expected[1][1]];
    assert_eq!((torques[0], torques[1]), (first, first));
    assert!(torques[2..].iter().all(|torque| *torque == torques[2] && (torque - second).abs() < 1e-10));
}

/// A cascade of an angle's loop every 10 ms and a speed's every 2 ms, which begins half a millisecond later.
#[test]
fn a_cascade_of_two_rates_has_its_exact_discrete_solution() {
    let text = "graph Sampled {
        every 10 ms { sample speed: rad/s = 8 * (1 - turned) / (1 s); }
        every 2 ms offset 0.5 ms {
            sample sum: rad = sum.last + 2 ms * (speed - shaft.flow);
            sample torque: N*m = 5 * (speed - shaft.flow) + 20 * sum;
        }
        let turned: rad = shaft.displacement;
        MSe motor = torque; 1 shaft: rotation; I wheel = 0.1; R rub = 0.3; motor -> shaft -> wheel; shaft -> rub;
        observe { speed: rad/s = shaft.flow; turned: rad = turned; torque: N*m = torque }
    }";
    // Speed, angle and torque, which is held: over h by the exponential.
    let plant = Matrix3::new(-3.0, 0.0, 10.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    let over = |h: f64| (plant * h).exp();
    let (half, rest) = (over(0.5e-3), over(1.5e-3));
    let mut x = Vector3::zeros();
    let (mut wanted, mut sum, mut expected) = (0.0, 0.0, Vec::new());
    for k in 0..400 {
        if k % 5 == 0 {
            wanted = 8.0 * (1.0 - x[1]);
        }
        expected.push([x[0], x[1], x[2]]);
        x = half * x;
        sum += 2e-3 * (wanted - x[0]);
        x[2] = 5.0 * (wanted - x[0]) + 20.0 * sum;
        x = rest * x;
    }
    let instants: Vec<f64> = (0..400).map(|k| f64::from(k) * 2e-3).collect();
    compare(&at(text, &[], Dop853::new().into(), &instants), &expected, 1e-10);
}

/// Where a slow clock has an instant with a fast one, each sees what the other computes there, whatever comes first.
#[test]
fn clocks_of_one_instant_compute_together() {
    let blocks = ["every 0.1 s { sample fast: 1 = fast.last + 1; }", "every 0.3 s { sample slow: 1 = fast; }"];
    for [first, second] in [[0, 1], [1, 0]].map(|order| order.map(|k| blocks[k])) {
        let text = format!(
            "graph Sampled {{ {first} {second} 1 j: translation; I m = 1; Se f = 1; f -> j -> m;
            observe {{ fast: 1 = fast; slow: 1 = slow }} }}"
        );
        let found = at(&text, &[], Dop853::new().into(), &[0.0, 0.25, 0.3, 0.65, 0.95]);
        assert_eq!(found, [[1.0, 1.0], [3.0, 1.0], [4.0, 4.0], [7.0, 7.0], [10.0, 10.0]]);
    }
}

/// Flows are those just before the instant, with what was held until then; a name of an expression is that expression,
/// in a block as elsewhere.
#[test]
fn signals_are_those_before_the_instant_and_names_are_what_they_name() {
    let text = "graph Sampled {
        let doubled = 2 * count;
        let force: N = 1 N * doubled;
        every 1 s { sample seen: 1 = doubled; sample count: 1 = count.last + 1 start 5; \
        sample effort: N = push.effort; }
        1 j: translation; I m = 1; MSe push = force; push -> j -> m;
        observe { count: 1 = count; seen: 1 = seen; doubled; effort: N = effort }
    }";
    let found = at(text, &[], Dop853::new().into(), &[0.0, 0.5, 1.0]);
    assert_eq!(found, [[6.0, 12.0, 12.0, 10.0], [6.0, 12.0, 12.0, 10.0], [7.0, 14.0, 14.0, 12.0]]);
}

/// A relay that a computer switches moves a mass: a law's branch changes with what is held.
#[test]
fn a_branch_that_depends_on_a_sample_changes_at_the_instant() {
    let text = "graph Sampled {
        every 0.25 s { sample side: 1 = if j.displacement < 1 m { 1 } else { -1 }; }
        MSe push = if side > 0 { 2 } else { -4 };
        1 j: translation; I m = 1; push -> j -> m; observe { x: m = j.displacement; v: m/s = j.flow; side: 1 = side }
    }";
    let found = at(text, &[], Dop853::new().into(), &[1.0, 1.25, 2.0]);
    // x = t^2 until the first instant at which it is 1 m, t = 1 s.
    assert!((found[0][0] - 1.0).abs() < 1e-12);
    let side = found[0][2];
    let (v, x) = (2.0 + 0.25 * if side > 0.0 { 2.0 } else { -4.0 }, found[1][0]);
    assert!((found[1][1] - v).abs() < 1e-12 && x > 1.0, "{found:?}");
    assert_eq!(found[1][2], -1.0);
}

/// The oldest sampled loop there is: what is measured comes late. y(n) = y(n - 1) + (1 - y(n - 4)) / 10.
#[test]
fn a_delay_hands_a_signal_on() {
    let text = "graph Sampled {
        every 5 ms {
            sample y: m = y.last + 0.1 * (1 m - delay(y, 20 ms));
            sample speed: m/s = delay(j.flow, 15 ms, -3 m/s);
        }
        1 j: translation; I m = 1; Se f = 2; f -> j -> m; observe { y: m = y; speed: m/s = speed }
    }";
    let instants: Vec<f64> = (0..60).map(|k| f64::from(k) * 5e-3).collect();
    let found = at(text, &[], Dop853::new().into(), &instants);
    let mut y: Vec<f64> = Vec::new();
    for (n, found) in found.iter().enumerate() {
        let ago = |instants: usize| n.checked_sub(instants).map(|k| y[k]);
        y.push(ago(1).unwrap_or(0.0) + 0.1 * (1.0 - ago(4).unwrap_or(0.0)));
        let speed = if n < 3 { -3.0 } else { 2.0 * 5e-3 * (n - 3) as f64 };
        assert!((found[0] - y[n]).abs() < 1e-14 && (found[1] - speed).abs() < 1e-12, "{n}: {found:?} {}", y[n]);
    }
    let model = model(&graphs(text), "Sampled", &[]);
    let units: Vec<&str> = Machine::description(&*model).states.iter().map(|state| state.unit).collect();
    assert_eq!(units.iter().filter(|unit| **unit == "m").count(), 5);
    assert_eq!(units.iter().filter(|unit| **unit == "m/s").count(), 4);
}

/// A run made in pieces, one of which ends at an instant, computes each once.
#[test]
fn pieces_lead_where_one_run_does() {
    let model = model(&graphs(WHEEL), "Sampled", &[]);
    let mut run = Ongoing::at(0.0, &model.start().expect("a start"));
    let mut method = Dop853::new();
    let settings = Settings { tolerances: Tolerances::new(1e-12, 1e-13), ..Settings::default() };
    for k in 1..=40 {
        run.drive(&*model, &mut method, f64::from(k) * 0.01, &settings, &mut ()).expect("a piece");
    }
    let found = outputs(&*model, run.time(), run.state(), run.negative());
    compare(&[found], &wheel(0.02, 1000.0, 21)[20..], 1e-10);
}

/// What ends a run may be what is held: it does so at the instant.
#[test]
fn a_condition_of_a_sample_ends_the_run_at_the_instant() {
    let model = model(&graphs(WHEEL), "Sampled", &[]);
    let start = model.start().expect("a start");
    let settings = Settings { tolerances: Tolerances::new(1e-12, 1e-13), ..Settings::default() };
    let torque = |model: &dyn Machine, t: f64, x: &[f64], negative: &[bool]| outputs(model, t, x, negative)[1];
    let mut below = |t: f64, x: &[f64], negative: &[bool]| torque(&*model, t, x, negative) - 25.0;
    let span = Span { t0: 0.0, t_end: 3.0 };
    let finish = drive(&*model, &mut Dop853::new(), &start, span, &settings, Some(&mut below), &mut ());
    let finish = finish.expect("a run");
    let first = wheel(0.02, 1000.0, 150).iter().position(|[_, torque, _]| *torque < 25.0).expect("it falls");
    assert_eq!(finish.t, first as f64 * 0.02);
}

#[test]
fn reference_solutions_know_clocks() {
    use bg_model::extended::{Accuracy, integrate};
    let model = model(&graphs(WHEEL), "Sampled", &[("limit", 12.0)]);
    let (start, instants) = (model.start().expect("a start"), [0.5, 1.0]);
    let (span, accuracy) = (Span { t0: 0.0, t_end: 1.0 }, Accuracy { columns: 8, tolerance: 1e-14 });
    let mut found = Vec::new();
    integrate(&*model, &start, span, accuracy, &instants, &mut |t, x, negative| {
        found.push(outputs(&*model, t, x, negative));
    })
    .expect("a reference");
    let expected = wheel(0.02, 12.0, 51);
    compare(&found, &[expected[25], expected[50]], 1e-11);
}

/// What a time is that cannot be is said where the model is made.
#[test]
fn a_period_that_is_nothing_is_refused() {
    let graphs = graphs(
        "graph Sampled { param period: s = 1; every period { sample x: 1 = x.last + PI; } param PI: 1 = 3;
        1 j: translation; I m = 1; Se f = 1; f -> j -> m; observe { x: 1 = x } }",
    );
    let model = &graphs[0].models[0];
    let blueprint = model.blueprint.as_ref().expect("all models were asked for");
    let refused = bg_loaded::Interpreted::<f64>::new(blueprint, &[0.0, PI], &[]).expect_err("no time");
    assert!(refused.to_string().contains("after `every`"), "{refused}");
    assert_eq!(Machine::description(&*super::text::model(&graphs, "Sampled", &[])).switches.len(), 1);
}
