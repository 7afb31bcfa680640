use bond_graph_tests::models::loops::{
    Bridge, BridgeParameters, Charger, ChargerParameters, Clipped, ClippedParameters, Lever, LeverParameters, Manifold,
    ManifoldParameters,
};
use bond_graph_tests::support::record::{instants, record};

use super::truth::{root, within};

/// Thevenin: the bridge is a source with an inner resistance, the coil's current an exponential.
#[test]
fn a_bridge_is_a_source_with_an_inner_resistance() {
    let p = BridgeParameters::default();
    let run = record(&Bridge::new(p.clone()).unwrap(), &instants(0.02, 100), 1e-11);
    let open = p.voltage * (p.third / (p.first + p.third) - p.fourth / (p.second + p.fourth));
    let side = |a: f64, b: f64| a * b / (a + b);
    let inner = side(p.first, p.third) + side(p.second, p.fourth) + p.winding;
    let truth = |t: f64| open / inner * (1.0 - (-inner / p.coil * t).exp());
    within("current", run.deviation("current", truth) / (open / inner).abs(), 1e-9);
    within("energy", run.imbalance() / run.last("supplied"), 1e-9);
}

/// Runge and Kutta's classical method with many steps.
fn integrated(start: [f64; 2], t_end: f64, steps: usize, rate: &dyn Fn(f64, [f64; 2]) -> [f64; 2]) -> Vec<[f64; 2]> {
    let h = t_end / steps as f64;
    let mut states = vec![start];
    for step in 0..steps {
        let (t, x) = (h * step as f64, states[step]);
        let moved = |k: [f64; 2], part: f64| [x[0] + part * h * k[0], x[1] + part * h * k[1]];
        let a = rate(t, x);
        let b = rate(t + 0.5 * h, moved(a, 0.5));
        let c = rate(t + 0.5 * h, moved(b, 0.5));
        let d = rate(t + h, moved(c, 1.0));
        states.push(std::array::from_fn(|k| x[k] + h / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k])));
    }
    states
}

/// (J + m r^2) w' = -k x - m r r' w^2 with the ratio r(x) and its derivative r'.
#[test]
fn a_mass_on_a_lever_feels_the_change_of_its_ratio() {
    let p = LeverParameters::default();
    let run = record(&Lever::new(p.clone()).unwrap(), &instants(3.0, 300), 1e-11);
    let rate = |_: f64, [x, w]: [f64; 2]| {
        let (ratio, change) = (p.length * x.cos(), -p.length * x.sin());
        [w, (-p.stiffness * x - p.mass * ratio * change * w * w) / (p.inertia + p.mass * ratio * ratio)]
    };
    let truth = integrated([0.9, 0.0], 3.0, 30_000, &rate);
    let (angle, speed, force) = (run.series("angle"), run.series("speed"), run.series("force"));
    let (energy, first) = (run.series("stored"), run.series("stored")[0]);
    for k in 0..angle.len() {
        let [x, w] = truth[100 * k];
        within("angle", (angle[k] - x).abs(), 1e-8);
        within("speed", (speed[k] - w).abs(), 1e-7);
        let [_, turn] = rate(0.0, [x, w]);
        let expected = p.mass * p.length * (x.cos() * turn - x.sin() * w * w);
        within("force", (force[k] - expected).abs(), 1e-6);
        within("energy", (energy[k] / first - 1.0).abs(), 1e-9);
    }
}

/// The loop's solution has one branch for each sign of the voltage: u = (s - R i) / (1 + R g).
#[test]
fn a_loop_with_a_switch_takes_the_branch_of_its_solution() {
    let p = ClippedParameters::default();
    let run = record(&Clipped::new(p.clone()).unwrap(), &instants(0.5, 500), 1e-11);
    let voltage = |t: f64, current: f64| {
        let rest = p.amplitude * (p.frequency * t).sin() - p.series * current;
        rest / (1.0 + p.series * if rest < 0.0 { p.forward } else { p.backward })
    };
    let rate = |t: f64, [current, _]: [f64; 2]| [voltage(t, current) / p.coil, 0.0];
    let truth = integrated([0.0, 0.0], 0.5, 500_000, &rate);
    let (found, current) = (run.series("voltage"), run.series("current"));
    for k in 0..current.len() {
        let [expected, _] = truth[1000 * k];
        within("current", (current[k] - expected).abs(), 1e-8);
        within("voltage", (found[k] - voltage(0.5 * k as f64 / (current.len() - 1) as f64, expected)).abs(), 1e-6);
    }
    assert!(current.iter().any(|&i| i > 0.5) && found.iter().any(|&u| u < -0.1), "both branches are taken");
    within("energy", run.imbalance() / run.last("supplied"), 1e-9);
}

/// The current is where resistor, diode and capacitor take what the source gives: s = R i + d + u with i = i0 (exp(d /
/// n) - 1).
#[test]
fn a_diode_in_a_loop_lets_current_through_one_way() {
    let p = ChargerParameters { saturation: 1e-9, thermal: 0.05, ..ChargerParameters::default() };
    let model = Charger::new(p.clone()).unwrap();
    let run = record(&model, &instants(1.0, 1000), 1e-10);
    let current = |t: f64, voltage: f64| {
        let rest = p.amplitude * (p.frequency * t).sin() - voltage;
        let through = |drop: f64| p.saturation * (drop / p.thermal).exp_m1();
        through(root(|drop| p.series * through(drop) + drop - rest, rest.min(0.0) - 1.0, 1.5))
    };
    let rate = |t: f64, [u, _]: [f64; 2]| [(current(t, u) - u / p.resistance) / p.capacitance, 0.0];
    let truth = integrated([0.0, 0.0], 1.0, 20_000, &rate);
    let (voltage, flow) = (run.series("voltage"), run.series("current"));
    for k in 0..voltage.len() {
        let ([expected, _], t) = (truth[20 * k], 1e-3 * k as f64);
        within("voltage", (voltage[k] - expected).abs(), 1e-7);
        within("current", (flow[k] - current(t, expected)).abs(), 1e-6);
    }
    assert!(voltage[1000] > 5.0, "{}", voltage[1000]);
    within("energy", run.imbalance() / run.last("supplied"), 1e-9);
}

/// The node has the pressure at which what comes through one throttle leaves through the others.
#[test]
fn throttles_that_meet_share_the_flow() {
    let p = ManifoldParameters::default();
    let run = record(&Manifold::new(p.clone()).unwrap(), &instants(1e-3, 100), 1e-11);
    let through = |drop: f64, part: f64| {
        let (a, b) = (p.laminar, part * p.turbulent);
        2.0 * drop / (a + (a * a + 4.0 * b * drop.abs()).sqrt())
    };
    let node = |pressure: f64| {
        let left = |node: f64| through(p.pump - node, 1.0) - through(node, 2.0) - through(node - pressure, 0.5);
        root(left, 0.0, p.pump)
    };
    let rate = |_: f64, [pressure, _]: [f64; 2]| [through(node(pressure) - pressure, 0.5) / p.compliance, 0.0];
    let truth = integrated([0.0, 0.0], 1e-3, 20_000, &rate);
    let (pressure, at_node) = (run.series("pressure"), run.series("node"));
    for k in 0..pressure.len() {
        let [expected, _] = truth[200 * k];
        within("pressure", (pressure[k] - expected).abs() / p.pump, 1e-8);
        within("node", (at_node[k] - node(expected)).abs() / p.pump, 1e-8);
    }
    within("energy", run.imbalance() / run.last("supplied"), 1e-9);
}
