use bg_model::integrator::Integrator;
use bg_model::run::{Request, Simulation};
use bond_graph_tests::models::double_pendulum::{RigidPendulum, RigidPendulumParameters};
use bond_graph_tests::models::slider_crank::{
    RigidSliderCrank, RigidSliderCrankParameters, SliderCrank, SliderCrankParameters,
};
use bond_graph_tests::models::spinning_top::{FixedTip, FixedTipParameters};
use bond_graph_tests::support::record::{Record, instants, record};
use hacksaw::mechanism::{Rigid, RigidParameters};

/// The largest value of a series that must be small.
fn within(what: &str, value: f64, bound: f64) {
    println!("{what}: {value:.2e}");
    assert!(value < bound, "{what}: {value:e}");
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |largest, value| if value.is_nan() { f64::NAN } else { value.abs().max(largest) })
}

#[test]
fn the_rigid_slider_crank_has_the_kinematics_and_the_energy_of_geometry() {
    for (crank_angle, crank_length, rod_length) in [(0.4, 0.1, 0.35), (-1.1, 0.12, 0.3)] {
        let p = RigidSliderCrankParameters { crank_angle, crank_length, rod_length, ..Default::default() };
        let model = RigidSliderCrank::new(p.clone()).unwrap();
        let run = record(&model, &instants(1.0, 100), 1e-11);
        let (angle, x, rod) = (run.series("angle"), run.series("slider_x"), run.series("rod_angle"));
        let expected = |angle: f64| {
            let y = crank_length * angle.sin();
            (crank_length * angle.cos() + (rod_length * rod_length - y * y).sqrt(), (-y / rod_length).asin())
        };
        within("slider", largest(angle.iter().zip(&x).map(|(a, x)| x - expected(*a).0)), 1e-9);
        within("rod", largest(angle.iter().zip(&rod).map(|(a, r)| r - expected(*a).1)), 1e-9);
        within("off the slide", run.largest("slider_y"), 1e-9);
        let turns = largest(angle.windows(2).map(|pair| pair[1] - pair[0]));
        assert!(turns > 0.01, "it turns");
        within("energy", run.imbalance(), 1e-8);
    }
}

#[test]
fn the_compliant_slider_crank_tends_to_the_rigid_one_with_the_compliance() {
    // At rest without load on the crank there is no vibration to begin with; the torque comes on at once, and the
    // joints' damping ends what it excites before the samples.
    let times: Vec<f64> = std::iter::once(0.0).chain(instants(0.2, 20).iter().map(|t| 0.2 + t)).collect();
    let rigid = record(&RigidSliderCrank::new(RigidSliderCrankParameters::default()).unwrap(), &times, 1e-11);
    let of = |factor: f64| -> Vec<f64> {
        let p = SliderCrankParameters::default();
        let p = SliderCrankParameters { stiffness: factor * p.stiffness, ..p };
        let run = record(&SliderCrank::new(p).unwrap(), &times, 1e-10);
        run.series("slider_x").iter().zip(rigid.series("slider_x")).skip(1).map(|(a, b)| a - b).collect()
    };
    let (soft, firm, stiff) = (of(1.0), of(2.0), of(4.0));
    let beyond = |soft: &[f64], firm: &[f64]| largest(soft.iter().zip(firm).map(|(a, b)| 2.0 * b - a));
    let (soft_most, firm_most, stiff_most) =
        (largest(soft.iter().copied()), largest(firm.iter().copied()), largest(stiff.iter().copied()));
    println!("departures {soft_most:.3e} {firm_most:.3e} {stiff_most:.3e}");
    println!("beyond 1/k {:.3e} {:.3e}", beyond(&soft, &firm), beyond(&firm, &stiff));
    assert!((soft_most / firm_most - 2.0).abs() < 0.1, "{}", soft_most / firm_most);
    assert!((firm_most / stiff_most - 2.0).abs() < 0.05, "{}", firm_most / stiff_most);
    // Richardson's extrapolation to no compliance.
    assert!(beyond(&firm, &stiff) < 0.05 * stiff_most);
}

#[test]
fn gaps_of_rigid_joints_do_not_drift() {
    let run = record(
        &RigidSliderCrank::new(RigidSliderCrankParameters { torque: 0.3, ..Default::default() }).unwrap(),
        &instants(10.0, 200),
        1e-9,
    );
    for gap in ["gap_o", "gap_a", "gap_b", "slider_y"] {
        let series = run.series(gap);
        let (early, late) = (largest(series[..100].iter().copied()), largest(series[100..].iter().copied()));
        println!("{gap}: {early:.2e} to 5 s, {late:.2e} to 10 s");
        assert!(late < 1e-9, "{gap}: {late:e}");
    }
    let pendulum = record(&RigidPendulum::new(RigidPendulumParameters::default()).unwrap(), &instants(10.0, 200), 1e-9);
    for gap in ["shoulder_gap_x", "shoulder_gap_y", "elbow_gap_x", "elbow_gap_y"] {
        within(gap, pendulum.largest(gap), 1e-9);
    }
    within("energy of the pendulum", pendulum.imbalance(), 1e-7);
}

/// Angles and speeds of the rigid double pendulum at `end`, from Lagrange's equations by RK4 in 20 000 steps.
fn lagrange(p: &RigidPendulumParameters, end: f64) -> [f64; 4] {
    let (l, m, g) = ([p.upper_length, p.lower_length], [p.upper_mass, p.lower_mass], p.gravity);
    let rate = |s: [f64; 4]| {
        // Rods: T = (m1 l1^2 / 6 + m2 l1^2 / 2) u'^2 + m2 l2^2 v'^2 / 6 + m2 l1 l2 u' v' cos(u - v) / 2.
        let a = l[0] * l[0] * (m[0] / 3.0 + m[1]);
        let b = 0.5 * m[1] * l[0] * l[1];
        let c = m[1] * l[1] * l[1] / 3.0;
        let (sine, cosine) = (s[0] - s[1]).sin_cos();
        let force = [
            -b * sine * s[3] * s[3] - g * l[0] * (0.5 * m[0] + m[1]) * s[0].sin(),
            b * sine * s[2] * s[2] - 0.5 * g * m[1] * l[1] * s[1].sin(),
        ];
        let determinant = a * c - b * b * cosine * cosine;
        let upper = (c * force[0] - b * cosine * force[1]) / determinant;
        let lower = (a * force[1] - b * cosine * force[0]) / determinant;
        [s[2], s[3], upper, lower]
    };
    let h = end / 20_000.0;
    let mut s = [p.upper_angle, p.lower_angle, 0.0, 0.0];
    for _ in 0..20_000 {
        let plus = |k: [f64; 4], h: f64| std::array::from_fn(|i| s[i] + h * k[i]);
        let k1 = rate(s);
        let k2 = rate(plus(k1, 0.5 * h));
        let k3 = rate(plus(k2, 0.5 * h));
        let k4 = rate(plus(k3, h));
        s = std::array::from_fn(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    s
}

#[test]
fn the_rigid_double_pendulum_obeys_lagrange_s_equations() {
    for (upper_angle, lower_angle) in [(1.6, 0.9), (0.3, -0.4), (-1.2, 2.0)] {
        let p = RigidPendulumParameters { upper_angle, lower_angle, ..Default::default() };
        let run = record(&RigidPendulum::new(p.clone()).unwrap(), &instants(2.0, 40), 1e-12);
        let expected = lagrange(&p, 2.0);
        let apart = |a: f64, b: f64| (a - b).sin().abs().max(1.0 - (a - b).cos());
        within("upper angle", apart(run.last("upper_angle"), expected[0]), 1e-9);
        within("elbow", apart(run.last("elbow_angle"), expected[1] - expected[0]), 1e-9);
        within("energy", run.imbalance(), 1e-9);
    }
}

/// The largest distance of a vector output from `truth` of time.
fn apart(run: &Record, name: &str, truth: impl Fn(f64) -> [f64; 3]) -> f64 {
    let pairs = run.times.iter().zip(run.vectors(name));
    largest(pairs.flat_map(|(t, v)| std::array::from_fn::<f64, 3, _>(|k| v[k] - truth(*t)[k])))
}

#[test]
fn a_top_about_a_rigid_point_precesses_regularly() {
    for (tilt, precession) in [(0.5, 3.0), (1.2, -2.0), (0.8, 6.0)] {
        let mut p = FixedTipParameters { tilt, precession, ..Default::default() };
        // (A + m l^2) W^2 cos(tilt) - C w3 W + m g l = 0 (Goldstein, section 5.7).
        let across = p.across + p.mass * p.arm * p.arm;
        let axial = (across * precession * precession * tilt.cos() + p.mass * p.gravity * p.arm) / precession / p.axial;
        p.spin = axial - precession * tilt.cos();
        let run = record(&FixedTip::new(p.clone()).unwrap(), &instants(2.0, 50), 1e-11);
        let circle = |radius: f64, height: f64| {
            move |t: f64| [radius * (precession * t).cos(), radius * (precession * t).sin(), height]
        };
        within("axis", apart(&run, "axis", circle(tilt.sin(), tilt.cos())), 1e-8);
        within("centre", apart(&run, "center", circle(p.arm * tilt.sin(), p.arm * tilt.cos())), 1e-9);
        within("gap", largest(["x", "y", "z"].map(|axis| run.largest(&format!("gap_{axis}")))), 1e-10);
        within("energy", run.imbalance() / run.largest("stored"), 1e-9);
    }
}

/// A state at an event is projected until that moves it no more: a projection that left a guard on either side of its
/// zero made the branches change without end.
#[test]
fn loose_tolerances_find_the_branches_of_the_rigid_hacksaw() {
    const EVENTS: u64 = 36;
    let model = Rigid::new(RigidParameters::default()).unwrap();
    for method in [Integrator::Taylor, Integrator::Dop853, Integrator::Cfmr7, Integrator::Nystrom] {
        // The tolerances may be those of parts of states, or of states.
        for (rtol, atol) in [(1e-3, None), (3e-4, None), (1e-12, Some(1e-3))] {
            let request = Request { method, t_end: 2.0, rtol, atol, ..Request::default() };
            let run = Simulation::of(&model, request).run();
            let run = run.unwrap_or_else(|failure| panic!("{method:?} at {rtol}, {atol:?}: {failure}"));
            assert_eq!(run.statistics.events, EVENTS, "{method:?} at {rtol}, {atol:?}");
        }
    }
}
