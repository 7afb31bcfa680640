//! Text to blueprints.
//!
//! In: text in the language of the macro. Out: the models of its graphs, or all faults at their places.

use std::fmt;
use std::sync::Arc;

use bg_compiler::pipeline;
use bg_compiler::source::{part, syntax};
use proc_macro2::{Span, TokenStream};

use crate::blueprint::Blueprint;

/// A graph with its models.
#[derive(Clone, Debug)]
pub struct Graph {
    /// Its name.
    pub name: String,
    /// Its models: the literal one where there is one, then the scenes in the order of the text.
    pub models: Vec<Model>,
    /// Whether the first model is the literal one.
    pub is_literal: bool,
}

/// A model of a graph.
#[derive(Clone, Debug)]
pub struct Model {
    /// What it is made of.
    pub blueprint: Arc<Blueprint>,
}

/// What is wrong with a text, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The stable code, such as `BG0301`; none of text that is made of no tokens.
    pub code: Option<&'static str>,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub help: String,
    /// Line from 1 and column from 1, in characters, of its first and behind its last character.
    pub from: [usize; 2],
    /// As `from`.
    pub to: [usize; 2],
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { code, message, help, from: [line, column], .. } = self;
        write!(f, "{line}:{column}: ")?;
        if let Some(code) = code {
            write!(f, "[{code}] ")?;
        }
        write!(f, "{message}")?;
        if help.is_empty() { Ok(()) } else { write!(f, "; {help}") }
    }
}

/// The graphs of a text with their models.
///
/// # Errors
/// All faults of the first stage that has any.
pub fn load(text: &str) -> Result<Vec<Graph>, Vec<Fault>> {
    let tokens: TokenStream = text.parse().map_err(|fault: proc_macro2::LexError| {
        let message = "this is no text of the language: a bracket, a quote or a character is out of place".to_owned();
        vec![at(fault.span(), None, message, "close what is open, and quote what is text".to_owned())]
    })?;
    let of_stage = |faults: Vec<bg_compiler::fault::Fault>| {
        faults.into_iter().map(|fault| at(fault.span, Some(fault.code), fault.message, fault.help)).collect::<Vec<_>>()
    };
    let source = syntax::parse(tokens).map_err(of_stage)?;
    if let Some(path) = part::unasked(&source) {
        let message = format!("the part `{}` stands in no file here", path.name.text);
        let help = "write the part into this file: a text cannot use parts of a Rust crate".to_owned();
        return Err(vec![at(path.name.places()[0], None, message, help)]);
    }
    let compiled = pipeline::models(&source).map_err(of_stage)?;
    let mut graphs: Vec<Graph> = Vec::new();
    for model in &compiled {
        let own = Model { blueprint: Arc::new(Blueprint::of(model)) };
        match graphs.last_mut().filter(|_| !model.stands_for_graph()) {
            Some(graph) => graph.models.push(own),
            None => graphs.push(Graph {
                name: model.source.name.text.clone(),
                models: vec![own],
                is_literal: !model.is_scene,
            }),
        }
    }
    Ok(graphs)
}

fn at(span: Span, code: Option<&'static str>, message: String, help: String) -> Fault {
    let [from, to] = [span.start(), span.end()].map(|place| [place.line, place.column + 1]);
    Fault { code, message, help, from, to }
}
