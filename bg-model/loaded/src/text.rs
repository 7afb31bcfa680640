//! Text to blueprints.
//!
//! In: text in the language of the macro. Out: the models of its graphs, or all faults at their places.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use bg_compiler::pipeline::{self, Compiled, Derived, Known};
use bg_compiler::source::{part, syntax};
use bg_compiler::tables;
pub use bg_compiler::tables::Counted;
use bg_model::description::Description;
use proc_macro2::{Span, TokenStream, TokenTree};

use crate::blueprint::Blueprint;
use crate::statics;

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
    /// Its tables; of a graph that was not asked for what it declares, of such a scene its name.
    pub description: &'static Description,
    /// What it is made of; none of what was not asked for.
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
    /// Which models, by their names; where there are none of them in a graph, its first. Others have no blueprints, and
    /// such scenes are not looked at.
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
    for known in compiled {
        match known {
            Known::Graph(derived, scenes) => graphs.push(Graph::begun(Model::declared(&derived), scenes, true)),
            Known::Model(model) => {
                let (scenes, is_literal, stands_for_graph) =
                    (model.scenes.clone(), !model.is_scene, model.stands_for_graph());
                let model = Model::of(*model, wanted.counted);
                match graphs.last_mut().filter(|_| !stands_for_graph) {
                    Some(graph) => {
                        let own = graph.models.iter_mut().find(|own| own.description.name == model.description.name);
                        *own.expect("its graph names it") = model;
                    }
                    None => graphs.push(Graph::begun(model, scenes, is_literal)),
                }
            }
        }
    }
    Ok(graphs)
}

impl Graph {
    /// The graph of a first model, whose `scenes` are known by their names.
    fn begun(first: Model, scenes: Vec<String>, is_literal: bool) -> Self {
        let name = first.description.name.to_owned();
        let models = [first].into_iter().chain(scenes.into_iter().map(Model::named)).collect();
        Self { name, models, is_literal }
    }
}

impl Model {
    fn of(model: Compiled, counted: Counted) -> Self {
        let blueprint = Arc::new(Blueprint::of(model, counted));
        Self { description: blueprint.description(), blueprint: Some(blueprint) }
    }

    fn declared(derived: &Derived) -> Self {
        Self { description: statics::leaked(&tables::declared(derived)), blueprint: None }
    }

    fn named(name: String) -> Self {
        let description = Description { name: name.leak(), ..Description::default() };
        Self { description: Box::leak(Box::new(description)), blueprint: None }
    }
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
