use bond_graph_tests::models::free_body::{FreeBody, FreeBodyParameters};
use bond_graph_tests::support::record::{Record, instants, record};

use super::truth::{dot, elliptic, within};

/// The angular momentum in the body's axes at sample `k`.
fn in_body(run: &Record, k: usize) -> [f64; 3] {
    let h = run.vectors("h")[k];
    std::array::from_fn(|i| (0..3).map(|row| run.series(&format!("R_{}{}", row + 1, i + 1))[k] * h[row]).sum())
}

#[test]
fn angular_momentum_and_energy_stay_and_the_body_returns_after_eulers_period() {
    let p = FreeBodyParameters::default();
    let model = FreeBody::new(p.clone()).unwrap();
    let start = in_body(&record(&model, &[0.0], 1e-11), 0);
    // Landau and Lifshitz, Mechanics, section 37, with the axis that the polhode encircles as the third.
    let (square, double_energy) =
        (dot(start, start), start[0].powi(2) / p.least + start[1].powi(2) / p.middle + start[2].powi(2) / p.greatest);
    let (i1, i2, i3) = if square > double_energy * p.middle {
        (p.least, p.middle, p.greatest)
    } else {
        (p.greatest, p.middle, p.least)
    };
    let k = ((i2 - i1) * (double_energy * i3 - square) / ((i3 - i2) * (square - double_energy * i1))).sqrt();
    let period = 4.0 * elliptic(k) * (i1 * i2 * i3 / ((i3 - i2) * (square - double_energy * i1))).sqrt();
    let run = record(&model, &instants(5.0 * period, 20), 1e-11);
    for axis in ["h_x", "h_y", "h_z"] {
        within(axis, run.drift(axis), 1e-15);
    }
    within("energy", run.drift("stored"), 1e-9);
    for turn in 1..=5 {
        let later = in_body(&run, 4 * turn);
        within("return", (0..3).map(|i| (later[i] - start[i]).abs()).fold(0.0, f64::max), 1e-8);
        let between = in_body(&run, 4 * turn - 2);
        assert!((0..3).any(|i| (between[i] - start[i]).abs() > 0.1));
    }
    // Orientations stay orthogonal.
    let column = |i: usize| [1, 2, 3].map(|row| run.last(&format!("R_{row}{i}")));
    for (a, b, expected) in [(1, 1, 1.0), (2, 2, 1.0), (3, 3, 1.0), (1, 2, 0.0), (1, 3, 0.0), (2, 3, 0.0)] {
        within("orthogonal", (dot(column(a), column(b)) - expected).abs(), 1e-14);
    }
}
