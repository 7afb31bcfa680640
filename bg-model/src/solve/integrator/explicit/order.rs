//! Checks of the tableaus against the order conditions of Runge-Kutta methods.
//!
//! Source: Hairer, Norsett, Wanner, section II.2: a method has order p if for every rooted tree t of up to p nodes the
//! elementary weight is 1 / density(t).

use super::{BogackiShampine, CalvoFrancoMontijanoRandez, DormandPrince, FROM_ENDS, Row, STAGES, Tableau};

type Stages = [f64; STAGES];

/// A rooted tree: the trees that hang at its root, by their indices in the list of all trees.
struct Tree {
    branches: Vec<usize>,
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

fn matrix<T: Tableau>() -> Vec<Stages> {
    (0..STAGES).map(|stage| T::A.get(stage).map_or([0.0; STAGES], |row| full(row))).collect()
}

fn dot(a: &Stages, b: &Stages) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// All rooted trees of up to `largest` nodes; each has its branches in ascending order of their indices.
fn trees<T: Tableau>(largest: usize) -> Vec<Tree> {
    let a = matrix::<T>();
    let mut trees = vec![Tree { branches: vec![], nodes: 1, density: 1.0, weight: [1.0; STAGES] }];
    for nodes in 2..=largest {
        let mut found = Vec::new();
        collect(&trees, nodes - 1, 0, &mut Vec::new(), &mut found);
        for branches in found {
            let density = branches.iter().map(|b: &usize| trees[*b].density).product::<f64>() * nodes as f64;
            let weight = std::array::from_fn(|i| branches.iter().map(|b| dot(&a[i], &trees[*b].weight)).product());
            trees.push(Tree { branches, nodes, density, weight });
        }
    }
    trees
}

/// All ascending lists of trees from index `from` with `nodes` nodes altogether.
fn collect(trees: &[Tree], nodes: usize, from: usize, chosen: &mut Vec<usize>, found: &mut Vec<Vec<usize>>) {
    if nodes == 0 {
        found.push(chosen.clone());
    }
    for (index, tree) in trees.iter().enumerate().skip(from).filter(|(_, tree)| tree.nodes <= nodes) {
        chosen.push(index);
        collect(trees, nodes - tree.nodes, index, chosen, found);
        chosen.pop();
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
    let trees = trees::<T>(9);
    (1..=9).take_while(|nodes| violation(&trees, b, *nodes, theta) < ROUNDING).count()
}

/// The orders of the step and of its embedded methods.
fn orders<T: Tableau>() -> [usize; 3] {
    let (b, difference) = (full(T::B), full(T::ERROR));
    let embedded = std::array::from_fn(|i| b[i] - difference[i]);
    [order::<T>(&b, 1.0), order::<T>(&embedded, 1.0), order::<T>(&full(T::SECOND), 1.0)]
}

/// The least order of the dense output at some instants inside the step.
fn dense_order<T: Tableau>() -> usize {
    let (b, end) = (full(T::B), full(&[(T::END, 1.0)]));
    let weights = |theta: f64| {
        let start = full(&[(0, 1.0)]);
        std::array::from_fn(|i| {
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
    let trees = trees::<DormandPrince>(9);
    let count = |nodes| trees.iter().filter(|tree| tree.nodes == nodes).count();
    assert_eq!((1..=9).map(count).collect::<Vec<_>>(), [1, 1, 2, 4, 9, 20, 48, 115, 286]);
    assert!(trees.iter().all(|tree| tree.branches.is_sorted()));
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
}

#[test]
fn the_steps_and_their_companions_have_their_orders() {
    assert_eq!(orders::<DormandPrince>(), [8, 5, 3]);
    assert_eq!(orders::<CalvoFrancoMontijanoRandez>(), [7, 5, 0]);
    assert_eq!(orders::<BogackiShampine>(), [5, 4, 0]);
}

#[test]
fn the_late_companion_of_bs5_has_its_order() {
    let (b, difference) = (full(BogackiShampine::B), full(BogackiShampine::LATE));
    let embedded: Stages = std::array::from_fn(|i| b[i] + difference[i]);
    assert_eq!(order::<BogackiShampine>(&embedded, 1.0), 4);
}

#[test]
fn the_dense_outputs_have_their_orders_inside_the_step() {
    assert_eq!(dense_order::<DormandPrince>(), 7);
    assert_eq!(dense_order::<CalvoFrancoMontijanoRandez>(), 5);
    assert_eq!(dense_order::<BogackiShampine>(), 5);
}
