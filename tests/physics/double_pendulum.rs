use std::f64::consts::TAU;

use bond_graph_tests::models::double_pendulum::{DoublePendulum, DoublePendulumParameters as Parameters};
use bond_graph_tests::support::record::{Record, instants, record};

use super::truth::{dot, within};

/// Inertia matrix at angle difference `between`, and the weight's moments per sine of each angle, of the rigid
/// pendulum.
fn rigid(p: &Parameters, between: f64) -> ([[f64; 2]; 2], [f64; 2]) {
    let upper = p.upper_length * p.upper_length * (p.upper_mass / 3.0 + p.lower_mass);
    let coupling = 0.5 * p.lower_mass * p.upper_length * p.lower_length * between.cos();
    let lower = p.lower_mass * p.lower_length * p.lower_length / 3.0;
    let weights = [
        p.gravity * p.upper_length * (0.5 * p.upper_mass + p.lower_mass),
        0.5 * p.gravity * p.lower_length * p.lower_mass,
    ];
    ([[upper, coupling], [coupling, lower]], weights)
}

/// Angles from the vertical.
fn angles(run: &Record) -> Vec<[f64; 2]> {
    let (upper, elbow) = (run.series("upper_angle"), run.series("elbow_angle"));
    upper.iter().zip(elbow).map(|(upper, elbow)| [*upper, upper + elbow]).collect()
}

#[test]
fn energy_is_kept_though_the_pins_vibrate() {
    let p = Parameters::default();
    let run = record(&DoublePendulum::new(p.clone()).unwrap(), &instants(4.0, 100), 1e-11);
    // Not the model's own sum: kinetic and potential energy from velocities, spins, heights and gaps.
    let [upper, lower, upper_v, lower_v, upper_w, lower_w, shoulder, elbow] = [
        "upper_position",
        "lower_position",
        "upper_velocity",
        "lower_velocity",
        "upper_spin",
        "lower_spin",
        "shoulder_gap",
        "elbow_gap",
    ]
    .map(|name| run.vectors(name));
    let moment = |mass: f64, length: f64| mass * length * length / 12.0;
    let energy = |k: usize| {
        0.5 * p.upper_mass * dot(upper_v[k], upper_v[k])
            + 0.5 * p.lower_mass * dot(lower_v[k], lower_v[k])
            + 0.5 * moment(p.upper_mass, p.upper_length) * upper_w[k][2].powi(2)
            + 0.5 * moment(p.lower_mass, p.lower_length) * lower_w[k][2].powi(2)
            + p.gravity * (p.upper_mass * upper[k][1] + p.lower_mass * lower[k][1])
            + 0.5 * p.stiffness * (dot(shoulder[k], shoulder[k]) + dot(elbow[k], elbow[k]))
    };
    let drift = (0..run.times.len()).map(|k| (energy(k) - energy(0)).abs()).fold(0.0, f64::max);
    within("energy", drift, 1e-8);
    within("its own balance", run.imbalance(), 1e-8);
    let turns = angles(&run).windows(2).map(|pair| (pair[1][1] - pair[0][1]).abs()).sum::<f64>();
    assert!(turns > TAU, "{turns}");
}

#[test]
fn small_swings_have_the_frequencies_of_the_linear_pendulum() {
    let p = Parameters::default();
    let (m, g) = rigid(&p, 0.0);
    // det(K - w^2 M) = 0 with K = diag(g).
    let a = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    let b = m[0][0] * g[1] + m[1][1] * g[0];
    let spread = (b * b - 4.0 * a * g[0] * g[1]).sqrt();
    for (name, square) in [("slow", (b - spread) / (2.0 * a)), ("fast", (b + spread) / (2.0 * a))] {
        let w = square.sqrt();
        // The mode: (g0 - w^2 m00) u0 = w^2 m01 u1. Started with it alone, the angles follow cos(w t).
        let (u0, u1) = (square * m[0][1], g[0] - square * m[0][0]);
        let size = 1e-3 / u0.abs().max(u1.abs());
        let (upper_angle, lower_angle) = (size * u0, size * u1);
        let of = |stiffness: f64| {
            let parameters = Parameters { upper_angle, lower_angle, stiffness, ..p.clone() };
            // At 1e-11 the momenta's tolerances are below the rounding of the pins' forces, and steps as short as that
            // asks.
            let run = record(&DoublePendulum::new(parameters).unwrap(), &instants(2.0 * TAU / w, 40), 1e-9);
            let error = angles(&run).iter().zip(&run.times).fold(0.0_f64, |largest, (angle, t)| {
                let (upper, lower) = (upper_angle * (w * t).cos(), lower_angle * (w * t).cos());
                largest.max((angle[0] - upper).abs()).max((angle[1] - lower).abs())
            });
            error / 1e-3
        };
        let (soft, stiff) = (of(1e6), of(4e6));
        println!("{name} mode, w = {w}: {soft:e}, {stiff:e}");
        // What is left is the pins' stretch, as 1 / stiffness, and the amplitude, 1e-6 of it.
        within(name, stiff, 3e-4);
        within("as 1 / k", stiff / soft, 0.3);
    }
}

#[test]
fn large_swings_are_those_of_the_rigid_pendulum_to_first_order_of_the_compliance() {
    let p = Parameters { upper_angle: 1.0, lower_angle: 1.4, ..Parameters::default() };
    let end = 1.5;
    // Rigid equations of motion, M q'' = -g sin q - coupling terms, by RK4 with 1e5 steps (error far below 1e-10).
    let rate = |s: [f64; 4]| {
        let (m, g) = rigid(&p, s[0] - s[1]);
        let h = 0.5 * p.lower_mass * p.upper_length * p.lower_length * (s[0] - s[1]).sin();
        let force = [-g[0] * s[0].sin() - h * s[3] * s[3], -g[1] * s[1].sin() + h * s[2] * s[2]];
        let det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
        [s[2], s[3], (m[1][1] * force[0] - m[0][1] * force[1]) / det, (m[0][0] * force[1] - m[1][0] * force[0]) / det]
    };
    let steps = 20_000;
    let h = end / f64::from(steps);
    let mut s = [p.upper_angle, p.lower_angle, 0.0, 0.0];
    for _ in 0..steps {
        let plus = |k: [f64; 4], h: f64| std::array::from_fn(|i| s[i] + h * k[i]);
        let k1 = rate(s);
        let k2 = rate(plus(k1, 0.5 * h));
        let k3 = rate(plus(k2, 0.5 * h));
        let k4 = rate(plus(k3, h));
        s = std::array::from_fn(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    let of = |stiffness: f64| {
        let model = DoublePendulum::new(Parameters { stiffness, ..p.clone() }).unwrap();
        let last = *angles(&record(&model, &[0.0, end], 1e-10)).last().unwrap();
        (last[0] - s[0]).abs().max((last[1] - s[1]).abs())
    };
    let (soft, stiff) = (of(1e6), of(4e6));
    println!("soft {soft:e}, stiff {stiff:e}");
    within("stiff", stiff, 1e-4);
    // The pins vibrate with the same energy at any stiffness started unloaded, so a quarter only nearly.
    within("as 1 / k", stiff / soft, 0.35);
}
