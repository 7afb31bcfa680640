//! What can be wrong with parts, their uses and repetitions.

use crate::fault::Explain;
use crate::source::library;

/// A fault of a part.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "each variant's message says what it and its fields are")]
pub enum PartFault {
    UnknownPart { name: String, near: Option<String> },
    OfRust { name: String },
    UnknownParameter { part: String, name: String, near: Option<String>, known: Vec<String> },
    GivenInside { part: String, name: String },
    ContainsItself { circle: Vec<String> },
    PortWithoutBond { of: String, ports: Vec<String> },
    NoElement { array: String, index: i64, numbers: Vec<i64> },
    NotAnArray { name: String },
    IsAnArray { name: String, first: i64, count: usize },
    NotANumber { word: String },
    EmptyRange { from: i64, to: i64 },
    TooMany { most: i64 },
    SameIndex { name: String },
    OutsideRange { parameter: String, wanted: String },
    Unused { of: String, word: &'static str, name: String },
    NothingToStart { name: String, near: Option<String> },
    StartTwice { body: String, clause: &'static str },
    NothingToWatch { name: String, near: Option<String> },
    WatchesNothing { part: String },
    Large { of: String, most: usize },
    IsAPart { name: String, outputs: Vec<String> },
    NotInPart { part: String, name: String, near: Option<String>, outputs: Vec<String> },
}

use PartFault as F;

impl Explain for PartFault {
    fn code(&self) -> &'static str {
        match self {
            F::UnknownPart { .. } | F::OfRust { .. } => "BG0801",
            F::UnknownParameter { .. } | F::GivenInside { .. } => "BG0802",
            F::ContainsItself { .. } => "BG0803",
            F::PortWithoutBond { .. } => "BG0804",
            F::NoElement { .. } => "BG0805",
            F::NotAnArray { .. } | F::IsAnArray { .. } => "BG0806",
            F::NotANumber { .. } | F::SameIndex { .. } => "BG0807",
            F::EmptyRange { .. } | F::TooMany { .. } => "BG0808",
            F::OutsideRange { .. } => "BG0810",
            F::Unused { .. } => "BG0811",
            F::NothingToStart { .. } => "BG0812",
            F::StartTwice { .. } => "BG0813",
            F::NothingToWatch { .. } | F::WatchesNothing { .. } => "BG0814",
            F::Large { .. } => "BG0815",
            F::IsAPart { .. } | F::NotInPart { .. } => "BG0816",
        }
    }

    fn message(&self) -> String {
        match self {
            F::UnknownPart { name, .. } => format!("there is no part `{name}`"),
            F::OfRust { name } => format!("the part `{name}` stands in no file here"),
            F::UnknownParameter { part, name, .. } => format!("part `{part}` has no parameter or input `{name}`"),
            F::GivenInside { part, name } => format!("part `{part}` gives `{name}` a value itself"),
            F::ContainsItself { circle } => format!("part `{}` contains itself: {}", circle[0], circle.join(" -> ")),
            F::PortWithoutBond { of, ports } => match &ports[..] {
                [port] => format!("nothing is bonded to the port `{port}` of `{of}`"),
                _ => format!("nothing is bonded to the ports {} of `{of}`", listed(ports)),
            },
            F::NoElement { array, index, numbers } => {
                format!("`{array}` has no [{index}]: its length is {}, from {}", numbers.len(), ends(numbers))
            }
            F::NotAnArray { name } => format!("`{name}` is no array"),
            F::IsAnArray { name, count, .. } => format!("`{name}` is an array of {count}"),
            F::NotANumber { word } => format!("`{word}` is no index of a repetition around it"),
            F::SameIndex { name } => format!("`{name}` is the index of two repetitions, one inside of the other"),
            F::EmptyRange { from, to } => format!("there is no number from {from} up to {to}, not included"),
            F::TooMany { most } => format!("more than {most} repetitions"),
            F::OutsideRange { parameter, wanted } => format!("{parameter} must be {wanted}"),
            F::Unused { of, word, name } => format!("nothing in {of} uses its {word} `{name}`"),
            F::NothingToStart { name, .. } => format!("there is no body `{name}` to start, and no point of this name"),
            F::StartTwice { body, clause } => format!("`start {clause}` of `{body}` is given twice"),
            F::NothingToWatch { name, .. } => format!("nothing is called `{name}`"),
            F::WatchesNothing { part } => format!("part `{part}` has no `observe`, so that there is nothing to watch"),
            F::IsAPart { name, .. } => format!("`{name}` is a part, not a value"),
            F::NotInPart { part, name, .. } => format!("the part `{part}` has no `{name}`"),
            F::Large { of, most } => {
                format!("{of} has more than {most} statements, with its repetitions and parts written out")
            }
        }
    }

    fn help(&self) -> String {
        match self {
            F::UnknownPart { near: Some(near), .. }
            | F::NotInPart { near: Some(near), .. }
            | F::UnknownParameter { near: Some(near), .. }
            | F::NothingToStart { near: Some(near), .. }
            | F::NothingToWatch { near: Some(near), .. } => format!("did you mean `{near}`?"),
            F::UnknownPart { name, .. } if let Some(library) = library::home(name) => {
                format!("write `use {library};` above it: it is a part of the library")
            }
            F::UnknownPart { name, .. } if name.contains("::") => "write the path of a `pub part`".to_owned(),
            F::OfRust { .. } => "write the part into a file: a text cannot use parts of a Rust crate".to_owned(),
            F::UnknownPart { name, .. } => {
                format!("declare `part {name} {{ ... }}`, or write the path of a part of elsewhere, `self::{name}`")
            }
            F::UnknownParameter { part, known, .. } if library::home(part).is_some() && !known.is_empty() => {
                format!("write one of those that this part of the library has: {}", listed(known))
            }
            F::UnknownParameter { name, known, .. } if known.is_empty() => {
                format!("remove `{name}`, or declare `param {name}` in the part")
            }
            F::UnknownParameter { name, known, .. } => {
                format!("declare `param {name}` in the part, or write one of those that it has: {}", listed(known))
            }
            F::GivenInside { name, .. } => format!("remove `{name}`, or make it a parameter of the part"),
            F::ContainsItself { .. } => "take one of the uses out".to_owned(),
            F::PortWithoutBond { of, ports } => format!("bond it, `{of}.{} -> ...;`", ports[0]),
            F::NoElement { .. } => "change the number, or the range of the index".to_owned(),
            F::NotAnArray { name } => format!("remove the brackets; a component of a vector is `{name}.x`"),
            F::IsAnArray { name, first, .. } => format!("say which one, such as `{name}[{first}]`"),
            F::NotANumber { .. } => {
                "write a whole number, or put the statement into `for i in 0..20 { ... }`".to_owned()
            }
            F::SameIndex { .. } => "give one of them another name".to_owned(),
            F::EmptyRange { .. } => "write the smaller number first: `0..20` are the numbers from 0 to 19".to_owned(),
            F::TooMany { .. } => "make the range smaller".to_owned(),
            F::OutsideRange { .. } => "change the value".to_owned(),
            F::Unused { .. } => "remove it, or use it".to_owned(),
            F::NothingToStart { .. } => "write the path of a body, or of a point of it".to_owned(),
            F::StartTwice { .. } => "remove one of the two".to_owned(),
            F::NothingToWatch { .. } => "write the path of a part, body, joint or element".to_owned(),
            F::IsAPart { name, outputs } | F::NotInPart { part: name, outputs, .. } => match &outputs[..] {
                [] => format!("write the path of something in it, such as `{name}.NAME.flow`"),
                [one] => format!("write its output, `{one}`"),
                several => format!("write one of its outputs: {}", listed(several)),
            },
            F::Large { .. } => {
                "make it smaller; where a text is loaded, a larger `--limit-statements` allows it".to_owned()
            }
            F::WatchesNothing { .. } => "name what to watch, or give the part an `observe { ... }`".to_owned(),
        }
    }
}

fn listed(names: &[String]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// The first and the last of an array's numbers.
fn ends(numbers: &[i64]) -> String {
    match numbers {
        [first, .., last] => format!("{first} to {last}"),
        [only] => format!("{only} to {only}"),
        [] => "none".to_owned(),
    }
}
