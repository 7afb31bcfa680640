//! Reads the tokens of a macro call as the tree of [`crate::source::ast`].
//!
//! In: a [`TokenStream`]. Out: a [`Source`], or every fault of syntax at once. No longer occurs: tokens.
//! Method: recursive descent over statements that begin with a word of their own, precedence climbing for expressions;
//! a faulty statement is noted and skipped.

use std::cell::RefCell;

use proc_macro2::{Delimiter, TokenStream};

use crate::fault::{Fault, Staged};
use crate::source::ast::{Graph, Source};
use crate::source::drawing::Drawing;
use crate::source::visibility::Visibility;
use cursor::{Block, Cursor, Noted, Parsed};

mod body;
mod cursor;
mod documentation;
mod expression;
mod fault;
pub mod files;
mod friction;
mod mechanism;
mod part;
pub mod points;
mod scene;
mod statement;
mod token;
pub mod told;
mod unit;

#[cfg(test)]
mod tests;

pub use cursor::BLOCKS;
pub use expression::{DEEPEST, MOST_NESTED};
pub use fault::SyntaxFault;

/// The macro call's outermost level.
const CALL: Block = Block { name: "the macro call", words: &["graph", "part"], list: false };

/// The blocks whose statements begin with words.
#[cfg(test)]
pub(super) const BLOCKS_OF_WORDS: [&Block; 17] = [
    &CALL,
    &statement::GRAPH,
    &statement::PART,
    &statement::EVERY,
    &body::BODY,
    &mechanism::GROUND,
    &mechanism::JOINT,
    &mechanism::SPRING,
    &mechanism::DRIVE,
    &mechanism::CONTACT,
    &mechanism::SHAPE_CONTACT,
    &friction::FRICTION,
    &friction::STOP,
    &friction::ORIFICE,
    &scene::SCENE,
    &scene::OBSERVE,
    &part::USE,
];

/// The parts and graphs of a macro call, or all of its faults of syntax.
///
/// # Errors
/// Every fault of syntax, in the order of the source.
pub fn parse(tokens: TokenStream) -> Staged<Source> {
    let (source, faults) = parse_leniently(tokens);
    if faults.is_empty() { Ok(source) } else { Err(faults) }
}

/// What could be read of a macro call, and its faults of syntax.
///
/// A parameter, input, scene or graph whose name could be read is there, if need be with the unit `1`, the default 0 or
/// without items.
#[must_use]
pub fn parse_leniently(tokens: TokenStream) -> (Source, Vec<Fault>) {
    let noted = RefCell::new(Noted::default());
    let mut source = Source::default();
    let mut call = Cursor::new(tokens, &CALL, &noted);
    call.statements(|call| declaration(call, &mut source));
    if source.graphs.is_empty() && source.parts.is_empty() && noted.borrow().faults.is_empty() {
        call.note(call.span(), &SyntaxFault::NoGraph);
    }
    let Noted { faults, unfinished, heard } = noted.into_inner();
    (source.unfinished, source.heard) = (unfinished, heard);
    (source, faults)
}

/// `pub graph NAME { ... }`, `pub part NAME { ... }`
fn declaration(call: &mut Cursor, source: &mut Source) -> Parsed<()> {
    if call.is("@") {
        return call.foreign(source);
    }
    let documentation = call.documentation();
    if call.word() == Some("use") {
        return call.used_file(&documentation);
    }
    let docs = documentation.text;
    let visibility = call.visibility()?;
    let is_private = matches!(visibility, Visibility::Private);
    match call.word() {
        Some("graph") => graph(call, docs, visibility, &mut source.graphs),
        Some("part") => call.part(docs, visibility, source),
        _ if is_private => Err(call.unknown_statement()),
        _ => Err(call.unexpected("`graph` or `part`")),
    }
}

/// `graph NAME { ... }`, after its documentation and visibility.
fn graph(call: &mut Cursor, docs: String, visibility: Visibility, graphs: &mut Vec<Graph>) -> Parsed<()> {
    call.advance();
    let name = call.plain_name("the graph")?;
    let block = call.group(Delimiter::Brace, "`{ ... }`", &statement::GRAPH);
    let (items, read) = match block {
        Ok(block) => (statement::items(block), Ok(())),
        Err(reported) => (Vec::new(), Err(reported)),
    };
    graphs.push(Graph { docs, visibility, name, items, drawing: Drawing::default() });
    read
}
