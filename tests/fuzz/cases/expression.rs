//! Random scalar expressions whose units always fit.
//!
//! In: the names that may stand in it. Out: a text. Every name is multiplied by a bare number, so that the product
//! takes any unit and the expression gets through to the stages after the check of units.

use fastrand::Rng;

use super::draw::{number, one};

/// A scalar expression at most so deep, times a number.
pub(super) fn scalar(rng: &mut Rng, names: &[String], depth: u32) -> String {
    format!("{} * ({})", one(rng, &["1", "2", "-1", "0.5", "1e-3"]), inner(rng, names, depth))
}

fn inner(rng: &mut Rng, names: &[String], depth: u32) -> String {
    if depth == 0 || rng.u32(..5) == 0 {
        return leaf(rng, names);
    }
    let (a, b) = (inner(rng, names, depth - 1), inner(rng, names, depth - 1));
    match rng.u32(..14) {
        0..=2 => format!("({a} + {b})"),
        3 | 4 => format!("({a} - {b})"),
        5..=7 => format!("{a} * {b}"),
        8 => format!("{a} / {b}"),
        9 => format!("-{a}"),
        10 | 11 => call(rng, &a, &b),
        12 => format!("if {a} {} {b} {{ {} }} else {{ {b} }}", one(rng, &["<", "<=", ">", ">="]), leaf(rng, names)),
        _ => vectors(rng, &a, &b),
    }
}

fn leaf(rng: &mut Rng, names: &[String]) -> String {
    let value = number(rng);
    match rng.choice(names) {
        Some(name) if rng.u32(..4) > 0 => format!("{value} * {name}"),
        _ => value,
    }
}

/// A function of scalars.
fn call(rng: &mut Rng, a: &str, b: &str) -> String {
    const ONE: [&str; 10] = ["sin", "cos", "tan", "asin", "acos", "exp", "ln", "tanh", "sqrt", "abs"];
    match rng.u32(..6) {
        0 => format!("atan2({a}, {b})"),
        1 => format!("pow({a}, {})", one(rng, &["2", "3", "-1", "16", "-16", "0", "0.5", "17", "1e9"])),
        2 => format!("pow({a}, {b})"),
        _ => format!("{}({a})", one(rng, &ONE)),
    }
}

/// A scalar by way of vectors and matrices.
fn vectors(rng: &mut Rng, a: &str, b: &str) -> String {
    match rng.u32(..4) {
        0 => format!("norm([{a}, 1, {b}])"),
        1 => format!("dot([{a}, 0, 2], inverse(rotation_x({b})) * [1, {b}, 3])"),
        2 => format!("dot(cross([{a}, 1, 2], [{b}, 2, 3]), outer([1, 2, 3], [{a}, 0, 1]) * [1, 0, 1])"),
        _ => format!("norm((skew([{a}, {b}, 1]) + transpose(diagonal([1, 2, {a}])) * identity()) * [{b}, 1, 0])"),
    }
}
