//! Text to blueprints.
//!
//! In: text in the language of the macro. Out: the models of its graphs, or all faults at their places.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use bg_compiler::pipeline;
use bg_compiler::source::{part, syntax};
pub use bg_compiler::tables::Counted;
use proc_macro2::{Span, TokenStream, TokenTree};

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
    /// Its name.
    pub name: String,
    /// What it is made of; none of a scene that was not asked for.
    pub blueprint: Option<Arc<Blueprint>>,
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
    /// Line and column of its first character, both from 1, the column in characters.
    pub place: [usize; 2],
    /// The bytes of the text that it is about.
    pub bytes: Range<usize>,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { code, message, help, place: [line, column], .. } = self;
        write!(f, "{line}:{column}: ")?;
        if let Some(code) = code {
            write!(f, "[{code}] ")?;
        }
        write!(f, "{message}")?;
        if help.is_empty() { Ok(()) } else { write!(f, "; {help}") }
    }
}

/// The graphs of a text with their models. Of a Rust file the calls of `bond_graph!` outside of functions and modules are
/// the text.
///
/// # Errors
/// All faults of the first stage that has any.
pub fn load(text: &str) -> Result<Vec<Graph>, Vec<Fault>> {
    load_wanted(text, Wanted { scene: &|_| true, counted: Counted::All })
}

/// What is wanted of a text.
#[derive(Clone, Copy)]
pub struct Wanted<'a> {
    /// Which scenes after each graph's first model, by their names: others have no blueprints, and are not looked at.
    pub scene: &'a dyn Fn(&str) -> bool,
    /// Of which programs descriptions tell the operations. To run a model not all of them have to be made.
    pub counted: Counted,
}

/// The same, but what is not wanted is left out.
///
/// # Errors
/// As [`load`].
pub fn load_wanted(text: &str, wanted: Wanted<'_>) -> Result<Vec<Graph>, Vec<Fault>> {
    let tokens: TokenStream = text.parse().map_err(|fault: proc_macro2::LexError| {
        let message = "this is no text of the language: a bracket, a quote or a character is out of place".to_owned();
        vec![at(fault.span(), None, message, "close what is open, and quote what is text".to_owned())]
    })?;
    let of_stage = |faults: Vec<bg_compiler::fault::Fault>| {
        faults.into_iter().map(|fault| at(fault.span, Some(fault.code), fault.message, fault.help)).collect::<Vec<_>>()
    };
    let source = syntax::parse(calls(&tokens).unwrap_or(tokens)).map_err(of_stage)?;
    if let Some(path) = part::unasked(&source) {
        let message = format!("the part `{}` stands in no file here", path.name.text);
        let help = "write the part into this file: a text cannot use parts of a Rust crate".to_owned();
        return Err(vec![at(path.name.places()[0], None, message, help)]);
    }
    let compiled = pipeline::models_where(&source, wanted.scene).map_err(of_stage)?;
    let mut graphs: Vec<Graph> = Vec::new();
    for model in compiled {
        let (name, others) = (model.source.name.text.clone(), model.scenes.clone());
        let (is_literal, stands_for_graph) = (!model.is_scene, model.stands_for_graph());
        let blueprint = Some(Arc::new(Blueprint::of(model, wanted.counted)));
        match graphs.last_mut().filter(|_| !stands_for_graph) {
            Some(graph) => {
                let own = graph.models.iter_mut().find(|own| own.name == name);
                own.expect("its graph names it").blueprint = blueprint;
            }
            None => {
                let others = others.into_iter().map(|name| Model { name, blueprint: None });
                let models = [Model { name: name.clone(), blueprint }].into_iter().chain(others).collect();
                graphs.push(Graph { name, models, is_literal });
            }
        }
    }
    Ok(graphs)
}

/// What stands in the calls of the macro, of a text that is a Rust file; none of other texts.
fn calls(tokens: &TokenStream) -> Option<TokenStream> {
    let tokens: Vec<TokenTree> = tokens.clone().into_iter().collect();
    let call = |tokens: &[TokenTree]| match tokens {
        [TokenTree::Ident(name), TokenTree::Punct(mark), TokenTree::Group(group)]
            if name == "bond_graph" && mark.as_char() == '!' =>
        {
            Some(group.stream())
        }
        _ => None,
    };
    let calls: Vec<TokenStream> = tokens.windows(3).filter_map(call).collect();
    (!calls.is_empty()).then(|| calls.into_iter().collect())
}

fn at(span: Span, code: Option<&'static str>, message: String, help: String) -> Fault {
    let start = span.start();
    Fault { code, message, help, place: [start.line, start.column + 1], bytes: span.byte_range() }
}
