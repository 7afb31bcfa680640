//! The names of the generated items.
//!
//! In: [`Source`]. Out: its models by name, and those whose structs would have the names of others' structs.

use std::collections::BTreeMap;

use crate::fault::{Explain, Fault, Faults, Staged};
use crate::source::ast::{Graph, Item, Name, Scene, Source};
use crate::source::scene;

/// What the names of a model's structs have after the model's own.
pub(crate) const PARAMETERS: &str = "Parameters";
pub(crate) const INPUTS: &str = "Inputs";

/// The words that Rust reserves in any edition, as syn has them (<https://doc.rust-lang.org/reference/keywords.html>).
const RESERVED: [&str; 52] = [
    "Self", "_", "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate", "do",
    "dyn", "else", "enum", "extern", "false", "final", "fn", "for", "if", "impl", "in", "let", "loop", "macro",
    "match", "mod", "move", "mut", "override", "priv", "pub", "ref", "return", "self", "static", "struct", "super",
    "trait", "true", "try", "type", "typeof", "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

/// Whether Rust reserves `word`, so that no item or field can have it as its name.
pub(crate) fn is_reserved(word: &str) -> bool {
    word.starts_with("r#") || RESERVED.contains(&word)
}

/// The field of a parameter or input: its path as one word, `front_stiffness` of `front.stiffness`, `link_3_length` of
/// `link[3].length`.
pub(crate) fn field(name: &str) -> String {
    name.replace("].", "_").replace(']', "").replace(['.', '['], "_")
}

/// A fault of the name of a model or field.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "each variant's message says what it and its fields are")]
pub enum NameFault {
    SameName { name: String },
    SameField { name: String, of: String },
    NameOfStruct { name: String, of: String, part: &'static str },
}

impl Explain for NameFault {
    fn code(&self) -> &'static str {
        match self {
            Self::SameField { .. } => "BG0809",
            Self::SameName { .. } | Self::NameOfStruct { .. } => "BG0601",
        }
    }

    fn message(&self) -> String {
        match self {
            Self::SameName { name } => format!("there are two models called `{name}`"),
            Self::SameField { name, of } => {
                format!("`{name}` and `{of}` would both be the field `{}`", field(name))
            }
            Self::NameOfStruct { name, of, part } => format!("`{name}` would be a model and the {part} of `{of}`"),
        }
    }

    fn help(&self) -> String {
        match self {
            Self::SameName { .. } | Self::SameField { .. } => "give one of them another name".to_owned(),
            Self::NameOfStruct { .. } => "give one of the two models another name".to_owned(),
        }
    }
}

/// Each generated struct of a macro call has a name of its own, and so has each of its fields.
///
/// # Errors
/// Models of one name, or with the name of another model's parameters or inputs; paths that are one word.
pub fn check(source: &Source) -> Staged<()> {
    let mut faults = models(source).1;
    source.graphs.iter().for_each(|graph| faults.extend(fields(graph)));
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// Parameters, or inputs, whose paths differ but not as words.
fn fields(graph: &Graph) -> Faults {
    let mut taken: BTreeMap<(&str, String), &str> = BTreeMap::new();
    let mut faults = Faults::new();
    for (word, name) in graph.items.iter().filter_map(Item::adjustable) {
        let of = *taken.entry((word, field(&name.text))).or_insert(&name.text);
        if of != name.text {
            let fault = NameFault::SameField { name: name.text.clone(), of: of.to_owned() };
            faults.push(Fault::new(name.span, &fault));
        }
    }
    faults
}

/// A model of the source: a graph, or a scene of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Promised<'s> {
    pub graph: &'s Graph,
    pub scene: Option<&'s Scene>,
}

impl<'s> Promised<'s> {
    pub fn name(&self) -> &'s Name {
        self.scene.map_or(&self.graph.name, |scene| &scene.name)
    }

    /// The names of its structs and what these are.
    fn structs(&self) -> impl Iterator<Item = (String, Struct)> {
        let name = &self.name().text;
        let has_inputs = self.graph.items.iter().any(|item| matches!(item, Item::Input(_)));
        let parameters = (format!("{name}{PARAMETERS}"), Struct::Parameters);
        let inputs = has_inputs.then(|| (format!("{name}{INPUTS}"), Struct::Inputs));
        [(name.clone(), Struct::Model), parameters].into_iter().chain(inputs)
    }
}

/// A generated struct.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Struct {
    Model,
    Parameters,
    Inputs,
}

/// The models whose names are free, in the order of the source, and a fault for each of the others.
pub(crate) fn models(source: &Source) -> (Vec<Promised<'_>>, Faults) {
    let mut taken: BTreeMap<String, (Struct, &str)> = BTreeMap::new();
    let (mut models, mut faults) = (Vec::new(), Faults::new());
    for model in source.graphs.iter().flat_map(of_graph) {
        let name = model.name();
        let clash = model.structs().find_map(|(item, own)| Some((own, *taken.get(&item)?)));
        match clash {
            None => {
                taken.extend(model.structs().map(|(item, kind)| (item, (kind, name.text.as_str()))));
                models.push(model);
            }
            Some((own, (other, of))) => faults.push(Fault::new(name.span, &fault((&name.text, own), (of, other)))),
        }
    }
    (models, faults)
}

/// The graph, where it is a model itself, and its scenes.
fn of_graph(graph: &Graph) -> impl Iterator<Item = Promised<'_>> {
    let scenes = graph.items.iter().filter_map(move |item| match item {
        Item::Scene(scene) => Some(Promised { graph, scene: Some(scene) }),
        _ => None,
    });
    let literal = (!scene::scenes_only(graph)).then_some(Promised { graph, scene: None });
    literal.into_iter().chain(scenes)
}

/// Two structs of one name: one of them is a model, or both are structs of models of one name.
fn fault((name, own): (&str, Struct), (other, kind): (&str, Struct)) -> NameFault {
    let (model, (of, part)) = match (own, kind) {
        (Struct::Model, Struct::Parameters) => (name, (other, "parameters")),
        (Struct::Model, Struct::Inputs) => (name, (other, "inputs")),
        (Struct::Parameters, Struct::Model) => (other, (name, "parameters")),
        (Struct::Inputs, Struct::Model) => (other, (name, "inputs")),
        _ => return NameFault::SameName { name: name.to_owned() },
    };
    NameFault::NameOfStruct { name: model.to_owned(), of: of.to_owned(), part }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::syntax::parse_leniently;

    #[test]
    fn what_is_reserved_is_no_identifier_to_syn() {
        let is_identifier = |word: &str| syn::parse_str::<syn::Ident>(word).is_ok();
        assert!(RESERVED.is_sorted() && RESERVED.iter().all(|word| !is_identifier(word)));
        for word in ["union", "auto", "raw", "safe", "gen", "graph", "_x", "selfish", "macro_rules", "r#type", "f64"] {
            assert_eq!(is_reserved(word), word.starts_with("r#") || !is_identifier(word), "{word}");
        }
    }

    fn said(text: &str) -> (Vec<String>, Vec<(usize, String)>) {
        let (source, faults) = parse_leniently(text.parse().expect("tokens"));
        assert!(faults.is_empty(), "{faults:?}");
        let (models, faults) = models(&source);
        let faults = faults.into_iter().map(|fault| (fault.span.start().column, fault.message));
        (models.iter().map(|model| model.name().text.clone()).collect(), faults.collect())
    }

    #[test]
    fn different_names_are_free_whatever_they_are() {
        let text =
            "graph A { input u: N; scene B {} scene Parameters {} } graph Option {} graph S {} graph AOutputs {}";
        let (models, faults) = said(text);
        assert_eq!(models, ["A", "B", "Parameters", "Option", "S", "AOutputs"]);
        assert!(faults.is_empty(), "{faults:?}");
    }

    #[test]
    fn two_models_of_one_name_are_one_too_many() {
        let (models, faults) = said("graph A { scene B {} } graph B { scene A {} scene C {} }");
        assert_eq!(models, ["A", "B", "C"]);
        let twice = |name: &str| format!("there are two models called `{name}`");
        assert_eq!(faults, [(29, twice("B")), (39, twice("A"))]);
    }

    #[test]
    fn a_model_is_not_called_like_another_one_s_structs() {
        for (text, column, message) in [
            ("graph A { scene AParameters {} }", 16, "`AParameters` would be a model and the parameters of `A`"),
            ("graph AParameters {} graph A {}", 27, "`AParameters` would be a model and the parameters of `A`"),
            ("graph A { input u: N; } graph AInputs {}", 30, "`AInputs` would be a model and the inputs of `A`"),
            ("graph AInputs {} graph A { input u: N; }", 23, "`AInputs` would be a model and the inputs of `A`"),
        ] {
            let (models, faults) = said(text);
            assert_eq!(models.len(), 1);
            assert_eq!(faults, [(column, message.to_owned())], "{text}");
        }
        assert!(said("graph A { scene AInputs {} }").1.is_empty(), "without inputs there is no such struct");
    }
}
