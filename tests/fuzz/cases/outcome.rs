//! What becomes of an input.
//!
//! In: an [`Input`]. Out: its [`Outcome`], or the [`Violation`] of what always holds.

use std::collections::BTreeSet;
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};

use bg_compiler::fault::Faults;
use bg_compiler::pipeline;
use bg_compiler::source::{mechanism, part, scene, syntax};
use bg_compiler::stages::stages;
use bg_model::parameters::Parameters;
use bg_model::system::Model;
use bg_workbench::parameters::{SettingError, merge};
use hacksaw::mechanism::{Hacksaw, HacksawParameters};
use proc_macro2::{Ident, TokenStream, TokenTree};

use super::Input;

/// Stages are shown, too, of graphs whose expanded texts have fewer bytes in all.
const SHORT: usize = 1500;

/// What became of an input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Its brackets or literals are none: rustc refuses it before the macro sees it.
    NoTokens,
    /// A model, or checked parameters.
    Accepted,
    /// Refused, with the codes of its faults.
    Refused(BTreeSet<String>),
}

/// What must never be, in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Violation(pub String);

/// Hands the input in.
///
/// # Errors
/// A panic, or a result that breaks a promise.
pub fn examine(input: &Input) -> Result<Outcome, Violation> {
    let outcome = catch_unwind(AssertUnwindSafe(|| match input {
        Input::Call(text) => call(text),
        Input::Settings { file, set } => settings(file, set),
    }));
    // No span of this input is used any more; otherwise the table of sources grows with every input.
    proc_macro2::extra::invalidate_current_thread_spans();
    outcome.unwrap_or_else(|payload| {
        let text = payload.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| payload.downcast_ref::<&str>().copied()).unwrap_or("without words");
        Err(Violation(format!("panic: {text}")))
    })
}

/// Compiles a macro call; what is accepted must be Rust, and its expanded graphs must be accepted again.
fn call(text: &str) -> Result<Outcome, Violation> {
    let Ok(tokens) = text.parse::<TokenStream>() else { return Ok(Outcome::NoTokens) };
    let items = bg_compiler::compile(tokens.clone());
    let codes = codes(items.clone(), text)?;
    if !codes.is_empty() {
        return Ok(Outcome::Refused(codes));
    }
    if let Err(error) = syn::parse2::<syn::File>(items) {
        return Err(Violation(format!("the generated code is no Rust: {error}")));
    }
    expanded_again(tokens)?;
    Ok(Outcome::Accepted)
}

/// The codes of the compile errors among generated items; each error is at a token of the input.
fn codes(items: TokenStream, text: &str) -> Result<BTreeSet<String>, Violation> {
    let mut codes = BTreeSet::new();
    let trees: Vec<TokenTree> = items.into_iter().collect();
    for window in trees.windows(3) {
        let [TokenTree::Ident(word), _, TokenTree::Group(message)] = window else { continue };
        if word != "compile_error" {
            continue;
        }
        let message = message.stream().to_string();
        let code = message
            .get(2..8)
            .filter(|code| code.starts_with("BG") && message.get(1..9).is_some_and(|c| c.ends_with(']')));
        let Some(code) = code else { return Err(Violation(format!("a fault without a code: {message}"))) };
        if !is_in(word, text) {
            return Err(Violation(format!("a fault without a place: {message}")));
        }
        codes.insert(code.to_owned());
    }
    Ok(codes)
}

/// Whether the token's span is a piece of the text; that of a text without tokens has none.
fn is_in(word: &Ident, text: &str) -> bool {
    let Some(source) = word.span().source_text() else { return text.trim().is_empty() };
    // A source begins at a byte of its own, so its text at the place of the span must be the same.
    text.get(word.span().byte_range()).is_some_and(|piece| piece == source)
}

/// Every expanded graph, as its description shows it, is a graph that is accepted and shown alike.
fn expanded_again(tokens: TokenStream) -> Result<(), Violation> {
    let failed = |faults: Faults| Violation(format!("accepted, but refused in parts: {}", faults[0]));
    let source = syntax::parse(tokens.clone()).map_err(failed)?;
    if part::unasked(&source).is_some() {
        // The result is the question for a part of another call, of which there is none here.
        return Ok(());
    }
    let mut length = 0;
    for graph in &part::flatten(&source).map_err(failed)?.source.graphs {
        for variant in scene::variants(graph).map_err(failed)? {
            let shown = mechanism::expand(&variant.graph).map_err(failed)?.to_string();
            length += shown.len();
            let again = shown.parse().map_err(|error| Violation(format!("expanded text is no tokens: {error}")))?;
            let refused = |faults: Faults| Violation(format!("expanded text is refused: {}\n{shown}", faults[0]));
            let source = syntax::parse(again).map_err(refused)?;
            let graph = pipeline::derive(&source.graphs[0]).map_err(refused)?.expanded;
            if graph.to_string() != shown {
                return Err(Violation(format!("expanded text reads back as another: {shown}\n{graph}")));
            }
        }
    }
    if length < SHORT {
        stages(tokens).map_err(failed)?;
    }
    Ok(())
}

/// Reads parameters; a refusal is one line that names its place, and accepted values make a model, or a typed error.
fn settings(file: &[u8], set: &[String]) -> Result<Outcome, Violation> {
    let failed = |error: std::io::Error| Violation(format!("no temporary file: {error}"));
    let mut written = tempfile::NamedTempFile::new().map_err(failed)?;
    written.write_all(file).map_err(failed)?;
    let path = (!file.is_empty()).then(|| written.path());
    match merge(HacksawParameters::table(), path, set) {
        Ok(chosen) => accepted(HacksawParameters::of_values(chosen.values.values())),
        Err(error) => refused(&error),
    }
}

fn accepted(values: HacksawParameters) -> Result<Outcome, Violation> {
    values.validate().map_err(|fault| Violation(format!("accepted out of range: {fault}")))?;
    let model = Hacksaw::<f64>::new(values).map_err(|fault| Violation(format!("accepted, but no model: {fault}")))?;
    // Any start, or a gap that does not close; both without a panic.
    match model.start() {
        Ok(start) if start.iter().all(|value| value.is_finite()) => Ok(Outcome::Accepted),
        Ok(_) => Err(Violation("a start that is not finite, without an error".to_owned())),
        Err(_) => Ok(Outcome::Refused(BTreeSet::from(["start".to_owned()]))),
    }
}

fn refused(error: &SettingError) -> Result<Outcome, Violation> {
    let message = error.to_string();
    if message.contains(['\n', '\r']) || message.is_empty() {
        return Err(Violation(format!("a refusal that is not one line: {message:?}")));
    }
    let kind = match error {
        SettingError::Unknown { .. } => "unknown",
        SettingError::Range { .. } => "range",
        SettingError::NoValue(_) => "no value",
        SettingError::NotANumber { .. } => "not a number",
        SettingError::Unreadable { .. } => "unreadable",
        SettingError::Toml { .. } => "toml",
    };
    Ok(Outcome::Refused(BTreeSet::from([kind.to_owned()])))
}
