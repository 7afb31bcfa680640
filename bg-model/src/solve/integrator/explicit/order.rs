//! Checks of the tableaus against the order conditions of Runge-Kutta methods.
//!
//! Source: Hairer, Norsett, Wanner, section II.2: a method has order p if for every rooted tree t of up to p nodes the
//! elementary weight is 1 / density(t). With an implicit companion each branch takes the coefficients of one of the two
//! methods, in all ways (C. A. Kennedy, M. H. Carpenter, Applied Numerical Mathematics 44 (2003), 139-181, section 2).

use super::stages::STAGES;
use super::{BogackiShampine, CalvoFrancoMontijanoRandez, DormandPrince, FROM_ENDS, Row, Tableau};
use crate::solve::integrator::partitioned::KennedyCarpenter;

type Stages = [f64; STAGES];

/// A rooted tree: the trees that hang at its root, each by its index in the list of all trees and the method that it
/// hangs by.
struct Tree {
    branches: Vec<(usize, usize)>,
    nodes: usize,
    density: f64,
    /// The stages' elementary weights.
    weight: Stages,
}

fn full(row: Row) -> Stages {
    let mut full = [0.0; STAGES];
    for (stage, weight) in row {
        full[*stage] = *weight;
    }
    full
}

/// The coefficients of the method, then those of its implicit companion, if it has one.
fn matrices<T: Tableau>() -> Vec<Vec<Stages>> {
    let explicit: Vec<Stages> =
        (0..STAGES).map(|stage| T::A.get(stage).map_or([0.0; STAGES], |row| full(row))).collect();
    let mut implicit = explicit.clone();
    for (stage, more) in T::MORE.iter().enumerate().skip(1) {
        implicit[stage][stage] = T::GAMMA;
        more.iter().for_each(|(before, weight)| implicit[stage][*before] += weight);
        // The first column is not in the table: each row sums to its instant.
        implicit[stage][0] = T::C[stage] - implicit[stage][1..].iter().sum::<f64>();
    }
    if T::MORE.is_empty() { vec![explicit] } else { vec![explicit, implicit] }
}

fn dot(a: &Stages, b: &Stages) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// All rooted trees of up to `largest` nodes; each has its branches in ascending order.
fn trees<T: Tableau>(largest: usize) -> Vec<Tree> {
    let a = matrices::<T>();
    let mut trees = vec![Tree { branches: vec![], nodes: 1, density: 1.0, weight: [1.0; STAGES] }];
    for nodes in 2..=largest {
        let mut found = Vec::new();
        collect(&trees, a.len(), nodes - 1, (0, 0), &mut Vec::new(), &mut found);
        for branches in found {
            let density = branches.iter().map(|(tree, _)| trees[*tree].density).product::<f64>() * nodes as f64;
            let of = |i: usize, &(tree, method): &(usize, usize)| dot(&a[method][i], &trees[tree].weight);
            let weight = core::array::from_fn(|i| branches.iter().map(|branch| of(i, branch)).product());
            trees.push(Tree { branches, nodes, density, weight });
        }
    }
    trees
}

/// All ascending lists of trees with `nodes` nodes altogether, each hanging by one of `methods`, from the branch `from`
/// on.
fn collect(
    trees: &[Tree],
    methods: usize,
    nodes: usize,
    from: (usize, usize),
    chosen: &mut Vec<(usize, usize)>,
    found: &mut Vec<Vec<(usize, usize)>>,
) {
    if nodes == 0 {
        found.push(chosen.clone());
    }
    for (index, tree) in trees.iter().enumerate().skip(from.0).filter(|(_, tree)| tree.nodes <= nodes) {
        for branch in (0..methods).map(|method| (index, method)).filter(|branch| *branch >= from) {
            chosen.push(branch);
            collect(trees, methods, nodes - tree.nodes, branch, chosen, found);
            chosen.pop();
        }
    }
}

/// The largest violation of the conditions for trees of `nodes` nodes at the part `theta` of the step.
fn violation(trees: &[Tree], b: &Stages, nodes: usize, theta: f64) -> f64 {
    let size = (0..nodes).fold(1.0, |power, _| power * theta);
    let of = |tree: &Tree| (dot(b, &tree.weight) - size / tree.density).abs();
    trees.iter().filter(|tree| tree.nodes == nodes).map(of).fold(0.0, f64::max)
}

fn order<T: Tableau>(b: &Stages, theta: f64) -> usize {
    // Weights up to 50 are rounded to 16 digits, and products of several of them enter.
    const ROUNDING: f64 = 1e-13;
    // Each branch by either method: far more trees.
    let largest = if T::MORE.is_empty() { 9 } else { 6 };
    let trees = trees::<T>(largest);
    (1..=largest).take_while(|nodes| violation(&trees, b, *nodes, theta) < ROUNDING).count()
}

/// The orders of the step and of its embedded methods.
fn orders<T: Tableau>() -> [usize; 3] {
    let (b, difference) = (full(T::B), full(T::ERROR));
    let embedded = core::array::from_fn(|i| b[i] - difference[i]);
    [order::<T>(&b, 1.0), order::<T>(&embedded, 1.0), order::<T>(&full(T::SECOND), 1.0)]
}

/// The least order of the dense output at some instants inside the step.
fn dense_order<T: Tableau>() -> usize {
    let (b, end) = (full(T::B), full(&[(T::END, 1.0)]));
    let weights = |theta: f64| {
        let start = full(&[(0, 1.0)]);
        core::array::from_fn(|i| {
            let first = start[i] - b[i];
            let mut coefficients = vec![b[i], first, b[i] - end[i] - first];
            coefficients.extend(T::DENSE.iter().map(|row| full(row)[i]));
            assert!(coefficients.len() >= FROM_ENDS);
            let factor = |m: usize| if m.is_multiple_of(2) { theta } else { 1.0 - theta };
            coefficients.iter().enumerate().rev().fold(0.0, |sum, (m, p)| factor(m) * (p + sum))
        })
    };
    [0.1, 0.37, 0.5, 0.83].into_iter().map(|theta| order::<T>(&weights(theta), theta)).min().unwrap_or(0)
}

#[test]
fn all_trees_are_there() {
    fn counts<T: Tableau>(largest: usize) -> Vec<usize> {
        let trees = trees::<T>(largest);
        assert!(trees.iter().all(|tree| tree.branches.is_sorted()));
        (1..=largest).map(|nodes| trees.iter().filter(|tree| tree.nodes == nodes).count()).collect()
    }
    assert_eq!(counts::<DormandPrince>(9), [1, 1, 2, 4, 9, 20, 48, 115, 286]);
    assert_eq!(counts::<KennedyCarpenter>(6), [1, 2, 7, 26, 107, 458]);
}

fn check_rows<T: Tableau>() {
    assert_eq!(T::A.len(), T::C.len());
    for (stage, (row, c)) in T::A.iter().zip(T::C).enumerate() {
        assert!(
            row.iter().all(|(before, _)| *before < stage) && row.is_sorted_by_key(|(before, _)| *before),
            "{stage}"
        );
        let size: f64 = row.iter().map(|(_, a)| a.abs()).sum();
        assert!((row.iter().map(|(_, a)| a).sum::<f64>() - c).abs() <= f64::EPSILON * size, "{stage}");
    }
    assert!(T::ERROR.iter().all(|(stage, _)| *stage < T::END));
}

#[test]
fn the_rows_sum_to_the_instants() {
    check_rows::<DormandPrince>();
    check_rows::<CalvoFrancoMontijanoRandez>();
    check_rows::<BogackiShampine>();
    check_rows::<KennedyCarpenter>();
}

#[test]
fn the_steps_and_their_companions_have_their_orders() {
    assert_eq!(orders::<DormandPrince>(), [8, 5, 3]);
    assert_eq!(orders::<CalvoFrancoMontijanoRandez>(), [7, 5, 0]);
    assert_eq!(orders::<BogackiShampine>(), [5, 4, 0]);
    assert_eq!(orders::<KennedyCarpenter>(), [5, 4, 0]);
}

#[test]
fn the_other_companion_of_dop853_has_the_order_of_the_first() {
    let (b, difference) = (full(DormandPrince::B), full(DormandPrince::OTHER_ERROR));
    let embedded: Stages = core::array::from_fn(|i| b[i] - difference[i]);
    assert_eq!(order::<DormandPrince>(&embedded, 1.0), 5);
    assert!(DormandPrince::OTHER_ERROR.iter().all(|(stage, _)| *stage < DormandPrince::END));
}

#[test]
fn the_late_companion_of_bs5_has_its_order() {
    let (b, difference) = (full(BogackiShampine::B), full(BogackiShampine::LATE));
    let embedded: Stages = core::array::from_fn(|i| b[i] + difference[i]);
    assert_eq!(order::<BogackiShampine>(&embedded, 1.0), 4);
}

#[test]
fn the_dense_outputs_have_their_orders_inside_the_step() {
    assert_eq!(dense_order::<DormandPrince>(), 7);
    assert_eq!(dense_order::<CalvoFrancoMontijanoRandez>(), 5);
    assert_eq!(dense_order::<BogackiShampine>(), 5);
    assert_eq!(dense_order::<KennedyCarpenter>(), 4);
}
