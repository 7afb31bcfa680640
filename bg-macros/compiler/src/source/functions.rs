//! The functions of the language, with what a reader is told of each: by an editor, the reference, near misses.
//!
//! In: a name. Out: what it takes, gives and means, with an example, which a test compiles. The rows of the reference's
//! table, `docs/language/expressions.md`, are these.

use std::fmt::{self, Display, Formatter};

/// The shape of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A number.
    Scalar,
    /// Three components.
    Vector,
    /// Three rows of three.
    Matrix,
}

/// A function of the language.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    /// Its name.
    pub name: &'static str,
    /// The names and shapes of what it takes.
    pub arguments: &'static [(&'static str, Shape)],
    /// How many of these, the last ones, may be left out.
    pub optional: usize,
    /// The shape of what it gives.
    pub gives: Shape,
    /// What it gives, in a sentence.
    pub meaning: &'static str,
    /// Which units it takes and gives.
    pub units: &'static str,
    /// The heading of the reference that says more of it.
    pub more: Option<&'static str>,
    /// A statement that uses it: an output, of what gives starts the start of a body.
    pub example: &'static str,
}

use Shape::{Matrix, Scalar, Vector};

const ONE: &[(&str, Shape)] = &[("a", Scalar)];
const TWO: (&[(&str, Shape)], Shape) = (&[("a", Scalar), ("b", Scalar)], Scalar);
const OF_VECTOR: &[(&str, Shape)] = &[("a", Vector)];
const OF_VECTORS: &[(&str, Shape)] = &[("a", Vector), ("b", Vector)];
const OF_MATRIX: &[(&str, Shape)] = &[("A", Matrix)];
const OF_A_NUMBER: &str = "a in rad, or a pure number; the result is a pure number";
const PURE: &str = "a is a pure number, and so is the result";

/// One with all its arguments.
const fn function(
    name: &'static str,
    (arguments, gives): (&'static [(&'static str, Shape)], Shape),
    meaning: &'static str,
    units: &'static str,
    example: &'static str,
) -> Function {
    Function { name, arguments, optional: 0, gives, meaning, units, more: None, example }
}

/// All functions, those that belong together side by side.
pub const FUNCTIONS: [Function; 31] = [
    function("sin", (ONE, Scalar), "The sine.", OF_A_NUMBER, "height: m = 0.4 m * sin(pin.angle);"),
    function("cos", (ONE, Scalar), "The cosine.", OF_A_NUMBER, "reach: m = 0.4 m * cos(pin.angle);"),
    function("tan", (ONE, Scalar), "The tangent.", OF_A_NUMBER, "slope: 1 = tan(pin.angle);"),
    function(
        "asin",
        (ONE, Scalar),
        "The angle whose sine is a, from -pi/2 to pi/2, rad; a is from -1 to 1.",
        PURE,
        "tilt: rad = asin(rod.x_axis.y);",
    ),
    function(
        "acos",
        (ONE, Scalar),
        "The angle whose cosine is a, from 0 to pi, rad; a is from -1 to 1.",
        PURE,
        "between: rad = acos(rod.x_axis.x);",
    ),
    function(
        "atan2",
        (&[("y", Scalar), ("x", Scalar)], Scalar),
        "The angle of the point (x, y) in one turn, from -pi to pi, rad.",
        "y and x alike; the result in rad",
        "course: rad = atan2(rod.velocity.y, rod.velocity.x);",
    ),
    Function {
        more: Some("angles-and-ways"),
        ..function(
            "unwrapped",
            (&[("y", Scalar), ("x", Scalar), ("w", Scalar)], Scalar),
            "The angle of the point (x, y) with its turns, rad, where w is its speed, or nearly. Only in a `let` and \
             in `observe`.",
            "y and x alike, w in rad/s; the result in rad",
            "turned: rad = unwrapped(rod.x_axis.y, rod.x_axis.x, pin.speed);",
        )
    },
    function("exp", (ONE, Scalar), "e to the power a.", PURE, "left: 1 = exp(-t / 0.2 s);"),
    function(
        "ln",
        (ONE, Scalar),
        "The natural logarithm; a is above 0.",
        PURE,
        "decades: 1 = ln(1 + t / 1 s) / ln(10);",
    ),
    function(
        "tanh",
        (ONE, Scalar),
        "The hyperbolic tangent: from -1 to 1, without a kink.",
        PURE,
        "side: 1 = tanh(pin.speed / 0.01 rad/s);",
    ),
    function(
        "sqrt",
        (ONE, Scalar),
        "The square root; a is not below 0.",
        "the root of that of a",
        "v: m/s = sqrt(2 * 9.81 m/s^2 * 0.4 m);",
    ),
    Function {
        more: Some("the-square-root-at-zero"),
        ..function(
            "root",
            (&[("a", Scalar), ("l", Scalar)], Scalar),
            "The square root of the magnitude of a, with the sign of a; linear where a is small beside l.",
            "a and l alike; the result has the root of that",
            "v: m/s = root(2 * 9.81 m/s^2 * rod.position.y, 0.01 m^2/s^2);",
        )
    },
    function("abs", (ONE, Scalar), "The magnitude: a without its sign.", "that of a", "speed: rad/s = abs(pin.speed);"),
    function(
        "min",
        TWO,
        "The smaller of two. Which one it is changes at an event.",
        "a and b alike; that of both",
        "pull: N = min(pin.force.x, 300 N);",
    ),
    function(
        "max",
        TWO,
        "The larger of two. Which one it is changes at an event.",
        "a and b alike; that of both",
        "push: N = max(pin.force.x, 0);",
    ),
    function(
        "pow",
        TWO,
        "a to the power b. There is no `^`.",
        "any with a whole number b, else pure numbers",
        "loss: m^3/s^3 = pow(rod.velocity.x, 3);",
    ),
    Function {
        name: "delay",
        arguments: &[("a", Scalar), ("T", Scalar), ("start", Scalar)],
        optional: 1,
        gives: Scalar,
        meaning: "What a was at the time T before; until T has passed, start, or what a is at the start. \
             In a block `every` it is what a was at the instant T before. Not in starts.",
        units: "that of a, T in s, start as a",
        more: Some("a-delay"),
        example: "late: rad/s = delay(pin.speed, 20 ms, 0);",
    },
    function(
        "integral",
        (ONE, Scalar),
        "The time integral of a since t = 0, a state of its own. Only in `observe`.",
        "that of a, times s",
        "lost: J = integral(dissipated_power);",
    ),
    function(
        "guess",
        (ONE, Scalar),
        "An unknown of the assembly, pose or velocity, first guessed as a; \
        of `[a, b, c]` one for each. Only in starts.",
        "that of a",
        "start turned rotation_z(guess(0.3));",
    ),
    function(
        "dot",
        (OF_VECTORS, Scalar),
        "The scalar product.",
        "the product",
        "power: W = dot(pin.force, rod.velocity);",
    ),
    function(
        "cross",
        (OF_VECTORS, Vector),
        "The vector product, at right angles to both.",
        "the product",
        "moment: N*m = cross(rod.end.arm, pin.force);",
    ),
    function(
        "outer",
        (OF_VECTORS, Matrix),
        "The matrix a b^T.",
        "the product",
        "pull: N*m = outer(rod.end.arm, pin.force);",
    ),
    function("norm", (OF_VECTOR, Scalar), "The length of a vector.", "that of a", "force: N = norm(pin.force);"),
    function(
        "skew",
        (OF_VECTOR, Matrix),
        "The matrix whose product with a vector b is `cross(a, b)`.",
        "that of a",
        "way: m = skew(rod.end.arm);",
    ),
    function(
        "diagonal",
        (OF_VECTOR, Matrix),
        "The matrix with a on its diagonal and zeros elsewhere.",
        "that of a",
        "forces: N = diagonal(pin.force);",
    ),
    function(
        "transpose",
        (OF_MATRIX, Matrix),
        "The matrix with rows for columns; of a rotation its inverse.",
        "that of A",
        "force: N = transpose(rod.orientation) * pin.force;",
    ),
    function(
        "inverse",
        (OF_MATRIX, Matrix),
        "The inverse of a matrix.",
        "the reciprocal of that of A",
        "eased: 1/kg/m^2 = inverse(rod.tensor);",
    ),
    function("identity", (&[], Matrix), "The unit matrix.", "any", "stretch: 1 = rod.orientation - identity();"),
    function(
        "rotation_x",
        (ONE, Matrix),
        "The rotation matrix about the x axis.",
        OF_A_NUMBER,
        "view: 1 = rotation_x(30 deg) * rod.x_axis;",
    ),
    function(
        "rotation_y",
        (ONE, Matrix),
        "The rotation matrix about the y axis.",
        OF_A_NUMBER,
        "view: 1 = rotation_y(30 deg) * rod.x_axis;",
    ),
    function(
        "rotation_z",
        (ONE, Matrix),
        "The rotation matrix about the z axis.",
        OF_A_NUMBER,
        "view: 1 = rotation_z(30 deg) * rod.x_axis;",
    ),
];

/// What is called otherwise in other languages, and how it is written in this one.
const ELSEWHERE: [(&str, &str); 10] = [
    ("atan", "atan2(a, 1)"),
    ("arctan", "atan2(a, 1)"),
    ("arcsin", "asin(a)"),
    ("arccos", "acos(a)"),
    ("log", "ln(a)"),
    ("log10", "ln(a) / ln(10)"),
    ("sign", "if a < 0 { -1 } else { 1 }"),
    ("sgn", "if a < 0 { -1 } else { 1 }"),
    ("clamp", "min(max(a, least), most)"),
    ("limit", "min(max(a, least), most)"),
];

/// What is written for a function of another language.
#[must_use]
pub fn of_elsewhere(name: &str) -> Option<&'static str> {
    ELSEWHERE.iter().find(|(known, _)| *known == name).map(|&(_, written)| written)
}

/// The function of this name.
#[must_use]
pub fn named(name: &str) -> Option<&'static Function> {
    FUNCTIONS.iter().find(|function| function.name == name)
}

impl Function {
    /// How many arguments it takes at least.
    #[must_use]
    pub const fn least(&self) -> usize {
        self.arguments.len() - self.optional
    }

    /// How it is called: `delay(a, T)`, and with all that may be left out.
    #[must_use]
    pub fn calls(&self) -> Vec<String> {
        let call = |count: usize| {
            let names: Vec<&str> = self.arguments[..count].iter().map(|(name, _)| *name).collect();
            format!("{}({})", self.name, names.join(", "))
        };
        (self.least()..=self.arguments.len()).map(call).collect()
    }
}

/// All of it as a reader without the reference sees it, in Markdown.
impl Display for Function {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { meaning, units, example, .. } = self;
        let calls = self.calls().join("\n");
        write!(f, "```text\n{calls}\n```\n\n{meaning}\n\nUnits: {units}.\n\n```text\n{example}\n```")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline;
    use crate::source::syntax::parse;

    /// What is wrong with a graph of these statements.
    fn faults(statements: &str) -> Vec<String> {
        let text = format!("graph G {{ {statements} }}");
        let compiled = parse(text.parse().expect("tokens")).and_then(|source| pipeline::models(&source));
        compiled.err().into_iter().flatten().map(|fault| fault.to_string()).collect()
    }

    #[test]
    fn examples_are_in_the_language() {
        for Function { name, example, .. } in FUNCTIONS {
            assert!(example.contains(&format!("{name}(")), "{name}");
            let (start, output) = if example.starts_with("start") { (example, "t;") } else { ("", example) };
            let faults = faults(&format!(
                "ground {{ point O = [0, 0, 0]; }}
                 body rod {{ mass 1; inertia [1, 1, 1]; point end = [1, 0, 0]; {start} }}
                 joint pin: revolute z (ground.O -> rod.end) {{ rigid; }}
                 observe {{ {output} }}"
            ));
            assert!(faults.is_empty(), "{name}: {}", faults.join("\n"));
        }
    }

    #[test]
    fn the_numbers_of_arguments_are_those_of_the_language() {
        for function in FUNCTIONS {
            for count in 0..5 {
                let call = format!("{}({})", function.name, vec!["1"; count].join(", "));
                let faults = faults(&format!("1 m: translation; I i = 1; m -> i; observe {{ value: 1 = {call} }}"));
                let is_refused = faults.iter().any(|fault| fault.contains("BG0306"));
                let is_taken = (function.least()..=function.arguments.len()).contains(&count);
                assert_eq!(is_refused, !is_taken, "{call}");
            }
        }
    }
}
