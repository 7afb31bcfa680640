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
    let graphs = graphs(text);
    let model = model(&graphs, &graphs[0].name, &[]);
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
    let text =
        "part Coil { table force: mm -> N = [[-20, -60], [20, 60]]; 1 slide: translation; C coil(q) = force(q); \
        slide -> coil;
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

/// A rotor that a torque of its angle turns, with what is known of it.
fn rotor(table: &str, start: &str) -> String {
    format!(
        "graph Rotor {{
            {table}
            1 shaft: rotation; I wheel = 0.2 start 0.2 * {start}; C magnet(q) = torque(q) start 0.3; shaft -> wheel; \
            shaft -> magnet;
            observe {{ angle: rad = magnet.q; total: J = stored_energy; slope: N*m/rad = torque.derivative(magnet.q) }}
        }}"
    )
}

#[test]
fn a_periodic_table_goes_on_in_every_turn_both_ways() {
    // A cosine of three poles per turn, with an offset: the energy has a part that grows from turn to turn.
    let of = |angle: f64| 0.4 * (3.0 * angle).cos() + 0.05;
    let points = |count: u32| -> String {
        let angle = |k: u32| 30.0 + 360.0 * f64::from(k) / f64::from(count);
        let point = |k: u32| format!("[{}, {:?}]", angle(k), of(angle(k % count).to_radians()));
        (0..=count).map(point).collect::<Vec<_>>().join(", ")
    };
    let formula = |start: &str| {
        rotor("", start)
            .replace("torque(q)", "0.4 * cos(3 * q) + 0.05")
            .replace("torque.derivative(magnet.q)", "-1.2 * sin(3 * magnet.q)")
    };
    for start in ["9", "-9"] {
        let by_formula = after(&formula(start), Dop853::new().into(), 3.0);
        assert!(by_formula[0].abs() > 3.0 * std::f64::consts::TAU, "{by_formula:?}");
        let error = |count: u32| {
            let table = format!("table torque: deg -> N*m = [{}], spline, periodic;", points(count));
            let start_energy = after(&rotor(&table, start), Dop853::new().into(), 1e-12)[1];
            let found = after(&rotor(&table, start), Dop853::new().into(), 3.0);
            assert!((found[1] - start_energy).abs() < 1e-11 * start_energy, "{found:?} {start_energy}");
            for method in [AnyMethod::from(Taylor::new()), Radau5::new().into()] {
                let other = after(&rotor(&table, start), method, 3.0);
                assert!((other[0] - found[0]).abs() < 1e-8, "{other:?} {found:?}");
            }
            (found[0] - by_formula[0]).abs()
        };
        let order = (error(36) / error(72)).log2();
        assert!(order > 3.5, "order {order}");
    }
}

#[test]
fn straight_lines_of_a_periodic_table_are_a_saw_in_all_turns() {
    let table = "table torque: deg -> N*m = [[-40, 0.3], [80, -0.3], [320, 0.3]], periodic;";
    // The integral of the torque from zero, turn by turn: 0 over each.
    let energy = |angle: f64| {
        let [low, high, span] = [-40.0_f64, 80.0, 360.0].map(f64::to_radians);
        let within = |x: f64| {
            let fall = |x: f64| 0.3 * (x - low) - 0.3 * (x - low).powi(2) / (high - low);
            let rise = |x: f64| -0.3 * (x - high) + 0.3 * (x - high).powi(2) / (low + span - high);
            if x < high { fall(x) } else { fall(high) + rise(x) }
        };
        let turned = |x: f64| within(low + (x - low).rem_euclid(span));
        turned(angle) - turned(0.0)
    };
    for start in [4.0_f64, -4.0] {
        let text = rotor(table, &start.to_string()).replace("stored_energy", "wheel.energy");
        for t_end in [1.3, 5.0, 11.0] {
            let [angle, kinetic] = after(&text, Dop853::new().into(), t_end);
            let expected = 0.1 * start * start - energy(angle) + energy(0.3);
            assert!((kinetic - expected).abs() < 1e-11, "{angle} rad: {kinetic} J, not {expected} J");
        }
    }
}

#[test]
fn derivatives_of_tables_are_those_of_their_polynomials() {
    // A spline through points of a cubic is that cubic.
    let text = "graph Cubic {
        table cubic: mm -> N = [[-2, -8], [-1, -1], [0, 0], [1, 1], [3, 27]], spline;
        1 slide: translation; I block = 1 start 1e-3; slide -> block; C spring(q) = cubic.derivative(q) * 1 mm start \
        0.5 mm; slide -> spring;
        observe { place: mm = spring.q; first: N/mm = cubic.derivative(spring.q); \
        second: N/mm/mm = cubic.second_derivative(spring.q);
            energy: N*mm = spring.energy }
    }";
    let cubic = model(&graphs(text), "Cubic", &[]);
    let start = cubic.start().expect("a start");
    for t_end in [0.01, 0.05, 0.09] {
        let finish = super::hand::run(&*cubic, &start, t_end);
        let found = outputs(&*cubic, finish.t, finish.x.as_slice(), &finish.negative);
        let [place, first, second, energy] = found[..] else { panic!("four outputs") };
        assert!((first - 3.0 * place * place).abs() < 1e-12 && (second - 6.0 * place).abs() < 1e-12, "{found:?}");
        assert!((energy - place.powi(3)).abs() < 1e-12, "{found:?}");
    }
}

/// The same written without a part, and the work of the force: what lifts has the energy of the lift.
#[test]
fn a_part_takes_the_derivative_of_its_own_table() {
    let table = "table lift: rad -> mm = [[0, 0], [1, 2], [2, 3], [3, 0]], spline, periodic;";
    let law = "1 N * lift.derivative(turn)";
    let text = format!(
        "part Coil {{ {table} 1 shaft: rotation;
            MSe push = {law}; state turn: rad = shaft.flow start 0.5; push -> shaft; port end = shaft; }}
        graph Use {{ part left: Coil {{}} 1 shaft: rotation; I wheel = 0.1; left.end -> shaft; shaft -> wheel;
            observe {{ energy: J = wheel.energy; angle: rad = left.turn }} }}
        graph Plain {{ {table} 1 shaft: rotation; I wheel = 0.1; MSe push = {law}; \
        state turn: rad = shaft.flow start 0.5;
            push -> shaft -> wheel;
            observe {{ energy: J = wheel.energy; angle: rad = turn; gained: J = 1 N * (lift(turn) - lift(0.5)) }} }}"
    );
    let graphs = graphs(&text);
    let [of_part, plain] = ["Use", "Plain"].map(|name| {
        let used = model(&graphs, name, &[]);
        let finish = super::hand::run(&*used, &used.start().expect("a start"), 9.0);
        outputs(&*used, finish.t, finish.x.as_slice(), &finish.negative)
    });
    assert!((of_part[0] - plain[0]).abs() < 1e-14 && (of_part[1] - plain[1]).abs() < 1e-12, "{of_part:?} {plain:?}");
    // 1.2 mJ and 0.6 rad at least: far from what a derivative of nothing gives.
    assert!((plain[0] - plain[2]).abs() < 1e-11 && plain[0] > 1e-4 && plain[1] > 0.8, "{plain:?}");
}

#[test]
fn a_map_of_speed_and_voltage_drives_as_its_formula() {
    // A torque that is linear in each: straight lines are exact, and so is a spline.
    let torque = |rpm: f64, volt: f64| 0.02 * volt - 4e-4 * rpm + 1e-5 * rpm * volt;
    let row = |rpm: f64| format!("[{rpm:?}, {:?}, {:?}, {:?}]", torque(rpm, 0.0), torque(rpm, 10.0), torque(rpm, 24.0));
    let rows: Vec<String> = [0.0, 200.0, 700.0, 900.0, 2000.0].map(row).into();
    let text = |declared: &str, law: &str| {
        format!(
            "graph Motor {{
                {declared}
                let volt: V = 12 V + 6 V * sin(3 * t / (1 s));
                1 shaft: rotation; I rotor = 2e-3; MSe motor = {law}; R fan = 1e-3; motor -> shaft -> rotor; \
                shaft -> fan;
                observe {{ speed: rpm = shaft.flow; total: J = stored_energy }}
            }}"
        )
    };
    let by_formula =
        "0.02 N*m/V * volt - (4e-4 N*m) / (1 rpm) * shaft.flow + (1e-5 N*m/V) / (1 rpm) * shaft.flow * volt";
    let expected = after(&text("", by_formula), Dop853::new().into(), 2.0);
    for words in ["", ", spline", ", continued"] {
        let table = format!("table map: rpm, V -> N*m = [[0, 10, 24], {}]{words};", rows.join(", "));
        for method in [AnyMethod::from(Dop853::new()), Taylor::new().into(), Radau5::new().into()] {
            let found = after(&text(&table, "map(shaft.flow, volt)"), method, 2.0);
            assert!((found[0] - expected[0]).abs() < 1e-7, "{words}: {found:?} {expected:?}");
        }
    }
}
