//! The language's words, and texts that are made of them in no order.

use fastrand::Rng;

use super::draw::{EXTREMES, one, rarely};
use super::lexemes::joined;

/// Words that begin a statement or a clause.
const STATEMENTS: [&str; 62] = [
    "part",
    "port",
    "for",
    "all",
    "but",
    "graph",
    "pub",
    "param",
    "input",
    "let",
    "observe",
    "scene",
    "ground",
    "gravity",
    "body",
    "joint",
    "spring",
    "drive",
    "contact",
    "position",
    "orientation",
    "close",
    "point",
    "start",
    "tune",
    "without",
    "rigid",
    "expect",
    "angles",
    "joints",
    "planar",
    "states",
    "cuboid",
    "cylinder",
    "sphere",
    "mass",
    "inertia",
    "center",
    "density",
    "stiffness",
    "damping",
    "tilt",
    "frame",
    "inertial",
    "length",
    "radius",
    "along",
    "on",
    "of",
    "at",
    "in",
    "turned",
    "velocity",
    "spin",
    "above",
    "least",
    "friction",
    "stop",
    "orifice",
    "coulomb",
    "static",
    "holds",
];

/// Symbols of elements, kinds of joints and drives, domains, axes, roles.
const SYMBOLS: [&str; 39] = [
    "Se",
    "Sf",
    "I",
    "C",
    "R",
    "TF",
    "GY",
    "MSe",
    "MSf",
    "rSe",
    "MTF",
    "MGY",
    "MR",
    "0",
    "1",
    "revolute",
    "prismatic",
    "spherical",
    "cylindrical",
    "universal",
    "fixed",
    "torque",
    "force",
    "speed",
    "translation",
    "rotation",
    "electrical",
    "hydraulic",
    "thermal",
    "x",
    "y",
    "z",
    "effort",
    "flow",
    "energy",
    "power",
    "p",
    "q",
    "most",
];

/// Functions and quantities of expressions.
const FUNCTIONS: [&str; 33] = [
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "exp",
    "ln",
    "tanh",
    "atan2",
    "sqrt",
    "abs",
    "pow",
    "dot",
    "cross",
    "outer",
    "norm",
    "skew",
    "diagonal",
    "transpose",
    "inverse",
    "identity",
    "rotation_x",
    "rotation_y",
    "rotation_z",
    "guess",
    "integral",
    "t",
    "stored_energy",
    "supplied_power",
    "dissipated_power",
    "if",
    "else",
    "position",
];

/// Units, and names that the texts use again and again.
const NAMES: [&str; 32] = [
    "kg", "m", "s", "A", "K", "N", "V", "Ohm", "rad", "J", "W", "Pa", "a", "b", "j", "k", "rod", "pin", "end", "G",
    "S", "shaft", "ground", "_", "self", "fn", "r#type", "α", "Ω", "中", "x1", "below",
];

/// Marks and brackets.
const MARKS: [&str; 34] = [
    ";", ",", ":", "=", ".", "+", "-", "*", "/", "^", "->", "<", "<=", ">", ">=", "==", "!=", "(", ")", "[", "]", "{",
    "}", "(", ")", "[", "]", "{", "}", "#", "|", "?", "\"text\"", "'a'",
];

/// A lexeme of the language, or one that it does not have.
pub(super) fn lexeme(rng: &mut Rng) -> String {
    let tables: [&[&str]; 6] = [&STATEMENTS, &SYMBOLS, &FUNCTIONS, &NAMES, &MARKS, &EXTREMES];
    let table = [0, 1, 2, 3, 3, 4, 4, 4, 5][rng.usize(..9)];
    one(rng, tables[table]).to_owned()
}

/// Lexemes in no order, mostly inside a graph, sometimes with a statement's head in front.
pub(super) fn disorder(rng: &mut Rng) -> String {
    let mut lexemes: Vec<String> = Vec::new();
    let inside = !rarely(rng, 8);
    if inside {
        lexemes.extend(["graph", "G", "{"].map(str::to_owned));
    }
    for _ in 0..rng.usize(..12) {
        lexemes.extend(head(rng));
        let length = if rarely(rng, 50) { 200 } else { 12 };
        lexemes.extend((0..rng.usize(..length)).map(|_| lexeme(rng)));
        lexemes.push(";".to_owned());
    }
    joined(&lexemes)
}

/// How a statement begins, so that what follows is read as one.
fn head(rng: &mut Rng) -> Vec<String> {
    let heads = [
        "",
        "",
        "param a : m =",
        "input b :",
        "let c =",
        "1 j",
        "0 k",
        "R r =",
        "C c ( q ) =",
        "I i =",
        "Se s =",
        "TF n =",
        "j -> ",
        "observe {",
        "scene A {",
        "body rod {",
        "joint pin : revolute z ( ground -> rod ) {",
        "spring coil ( ground -> rod ) {",
        "drive push on rod",
        "contact cut ( ground -> rod along x ) {",
        "position x of j",
        "close gap =",
        "gravity",
        "ground { point O =",
        "/// text\n param d : 1",
    ];
    one(rng, &heads).split(' ').filter(|word| !word.is_empty()).map(str::to_owned).collect()
}
