use bond_graph_tests::models::loops::{Bridge, BridgeParameters, Clipped, ClippedParameters, Lever, LeverParameters};
use bond_graph_tests::support::record::{instants, record};

use super::truth::within;

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
