//! What can be wrong with the names, ports, cardinalities, shapes and units of a graph.

use super::Shape;
use crate::fault::Explain;
use crate::graph::units::{Dimension, Domain};
use crate::source::functions::{self, FUNCTIONS};
use crate::source::numbers::{Constant, constant};

/// A fault of the resolution.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "each variant's message says what it and its fields are")]
pub enum GraphFault {
    Reserved { name: String },
    UnknownName { name: String, near: Option<String> },
    UnknownFunction { name: String, near: Option<String> },
    UnknownDomain { name: String, near: Option<String> },
    ArgumentCount { function: String, expected: usize, found: usize },
    NotANode { name: String },
    NotAValue { name: String },
    OnePortBonds { symbol: &'static str, name: String, count: usize },
    TwoPortBonds { symbol: &'static str, name: String, inward: usize, outward: usize },
    NoBond { name: String },
    Cardinality { from: String, from_cardinality: usize, to: String, to_cardinality: usize },
    SelfBond { name: String },
    Shapes { what: &'static str, left: Shape, right: Shape },
    ShapeOf { what: String, expected: Shape, found: Shape },
    VectorLength { found: usize },
    NoComponent { found: Shape },
    Units { what: String, left: Dimension, right: Dimension },
    UnitOf { what: String, expected: Dimension, found: Dimension },
    Domains { from: String, to: String, left: Domain, right: Domain },
    NotDimensionless { what: String, found: Dimension },
    NoRoot { found: Dimension },
    UnknownUnits { from: String, to: String, declaration: Option<String> },
    LawUnit { symbol: &'static str, name: String, found: Dimension, expected: Vec<Dimension> },
    NumberForC { name: String },
    Modulated { symbol: &'static str, name: String, by: String },
    NotConstant { what: String, by: String },
    LetCycle { name: String },
    TrackOfNoJunction { track: String, junction: String },
    NotStorage { name: String, clause: &'static str },
    RangeEmpty { name: String },
    DefaultOutOfRange { name: String },
    NotANumber { what: String, constant: Option<&'static Constant> },
    GuessOutsideStart,
    IntegralOutsideObserve,
    UnwrappedElsewhere,
    VariableRole { name: String, symbol: &'static str },
    EmptyGraph { name: String },
    Decay,
    UnitOrName { unit: String, symbol: String },
    TablePoint { name: String },
    TableOrder { name: String },
    TableSize { name: String, found: usize, most: usize },
    TablePeriod { name: String },
    TableRow { name: String, found: usize, expected: usize },
    TableOfTwo { name: String, word: &'static str },
    TableWithoutArgument { name: String },
    EveryEmpty,
    LastOutside { sample: String },
    SampleCycle { name: String },
    DelayAtStart,
    DelayTime { clock: String, most: f64 },
}

use GraphFault as F;

/// The codes of what is wrong with the bonds that are there, or are missing.
pub const OF_BONDS: [&str; 5] = ["BG0308", "BG0309", "BG0310", "BG0319", "BG0333"];

impl Explain for GraphFault {
    fn code(&self) -> &'static str {
        match self {
            F::UnknownName { .. } => "BG0303",
            F::UnknownFunction { .. } => "BG0304",
            F::UnknownDomain { .. } => "BG0305",
            F::ArgumentCount { .. } => "BG0306",
            F::NotANode { .. } => "BG0307",
            F::OnePortBonds { .. } => "BG0308",
            F::TwoPortBonds { .. } => "BG0309",
            F::NoBond { .. } => "BG0310",
            F::Cardinality { .. } => "BG0311",
            F::SelfBond { .. } => "BG0312",
            F::Shapes { .. } => "BG0313",
            F::ShapeOf { .. } | F::VectorLength { .. } => "BG0314",
            F::NoComponent { .. } => "BG0315",
            F::Units { .. } | F::UnitOf { .. } | F::Domains { .. } => "BG0316",
            F::NotDimensionless { .. } => "BG0317",
            F::NoRoot { .. } => "BG0318",
            F::UnknownUnits { .. } => "BG0319",
            F::LawUnit { .. } => "BG0320",
            F::NumberForC { .. } => "BG0321",
            F::Modulated { .. } => "BG0322",
            F::NotConstant { .. } => "BG0323",
            F::LetCycle { .. } => "BG0324",
            F::TrackOfNoJunction { .. } => "BG0325",
            F::NotStorage { .. } => "BG0326",
            F::RangeEmpty { .. } => "BG0327",
            F::DefaultOutOfRange { .. } => "BG0328",
            F::NotANumber { .. } => "BG0329",
            F::GuessOutsideStart => "BG0330",
            F::IntegralOutsideObserve => "BG0331",
            F::UnwrappedElsewhere => "BG0336",
            F::VariableRole { .. } => "BG0332",
            F::EmptyGraph { .. } => "BG0333",
            F::Reserved { .. } => "BG0334",
            F::Decay => "BG0335",
            F::NotAValue { .. } => "BG0337",
            F::UnitOrName { .. } => "BG0338",
            F::TablePoint { .. }
            | F::TableOrder { .. }
            | F::TableSize { .. }
            | F::TablePeriod { .. }
            | F::TableRow { .. } => "BG0339",
            F::TableOfTwo { .. } => "BG0341",
            F::TableWithoutArgument { .. } => "BG0340",
            F::EveryEmpty => "BG0342",
            F::LastOutside { .. } => "BG0343",
            F::SampleCycle { .. } => "BG0344",
            F::DelayAtStart | F::DelayTime { .. } => "BG0345",
        }
    }

    fn message(&self) -> String {
        match self {
            F::Reserved { name } => format!("`{name}` is the time"),
            F::UnknownName { name, .. } => format!("nothing is called `{name}`"),
            F::UnknownFunction { name, .. } => format!("there is no function `{name}`"),
            F::UnknownDomain { name, .. } => format!("there is no energy domain `{name}`"),
            F::ArgumentCount { function, expected, found } => {
                let s = if *expected == 1 { "" } else { "s" };
                format!("`{function}` takes {expected} argument{s}, not {found}")
            }
            F::NotANode { name } => format!("`{name}` is neither a junction nor an element, so no bond can end at it"),
            F::NotAValue { name } => format!("`{name}` is a junction or an element, which has no value of its own"),
            F::OnePortBonds { symbol, name, count } => format!("{symbol} `{name}` has one port but {count} bonds"),
            F::TwoPortBonds { symbol, name, inward, outward } => {
                format!("{symbol} `{name}` needs one half arrow in and one out; it has {inward} in and {outward} out")
            }
            F::NoBond { name } => format!("no bond ends at `{name}`"),
            F::Cardinality { from, from_cardinality, to, to_cardinality } => format!(
                "the bond joins `{from}` of cardinality {from_cardinality} to `{to}` of cardinality {to_cardinality}"
            ),
            F::SelfBond { name } => format!("the bond joins `{name}` to itself"),
            F::Shapes { what, left, right } => format!("cannot {what} a {left} and a {right}"),
            F::ShapeOf { what, expected, found } => format!("{what} must be a {expected}; this is a {found}"),
            F::VectorLength { found } => format!("a vector has three components; this one has {found}"),
            F::NoComponent { found } => format!("a {found} has no component x, y or z"),
            F::Units { what, left, right } => format!("{what}: the units {left} and {right} disagree"),
            F::UnitOf { what, expected, found } => {
                format!("{what} is {}, not {}", in_unit(*found), in_unit(*expected))
            }
            F::Domains { from, to, left, right } => format!(
                "bonds join `{from}` to `{to}` without a two-port: {} is not {}, the units {} and {} disagree",
                left.name, right.name, left.effort, right.effort
            ),
            F::NotDimensionless { what, found } => format!("{what} must be a pure number; this has unit {found}"),
            F::NoRoot { found } => {
                format!("the square root of a quantity in {found} has no unit: exponents are whole or half")
            }
            F::UnknownUnits { from, to, .. } => {
                format!("nothing fixes the units of effort and flow on the bond `{from}` -> `{to}`")
            }
            F::LawUnit { symbol, name, found, expected } => format!(
                "the law of {symbol} `{name}` has unit {found}; its bond asks for {}",
                expected.iter().map(ToString::to_string).collect::<Vec<_>>().join(" or ")
            ),
            F::NumberForC { name } => {
                format!("the bare number of C `{name}` may be a stiffness or a compliance")
            }
            F::Modulated { symbol, name, by } => format!("{symbol} `{name}` is modulated by {by}"),
            F::NotConstant { what, by } => format!("{what} depends on {by}"),
            F::LetCycle { name } => format!("`{name}` is defined by itself"),
            F::TrackOfNoJunction { track, junction } => {
                format!("`{track}` follows `{junction}`, which is no 1-junction of cardinality 3")
            }
            F::NotStorage { name, clause } => format!("`{name}` cannot have the clause `{clause}`"),
            F::RangeEmpty { name } => format!("no value of `{name}` is allowed by its range"),
            F::DefaultOutOfRange { name } => format!("the default of `{name}` is outside its range"),
            F::NotANumber { what, .. } => format!("{what} must be made of numbers only"),
            F::GuessOutsideStart => "`guess` has a meaning only in a start value".to_owned(),
            F::IntegralOutsideObserve => "`integral` has a meaning only in an observed output".to_owned(),
            F::UnwrappedElsewhere => "`unwrapped` has a meaning only in a `let` and in an observed output".to_owned(),
            F::VariableRole { name, symbol } => format!("the law of {symbol} `{name}` cannot be of that variable"),
            F::EmptyGraph { name } => format!("graph `{name}` has no bond"),
            F::TablePoint { name } => format!("a point of the table `{name}` is no pair of numbers"),
            F::TableOrder { name } => {
                format!("the arguments of the table `{name}` do not ascend: this one is not above the one before")
            }
            F::TableSize { name, found, most } => {
                format!("the table `{name}` has {found} points; a table has at least 2 and at most {most}")
            }
            F::TablePeriod { name } => {
                format!("the periodic table `{name}` does not end as it begins: its last value is not its first one")
            }
            F::TableRow { name, found, expected } => {
                format!("a row of the table `{name}` has {found} numbers; with its first argument it has {expected}")
            }
            F::TableOfTwo { name, word } => format!("the table `{name}` of two arguments cannot have a `{word}`"),
            F::TableWithoutArgument { name } => format!("`{name}` is a table, whose value needs an argument"),
            F::EveryEmpty => "this `every` computes nothing".to_owned(),
            F::LastOutside { sample } => {
                format!("`{sample}.last` is what was held before an instant, which only a block `every` knows")
            }
            F::SampleCycle { name } => format!("the sample `{name}` depends on its own value at the same instant"),
            F::DelayAtStart => "a start has no past, so there is nothing that a `delay` could give".to_owned(),
            F::DelayTime { clock, most } => {
                format!(
                    "the time of a `delay` is 1 to {most} times that of its block, `{clock}`, both written as numbers"
                )
            }
            F::UnitOrName { unit, symbol } => {
                format!("`{symbol}` in `{unit}` is a unit, and there is something of this name")
            }
            F::Decay => "the rate of `baumgarte` must be a number above 0, in 1/s".to_owned(),
        }
    }

    fn help(&self) -> String {
        match self {
            F::Reserved { .. } => "give it another name".to_owned(),
            F::UnknownName { name, near: Some(near) } if constant(name).is_none() => format!("did you mean `{near}`?"),
            F::UnknownFunction { near: Some(near), .. } => {
                format!("did you mean `{near}`?")
            }
            F::UnknownName { name, .. } => match constant(name) {
                Some(constant) => constant.written(),
                None => format!("declare `{name}`"),
            },
            F::UnknownFunction { .. } => {
                format!("use one of {}", FUNCTIONS.map(|function| function.name).join(" "))
            }
            F::UnknownDomain { near: Some(near), .. } => format!("did you mean `{near}`?"),
            F::UnknownDomain { .. } => {
                let names: Vec<_> = crate::graph::units::DOMAINS.iter().map(|domain| domain.name).collect();
                format!("use one of {}", names.join(" "))
            }
            F::ArgumentCount { function, expected, .. } => match functions::named(function) {
                Some(function) => format!("write {}", quoted(&function.calls())),
                None => format!("give it {expected}"),
            },
            F::NotANode { .. } => "name a junction or an element".to_owned(),
            F::NotAValue { name } => format!("write `{name}.flow` or `{name}.effort`"),
            F::OnePortBonds { name, count: 0, .. } | F::NoBond { name } => {
                format!("bond `{name}` to a junction, `... -> {name};`, or delete it")
            }
            F::OnePortBonds { .. } => "put a junction in between and bond the others to that".to_owned(),
            F::TwoPortBonds { name, .. } => format!("write it inside one chain, `a -> {name} -> b;`"),
            F::Cardinality { .. } => {
                "make the junctions alike, or put a TF in between that maps the flows, `TF t(v) = dot(n, v);`"
                    .to_owned()
            }
            F::SelfBond { .. } => "end it at another node".to_owned(),
            F::Shapes { what: "multiply", .. } => "use `dot`, `cross` or `outer` for two vectors".to_owned(),
            F::Shapes { .. } => "make them alike".to_owned(),
            F::ShapeOf { expected, .. } => match expected {
                Shape::Scalar => "write a scalar, or take a component such as `.x`".to_owned(),
                Shape::Vector => "write `[x, y, z]`".to_owned(),
                Shape::Matrix => "write its three rows, `[[..], [..], [..]]`, or use a rotation".to_owned(),
            },
            F::VectorLength { .. } => "write `[x, y, z]`, with 0 for a component that is not there".to_owned(),
            F::NoComponent { .. } => "take components of vectors only".to_owned(),
            F::TablePoint { .. } => "write each point as `[argument, value]`".to_owned(),
            F::TableOrder { .. } => "put the points in the order of their arguments, each argument once".to_owned(),
            F::TableSize { found, most, .. } if found > most => {
                "leave points out where the curve is nearly straight".to_owned()
            }
            F::TableSize { .. } => "write at least two points, `[[0, 1], [2, 3]]`".to_owned(),
            F::TableRow { .. } => {
                "write a row of the second arguments, then rows of a first one with its values: `[[y1, y2], [x1, v11, \
                v12], ..]`"
                    .to_owned()
            }
            F::TableOfTwo { word: "monotone", .. } => "write `spline`, or leave the word out for straight \
                lines"
                .to_owned(),
            F::TableOfTwo { word: "periodic", .. } => "write `held` or `continued`".to_owned(),
            F::TableOfTwo { .. } => "use its values at two places".to_owned(),
            F::TablePeriod { .. } => {
                "add the point at which the next period begins, with the first value again; three points at least"
                    .to_owned()
            }
            F::TableWithoutArgument { name } => format!("write `{name}(..)` with the argument in the parentheses"),
            F::EveryEmpty => "write `sample NAME: UNIT = VALUE;` into its braces".to_owned(),
            F::LastOutside { sample } => format!("write `{sample}`, which is held until the next instant"),
            F::SampleCycle { name } => format!("write `{name}.last` for its value before the instant"),
            F::DelayAtStart => {
                "write the value that the signal has before the run; `delay(SIGNAL, TIME, START)` takes it \
                too"
                .to_owned()
            }
            F::DelayTime { .. } => "write a multiple of it, such as `delay(x, 20 ms)` in `every 1 ms`".to_owned(),
            F::UnitOrName { symbol, .. } => {
                format!("write `({symbol})` if you mean that, or rename it if you mean the unit")
            }
            F::Units { .. } => "change one of the two so that they agree".to_owned(),
            F::UnitOf { expected, .. } => {
                let value = if *expected == Dimension::NONE { "" } else { "a value " };
                format!("write {value}{}, or declare the unit that it has", in_unit(*expected))
            }
            F::Domains { from, to, left, right } => {
                let (effort, flow) = (left.effort_dimension(), Dimension::WATT.per(right.effort_dimension()));
                let ratio = flow.per(Dimension::WATT.per(effort));
                format!(
                    "put a GY between them, effort of the one by flow of the other, `GY g = E; \
                     {from} -> g -> {to};` with E in {}, or a TF, flow by flow, with E in {ratio}",
                    effort.per(flow)
                )
            }
            F::NotDimensionless { .. } => "divide by a reference quantity of the same unit".to_owned(),
            F::NoRoot { .. } => "take the root of a quantity whose unit has whole exponents".to_owned(),
            F::UnknownUnits { declaration: Some(declaration), .. } => {
                format!("where the junction is declared, name its domain, such as `{declaration}: rotation`")
            }
            F::UnknownUnits { from, to, .. } => format!(
                "put a junction with a domain between them, such as `1 between: rotation; {from} -> between -> {to};`"
            ),
            F::LawUnit { expected, .. } => {
                format!("give a value in {}", expected.first().map_or_else(String::new, ToString::to_string))
            }
            F::NumberForC { .. } => "use a parameter with its unit".to_owned(),
            F::Modulated { symbol, name, .. } => format!("write `M{symbol} {name}`"),
            F::NotConstant { .. } => "use parameters and numbers only".to_owned(),
            F::LetCycle { .. } => "break the circle".to_owned(),
            F::TrackOfNoJunction { .. } => "follow a `1 NAME[3]` junction".to_owned(),
            F::NotStorage { clause, .. } => format!("remove `{clause}`"),
            F::RangeEmpty { .. } => "swap or widen the ends".to_owned(),
            F::DefaultOutOfRange { .. } => "change the default or the range".to_owned(),
            F::NotANumber { constant: Some(constant), .. } => constant.written(),
            F::NotANumber { .. } => "write a number".to_owned(),
            F::GuessOutsideStart => "write the value itself".to_owned(),
            F::UnwrappedElsewhere => "name it, `let turned = unwrapped(..);`, and use that name here".to_owned(),
            F::IntegralOutsideObserve => "observe the integral, or use a C or I for a state".to_owned(),
            F::VariableRole { .. } => {
                "leave `effort` or `flow` away: a C's law is of its displacement, an I's of its momentum".to_owned()
            }
            F::Decay => "write for example `baumgarte 50;`".to_owned(),
            F::EmptyGraph { .. } => "bond its elements in a chain, `a -> b;`".to_owned(),
        }
    }
}

/// What has this dimension, as a sentence says it of a value.
fn in_unit(dimension: Dimension) -> String {
    if dimension == Dimension::NONE { "a pure number".to_owned() } else { format!("in {dimension}") }
}

/// Codes between which a reader chooses.
fn quoted(codes: &[String]) -> String {
    codes.iter().map(|code| format!("`{code}`")).collect::<Vec<_>>().join(" or ")
}
