//! Parts in the tree: what is described once and used often.
//!
//! None of this occurs after `part::flatten`.

use std::fmt::{Debug, Formatter, Result};

use proc_macro2::{Span, TokenStream};

use crate::source::ast::{Expression, Item, Junction, Name, Source};
use crate::source::visibility::Visibility;

/// One `part NAME { ... }`: a piece of machine.
#[derive(Clone, Debug)]
pub struct Part {
    /// Documentation comment.
    pub docs: String,
    /// From where it can be used.
    pub visibility: Visibility,
    /// Its name (no dots).
    pub name: Name,
    /// The statements in their order.
    pub items: Vec<Item>,
    /// Its words from `part` to the closing brace, for other macro calls.
    pub written: Written,
}

/// Tokens as they were written. They print as nothing, since they say no more than the tree beside them.
#[derive(Clone)]
pub struct Written(pub TokenStream);

impl Debug for Written {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str("Written")
    }
}

/// What another macro call described: the part of this path with all that it needs.
#[derive(Clone, Debug)]
pub struct Foreign {
    /// The path by which the part is called here, `other_crate::Leg`.
    pub path: Name,
    /// The tokens of the path.
    pub written: Written,
    /// The part, which is the first, and what it uses.
    pub source: Source,
}

/// `part NAME: PART { ... }`, `part NAME[20]: PART { ... }` or `part PART { ... }`
#[derive(Clone, Debug)]
pub struct Use {
    /// What names inside begin with here. None: they stay as they are.
    pub name: Option<Name>,
    /// `[20]` with its span: so many, counted from 0.
    pub count: Option<(usize, Span)>,
    /// The part.
    pub part: PartPath,
    /// `NAME = E;` what its parameters and inputs are.
    pub arguments: Vec<Argument>,
    /// `start BODY at E;` with paths from inside the part.
    pub starts: Vec<Start>,
}

/// The name of a part, or the path of one that another macro call describes.
#[derive(Clone, Debug)]
pub struct PartPath {
    /// `Leg`, `other_crate::Leg`
    pub name: Name,
    /// Its tokens.
    pub written: Written,
}

impl PartPath {
    /// Whether another macro call describes the part.
    #[must_use]
    pub fn is_foreign(&self) -> bool {
        self.name.text.contains("::")
    }
}

/// A parameter or input of a part with its value.
#[derive(Clone, Debug)]
pub struct Argument {
    /// The parameter; a path where it is one of a part inside.
    pub name: Name,
    /// Its value, in names of the user of the part.
    pub value: Expression,
}

/// `port NAME: DOMAIN;` or `port NAME = PATH;`
#[derive(Clone, Debug)]
pub enum Port {
    /// A junction that the user of the part bonds to.
    Junction(Junction),
    /// Another name of a point, body, junction, joint or free axis inside.
    Alias(Name, Name),
}

/// `start BODY at E;` and its like, outside of the body: where the user of a part puts it.
#[derive(Clone, Debug)]
pub struct Start {
    /// A body, or a point of it where a place is given.
    pub of: Name,
    /// What is given.
    pub kind: StartKind,
    /// Its value.
    pub value: Expression,
}

/// What is given of a body's start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum StartKind {
    /// `at`
    Place,
    /// `turned`
    Orientation,
    /// `velocity`
    Velocity,
    /// `spin`
    Spin,
}

/// `for INDEX in FROM..TO { ... }`: the statements once for each whole number from the first to the one before the
/// last.
#[derive(Clone, Debug)]
pub struct For {
    /// What the number is called inside.
    pub index: Name,
    /// The first number: digits, or an expression of outer indices.
    pub from: Name,
    /// The end, not included.
    pub to: Name,
    /// The statements.
    pub items: Vec<Item>,
}

/// The paths of all parts that the statements use.
#[must_use]
pub fn used_parts(items: &[Item]) -> Vec<&PartPath> {
    let each = items.iter().map(|item| match item {
        Item::Use(used) => vec![&used.part],
        Item::For(repeated) => used_parts(&repeated.items),
        _ => Vec::new(),
    });
    each.flatten().collect()
}
