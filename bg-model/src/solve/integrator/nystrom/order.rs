//! Checks of the tableau against the order conditions of Runge-Kutta-Nystrom methods for q'' = f(q, q').

use super::stages::{END, ERROR};
use super::tableau::{DENSE, FIRST, INSTANTS, SECOND, STAGES};
use super::trees::{self, dot};

/// A tree with its elementary weights at the stages.
struct Tree {
    order: usize,
    by_momenta: usize,
    exact: f64,
    weight: Vec<f64>,
}

/// All trees up to this order.
fn trees(largest: usize) -> Vec<Tree> {
    let trees = trees::trees(largest);
    let weights = trees::weights(&trees, &INSTANTS, &FIRST[..STAGES], &SECOND[..STAGES]);
    let weighted = |(tree, weight): (trees::Tree, Vec<f64>)| Tree {
        order: tree.order,
        by_momenta: tree.by_momenta,
        exact: tree.exact,
        weight,
    };
    trees.into_iter().zip(weights).map(weighted).collect()
}

/// The largest violation of the conditions of the trees that are asked for, in parts of their values.
fn violation(trees: &[Tree], asked: impl Fn(&Tree) -> bool) -> f64 {
    let of = |tree: &Tree| {
        let order = tree.order as f64;
        let momentum = dot(FIRST[END], &tree.weight) * order / tree.exact - 1.0;
        let position = dot(SECOND[END], &tree.weight) * order * (order + 1.0) / tree.exact - 1.0;
        // The position has an order more.
        momentum.abs().max(if tree.order < 6 { position.abs() } else { 0.0 })
    };
    trees.iter().filter(|tree| asked(tree)).map(of).fold(0.0, f64::max)
}

#[test]
fn all_trees_are_there() {
    let trees = trees(6);
    let count = |order| trees.iter().filter(|tree| tree.order == order).count();
    assert_eq!((1..=6).map(count).collect::<Vec<_>>(), [1, 2, 6, 18, 60, 204]);
    let undamped = |order| trees.iter().filter(|tree| tree.order == order && tree.by_momenta == 0).count();
    assert_eq!((1..=6).map(undamped).collect::<Vec<_>>(), [1, 1, 2, 3, 6, 10]);
}

#[test]
fn rows_sum_to_the_instants() {
    for (stage, c) in INSTANTS.iter().enumerate() {
        let (first, second): (f64, f64) = (FIRST[stage].iter().sum(), SECOND[stage].iter().sum());
        assert!((first - c).abs() <= 1e-15 && (second - 0.5 * c * c).abs() <= 1e-15, "{stage}");
        assert_eq!((FIRST[stage].len(), SECOND[stage].len()), (stage, stage));
    }
}

#[test]
fn quadrature_is_exact_to_order_6() {
    for power in 0..6 {
        let powers = INSTANTS.map(|c| c.powi(power));
        let order = f64::from(power) + 1.0;
        assert!((dot(FIRST[END], &powers) - 1.0 / order).abs() < 1e-15, "{power}");
        assert!(power == 5 || (dot(SECOND[END], &powers) - 1.0 / (order * (order + 1.0))).abs() < 1e-15, "{power}");
    }
}

#[test]
fn the_conditions_hold_to_a_part_of_their_values() {
    let trees = trees(6);
    let all = violation(&trees, |tree| tree.order <= 5);
    let undamped = violation(&trees, |tree| tree.by_momenta == 0);
    let damped = violation(&trees, |tree| tree.order == 6);
    println!("to order 5 {all:.1e}, order 6 undamped {undamped:.1e}, damped {damped:.1e}");
    assert!(all < 3e-6 && undamped < 3e-7, "{all:e} {undamped:e}");
    assert!(damped > 1e-3, "order 6 with momenta is more than is promised");
}

#[test]
fn the_estimate_is_blind_to_order_4_and_to_nothing_beyond() {
    let parts = |order: usize, row: &[f64]| -> Vec<f64> {
        let trees = trees(order);
        let of_order = trees.iter().filter(|tree| tree.order == order);
        of_order.map(|tree| (dot(row, &tree.weight) / tree.exact).abs()).collect()
    };
    let largest = |parts: &[f64]| parts.iter().copied().fold(0.0, f64::max);
    let least = |parts: &[f64]| parts.iter().copied().fold(f64::INFINITY, f64::min);
    for (row, blind) in [(FIRST[ERROR], 4), (SECOND[ERROR], 3)] {
        assert!((1..=blind).all(|order| largest(&parts(order, row)) < 1e-5), "{blind}");
        assert!(least(&parts(blind + 1, row)) > 1e-4, "{blind}: {:?}", parts(blind + 1, row));
    }
    // Forces that change with time, and the least of all others.
    assert!(parts(5, FIRST[ERROR])[0] > 1e-2 && least(&parts(5, FIRST[ERROR])) > 1e-3);
}

#[test]
fn the_estimate_of_an_oscillation_is_ten_times_its_error() {
    // One step of q'' = -z^2 q - 2 d z q', from q = 1 and from q' = z: the error of the momentum and its estimate.
    let step = |z: f64, damping: f64, [q, v]: [f64; 2]| {
        let mut forces = [0.0; STAGES];
        for stage in 0..STAGES {
            let at = q + INSTANTS[stage] * v + dot(SECOND[stage], &forces);
            forces[stage] = -z * z * at - 2.0 * damping * z * (v + dot(FIRST[stage], &forces));
        }
        let damped = z * (1.0 - damping * damping).sqrt();
        let along = (v + damping * z * q) / damped;
        let decay = libm::exp(-damping * z);
        let exact = decay
            * ((damped * along - damping * z * q) * damped.cos() - (damped * q + damping * z * along) * damped.sin());
        [v + dot(FIRST[END], &forces) - exact, dot(FIRST[ERROR], &forces)]
    };
    for damping in [0.0, 0.02, 0.1, 0.3] {
        for k in 4..=140 {
            let z = 0.05 * f64::from(k);
            let [[error, estimate], [second_error, second]] =
                [step(z, damping, [1.0, 0.0]), step(z, damping, [0.0, z])];
            let ratio = estimate.hypot(second) / error.hypot(second_error);
            assert!(ratio > 10.0, "{z} {damping}: {ratio}");
        }
    }
}

#[test]
fn an_undamped_oscillation_hardly_grows() {
    // The step of q'' = -z^2 q as a matrix for (q, q' / z), column by column.
    let step = |z: f64, [q, v]: [f64; 2]| {
        let mut forces = [0.0; STAGES];
        for stage in 0..STAGES {
            forces[stage] = -z * z * (q + INSTANTS[stage] * z * v + dot(SECOND[stage], &forces));
        }
        [q + z * v + dot(SECOND[END], &forces), v + dot(FIRST[END], &forces) / z]
    };
    for k in 1..=815 {
        let z = 0.01 * f64::from(k);
        let [[a, c], [b, d]] = [step(z, [1.0, 0.0]), step(z, [0.0, 1.0])];
        let (trace, determinant) = (a + d, a * d - b * c);
        let growth = if trace * trace < 4.0 * determinant {
            determinant.sqrt()
        } else {
            0.5 * trace.abs() + (0.25 * trace * trace - determinant).sqrt()
        };
        // Where a step is half a turn, or one, both roots are close to each other and may part.
        let bound = match z {
            3.13..3.15 => 1.003,
            6.21..6.33 => 1.05,
            _ => 1.0 + 1e-9,
        };
        assert!(growth <= bound, "{z}: {growth}");
    }
}

#[test]
fn the_dense_output_of_the_momenta_has_order_4() {
    let weights = |theta: f64| -> [f64; STAGES + 1] {
        let end = |stage: usize| FIRST[END].get(stage).copied().unwrap_or(0.0);
        core::array::from_fn(|stage| {
            let first = f64::from(stage == 0) - end(stage);
            let third = end(stage) - f64::from(stage == STAGES) - first;
            let inner = third + (1.0 - theta) * (DENSE[0][stage] + theta * DENSE[1][stage]);
            theta * (end(stage) + (1.0 - theta) * (first + theta * inner))
        })
    };
    for theta in [0.1, 0.37, 0.5, 0.83] {
        for power in 0..4 {
            let of_stages: f64 = dot(&weights(theta)[..STAGES], &INSTANTS.map(|c| c.powi(power)));
            let sum = of_stages + weights(theta)[STAGES];
            let exact = theta.powi(power + 1) / f64::from(power + 1);
            assert!((sum - exact).abs() < 1e-11, "{theta} {power}: {:e}", sum - exact);
        }
    }
}
