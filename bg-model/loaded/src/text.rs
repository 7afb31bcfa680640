//! Text to blueprints.
//!
//! In: text in the language of the macro, and what opens the files that it uses. Out: the models of its graphs, or all
//! faults at their places.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bg_compiler::fault::Staged;
use bg_compiler::pipeline::{self, Compiled, Derived, Known};
use bg_compiler::source::ast::Source;
use bg_compiler::source::syntax::files::{self, Gathered, Open, Opened};
use bg_compiler::source::syntax::told::Told;
use bg_compiler::source::{part, syntax};
use bg_compiler::tables;
pub use bg_compiler::tables::Counted;
use bg_model::description::Description;
use proc_macro2::{Group, TokenStream, TokenTree};

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
    /// The stable code, such as `BG0301`.
    pub code: &'static str,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub help: String,
    /// Line and column of its first character, both from 1, the column in characters.
    pub place: [usize; 2],
    /// The bytes of the text that it is about.
    pub bytes: Range<usize>,
    /// The file of that text, where it is one that the text uses; none: the text itself.
    pub file: Option<Arc<UsedFile>>,
}

/// A file that a text uses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UsedFile {
    /// Its path.
    pub path: PathBuf,
    /// What stands in it.
    pub text: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { code, message, help, place: [line, column], file, .. } = self;
        if let Some(file) = file {
            write!(f, "{}:", file.path.display())?;
        }
        write!(f, "{line}:{column}: [{code}] {message}")?;
        if help.is_empty() { Ok(()) } else { write!(f, "; {help}") }
    }
}

/// The graphs of a text with their models. Of a Rust file the calls of `bond_graph!` outside of functions and modules
/// are the text. A text alone uses no files.
///
/// # Errors
/// All faults of the first stage that has any.
pub fn load(text: &str) -> Result<Vec<Graph>, Vec<Fault>> {
    load_wanted(text, Wanted { scene: &|_| true, counted: Counted::All, most: None })
}

/// The same without what is not wanted.
///
/// # Errors
/// As [`load`].
pub fn load_wanted(text: &str, wanted: Wanted<'_>) -> Result<Vec<Graph>, Vec<Fault>> {
    let first = Opened { file: PathBuf::new(), text: text.to_owned() };
    let open: Open<'_> = &|path| Err(format!("cannot read {}: a text alone uses no files", path.display()));
    load_file(Path::new(""), first, open, wanted)
}

/// What is wanted of a text.
#[derive(Clone, Copy)]
pub struct Wanted<'a> {
    /// Which models, by their names; where there are none of them in a graph, its first. Others have no blueprints, and
    /// such scenes are not looked at.
    pub scene: &'a dyn Fn(&str) -> bool,
    /// Of which programs descriptions tell the operations. To run a model not all of them have to be made.
    pub counted: Counted,
    /// The most statements of a graph with its repetitions and parts written out; none: 20000.
    pub most: Option<usize>,
}

/// The same of the file at `path`, with the files that it uses, each opened by `open`; what is not wanted is left out.
///
/// # Errors
/// As [`load`].
pub fn load_file(path: &Path, first: Opened, open: Open<'_>, wanted: Wanted<'_>) -> Result<Vec<Graph>, Vec<Fault>> {
    let gathered = files::gather(path, first, open);
    graphs(&gathered, wanted).map_err(|faults| placed(&gathered, faults))
}

/// The same of the file at `path`, of which nothing is made: the names of its graphs, each with the number of its
/// models.
///
/// # Errors
/// As [`load`].
pub fn check_file(
    path: &Path,
    first: Opened,
    open: Open<'_>,
    most: Option<usize>,
) -> Result<Vec<(String, usize)>, Vec<Fault>> {
    let gathered = files::gather(path, first, open);
    let checked = parsed(&gathered, most).and_then(|source| pipeline::check(&source));
    checked.map_err(|faults| placed(&gathered, faults))
}

/// The stack of the compiler, bytes: laws may be long.
const STACK: usize = 1 << 28;

/// What `compile` gives, in a thread whose stack is large enough for laws of any length.
///
/// # Panics
/// As `compile`, or the machine has no memory for a thread.
pub fn on_a_large_stack<T: Send>(compile: impl FnOnce() -> T + Send) -> T {
    std::thread::scope(|scope| {
        let compiler = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, compile);
        compiler.expect("a thread can be started").join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

/// The faults of syntax of a text, without the files that it uses.
#[must_use]
pub fn syntax_faults(text: &str) -> Vec<Fault> {
    let faults = match files::alone(text) {
        // A file may have nothing but what it uses.
        Ok(tokens) if tokens.is_empty() => Vec::new(),
        Ok(tokens) => syntax::parse(tokens).err().unwrap_or_default(),
        Err(fault) => vec![fault],
    };
    placed(&Gathered::default(), faults)
}

/// The words and functions of a text where they stand; nothing of what is no text of tokens.
#[must_use]
pub fn told(text: &str) -> Vec<Told> {
    files::alone(text).map_or_else(|_| Vec::new(), |tokens| syntax::told::told(&tokens))
}

/// The faults with their places in the files.
fn placed(gathered: &Gathered, faults: Vec<bg_compiler::fault::Fault>) -> Vec<Fault> {
    let files: Vec<Arc<UsedFile>> = gathered
        .files
        .iter()
        .map(|file| Arc::new(UsedFile { path: file.path.clone(), text: file.text.clone() }))
        .collect();
    let placed = |fault: bg_compiler::fault::Fault| {
        let bg_compiler::fault::Fault { span, code, message, help } = gathered.named(fault);
        let (start, bytes, file) = (span.start(), span.byte_range(), gathered.place(span));
        let file = (file > 0).then(|| Arc::clone(&files[file]));
        Fault { code, message, help, place: [start.line, start.column + 1], bytes, file }
    };
    faults.into_iter().map(placed).collect()
}

/// The graphs and parts of what has been gathered.
fn parsed(gathered: &Gathered, most: Option<usize>) -> Staged<Source> {
    if !gathered.faults.is_empty() {
        return Err(gathered.faults.clone());
    }
    let tokens = gathered.tokens.clone();
    let calls = macro_calls(tokens.clone());
    let inside = calls.iter().map(Group::stream).collect();
    let source = Source { most, ..syntax::parse(if calls.is_empty() { tokens } else { inside })? };
    match part::unasked(&source) {
        Some(path) => Err(vec![part::of_rust(path)]),
        None => Ok(source),
    }
}

fn graphs(gathered: &Gathered, wanted: Wanted<'_>) -> Staged<Vec<Graph>> {
    let source = parsed(gathered, wanted.most)?;
    let compiled = pipeline::models_where(&source, wanted.scene)?;
    let mut graphs: Vec<Graph> = Vec::new();
    for known in compiled {
        match known {
            Known::Graph(derived, scenes) => graphs.push(Graph::begun(Model::declared(&derived), scenes, true)),
            Known::Model(model) => {
                let (scenes, is_literal) = (model.scenes.clone(), !model.is_scene);
                let model = Model::of(*model, wanted.counted);
                // No two models have one name: what the last graph does not name stands for a graph of its own.
                let name = model.description.name;
                let own = graphs
                    .last_mut()
                    .and_then(|graph| graph.models.iter_mut().find(|own| own.description.name == name));
                match own {
                    Some(own) => *own = model,
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

/// What stands in the brackets of each call of the macro outside of functions and modules; nothing of a text that is no
/// Rust file.
#[must_use]
pub fn macro_calls(tokens: TokenStream) -> Vec<Group> {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let call = |tokens: &[TokenTree]| match tokens {
        [TokenTree::Ident(name), TokenTree::Punct(mark), TokenTree::Group(group)]
            if name == "bond_graph" && mark.as_char() == '!' =>
        {
            Some(group.clone())
        }
        _ => None,
    };
    tokens.windows(3).filter_map(call).collect()
}
