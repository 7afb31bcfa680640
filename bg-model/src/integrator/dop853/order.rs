//! Checks of the tableau against the order conditions of Runge-Kutta methods.
//!
//! Source: Hairer, Norsett, Wanner, section II.2: a method has order p if for every rooted tree t of up to p nodes the
//! elementary weight is 1 / density(t).

use super::STAGES;
use super::tableau::*;

type Stages = [f64; STAGES];

/// A rooted tree: the trees that hang at its root, by their indices in the list of all trees.
struct Tree {
    branches: Vec<usize>,
    nodes: usize,
    density: f64,
    /// The stages' elementary weights.
    weight: Stages,
}

fn dense<const K: usize>(row: &Row<K>) -> Stages {
    let mut full = [0.0; STAGES];
    for (stage, weight) in row.stage.iter().zip(row.weight) {
        full[*stage] = weight;
    }
    full
}

fn matrix() -> [Stages; STAGES] {
    let mut a = [[0.0; STAGES]; STAGES];
    a[1..12].copy_from_slice(&[
        dense(&A1),
        dense(&A2),
        dense(&A3),
        dense(&A4),
        dense(&A5),
        dense(&A6),
        dense(&A7),
        dense(&A8),
        dense(&A9),
        dense(&A10),
        dense(&A11),
    ]);
    a[12..].copy_from_slice(&[dense(&B), dense(&A13), dense(&A14), dense(&A15)]);
    a
}

fn dot(a: &Stages, b: &Stages) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// All rooted trees of up to `largest` nodes; each has its branches in ascending order of their indices.
fn trees(largest: usize) -> Vec<Tree> {
    let a = matrix();
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

fn order(b: &Stages, theta: f64) -> usize {
    // Weights up to 50 are rounded to 16 digits, and products of several of them enter.
    const ROUNDING: f64 = 1e-13;
    let trees = trees(9);
    (1..=9).take_while(|nodes| violation(&trees, b, *nodes, theta) < ROUNDING).count()
}

#[test]
fn all_trees_are_there() {
    let trees = trees(9);
    let count = |nodes| trees.iter().filter(|tree| tree.nodes == nodes).count();
    assert_eq!((1..=9).map(count).collect::<Vec<_>>(), [1, 1, 2, 4, 9, 20, 48, 115, 286]);
    assert!(trees.iter().all(|tree| tree.branches.is_sorted()));
}

#[test]
fn the_rows_sum_to_the_instants() {
    for (row, c) in matrix().iter().zip(C) {
        let size: f64 = row.iter().map(|a| a.abs()).sum();
        assert!((row.iter().sum::<f64>() - c).abs() <= f64::EPSILON * size, "{c}");
    }
}

#[test]
fn the_step_has_order_8_and_its_companions_5_and_3() {
    let (b, difference) = (dense(&B), dense(&E5));
    assert_eq!(order(&b, 1.0), 8);
    assert_eq!(order(&std::array::from_fn(|i| b[i] - difference[i]), 1.0), 5);
    assert_eq!(order(&dense(&B3), 1.0), 3);
}

#[test]
fn the_dense_output_has_order_7_inside_the_step() {
    let (b, d) = (dense(&B), [dense(&D3), dense(&D4), dense(&D5), dense(&D6)]);
    for theta in [0.1, 0.37, 0.5, 0.83] {
        let rest = 1.0 - theta;
        let weights: Stages = std::array::from_fn(|i| {
            let first = if i == 0 { 1.0 } else { 0.0 } - b[i];
            let last = b[i] - if i == 12 { 1.0 } else { 0.0 } - first;
            let upper = d[0][i] + theta * (d[1][i] + rest * (d[2][i] + theta * d[3][i]));
            theta * (b[i] + rest * (first + theta * (last + rest * upper)))
        });
        assert_eq!(order(&weights, theta), 7, "{theta}");
    }
}
