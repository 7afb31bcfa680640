//! Vectors and matrices of numbers: constant axes of hinges.

use std::collections::BTreeMap;

use crate::expr::{Environment, Id, Node, Pool, evaluate, exchange};
use crate::system::Value;

pub(super) type Vector = [f64; 3];
/// By rows.
pub(super) type Matrix = [f64; 9];

pub(super) const UNIT: Matrix = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// A row, in parts of its largest number, is as another one below it.
const DEPENDENT: f64 = 1e-9;

/// What rounding leaves of a component that is 0 or 1.
const ROUNDING: f64 = 1e-13;

pub(super) fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn norm(a: &Vector) -> f64 {
    dot(a, a).sqrt()
}

pub(super) fn cross(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

/// The direction of a vector that is not small.
pub(super) fn unit(a: &Vector) -> Option<Vector> {
    let norm = norm(a);
    (norm > 1e-3).then(|| a.map(|part| part / norm))
}

pub(super) fn are_near(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < ROUNDING)
}

/// Whether directions are perpendicular to each other and of length 1.
pub(super) fn are_perpendicular(directions: &[Vector]) -> bool {
    let wanted = |i: usize, j: usize| f64::from(u8::from(i == j));
    let count = directions.len();
    (0..count).all(|i| (0..count).all(|j| are_near(&[dot(&directions[i], &directions[j])], &[wanted(i, j)])))
}

/// How many of these rows are independent.
pub(super) fn rank(mut rows: Vec<Vec<f64>>) -> usize {
    let largest = |row: &[f64]| row.iter().fold(0.0, |largest: f64, part| largest.max(part.abs()));
    rows.iter_mut().for_each(|row| {
        let size = largest(row);
        row.iter_mut().for_each(|part| *part /= if size > 0.0 { size } else { 1.0 });
    });
    let mut rank = 0;
    while let Some(pivot) = (rank..rows.len()).max_by(|&a, &b| largest(&rows[a]).total_cmp(&largest(&rows[b]))) {
        if largest(&rows[pivot]) < DEPENDENT {
            break;
        }
        rows.swap(rank, pivot);
        let (found, rest) = rows.split_at_mut(rank + 1);
        let row = &found[rank];
        let column = (0..row.len()).max_by(|&a, &b| row[a].abs().total_cmp(&row[b].abs())).unwrap_or(0);
        for other in rest {
            let factor = other[column] / row[column];
            other.iter_mut().zip(row).for_each(|(part, by)| *part -= factor * by);
        }
        rank += 1;
    }
    rank
}

/// Components that are 0, 1 or -1 but for rounding as these.
pub(super) fn cleaned<const N: usize>(of: &[f64; N]) -> [f64; N] {
    of.map(|part| if (part - part.round()).abs() < ROUNDING { part.round() + 0.0 } else { part })
}

pub(super) fn column<T: Copy>(of: &[T; 9], column: usize) -> [T; 3] {
    [of[column], of[3 + column], of[6 + column]]
}

pub(super) fn transposed(of: &Matrix) -> Matrix {
    std::array::from_fn(|k| of[3 * (k % 3) + k / 3])
}

pub(super) fn product(a: &Matrix, b: &Matrix) -> Matrix {
    cleaned(&std::array::from_fn(|k| (0..3).map(|i| a[k / 3 * 3 + i] * b[3 * i + k % 3]).sum()))
}

pub(super) fn applied(a: &Matrix, b: &Vector) -> Vector {
    std::array::from_fn(|row| (0..3).map(|k| a[3 * row + k] * b[k]).sum())
}

/// A rotation whose third column is this direction: one of coordinate axes, where it is along such an axis.
pub(super) fn upright(axis: &Vector) -> Matrix {
    let least = (0..3).min_by(|&i, &j| axis[i].abs().total_cmp(&axis[j].abs())).unwrap_or(0);
    let largest = (0..3).max_by(|&i, &j| axis[i].abs().total_cmp(&axis[j].abs())).unwrap_or(2);
    let mut helper = [0.0; 3];
    helper[if axis[largest].abs() == 1.0 { (largest + 1) % 3 } else { least }] = 1.0;
    let along = dot(&helper, axis);
    let across: Vector = std::array::from_fn(|k| helper[k] - along * axis[k]);
    let x = across.map(|part| part / norm(&across));
    let y = cross(axis, &x);
    cleaned(&std::array::from_fn(|k| [x, y, *axis][k % 3][k / 3]))
}

pub(super) fn constant(pool: &mut Pool, of: &Vector) -> Value {
    Value(of.iter().map(|&part| pool.number(part)).collect())
}

pub(super) fn matrix(pool: &mut Pool, of: &Matrix) -> Value {
    Value(of.iter().map(|&part| pool.number(part)).collect())
}

/// Nodes with functions of numbers, as `cos(0.3)`, as numbers.
pub(super) fn folded(pool: &mut Pool, ids: &[Id]) -> Vec<Id> {
    let calls = pool.reachable(ids).into_iter().filter(|&id| {
        matches!(pool.node(id), Node::Call(..)) && pool.symbols(&[id]).is_empty() && !pool.has_select(&[id])
    });
    let calls: Vec<Id> = calls.collect();
    let values = evaluate(pool, &calls, &Environment::default());
    let places: BTreeMap<Id, Id> =
        calls.into_iter().zip(values).map(|(id, value)| (id, pool.number(cleaned(&[value])[0]))).collect();
    exchange(pool, ids, &places)
}
