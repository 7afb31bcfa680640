//! Tables as laws, beside the formulas that they are points of: errors of the order of their lines, energies, ends.

use bg_model::dynamics::Machine;
use bg_model::integrator::{AnyMethod, Dop853, Radau5, Taylor, Tolerances};
use bg_model::simulation::{Settings, Span, drive};

use super::text::{graphs, model, outputs};

/// A mass on a spring whose force is the law, from 15 mm.
fn spring(declared: &str, law: &str) -> String {
    format!(
        "graph Spring {{
            {declared}
            1 slide: translation; I block = 0.5; C coil(q) = {law} start 15 mm;
            slide -> block; slide -> coil;
            observe {{ place: m = coil.q; total: J = stored_energy }}
        }}"
    )
}

/// Place and energy after `t_end`.
fn after(text: &str, method: AnyMethod, t_end: f64) -> [f64; 2] {
    let model = model(&graphs(text), "Spring", &[]);
    let start = model.start().expect("a start");
    let settings = Settings { tolerances: Tolerances::new(1e-12, 1e-14), ..Settings::default() };
    let mut method = method;
    let finish = drive(&*model, &mut method, &start, Span { t0: 0.0, t_end }, &settings, None, &mut ())
        .unwrap_or_else(|failure| panic!("{failure}"));
    let found = outputs(&*model, finish.t, finish.x.as_slice(), &finish.negative);
    [found[0], found[1]]
}

/// Points of 2 kN/m * q * (1 + (q / 10 mm)^2) from -20 to 20 mm.
fn hardening(parts: i32) -> String {
    let points = (-parts..=parts).map(|k| {
        let q = 20.0 * f64::from(k) / f64::from(parts);
        format!("[{q:?}, {:?}]", 2.0 * q * (1.0 + 0.01 * q * q))
    });
    format!("table force: mm -> N = [{}]", points.collect::<Vec<_>>().join(", "))
}

#[test]
fn a_hardening_spring_errs_as_its_lines_do() {
    let formula = "2 kN/m * q * (1 + pow(q / (10 mm), 2))";
    let [place, _] = after(&spring("", formula), Dop853::new().into(), 0.7);
    // A spline of a cubic is that cubic.
    let [of_spline, _] = after(&spring(&(hardening(5) + ", spline;"), "force(q)"), Dop853::new().into(), 0.7);
    assert!((of_spline - place).abs() < 1e-11, "{of_spline} {place}");
    let error = |words: &str, parts: i32| {
        let table = format!("{}{words};", hardening(parts));
        (after(&spring(&table, "force(q)"), Dop853::new().into(), 0.7)[0] - place).abs()
    };
    for (words, order) in [("", 2.0), (", monotone", 3.0)] {
        let found = (error(words, 20) / error(words, 80)).log2() / 2.0;
        assert!(found > order - 0.3, "order {found}{words}");
    }
}

#[test]
fn all_methods_go_through_knots_and_keep_the_energy() {
    for words in ["", ", monotone", ", spline"] {
        let text = spring(&format!("{}{words};", hardening(4)), "force(q) + 0.2 kN/m * q");
        let [place, energy] = after(&text, Dop853::new().into(), 0.3);
        let at_start = after(&text, Dop853::new().into(), 1e-9)[1];
        for method in [Dop853::new().into(), Taylor::new().into(), Radau5::new().into()] {
            let [other, kept] = after(&text, method, 0.3);
            assert!((other - place).abs() < 1e-10, "{other} {place}{words}");
            assert!(
                (kept - at_start).abs() < 1e-10 * at_start && (energy - at_start).abs() < 1e-10 * at_start,
                "{words}"
            );
        }
    }
}

#[test]
fn straight_lines_are_what_comparisons_say() {
    let table = "table force: mm -> N = [[-10, -30], [0, 0], [5, 40], [20, 50]], continued;";
    let compared =
        "if q < 0 { 3 kN/m * q } else if q < 5 mm { 8 kN/m * q } else { 40 N + (10 N) / (15 mm) * (q - 5 mm) }";
    let energy = "if q < 0 { 1.5 kN/m * q * q } else if q < 5 mm { 4 kN/m * q * q }
        else { 0.1 J + 40 N * (q - 5 mm) + (5 N) / (15 mm) * pow(q - 5 mm, 2) }";
    let of_table = after(&spring(table, "force(q)"), Dop853::new().into(), 0.9);
    let of_comparisons = after(&spring("", &format!("{compared} energy {energy}")), Dop853::new().into(), 0.9);
    assert!((of_table[0] - of_comparisons[0]).abs() < 1e-11 && (of_table[1] - of_comparisons[1]).abs() < 1e-12);
}

#[test]
fn a_motor_settles_where_its_curve_meets_the_load() {
    let text = "graph Drive {
        table motor: rpm -> N*m = [[0, 12], [1000, 18], [1500, 0]], held;
        1 shaft: rotation; I rotor = 0.02; MSe drive = motor(shaft.flow); R fan = 0.1;
        drive -> shaft -> rotor; shaft -> fan;
        observe { speed: rpm = shaft.flow }
    }";
    let drive_model = model(&graphs(text), "Drive", &[]);
    let start = drive_model.start().expect("a start");
    let finish = super::hand::run(&*drive_model, &start, 20.0);
    let speed = outputs(&*drive_model, finish.t, finish.x.as_slice(), &finish.negative)[0];
    // 18 - 18 (n - 1000) / 500 = 0.1 n pi / 30.
    let expected = 54.0 / (0.036 + std::f64::consts::PI / 300.0);
    assert!((speed - expected).abs() < 1e-6, "{speed} {expected}");
}

#[test]
fn a_run_that_leaves_a_table_ends_with_its_name() {
    let text = spring("table force: mm -> N = [[-5, -20], [20, 80]];", "force(q)");
    let model = model(&graphs(&text), "Spring", &[]);
    let start = model.start().expect("a start");
    let settings = Settings::default();
    let span = Span { t0: 0.0, t_end: 1.0 };
    let failure = drive(&*model, &mut Dop853::new(), &start, span, &settings, None, &mut ()).expect_err("an end");
    let told = failure.to_string();
    assert!(told.contains("table `force` gives NaN") && told.contains("`held` or `continued`"), "{told}");
}

#[test]
fn each_use_of_a_part_has_its_table() {
    let text = "part Coil { table force: mm -> N = [[-20, -60], [20, 60]]; 1 slide: translation; C coil(q) = force(q); slide -> coil;
            port end = slide; }
        graph Pair {
            part left: Coil {} part right: Coil {}
            1 slide: translation; I block = 6 start 0.1; slide -> left.end; slide -> right.end; slide -> block;
            observe { place: mm = left.coil.q }
        }";
    let pair = model(&graphs(text), "Pair", &[]);
    let start = pair.start().expect("a start");
    let finish = super::hand::run(&*pair, &start, 0.5);
    let place = outputs(&*pair, finish.t, finish.x.as_slice(), &finish.negative)[0];
    let frequency = (2.0 * 3000.0_f64 / 6.0).sqrt();
    let expected = 1e3 * 0.1 / 6.0 / frequency * (frequency * 0.5).sin();
    assert!((place - expected).abs() < 1e-8, "{place} {expected}");
}
