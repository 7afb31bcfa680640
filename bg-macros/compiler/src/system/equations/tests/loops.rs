//! Algebraic loops and storages in derivative causality, by numbers, against what is found on paper.

use std::collections::BTreeMap;

use crate::expr::{Environment, Symbol, derivative, evaluate};
use crate::fault::Fault;
use crate::pipeline;
use crate::source::syntax;
use crate::system::equations::StateEquations;
use crate::system::equations::stage::Solved;
use crate::system::reduce;

fn derived(statements: &str) -> Result<StateEquations, Vec<Fault>> {
    let text = format!("graph G {{\n{statements}\n}}");
    let source = syntax::parse(text.parse().expect("tokens"))?;
    let Solved(mut equations) = reduce::literal(pipeline::derive(&source.graphs[0])?.equations);
    equations.close();
    Ok(equations)
}

fn equations(statements: &str) -> StateEquations {
    derived(statements).unwrap_or_else(|faults| panic!("{}\n{statements}", faults[0]))
}

fn faults(statements: &str) -> Vec<String> {
    let faults = derived(statements).err().unwrap_or_default();
    faults.iter().map(|fault| format!("{} {}", fault.code, fault.message)).collect()
}

/// Every rate and output by its name, where states and parameters have their values by name, and time is 0.3.
fn values(equations: &mut StateEquations, given: &[(&str, f64)]) -> BTreeMap<String, f64> {
    let value = |name: &str, default: f64| given.iter().find(|(known, _)| *known == name).map_or(default, |(_, v)| *v);
    let states: Vec<f64> = equations.states.iter().map(|state| value(&state.name, f64::NAN)).collect();
    let parameters: Vec<f64> = equations.parameters.iter().map(|p| value(&p.name.text, p.default)).collect();
    let rates = equations.states.iter().map(|state| (format!("{}'", state.name), state.rate));
    let outputs = equations.outputs.iter().map(|output| (output.name.clone(), output.value));
    let mut roots: Vec<_> = rates.chain(outputs).collect();
    let mut seeds: BTreeMap<Symbol, _> =
        (0..).map(Symbol::State).zip(equations.states.iter().map(|s| s.rate)).collect();
    seeds.insert(Symbol::Time, equations.pool.one());
    let change = derivative(&mut equations.pool, &[equations.balance.stored], &seeds)[0];
    let powers = [(equations.balance.supplied, 1.0), (equations.balance.dissipated, -1.0), (change, -1.0)];
    roots.push(("balance".to_owned(), equations.pool.linear(0.0, &powers)));
    roots.push(("stored".to_owned(), equations.balance.stored));
    let ids: Vec<_> = roots.iter().map(|(_, id)| *id).collect();
    let mut found = vec![0.0; equations.found()];
    let iterated: Vec<_> = equations.iterations.iter().flat_map(|iteration| iteration.values.clone()).collect();
    // Branches by their guards, which may depend on branches.
    let guards: Vec<_> = equations.switches.iter().map(|switch| switch.guard).collect();
    let mut negative = vec![false; guards.len()];
    let evaluated = |negative: &[bool], found: &[f64], ids: &[_]| {
        let (states, parameters) = (&states, &parameters);
        let environment = Environment { time: 0.3, states, parameters, negative, found, ..Environment::default() };
        evaluate(&equations.pool, ids, &environment)
    };
    for _ in 0..=guards.len() {
        // Newton's iteration without its safeguards.
        for _ in 0..30 {
            found = evaluated(&negative, &found, &iterated);
        }
        negative = evaluated(&negative, &found, &guards).into_iter().map(|guard| guard < 0.0).collect();
    }
    roots.into_iter().map(|(name, _)| name).zip(evaluated(&negative, &found, &ids)).collect()
}

/// Compares values with those expected, and the power balance with zero.
#[track_caller]
fn agrees(statements: &str, given: &[(&str, f64)], expected: &[(&str, f64)]) -> StateEquations {
    let mut equations = equations(statements);
    let found = values(&mut equations, given);
    for (name, expected) in expected {
        let value = found.get(*name).unwrap_or_else(|| panic!("no {name} in {found:?}"));
        assert!((value - expected).abs() <= 1e-12 * (1.0 + expected.abs()), "{name}: {value}, expected {expected}");
    }
    assert!(found["balance"].abs() < 1e-10, "{found:?}");
    equations
}

#[test]
fn two_inertias_on_one_shaft_are_one() {
    let text = "1 shaft: rotation; I J = 2; I wheel = 3; Se torque = 10; R bearing = 4; torque -> shaft -> J; \
        shaft -> wheel;
        shaft -> bearing; observe { e: N*m = wheel.effort; f: rad/s = wheel.flow; p: kg*m^2/s = wheel.p; \
        energy: J = wheel.energy;
        w: W = wheel.power; }";
    // f = 6 / 2 = 3; f' = (10 - 4 * 3) / 5 = -0.4.
    let expected =
        [("J.p'", -0.8), ("e", -1.2), ("f", 3.0), ("p", 9.0), ("energy", 13.5), ("w", -3.6), ("stored", 22.5)];
    let equations = agrees(text, &[("J.p", 6.0)], &expected);
    assert_eq!(equations.states.len(), 1);
    assert!(equations.texts.contains(&"wheel.p = 1.5*J.p, derivative causality".to_owned()), "{:?}", equations.texts);
}

#[test]
fn half_arrows_may_point_either_way() {
    for (arrow, sign) in [("shaft -> wheel", 1.0), ("wheel -> shaft", -1.0)] {
        let text = format!(
            "1 shaft: rotation; I J = 2; I wheel = 3; Se torque = 10; torque -> shaft -> J; {arrow};
             observe {{ e: N*m = wheel.effort; f: rad/s = wheel.flow; p: kg*m^2/s = wheel.p; }}"
        );
        agrees(&text, &[("J.p", 6.0)], &[("J.p'", 4.0), ("e", 6.0 * sign), ("f", 3.0), ("p", 9.0 * sign)]);
        let text = format!(
            "0 node: electrical; param c: F = 2; param d: F = 3; C C1 = c; C C2 = d; Sf i = 10; i -> node -> C1; {};
             observe {{ e: V = C2.effort; f: A = C2.flow; q: C = C2.q; }}",
            arrow.replace("shaft", "node").replace("wheel", "C2")
        );
        agrees(&text, &[("C1.q", 6.0)], &[("C1.q'", 4.0), ("e", 3.0), ("f", 6.0 * sign), ("q", 9.0)]);
    }
}

#[test]
fn a_rigid_gear_makes_one_inertia_of_two() {
    // f2 = n f1: (J1 + n^2 J2) f1' = T - n M.
    let (j1, j2, n): (f64, f64, f64) = (2.0, 3.0, 5.0);
    let first = (10.0 - n * 7.0) / (j1 + n * n * j2);
    let gear = "param n: 1 = 5; 1 a: rotation; I J1 = 2; Se T = 10; 1 b: rotation; I J2 = 3; Se M = -7; T -> a -> J1; \
        M -> b -> J2;
        observe { e: N*m = J2.effort; f: rad/s = b.flow; }";
    let expected = [("J1.p'", j1 * first), ("e", j2 * n * first), ("f", n * 4.0)];
    agrees(&format!("{gear} TF gear = n; a -> gear -> b;"), &[("J1.p", 8.0)], &expected);
    // Two gyrators in a row are a gear.
    let gyrators = "param g: N*m*s/rad = 2; param h: N*m*s/rad = 10; GY one = g; GY two = h; 1 m: rotation; R r = 1;";
    let pair = "a -> one -> m -> two -> b;";
    // g f1 = h f2 at the middle junction, where nothing else acts.
    let middle = format!(
        "{} {}",
        gear.replace("param n: 1 = 5;", ""),
        gyrators.replace("1 m: rotation; R r = 1;", "1 m: rotation;")
    );
    let n = 0.2;
    let first = (10.0 - n * 7.0) / (j1 + n * n * j2);
    let expected = [("J1.p'", j1 * first), ("e", j2 * n * first), ("f", n * 4.0)];
    agrees(&format!("{middle} {pair}"), &[("J1.p", 8.0)], &expected);
}

#[test]
fn a_mass_on_a_lever_feels_the_change_of_its_ratio() {
    // The ratio is that of the angle: v = r cos(x) w, and m v' = m (r cos(x) w' - r sin(x) w^2).
    let text = "param r: m = 0.5; 1 lever: rotation; I J = 2; C turn(q) = 0 * q energy 0; \
        MTF arm = r * cos(turn.q) in_unit; 1 mass: translation;
        I m = 3; Se T = 10; T -> lever -> J; lever -> turn; lever -> arm -> mass -> m; observe { e: N = m.effort; \
        v: m/s = mass.flow; p: kg*m/s = m.p }";
    let text = text.replace(" in_unit", "").replace("C turn(q) = 0 * q energy 0", "param k: N*m/rad = 4; C turn = k");
    let (r, j, m, x, w): (f64, f64, f64, f64, f64) = (0.5, 2.0, 3.0, 0.7, 1.5);
    let ratio = r * x.cos();
    let turn = (10.0 - 4.0 * x + m * ratio * r * x.sin() * w * w) / (j + m * ratio * ratio);
    let force = m * (ratio * turn - r * x.sin() * w * w);
    let expected = [("J.p'", j * turn), ("e", force), ("v", ratio * w), ("p", m * ratio * w)];
    agrees(&text, &[("J.p", j * w), ("turn.q", x)], &expected);
}

#[test]
fn a_capacitor_across_a_source_takes_the_current_of_the_change() {
    let circuit = |source: &str| {
        format!(
            "param c: F = 2; param r: Ohm = 5; 0 node: electrical; C cap = c; R load = r; {source} s -> node -> cap; \
            node -> load;
             observe {{ i: A = cap.flow; q: C = cap.q; w: J = cap.energy; supplied: A = s.flow; }}"
        )
    };
    let expected = [("i", 0.0), ("q", 20.0), ("w", 100.0), ("supplied", 2.0)];
    assert!(agrees(&circuit("Se s = 10;"), &[], &expected).states.is_empty());
    let (sine, cosine) = (4.0 * 0.3_f64).sin_cos();
    let expected = [("i", 2.0 * 12.0 * cosine), ("q", 6.0 * sine), ("supplied", 24.0 * cosine + 0.6 * sine)];
    agrees(&circuit("Se s = 3 * sin(4 * t);"), &[], &expected);
}

#[test]
fn an_inertia_behind_a_source_of_flow_needs_the_force_of_its_change() {
    let text =
        "1 j: translation; I m = 2; MSf v = 3 * t * t; v -> j -> m; observe { f: N = m.effort; p: kg*m/s = m.p }";
    agrees(text, &[], &[("f", 2.0 * 6.0 * 0.3), ("p", 2.0 * 3.0 * 0.09)]);
}

#[test]
fn resistors_in_a_row_and_side_by_side_divide() {
    let text = "param a: Ohm = 2; param b: Ohm = 3; Se u = 10; 1 ring: electrical; R ra = a; R rb = b; \
        u -> ring -> ra; ring -> rb;
        observe { i: A = ring.flow; ua: V = ra.effort; ub: V = rb.effort }";
    agrees(text, &[], &[("i", 2.0), ("ua", 4.0), ("ub", 6.0)]);
    let text = "param a: Ohm = 2; param b: Ohm = 3; Sf i = 10; 0 node: electrical; R ra = a; R rb = b; \
        i -> node -> ra; node -> rb;
        observe { u: V = node.effort; ia: A = ra.flow }";
    agrees(text, &[], &[("u", 12.0), ("ia", 6.0)]);
}

#[test]
fn a_bridge_is_that_of_kirchhoff() {
    // Node b at the top, c and d at the sides, ground below.
    let text = "param r1: Ohm = 1, above 0; param r2: Ohm = 2, above 0; param r3: Ohm = 3, above 0; \
        param r4: Ohm = 4, above 0; param r5: Ohm = 5, above 0;
        Se u = 10; 0 b: electrical; 0 c: electrical; 0 d: electrical; u -> b;
        1 b1: electrical; R R1 = r1; b -> b1 -> c; b1 -> R1; 1 b2: electrical; R R2 = r2; b -> b2 -> d; b2 -> R2;
        R R3 = r3; c -> R3; R R4 = r4; d -> R4; 1 b5: electrical; R R5 = r5; c -> b5 -> d; b5 -> R5;
        observe { c: V = c.effort; d: V = d.effort; i: A = b5.flow }";
    // (10 - c) / 1 = c / 3 + (c - d) / 5, (10 - d) / 2 + (c - d) / 5 = d / 4.
    let (a, b, e, f) = (1.0 + 1.0 / 3.0 + 0.2, -0.2, 0.5 + 0.25 + 0.2, 5.0);
    let determinant = a * e - b * b;
    let (c, d) = ((10.0 * e - b * f) / determinant, (a * f - b * 10.0) / determinant);
    let equations = agrees(text, &[], &[("c", c), ("d", d), ("i", (c - d) / 5.0)]);
    // The ranges prove that all divisors are above zero.
    assert!(equations.requirements.list.is_empty(), "{:?}", equations.requirements.list);
}

#[test]
fn resistors_make_a_loop_through_transformers_and_gyrators() {
    let text = |two_port: &str| {
        format!(
            "Se u = 10; 1 a: translation; R ra = 2; 1 b: translation; R rb = 3; param n: 1 = 2; param g: N*s/m = 4; \
            {two_port}
             u -> a -> ra; a -> x -> b -> rb; observe {{ fa: m/s = a.flow; fb: m/s = b.flow; }}"
        )
    };
    // f_b = 2 f_a: 10 = (2 + 4 * 3) f_a.
    agrees(&text("TF x = n;"), &[], &[("fa", 10.0 / 14.0), ("fb", 20.0 / 14.0)]);
    // 10 = 2 f_a + 4 f_b, 4 f_a = 3 f_b.
    agrees(
        &text("GY x = g;"),
        &[],
        &[("fb", 4.0 / 3.0 * (10.0 / (2.0 + 16.0 / 3.0))), ("fa", 10.0 / (2.0 + 16.0 / 3.0))],
    );
}

#[test]
fn multibonds_have_loops_and_dependent_tensors() {
    let tensor = "[[2, 0.5, 0], [0.5, 3, 0.25], [0, 0.25, 4]]";
    let text = format!(
        "1 a[3]: rotation; I J = [1, 2, 3]; I wheel = {tensor}; Se T = [1, 2, 3]; T -> a -> J; a -> wheel;
         observe {{ e: N*m = wheel.effort; p: kg*m^2/s = wheel.p; }}"
    );
    let mut of = equations(&text);
    let found = values(&mut of, &[("J.p_x", 1.0), ("J.p_y", 4.0), ("J.p_z", 9.0)]);
    // The whole inertia times the acceleration is the torque; the wheel's share of it is its effort.
    let rows = [[2.0, 0.5, 0.0], [0.5, 3.0, 0.25], [0.0, 0.25, 4.0]];
    let own = [1.0, 2.0, 3.0];
    let turn: Vec<f64> = ["x", "y", "z"].iter().zip(own).map(|(k, j)| found[&format!("J.p_{k}'")] / j).collect();
    for (k, letter) in ["x", "y", "z"].into_iter().enumerate() {
        let effort: f64 = rows[k].iter().zip(&turn).map(|(j, w)| j * w).sum();
        let momentum: f64 = rows[k].iter().zip([1.0, 2.0, 3.0]).map(|(j, w)| j * w).sum();
        assert!((found[&format!("e_{letter}")] - effort).abs() < 1e-13);
        assert!((found[&format!("p_{letter}")] - momentum).abs() < 1e-13);
        assert!((own[k] * turn[k] + effort - (1.0 + k as f64)).abs() < 1e-13);
    }
    assert!(found["balance"].abs() < 1e-12);
    let text = "1 a[3]: translation; R r = [1, 2, 4]; R s = [[2, 0.5, 0], [0.5, 3, 0.25], [0, 0.25, 4]]; \
        Se f = [1, 2, 3]; f -> a -> r; a -> s;
        observe { v: m/s = a.flow; e: N = s.effort }";
    let mut of = equations(text);
    let found = values(&mut of, &[]);
    for (k, (letter, r)) in ["x", "y", "z"].into_iter().zip([1.0, 2.0, 4.0]).enumerate() {
        let sum = r * found[&format!("v_{letter}")] + found[&format!("e_{letter}")];
        assert!((sum - (1.0 + k as f64)).abs() < 1e-13, "{found:?}");
    }
}

#[test]
fn a_body_s_tensor_turns_in_derivative_causality() {
    // Both tensors turn with the same orientation: together they are one body's.
    let both = "1 a[3]: rotation; orientation R of a start rotation_x(0.3) * rotation_z(0.8); \
        I J = [1, 2, 3] in R start [1, 2, 3];
        Se T = [1, 2, 3]; T -> a -> J; observe { w: rad/s = a.flow; energy: J = stored_energy; }";
    let parts = "1 a[3]: rotation; orientation R of a start rotation_x(0.3) * rotation_z(0.8); \
        I J = [0.25, 1.5, 1] in R;
        I wheel = [0.75, 0.5, 2] in R; Se T = [1, 2, 3]; T -> a -> J; a -> wheel; observe { w: rad/s = a.flow; \
        energy: J = stored_energy; }";
    let (mut both, mut parts) = (equations(both), equations(parts));
    let orientation: Vec<(String, f64)> = {
        let starts: Vec<_> = both.states.iter().map(|state| state.start).collect();
        let values = evaluate(&both.pool, &starts, &Environment::default());
        both.states.iter().map(|state| state.name.clone()).zip(values).collect()
    };
    let given: Vec<(&str, f64)> = orientation.iter().map(|(name, value)| (name.as_str(), *value)).collect();
    let whole = values(&mut both, &given);
    // The same angular velocity: p of the part is R J1 R^T w.
    let r = |i: usize, j: usize| given.iter().find(|(name, _)| *name == format!("R_{}{}", i + 1, j + 1)).expect("R").1;
    let w = ["w_x", "w_y", "w_z"].map(|name| whole[name]);
    let inside: [f64; 3] = std::array::from_fn(|j| (0..3).map(|i| r(i, j) * w[i]).sum::<f64>() * [0.25, 1.5, 1.0][j]);
    let momentum: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| r(i, j) * inside[j]).sum());
    let mut given: Vec<(&str, f64)> = given.into_iter().filter(|(name, _)| name.starts_with('R')).collect();
    given.extend(["J.p_x", "J.p_y", "J.p_z"].into_iter().zip(momentum));
    let found = values(&mut parts, &given);
    for name in ["w_x", "w_y", "w_z", "energy"] {
        assert!((found[name] - whole[name]).abs() < 1e-12, "{name}: {found:?} {whole:?}");
    }
    assert!(found["balance"].abs() < 1e-12 && whole["balance"].abs() < 1e-12, "{found:?}");
    // What both give of the torque: p' of the whole is T, that of the part and the effort of the wheel add up to it.
    assert_eq!(parts.states.len(), 12);
}

#[test]
fn a_motor_with_a_rigid_gearbox_is_that_of_the_book() {
    let text = "param R: Ohm = 2; param L: H = 0.5; param k: N*m/A = 0.1; param n: 1 = 0.25; param Jm: kg*m^2 = 1e-3; \
        param Jl: kg*m^2 = 0.02; param b: N*m*s/rad = 0.05;
        Se u = 12; 1 armature: electrical; I coil = L; R winding = R; GY motor = k; 1 shaft: rotation; I rotor = Jm; \
        TF gear = n; 1 load: rotation;
        I wheel = Jl; R bearing = b; u -> armature -> coil; armature -> winding; armature -> motor -> shaft -> rotor; \
        shaft -> gear -> load -> wheel; load -> bearing;
        observe { m: N*m = wheel.effort }";
    let (i, w) = (1.5, 30.0);
    let turn = (0.1 * i - 0.25 * 0.05 * 0.25 * w) / (1e-3 + 0.25 * 0.25 * 0.02);
    let expected = [("rotor.p'", 1e-3 * turn), ("m", 0.02 * 0.25 * turn), ("coil.p'", 12.0 - 2.0 * i - 0.1 * w)];
    agrees(text, &[("coil.p", 0.5 * i), ("rotor.p", 1e-3 * w)], &expected);
}

#[test]
fn a_law_without_an_inverse_keeps_its_state_in_step() {
    // tanh has no inverse here: the momentum of `k` stays a state; both speeds are equal and stay so.
    let text = "1 a: translation; I i = 2; param m: kg = 4; param n: kg = 1; param S: kg^2*m^2/s^2 = 5; \
        param T: kg^2*m^2/s^2 = 1;
        I k(p) = p / m * (1 + p * p / S); I l(p) = p / n * (1 + p * p / T); Se s = 1; s -> a -> i; a -> k; a -> l;
        observe { e: N = k.effort; }";
    let mut of = equations(text);
    assert_eq!(of.states.iter().map(|state| state.name.as_str()).collect::<Vec<_>>(), ["k.p", "l.p"]);
    // The same speed at both: 0.25 + 0.05 = 0.3 and p + p^3 = 0.3.
    let mut p = 0.28_f64;
    (0..30).for_each(|_| p -= (p + p * p * p - 0.3) / (1.0 + 3.0 * p * p));
    let found = values(&mut of, &[("k.p", 1.0), ("l.p", p)]);
    let (first, second) = ((0.25 + 0.15) * found["k.p'"], (1.0 + 3.0 * p * p) * found["l.p'"]);
    assert!((first - second).abs() < 1e-12, "{found:?}");
    assert!((2.0 * first + found["k.p'"] + found["l.p'"] - 1.0).abs() < 1e-12);
    assert!(found["balance"].abs() < 1e-12);
}

#[test]
fn a_state_that_only_the_strokes_determine_stays() {
    // The R gives the flow, its effort is what is left of the source: p is a state all the same.
    let text = "1 a: translation; I m = 2; R r(effort e) = e / 3; Se s = 10; s -> a -> m; a -> r; \
        observe { v: m/s = a.flow; }";
    agrees(text, &[("m.p", 4.0)], &[("v", 2.0), ("m.p'", 10.0 - 3.0 * 2.0)]);
    assert!(faults(&text.replace("e / 3", "e * e * e / 3"))[0].starts_with("BG0512"));
}

/// A mass on a straight rail with a resistor, which the transformer's effort leads to: v = r w with r = (2, 0, -1), and
/// m |r|^2 w' = -w / g + F r. One component of the momentum is a state, the largest.
const RAIL: &str = "1 a[3]: translation; I m = 3; Se push = [5, 7, 1]; TF rail(effort e) = dot([2, 0, -1], e); \
    0 b: translation; R r(effort e) = 4 * e;
    a -> m; push -> a; a -> rail -> b -> r;";

#[test]
fn a_component_of_a_momentum_determines_the_others() {
    let text = format!("{RAIL} observe {{ v: m/s = a.flow; p: kg*m/s = m.p; e: N = m.effort; }}");
    let (momentum, mass, w) = (6.0, 3.0, 1.0);
    let turn = (2.0 * 5.0 - 1.0 - w / 4.0) / (mass * 5.0);
    let expected = [
        ("v_x", 2.0 * w),
        ("v_y", 0.0),
        ("v_z", -w),
        ("p_x", momentum),
        ("p_z", -mass * w),
        ("m.p_x'", mass * 2.0 * turn),
        ("e_z", -mass * turn),
        ("stored", 0.5 * mass * 5.0 * w * w),
    ];
    let equations = agrees(&text, &[("m.p_x", momentum)], &expected);
    assert_eq!(equations.states.len(), 1);
    let lines = &equations.texts;
    assert!(lines.contains(&"d(m.p_x)/dt = e[a -> m]_x".to_owned()), "{lines:?}");
    assert!(lines.contains(&"m.p_[y, z] = [0, -0.5*m.p_x], derivative causality".to_owned()), "{lines:?}");
    assert_eq!(
        faults(&RAIL.replace("I m = 3", "I m = 3 start [1, 2, 3]")),
        ["BG0509 I `m` cannot start anywhere: of its components only `m.p_x` is free, the others follow"]
    );
}

#[test]
fn a_resistor_that_switches_in_a_loop_takes_the_branch_of_its_solution() {
    // Forward 1 Ohm, backward 99 Ohm, behind another one of 1 Ohm.
    let text = |source: f64| {
        format!(
            "Se u = {source}; 1 a: electrical; param r: Ohm = 1; R series = r; \
            R diode(i) = if i < 0 {{ 99 * i }} else {{ 1 * i }}; u -> a -> series; a -> diode;
             observe {{ i: A = a.flow }}"
        )
    };
    agrees(&text(10.0), &[], &[("i", 5.0)]);
    agrees(&text(-10.0), &[], &[("i", -0.1)]);
}

/// e = 1 - 2 f, f = g e^2: e = 1/2.
const SQUARE: &str =
    "Se u = 1; 1 a: translation; R r = 2; param g: m/N^2/s = 1; R s(effort e) = g * e * e; u -> a -> r; a -> s;";

#[test]
fn a_loop_that_is_not_linear_is_left_to_an_iteration() {
    let equations =
        agrees(&format!("{SQUARE} observe {{ f: m/s = a.flow; e: N = s.effort; }}"), &[], &[("f", 0.25), ("e", 0.5)]);
    assert_eq!((equations.found(), &equations.iterations[0].members[..]), (1, &["s".to_owned(), "r".to_owned()][..]));
    let line = equations.texts.iter().find(|line| line.ends_with("by Newton's iteration")).expect("a line");
    assert!(line.contains("[a -> s]"), "{line}");
}

/// Two loops, the second modulated by what the first gives; the rate of a state follows from that.
#[test]
fn a_loop_may_need_another() {
    let text = format!(
        "{SQUARE} Se w = 3; 1 b: translation; R q = 1; param k: N*s^3/m^3 = 4; R z(v) = k * a.flow * v * abs(v);
         w -> b -> q; b -> z; param c: N*s/m = 10; MSe push = c * b.flow; I m = 2; 1 d: translation; push -> d -> m;
         observe {{ v: m/s = b.flow; }}"
    );
    // v + v |v| = 3.
    let v = (13.0_f64.sqrt() - 1.0) / 2.0;
    let equations = agrees(&text, &[("m.p", 0.0)], &[("v", v), ("m.p'", 10.0 * v)]);
    assert_eq!(equations.iterations.len(), 2);
}

#[test]
fn an_unknown_changes_as_the_implicit_function_does() {
    // e + 2 g e^2 = u: de/du = 1 / (1 + 4 g e) = 1/3.
    let source = SQUARE.replace("Se u = 1", "MSe u = 0.7 * unit + rise * t");
    let text = format!("param unit: N = 1; param rise: N/s = 1; {source} observe {{ e: N = s.effort; }}");
    let mut equations = equations(&text);
    let seeds = BTreeMap::from([(Symbol::Time, equations.pool.one())]);
    let output = equations.outputs[0].value;
    let slope = derivative(&mut equations.pool, &[output], &seeds)[0];
    let environment = Environment { time: 0.3, parameters: &[1.0, 1.0, 1.0], found: &[0.25], ..Environment::default() };
    let parameters: Vec<&str> = equations.parameters.iter().map(|parameter| parameter.name.text.as_str()).collect();
    assert_eq!(parameters, ["unit", "rise", "g"]);
    let found = evaluate(&equations.pool, &[output, slope], &environment);
    assert!((found[0] - 0.5).abs() < 1e-15 && (found[1] - 1.0 / 3.0).abs() < 1e-15, "{found:?}");
}

#[test]
fn what_cannot_be_solved_is_told() {
    // The reaction is solved for after the loop.
    let nonlinear = SQUARE.replace("m/N^2/s", "m/N^3/s").replace("g * e * e", "g * hold.effort * e * e");
    let nonlinear =
        format!("{nonlinear} 1 k: translation; I m = 2; Se push = 3; rSe hold = 0; push -> k -> m; k -> hold;");
    assert_eq!(
        faults(&nonlinear),
        ["BG0501 algebraic loop that is not linear and depends on the reaction of `hold`, which is not known before \
            it: `s` -> `r`"]
    );
    // The capacitor's state is what the iteration finds.
    let dependent = "param c: F = 0.5; param g: Ohm/V^2 = 0.1; 1 a: electrical; I coil = 2; Se u = 3; u -> a -> coil;
        0 b: electrical; C cap = c; R r(i) = g * i * b.effort * b.effort; a -> b -> cap; b -> r;";
    assert!(faults(dependent)[0].starts_with("BG0512"), "{:?}", faults(dependent));
    let start = "1 a: rotation; I J = 2 start 1; I wheel = 3 start 4; a -> J; a -> wheel;";
    assert_eq!(
        faults(start),
        ["BG0509 I `wheel` has no start of its own: it is in derivative causality, its state follows from `J.p`"]
    );
    let input = "input v: m/s; 1 a: translation; I m = 2; Sf s = v; s -> a -> m;";
    assert_eq!(
        faults(input),
        ["BG0510 the state of I `m` is given by the input `v`, whose rate of change is not known"]
    );
    let jumps = "1 a: translation; I m = 2; MSf s = if t < 1 { 0 } else { 1 }; s -> a -> m;";
    assert!(faults(jumps)[0].starts_with("BG0511"), "{:?}", faults(jumps));
}
