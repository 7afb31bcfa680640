//! What is allowed for a value, as scalars that must be above 0 or at least 0.
//!
//! In: a value of 1, 3 or 9 components. Out: [`Condition`]s. Method: a symmetric matrix is positive definite where the
//! pivots of its L D L^T are above 0, in proportion to its diagonal; where it need not be definite, it is shifted by
//! [`SHIFT`] of its size first. A body's principal moments satisfy the triangle inequality where tr(J) / 2 - J is not
//! negative (Wensing, Kim, Slotine 2018, Linear Matrix Inequalities for Physically-Consistent Inertial Parameter
//! Identification, IEEE Robotics and Automation Letters 3).

use super::fault::Demand;
use crate::expr::{Function, Id, Node, Pool};
use crate::graph::Allowed;
use crate::system::Value;

/// How much of a symmetric matrix' diagonal its two halves may differ by, for those that are calculated.
const SYMMETRY: f64 = 1e-9;

/// A pivot below this part of its diagonal entry is rounding.
const PIVOT: f64 = 1e-14;

/// By how much of its size a matrix that may be singular is shifted.
const SHIFT: f64 = 1e-12;

/// How much larger than half the trace a principal moment may be, as a part of the trace: moments of three digits come
/// out so.
const MOMENT: f64 = 0.005;

/// How much R^T R may differ from the unit matrix: entries of six digits come out so.
const ORTHOGONALITY: f64 = 5e-6;

/// How far beyond its end a stop may start, which is more than gaps are closed to, m or rad.
const BEYOND: f64 = 1e-9;

/// Nothing but a size above 0 where a matrix is all zero.
const TINY: f64 = 1e-300;

const SYMMETRIC: &str = "must be symmetric";
const MAKE_SYMMETRIC: &str = "make the entries across the diagonal equal";

/// A scalar of a value with what is asked of it.
#[derive(Clone, Debug)]
pub(super) struct Condition {
    pub value: Id,
    pub is_strict: bool,
    /// Whether the scalar is the value itself, or a component of it.
    pub is_shown: bool,
    pub component: Option<char>,
    pub wanted: &'static str,
    pub help: &'static str,
    pub fault: Demand,
}

/// What is asked of a value.
pub(super) fn of(pool: &mut Pool, value: &Value, allowed: Allowed) -> Vec<Condition> {
    let is_matrix = value.0.len() == 9;
    match allowed {
        Allowed::Any => Vec::new(),
        Allowed::Determined => vec![determined(pool, value.0[0])],
        Allowed::Rotation => rotation(pool, value),
        Allowed::Fraction => fraction(pool, value.0[0]),
        Allowed::Part => part(pool, value.0[0]),
        Allowed::Clearance => vec![clearance(pool, value.0[0])],
        Allowed::Inertia if is_matrix => [symmetric_positive(pool, value), triangle(pool, value)].concat(),
        Allowed::Inertia => {
            let tensor = Value::diagonal(pool, &value.0);
            [numbers(value, allowed), triangle(pool, &tensor)].concat()
        }
        Allowed::Positive if is_matrix => symmetric_positive(pool, value),
        Allowed::NotNegative if is_matrix => {
            let wanted = "must not be negative in any direction";
            let help = "no spring pushes further away: make no eigenvalue negative";
            let mut conditions = vec![symmetric(pool, value)];
            conditions.extend(not_negative(pool, value, wanted, help));
            conditions
        }
        Allowed::Dissipative if is_matrix => dissipative(pool, value),
        Allowed::Invertible if is_matrix => {
            let mut conditions = dissipative(pool, value);
            conditions.push(invertible(pool, value));
            conditions
        }
        _ => numbers(value, allowed),
    }
}

/// Numbers above 0, or not below.
fn numbers(value: &Value, allowed: Allowed) -> Vec<Condition> {
    let (is_strict, wanted, help) = match allowed {
        Allowed::Positive | Allowed::Total | Allowed::Inertia => (true, "must be above 0", "give a value above 0"),
        Allowed::Dissipative => (
            false,
            "must not be negative",
            "to give power on purpose, write a law of its variable, `R r(f) = ...`, or a source",
        ),
        Allowed::Invertible => (
            true,
            "must be above 0, since its flow follows from its effort",
            "give a value above 0; to give power on purpose, write a law of its variable, `R r(effort e) = ...`, or a \
            source",
        ),
        _ => (false, "must not be negative", "give a value that is not negative; 0 is as if it were not there"),
    };
    let letters = ['x', 'y', 'z'].into_iter().map(|letter| (value.0.len() == 3).then_some(letter));
    let each = value.0.iter().zip(letters);
    each.map(|(&value, component)| Condition {
        value,
        is_strict,
        is_shown: true,
        component,
        wanted,
        help,
        fault: Demand::Number,
    })
    .collect()
}

/// Not below 0, not above 1.
fn fraction(pool: &mut Pool, value: Id) -> Vec<Condition> {
    let (wanted, help) = ("must be from 0 to 1", "give a value from 0, which is plastic, to 1, which takes no energy");
    let rest = pool.linear(1.0, &[(value, -1.0)]);
    let below = Condition { is_strict: false, is_shown: true, ..of_matrix(value, wanted, help) };
    let above = Condition { value: rest, is_shown: false, ..below.clone() };
    [below, above].map(|condition| Condition { fault: Demand::Stop, ..condition }).into()
}

/// Above 0 and below 1.
fn part(pool: &mut Pool, value: Id) -> Vec<Condition> {
    let (wanted, help) = ("must be above 0 and below 1", "give a value between; without a loss leave the clause out");
    let rest = pool.linear(1.0, &[(value, -1.0)]);
    let above = Condition { is_shown: true, ..of_matrix(value, wanted, help) };
    let below = Condition { value: rest, is_shown: false, ..above.clone() };
    [above, below].map(|condition| Condition { fault: Demand::Stop, ..condition }).into()
}

fn clearance(pool: &mut Pool, value: Id) -> Condition {
    let value = pool.linear(BEYOND, &[(value, 1.0)]);
    let (wanted, help) = ("must not be beyond its end", "start between the ends of the stop");
    Condition { is_strict: false, fault: Demand::Stop, ..of_matrix(value, wanted, help) }
}

fn of_matrix(value: Id, wanted: &'static str, help: &'static str) -> Condition {
    Condition { value, is_strict: true, is_shown: false, component: None, wanted, help, fault: Demand::Matrix }
}

fn symmetric(pool: &mut Pool, matrix: &Value) -> Condition {
    let sizes: Vec<(Id, f64)> = [0, 4, 8].map(|k| (pool.call(Function::Abs, &[matrix.0[k]]), SYMMETRY)).into();
    let differences = [(1, 3), (2, 6), (5, 7)].map(|(a, b)| {
        let difference = pool.sub(matrix.0[a], matrix.0[b]);
        (pool.call(Function::Abs, &[difference]), -1.0)
    });
    let value = pool.linear(0.0, &[sizes, differences.into()].concat());
    Condition { is_strict: false, ..of_matrix(value, SYMMETRIC, MAKE_SYMMETRIC) }
}

fn symmetric_positive(pool: &mut Pool, matrix: &Value) -> Vec<Condition> {
    let mut conditions = vec![symmetric(pool, matrix)];
    let help = "no store gives energy below 0: make every eigenvalue above 0";
    for (k, pivot) in pivots(pool, matrix).into_iter().enumerate() {
        let value = pool.linear(0.0, &[(pivot, 1.0), (matrix.0[4 * k], -PIVOT)]);
        conditions.push(of_matrix(value, "must be positive definite", help));
    }
    conditions
}

/// No eigenvalue of a symmetric matrix below 0.
fn not_negative(pool: &mut Pool, matrix: &Value, wanted: &'static str, help: &'static str) -> Vec<Condition> {
    let sizes: Vec<(Id, f64)> = matrix.0.iter().map(|&entry| (pool.call(Function::Abs, &[entry]), SHIFT)).collect();
    let shift = pool.linear(TINY, &sizes);
    let shifts = Value::diagonal(pool, &[shift; 3]);
    let shifted = matrix.add(pool, &shifts);
    pivots(pool, &shifted).into_iter().map(|pivot| of_matrix(pivot, wanted, help)).collect()
}

/// The symmetric part of a resistance takes no negative power.
fn dissipative(pool: &mut Pool, matrix: &Value) -> Vec<Condition> {
    let transposed = matrix.transpose();
    let part = matrix.add(pool, &transposed).scale(pool, 0.5);
    let help = "to give power on purpose, write a law of its variable, `R r(f) = ...`, or a source";
    not_negative(pool, &part, "must not give power in any direction", help)
}

/// A determinant that is not rounding beside the sizes of the rows (Hadamard's bound).
fn invertible(pool: &mut Pool, matrix: &Value) -> Condition {
    let row = |k: usize| Value(matrix.0[3 * k..3 * k + 3].to_vec());
    let normal = row(0).cross(pool, &row(1));
    let determinant = normal.dot(pool, &row(2));
    let size = pool.call(Function::Abs, &[determinant]);
    let norms = [0, 1, 2].map(|k| row(k).norm(pool));
    let bound = norms.into_iter().fold(pool.one(), |product, norm| pool.mul(product, norm));
    let value = pool.linear(0.0, &[(size, 1.0), (bound, -PIVOT)]);
    let help = "give it an inverse, or leave out the directions in which it is zero";
    of_matrix(value, "must have an inverse, since its flow follows from its effort", help)
}

/// No principal moment larger than the other two together.
fn triangle(pool: &mut Pool, tensor: &Value) -> Vec<Condition> {
    let half = 0.5 + MOMENT;
    let half = pool.linear(0.0, &[(tensor.0[0], half), (tensor.0[4], half), (tensor.0[8], half)]);
    let halves = Value::diagonal(pool, &[half; 3]);
    let opposite = tensor.negate(pool);
    let masses = halves.add(pool, &opposite);
    let wanted = "must have no principal moment larger than the other two together";
    let help = "no body has such moments: correct them, or build the body of solids";
    pivots(pool, &masses).into_iter().map(|pivot| of_matrix(pivot, wanted, help)).collect()
}

/// A pivot that is more than what is left of its terms where they cancel.
fn determined(pool: &mut Pool, pivot: Id) -> Condition {
    let terms: Vec<Id> = match pool.node(pivot) {
        Node::Sum { terms, .. } => terms.iter().map(|(term, _)| *term).collect(),
        _ => Vec::new(),
    };
    let mut parts = vec![(pool.call(Function::Abs, &[pivot]), 1.0)];
    parts.extend(terms.into_iter().map(|term| (pool.call(Function::Abs, &[term]), -PIVOT)));
    let value = pool.linear(0.0, &parts);
    let help = "change a ratio, a resistance or an inertia in it";
    of_matrix(value, "must have one solution, and for these parameters it has none or many", help)
}

fn rotation(pool: &mut Pool, matrix: &Value) -> Vec<Condition> {
    let help = "build it from `rotation_x`, `rotation_y`, `rotation_z`";
    let square = matrix.transpose().multiply(pool, matrix);
    let unit = Value::identity(pool).negate(pool);
    let excess = square.add(pool, &unit);
    let sizes: Vec<(Id, f64)> = [0, 4, 8, 1, 2, 5].map(|k| (pool.call(Function::Abs, &[excess.0[k]]), -1.0)).into();
    let orthogonal = pool.linear(ORTHOGONALITY, &sizes);
    let row = |k: usize| Value(matrix.0[3 * k..3 * k + 3].to_vec());
    let normal = row(0).cross(pool, &row(1));
    let determinant = normal.dot(pool, &row(2));
    [
        (orthogonal, "must be a rotation: its columns are not perpendicular to each other and of length 1"),
        (determinant, "must be a rotation, not a mirror image"),
    ]
    .map(|(value, wanted)| Condition { fault: Demand::Orientation, ..of_matrix(value, wanted, help) })
    .into()
}

/// The pivots of L D L^T of a symmetric matrix; only its upper half is read.
fn pivots(pool: &mut Pool, matrix: &Value) -> [Id; 3] {
    let at = |row: usize, column: usize| matrix.0[3 * row + column];
    let mut below = |from: Id, a: Id, b: Id, pivot: Id| {
        let product = pool.mul(a, b);
        let part = pool.div(product, pivot);
        pool.sub(from, part)
    };
    let first = at(0, 0);
    let second = below(at(1, 1), at(0, 1), at(0, 1), first);
    let side = below(at(1, 2), at(0, 1), at(0, 2), first);
    let third = below(at(2, 2), at(0, 2), at(0, 2), first);
    let third = below(third, side, side, second);
    [first, second, third]
}
