//! The words and symbols of the language that stand for one value each, for the parser and the printer alike.

use crate::source::ast::{
    Axis, Between, Beyond, BinaryOperator, Comparison, DriveKind, ElementKind, Role, StartKind, TrackKind,
};

/// The elements' symbols.
pub(crate) const ELEMENTS: [(&str, ElementKind); 13] = [
    ("Se", ElementKind::Se),
    ("Sf", ElementKind::Sf),
    ("I", ElementKind::I),
    ("C", ElementKind::C),
    ("R", ElementKind::R),
    ("TF", ElementKind::Tf),
    ("GY", ElementKind::Gy),
    ("MSe", ElementKind::MSe),
    ("MSf", ElementKind::MSf),
    ("rSe", ElementKind::RSe),
    ("MTF", ElementKind::Mtf),
    ("MGY", ElementKind::Mgy),
    ("MR", ElementKind::Mr),
];

/// The axes' letters.
pub(crate) const AXES: [(&str, Axis); 3] = [("x", Axis::X), ("y", Axis::Y), ("z", Axis::Z)];

/// What a drive prescribes.
pub(crate) const DRIVES: [(&str, DriveKind); 3] =
    [("torque", DriveKind::Torque), ("force", DriveKind::Force), ("speed", DriveKind::Speed)];

/// What a table is between its points.
pub(crate) const BETWEEN: [(&str, Between); 3] =
    [("straight", Between::Straight), ("monotone", Between::Monotone), ("spline", Between::Spline)];

/// What a table is beyond its points, where that is said.
pub(crate) const BEYOND: [(&str, Beyond); 3] =
    [("held", Beyond::Held), ("continued", Beyond::Continued), ("periodic", Beyond::Periodic)];

/// What follows the name of a table in a call that asks for a derivative, with its order.
pub(crate) const DERIVATIVES: [(&str, usize); 2] = [("derivative", 1), ("second_derivative", 2)];

/// The name of the table in the name of a called function, and the order of the derivative that is asked for.
pub(crate) fn table_called(function: &str) -> (&str, usize) {
    let of_order = |(word, order): (&str, usize)| Some((function.strip_suffix(word)?.strip_suffix('.')?, order));
    DERIVATIVES.into_iter().find_map(of_order).unwrap_or((function, 0))
}

/// What a track follows.
pub(crate) const TRACKS: [(&str, TrackKind); 2] =
    [("position", TrackKind::Position), ("orientation", TrackKind::Orientation)];

/// What is given of a body's start.
pub(crate) const STARTS: [(&str, StartKind); 4] = [
    ("at", StartKind::Place),
    ("turned", StartKind::Orientation),
    ("velocity", StartKind::Velocity),
    ("spin", StartKind::Spin),
];

/// What has a name of its own in every graph.
pub(crate) const QUANTITIES: [&str; 5] = ["t", "stored_energy", "supplied_power", "dissipated_power", "gravity_field"];

/// The inertial frame's name, of which a graph has one.
pub(crate) const GROUND: &str = "ground";

/// The roles of a law's variable.
pub(crate) const ROLES: [(&str, Role); 2] = [("effort", Role::Effort), ("flow", Role::Flow)];

/// The comparisons of an `if`.
pub(crate) const COMPARISONS: [(&str, Comparison); 4] = [
    ("<", Comparison::Less),
    ("<=", Comparison::LessOrEqual),
    (">", Comparison::Greater),
    (">=", Comparison::GreaterOrEqual),
];

/// The binary operators.
pub(crate) const OPERATORS: [(&str, BinaryOperator); 4] = [
    ("+", BinaryOperator::Add),
    ("-", BinaryOperator::Subtract),
    ("*", BinaryOperator::Multiply),
    ("/", BinaryOperator::Divide),
];

/// How strongly an operator binds: products before sums; all of them group to the left.
pub(crate) const fn strength(operator: BinaryOperator) -> u8 {
    match operator {
        BinaryOperator::Add | BinaryOperator::Subtract => 1,
        BinaryOperator::Multiply | BinaryOperator::Divide => 2,
    }
}

/// The value that `word` stands for in `table`.
pub(crate) fn value_of<T: Copy>(table: &[(&str, T)], word: &str) -> Option<T> {
    table.iter().find(|(known, _)| *known == word).map(|&(_, value)| value)
}

/// The word of `value`, which its table lists.
pub(crate) fn word_of<T: PartialEq>(table: &[(&'static str, T)], value: &T) -> &'static str {
    table.iter().find(|(_, listed)| listed == value).map_or("?", |(word, _)| word)
}
