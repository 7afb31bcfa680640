//! What a user can write that is no sentence of the language.

use super::statement::OPERATOR;
use crate::fault::{Explain, near_miss};

/// More words than a help line can list to advantage.
const MANY: usize = 10;

/// How many of them it lists instead; the table of a graph's words begins with as many typical ones.
const SEVERAL: usize = 5;

/// A fault of syntax.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SyntaxFault {
    /// A statement begins with a word that begins none.
    UnknownStatement {
        /// Where it stands: `a graph`, `a scene`.
        place: &'static str,
        /// The word.
        word: String,
        /// The words that begin a statement there.
        known: &'static [&'static str],
    },
    /// A token that cannot stand where it does.
    Unexpected {
        /// The token.
        found: String,
        /// What could stand there; the likeliest first.
        expected: String,
    },
    /// The components of a vector without its brackets.
    BareVector,
    /// A word after a number that is no unit, but nearly.
    UnitOfNumber {
        /// The number.
        number: String,
        /// The word.
        word: String,
        /// The unit that may be meant.
        unit: &'static str,
    },
    /// A start of the displacement of a junction.
    StartOfDisplacement {
        /// The displacement.
        name: String,
    },
    /// A statement without its `;`.
    MissingSemicolon {
        /// The statement's last token.
        last: String,
    },
    /// `^` or `**` in an expression.
    Power {
        /// The operator.
        operator: &'static str,
        /// What is raised.
        base: String,
        /// The exponent.
        exponent: String,
    },
    /// A unit that is no product of powers of symbols.
    NotAUnit {
        /// The token that does not belong there.
        found: String,
    },
    /// An `if` without `else`.
    IfWithoutElse,
    /// A comparison or a logical operator that is not the condition of an `if`.
    ComparisonOutsideIf {
        /// The operator.
        operator: &'static str,
    },
    /// `if a < b < c`, `while a < b and c < d`.
    SecondComparison {
        /// What stands after the first comparison.
        operator: String,
    },
    /// `if a == b`, `if a != b`.
    Equality {
        /// The operator.
        operator: &'static str,
    },
    /// A clause that stands twice.
    Duplicate {
        /// The clause, with quotes about its words.
        clause: String,
    },
    /// A word that names no joint kind, drive, contact law or expectation.
    UnknownKind {
        /// What it should name: `a joint kind`.
        what: &'static str,
        /// The word.
        word: String,
        /// The words that do.
        known: &'static [&'static str],
    },
    /// A word that needs an axis after it has none.
    MissingAxis {
        /// The word: `revolute`, `along`.
        of: String,
        /// What stands there instead.
        found: String,
    },
    /// A parameter or input without unit.
    MissingUnit {
        /// `parameter` or `input`.
        what: &'static str,
        /// Its name.
        name: String,
    },
    /// A parameter without default.
    MissingDefault {
        /// Its name.
        name: String,
    },
    /// Dots in a name that has none.
    DottedName {
        /// What it names: `the graph`.
        what: &'static str,
        /// The name.
        name: String,
        /// What to write.
        instead: String,
    },
    /// A name that Rust reserves.
    ReservedName {
        /// The name.
        name: String,
    },
    /// A number with a suffix, in another base, or beyond all floating-point numbers.
    NotANumber {
        /// The literal.
        text: String,
    },
    /// An expression nested too deeply.
    TooDeep {
        /// The deepest nesting.
        limit: usize,
    },
    /// A junction's cardinality other than 1 and 3.
    Cardinality {
        /// What stands there.
        found: String,
    },
    /// A documentation comment on a statement that has none.
    MisplacedDocumentation,
    /// An attribute other than a documentation comment.
    Attribute,
    /// A macro call without a graph and without a part.
    NoGraph,
    /// A file that is used by a macro call.
    UseInCall,
    /// A sample that no clock computes.
    SampleOutside,
}

impl Explain for SyntaxFault {
    fn code(&self) -> &'static str {
        match self {
            Self::UnknownStatement { .. } => "BG0101",
            Self::Unexpected { .. }
            | Self::BareVector
            | Self::UnitOfNumber { .. }
            | Self::StartOfDisplacement { .. } => "BG0102",
            Self::MissingSemicolon { .. } => "BG0103",
            Self::Power { .. } => "BG0104",
            Self::NotAUnit { .. } => "BG0105",
            Self::IfWithoutElse => "BG0106",
            Self::ComparisonOutsideIf { .. } => "BG0107",
            Self::SecondComparison { .. } => "BG0108",
            Self::Equality { .. } => "BG0109",
            Self::Duplicate { .. } => "BG0110",
            Self::UnknownKind { .. } => "BG0111",
            Self::MissingAxis { .. } => "BG0112",
            Self::MissingUnit { .. } => "BG0113",
            Self::MissingDefault { .. } => "BG0114",
            Self::DottedName { .. } => "BG0115",
            Self::ReservedName { .. } => "BG0116",
            Self::NotANumber { .. } => "BG0117",
            Self::TooDeep { .. } => "BG0118",
            Self::Cardinality { .. } => "BG0119",
            Self::MisplacedDocumentation => "BG0120",
            Self::Attribute => "BG0121",
            Self::NoGraph => "BG0122",
            Self::UseInCall => "BG0123",
            Self::SampleOutside => "BG0124",
        }
    }

    fn message(&self) -> String {
        match self {
            Self::UnknownStatement { place, word, .. } => format!("`{word}` begins no statement of {place}"),
            Self::Unexpected { found, expected } => format!("found {found}, expected {expected}"),
            Self::BareVector => {
                "found `,` after a value, expected `;`, or brackets about the components of a vector".into()
            }
            Self::StartOfDisplacement { name } => {
                format!("`{name}` has no start: it counts from t = 0, where it is 0")
            }
            Self::UnitOfNumber { number, word, .. } => {
                format!("found `{word}` after `{number}`, which is not a unit")
            }
            Self::MissingSemicolon { last } => format!("the statement that ends with {last} has no `;`"),
            Self::Power { operator, .. } => format!("found `{operator}`, which is no operator of an expression"),
            Self::NotAUnit { found } => format!("found {found} in a unit, expected symbols such as in `kg*m^2/s`"),
            Self::IfWithoutElse => "this `if` has no `else`, so that it has no value where its condition fails".into(),
            Self::ComparisonOutsideIf { operator } => {
                format!("found `{operator}` in a value, expected it only between `if` and `{{`")
            }
            Self::SecondComparison { operator } => {
                format!("found `{operator}` after a comparison: a condition is one comparison")
            }
            Self::Equality { operator } => format!("found `{operator}`, expected `<`, `<=`, `>` or `>=`"),
            Self::Duplicate { clause } => format!("found a second {clause}, expected one"),
            Self::UnknownKind { what, word, known } => {
                format!("found `{word}`, expected {what}: {}", listed(known))
            }
            Self::MissingAxis { of, found } => format!("found {found} after `{of}`, expected an axis"),
            Self::MissingUnit { what, name } => format!("the {what} `{name}` has no unit"),
            Self::MissingDefault { name } => format!("the parameter `{name}` has no default"),
            Self::DottedName { what, name, .. } => format!("found `{name}`, expected a name without dots for {what}"),
            Self::ReservedName { name } => format!("found `{name}` as a name, which Rust reserves"),
            Self::NotANumber { text } if is_plain(text) => {
                format!("found `{text}`, which is beyond all floating-point numbers")
            }
            Self::NotANumber { text } => format!("found `{text}`, expected a decimal number without a suffix"),
            Self::TooDeep { limit } => format!("the expression is nested deeper than {limit} levels"),
            Self::Cardinality { found } => format!("found {found}, expected a cardinality of 1 or 3"),
            Self::MisplacedDocumentation => {
                "only `graph`, `part`, `param`, `input` and `scene` have a documentation comment".into()
            }
            Self::Attribute => "found an attribute, expected none: the language has no attributes".into(),
            Self::NoGraph => "found no graph and no part, expected at least one".into(),
            Self::UseInCall => "found the use of a file in a macro call, expected it in a file".into(),
            Self::SampleOutside => "a `sample` stands in the block of a clock, which says when it is computed".into(),
        }
    }

    fn help(&self) -> String {
        match self {
            Self::UnknownStatement { word, known, .. } | Self::UnknownKind { word, known, .. } => {
                suggested(word, known)
            }
            Self::Unexpected { found, expected } => likeliest(found, expected),
            Self::BareVector => "write a vector in brackets, such as `[0, 1, 0]`".into(),
            Self::StartOfDisplacement { name } => {
                format!("leave this out, and write `{name} + E` with the start E where you use it")
            }
            Self::UnitOfNumber { number, unit, .. } => format!("write `{number} {unit}`"),
            Self::MissingSemicolon { last } => format!("write `;` after {last}"),
            Self::Power { base, exponent, .. } => format!("write `pow({base}, {exponent})`"),
            Self::NotAUnit { .. } => "write unit symbols joined by `*` and `/`, with whole powers, or `1`".into(),
            Self::IfWithoutElse => "write `else { ... }` after its block".into(),
            Self::ComparisonOutsideIf { .. } => "write `if a < b { 1 } else { 0 }`".into(),
            Self::SecondComparison { operator } if matches!(operator.as_str(), "||" | "|" | "or") => {
                "write `max(b - a, d - c) > 0`, which holds where `a < b` or `c < d` does; \
                of two units chain a second `if`"
                    .into()
            }
            Self::SecondComparison { .. } => {
                "write `min(b - a, d - c) > 0`, which holds where both `a < b` and `c < d` do; \
                of two units nest a second `if`"
                    .into()
            }
            Self::Equality { .. } => "compare with `<`, `<=`, `>` or `>=`".into(),
            Self::Duplicate { clause } => format!("remove one {clause}"),
            Self::MissingAxis { of, .. } => format!("write `x`, `y` or `z` after `{of}`"),
            Self::MissingUnit { name, .. } => format!("write its unit after its name, such as `{name}: N*m`"),
            Self::MissingDefault { .. } => "write `= NUMBER` after its unit".into(),
            Self::DottedName { instead, .. } => format!("write `{instead}`"),
            Self::ReservedName { name } if name == "_" => "write a word as its name".into(),
            Self::ReservedName { name } => format!("write another name, such as `{}_`", name.trim_start_matches("r#")),
            Self::NotANumber { text } => written_plainly(text),
            Self::TooDeep { .. } => "name a part of it with `let`".into(),
            Self::Cardinality { .. } => "write `[3]` for a multibond junction".into(),
            Self::MisplacedDocumentation => "write `//` instead of `///`".into(),
            Self::Attribute => "remove it".into(),
            Self::NoGraph => "write `graph NAME { ... }`".into(),
            Self::SampleOutside => "write `every 1 ms { .. }` about it, with the time between two instants".into(),
            Self::UseInCall => {
                "write `bond_graph!(file \"NAME.bond\")`, or the path of a part, such as `vehicles::Leg`".into()
            }
        }
    }
}

/// The nearest of the known words, or all of them.
fn suggested(word: &str, known: &[&'static str]) -> String {
    match near_miss(word, known.iter().copied().filter(|_| word.chars().count() > 1)) {
        Some(near) => format!("write `{near}`"),
        None if known.len() == 1 => format!("write {}", listed(known)),
        None if known.len() > MANY => format!("write a word that begins one, such as {}", listed(&known[..SEVERAL])),
        None => format!("write one of {}", listed(known)),
    }
}

/// What to write instead of `found`: the quoted word it was meant to be, or the first of the alternatives.
fn likeliest(found: &str, expected: &str) -> String {
    // Every second piece between backquotes is quoted.
    let quoted = expected.split('`').skip(1).step_by(2);
    let word = found.trim_matches('`');
    if let Some(near) = near_miss(word, quoted.filter(|candidate| candidate.len().min(word.len()) > 1)) {
        return format!("write `{near}`");
    }
    // A statement or an entry of a list that may have come to its end.
    let ending = ["`,`", "`;`"].into_iter().find(|ending| expected.contains(ending));
    if let Some(ending) = ending.filter(|_| expected.starts_with(OPERATOR)) {
        return format!("write {OPERATOR}, or {ending} before {found}");
    }
    let mut end = expected.len();
    let mut is_quoted = false;
    for (at, mark) in expected.char_indices() {
        is_quoted ^= mark == '`';
        if !is_quoted && (mark == ',' || expected[at..].starts_with(" or ")) {
            end = at;
            break;
        }
    }
    format!("write {} here", &expected[..end])
}

/// The words in quotes.
fn listed(words: &[&'static str]) -> String {
    words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}

/// Whether a literal has decimal digits and no suffix.
fn is_plain(text: &str) -> bool {
    text.chars().all(|c| c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E' | '+' | '-' | '_'))
}

/// How to write the number that `text` means.
fn written_plainly(text: &str) -> String {
    let digits = text.trim_start_matches('-');
    if is_plain(text) {
        return "write a number below 1.8e308".into();
    }
    let other_base = ["0x", "0o", "0b"].iter().any(|base| digits.starts_with(base));
    let end = digits.find(|c: char| c.is_alphabetic() && !matches!(c, 'e' | 'E')).unwrap_or(digits.len());
    if other_base || end == digits.len() {
        "write a decimal number such as `0.05` or `2e-3`".into()
    } else {
        let number = digits[..end].trim_end_matches(['e', 'E', '_']);
        let suffix = digits[number.len()..].trim_start_matches('_');
        let unit = if bg_units::Unit::of_symbol(suffix).is_some() { format!(" {suffix}") } else { String::new() };
        format!("write `{number}{unit}`")
    }
}
