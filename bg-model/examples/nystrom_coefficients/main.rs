//! Finds the coefficients of the Runge-Kutta-Nystrom method, prints them, and compares them with the tableau.
//!
//! `cargo run --release -p bg-model --example nystrom_coefficients`
//!
//! In: four digits of each coefficient, `start.rs`. Out: the coefficients as they stand in `nystrom/tableau.rs`. It
//! exits with 1 where one of them differs from the tableau.
//! Method: the least sum of squares of the order conditions' violations, of the errors on model oscillators
//! (`oscillators.rs`) and of the distances from the start (`search.rs`). The weights at the end of the step and of the
//! error estimate then move as little as possible to meet their linear conditions (`nearest.rs`). The dense output
//! follows from its conditions alone.

mod coefficients;
mod nearest;
mod oscillators;
mod search;
mod start;
#[allow(dead_code, reason = "the step-size controller's numbers are of no use here")]
#[path = "../../src/solve/integrator/nystrom/tableau.rs"]
mod tableau;
#[path = "../../src/solve/integrator/nystrom/trees.rs"]
mod trees;

use std::process::ExitCode;

use bg_model::scalar::{DoubleDouble, Scalar};
use coefficients::Coefficients;
use nearest::{Condition, nearest, residual};
use trees::{Tree, trees, weights};

/// The rates of a step.
const STAGES: usize = tableau::STAGES;
/// The largest difference to the tableau that passes.
const ALLOWED: f64 = 1e-13;

/// All rows of the tableau.
struct Found {
    coefficients: Coefficients<f64>,
    second_error: Vec<f64>,
    first_error: Vec<f64>,
    dense: [Vec<f64>; 2],
}

fn main() -> ExitCode {
    let trees = trees(6);
    let unknowns = search::minimum(&trees, &Coefficients::start());
    let found = complete(&trees, &unknowns);
    report(&trees, &found);
    print(&found);
    let difference = difference(&found);
    println!("\nlargest difference to the tableau: {difference:.1e}");
    if difference <= ALLOWED { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Meets the linear conditions: first the weights at the end, then those of the estimate and of the dense output.
fn complete(trees: &[Tree], unknowns: &[f64]) -> Found {
    let mut coefficients = Coefficients::from_unknowns(&widened(unknowns)).map(DoubleDouble::to_f64);
    let instants = widened(&coefficients.instants);
    coefficients.first[STAGES] = nearest(&coefficients.first[STAGES], &quadrature(&instants, 6, of_momenta), 0.0);
    coefficients.second[STAGES] = nearest(&coefficients.second[STAGES], &quadrature(&instants, 5, of_positions), 0.0);
    let at_stages = stage_weights(trees, &coefficients);
    Found {
        second_error: blind(&start::SECOND_ERROR, &of_trees(trees, &at_stages, 3), &instants, 3),
        first_error: blind(&start::FIRST_ERROR, &of_trees(trees, &at_stages, 4), &instants, 4),
        dense: [[0.25, 0.4], [0.0, 0.2]].map(|parts| dense(trees, &at_stages, &instants, parts)),
        coefficients,
    }
}

/// The integral of a power of time over the step, by its order: once, and twice.
fn of_momenta(order: usize) -> f64 {
    1.0 / order as f64
}

fn of_positions(order: usize) -> f64 {
    1.0 / (order * (order + 1)) as f64
}

/// Singular values below this are of conditions that depend on the others, but for what the search leaves of their
/// violation.
const NEARLY_DEPENDENT: f64 = 1e-5;
/// The weight of the dense output's conditions up to order 4, for a weight 1 of those of order 5.
const DENSE_WEIGHT: f64 = 1e3;

/// The nearest row to a start that is blind to the trees up to an order, exactly so to the powers of time.
fn blind(start: &[f64], conditions: &[Condition], instants: &[DoubleDouble], order: usize) -> Vec<f64> {
    nearest(&nearest(start, conditions, NEARLY_DEPENDENT), &quadrature(instants, order, |_| 0.0), 0.0)
}

/// A row of the dense output: the conditions up to order 4 hold, those of order 5 in the least squares. A tree of order
/// 4 or 5 gives these parts of its exact value, others give nothing. The last weight is that of the rate at the end.
fn dense(trees: &[Tree], at_stages: &[Vec<DoubleDouble>], instants: &[DoubleDouble], parts: [f64; 2]) -> Vec<f64> {
    let condition = |(tree, weights): (&Tree, &Vec<DoubleDouble>)| {
        let scale = if tree.order == 5 { 1.0 } else { DENSE_WEIGHT };
        let with_end = weights.iter().copied().chain([tree.exact.into()]);
        Condition {
            weights: with_end.map(|weight| weight * scale.into()).collect(),
            exact: part_of(parts, tree.order) * tree.exact * scale,
        }
    };
    let to_order_5 = trees.iter().zip(at_stages).filter(|(tree, _)| tree.order <= 5);
    let conditions: Vec<Condition> = to_order_5.map(condition).collect();
    let found = nearest(&[0.0; STAGES + 1], &conditions, NEARLY_DEPENDENT);
    let instants = [instants, &[1.0.into()]].concat();
    nearest(&found, &quadrature(&instants, 4, |order| part_of(parts, order)), 0.0)
}

/// The part for an order, of those for order 4 and 5.
fn part_of(parts: [f64; 2], order: usize) -> f64 {
    order.checked_sub(4).map_or(0.0, |beyond| parts[beyond])
}

/// The conditions of the powers of time, from the values for their orders.
fn quadrature(instants: &[DoubleDouble], count: usize, exact: impl Fn(usize) -> f64) -> Vec<Condition> {
    let power = |exponent: usize| {
        let weights =
            instants.iter().map(|c| (0..exponent).fold(1.0.into(), |power: DoubleDouble, _| power * *c)).collect();
        Condition { weights, exact: exact(exponent + 1) }
    };
    (0..count).map(power).collect()
}

/// The conditions to be blind to the trees up to an order.
fn of_trees(trees: &[Tree], weights: &[Vec<DoubleDouble>], order: usize) -> Vec<Condition> {
    let pairs = trees.iter().zip(weights).filter(|(tree, _)| tree.order <= order);
    pairs.map(|(_, weights)| Condition { weights: weights.clone(), exact: 0.0 }).collect()
}

fn stage_weights(trees: &[Tree], found: &Coefficients<f64>) -> Vec<Vec<DoubleDouble>> {
    let Coefficients { instants, first, second } = found.map(DoubleDouble::from);
    weights(trees, &instants, &first, &second)
}

fn widened(row: &[f64]) -> Vec<DoubleDouble> {
    row.iter().map(|value| DoubleDouble::from(*value)).collect()
}

/// Says how well each group of conditions holds.
fn report(trees: &[Tree], found: &Found) {
    let coefficients = found.coefficients.map(DoubleDouble::from);
    let instants = widened(&found.coefficients.instants);
    let at_stages = stage_weights(trees, &found.coefficients);
    let line = |name: &str, largest: f64| println!("{name:<76} {largest:.1e}");
    let Coefficients { first, second, .. } = &found.coefficients;
    line("quadrature to order 6, momenta", residual(&first[STAGES], &quadrature(&instants, 6, of_momenta)));
    line("quadrature to order 6, positions", residual(&second[STAGES], &quadrature(&instants, 5, of_positions)));
    let of = |asked: fn(&Tree) -> bool| search::largest_violation(trees, &coefficients, asked);
    line("trees to order 5, in parts of their values", of(|tree| tree.order <= 5));
    line("trees of order 6, no force by the momenta", of(|tree| tree.by_momenta == 0));
    let blind = |row: &[f64], order| residual(row, &of_trees(trees, &at_stages, order));
    line("error estimate of the momenta, trees to order 4", blind(&found.first_error, 4));
    line("error estimate of the positions, trees to order 3", blind(&found.second_error, 3));
}

/// Prints the rows in the order of the tableau.
fn print(found: &Found) {
    let Found { coefficients: Coefficients { instants, first, second }, second_error, first_error, dense } = found;
    let row = |row: &Vec<f64>| println!("    {row:?},");
    println!("\nINSTANTS {instants:?}\nSECOND");
    second.iter().chain([second_error]).for_each(row);
    println!("FIRST");
    first.iter().chain([first_error]).for_each(row);
    println!("DENSE");
    dense.iter().for_each(row);
}

/// The largest difference to the tableau.
fn difference(found: &Found) -> f64 {
    let Found { coefficients: Coefficients { instants, first, second }, second_error, first_error, dense } = found;
    let second = second.iter().chain([second_error]).zip(tableau::SECOND);
    let first = first.iter().chain([first_error]).zip(tableau::FIRST);
    let dense = dense.iter().zip(tableau::DENSE.iter().map(|row| row.as_slice()));
    let rows = second.chain(first).chain(dense).chain([(instants, tableau::INSTANTS.as_slice())]);
    rows.map(|(row, printed)| largest_difference(row, printed)).fold(0.0, f64::max)
}

fn largest_difference(row: &[f64], printed: &[f64]) -> f64 {
    assert_eq!(row.len(), printed.len(), "a row of the tableau has another length");
    row.iter().zip(printed).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
