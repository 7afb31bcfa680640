//! What an editor knows of the names in a macro call: hover, definition, references, rename, completion.
//!
//! In: the source as written, the models that it gives. Out: a hidden module for rust-analyzer alone, which sets
//! `cfg(rust_analyzer)`; rustc takes it away unread. Method: a struct for each graph and part with a field for
//! everything that is declared, at its place in the source, and for every use an expression that reads the field at the
//! place of the use.
//!
//! Only what means something is mentioned, so that rust-analyzer finds no faults of its own.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote};

use super::items::{identifier, placed};
use super::members::{self, Member, Shape};
use super::scopes::{DeclarationKind, Declared, Path, Scope, path};
use crate::fault::Fault;
use crate::pipeline::Compiled;
use crate::source::ast::{Graph, Item, Source, Spoken};
use crate::source::functions::{self, FUNCTIONS};
use crate::source::names::{INPUTS, PARAMETERS};
use crate::source::vocabulary::{first_words, meaning};

/// What rust-analyzer writes at the caret when it asks what could stand there.
const CARET: &str = "raCompletionMarker";

/// The most states that the text of one name lists.
const MOST_STATES: usize = 16;

/// The module of a macro call without faults, which gives these models.
#[must_use]
pub fn anchors(source: &Source, models: &[Compiled]) -> TokenStream {
    let scopes = Scopes::of(source);
    scopes.module(&scopes.names(source, models))
}

/// The module of a macro call with faults. The name where the caret may be stands in front of all else, so that what is
/// in front of it does not change with it: rust-analyzer compares the tokens with and without its own word at the
/// caret.
#[must_use]
pub fn anchors_with_faults(source: &Source, faults: &[Fault]) -> TokenStream {
    let scopes = Scopes::of(source);
    let (at_carets, names) = (scopes.at_carets(source, faults), scopes.names(source, &[]));
    scopes.module(&quote!(#at_carets #names))
}

/// All parts and graphs of a call.
struct Scopes {
    parts: Vec<Scope>,
    graphs: Vec<Scope>,
}

impl Scopes {
    fn of(source: &Source) -> Self {
        let parts = source.parts.iter().map(|part| Scope::of((&part.name, &part.docs), &part.items, true));
        let graphs = source.graphs.iter().map(|graph| Scope::of((&graph.name, &graph.docs), &graph.items, false));
        Self { parts: parts.collect(), graphs: graphs.collect() }
    }

    /// The module, which has a name of its own; nothing where the call declares nothing.
    fn module(&self, names: &TokenStream) -> TokenStream {
        let Some(first) = self.graphs.iter().chain(&self.parts).next() else { return TokenStream::new() };
        let module = format_ident!("__bond_graph_names_of_{}", first.name.text);
        quote! {
            #[doc(hidden)]
            #[allow(unexpected_cfgs)]
            mod #module {
                #[cfg(rust_analyzer)]
                #[allow(dead_code, unused_variables, non_snake_case, non_camel_case_types)]
                mod names { #names }
            }
        }
    }

    /// The structs and what mentions their fields.
    fn names(&self, source: &Source, models: &[Compiled]) -> TokenStream {
        let meaning = Meaning { parts: &self.parts };
        let parts: TokenStream = self.parts.iter().map(|scope| meaning.scope(scope, None)).collect();
        let graphs = self.graphs.iter().zip(&source.graphs);
        let graphs: TokenStream = graphs.map(|(scope, graph)| meaning.scope(scope, standing(graph, models))).collect();
        let kinds = kinds(self.parts.iter().chain(&self.graphs));
        let (functions, has) = (functions(), quote!(impl Functions for));
        let words = words(source);
        let named = |scope: &Scope| identifier(&scope.name.text);
        let (of_parts, of_graphs) = (self.parts.iter().map(named), self.graphs.iter().map(named));
        quote! {
            mod kinds { #kinds }
            mod parts { #parts }
            mod graphs { #graphs }
            #functions
            #words
            #(#has parts::#of_parts {})*
            #(#has graphs::#of_graphs {})*
        }
    }

    /// For each part and graph the first name that means nothing or ends with a dot.
    fn at_carets(&self, source: &Source, faults: &[Fault]) -> TokenStream {
        let meaning = Meaning { parts: &self.parts };
        let unfinished: Vec<Path> = source.unfinished.iter().filter_map(path).collect();
        let each = |scopes: &[Scope], module: &TokenStream| -> TokenStream {
            let functions = scopes.iter().map(|scope| {
                let (name, words) = (identifier(&scope.name.text), meaning.at_caret(scope, faults, &unfinished));
                quote!(impl #module::#name { fn at_caret(of: &Self) { let _ = of #words; } })
            });
            functions.collect()
        };
        let (parts, graphs) = (each(&self.parts, &quote!(parts)), each(&self.graphs, &quote!(graphs)));
        // A word that begins no statement may be the beginning of one.
        let mut unknown = source.heard.unknown.iter().filter(|spoken| is_name(&spoken.word.text));
        let is_at_caret = |spoken: &&Spoken| spoken.word.text.contains(CARET);
        let word = unknown.clone().find(is_at_caret).or_else(|| unknown.next());
        let word = word.map(|Spoken { block, word, .. }| {
            let (block, word) = (block_of(block), placed(&word.text, word.span));
            quote!(fn word_at_caret() { let _ = words::#block::#word; })
        });
        quote!(#word #parts #graphs)
    }
}

/// The model whose structs stand for those of its graph.
fn standing<'m>(graph: &Graph, models: &'m [Compiled]) -> Option<&'m Compiled> {
    let is_of = |name: &str| {
        name == graph.name.text
            || graph.items.iter().any(|item| matches!(item, Item::Scene(scene) if scene.name.text == name))
    };
    models.iter().find(|model| model.stands_for_graph && is_of(&model.source.name.text))
}

/// A type for each kind of thing that occurs.
fn kinds<'s>(scopes: impl Iterator<Item = &'s Scope>) -> TokenStream {
    let mut kinds: BTreeMap<&str, &[Member]> = BTreeMap::from([("Point", &members::POINT[..])]);
    for field in scopes.flat_map(|scope| &scope.fields) {
        if let DeclarationKind::Thing(kind, members) = &field.kind {
            kinds.insert(kind, members);
        }
    }
    let kinds = kinds.into_iter().map(|(kind, members)| {
        let (kind, members) = (identifier(kind), members.iter().map(|member| field_of(member, &quote!(self))));
        quote!(pub struct #kind { #(#members)* })
    });
    quote! {
        pub struct Parameter;
        pub struct Input;
        pub struct Value;
        pub struct Port;
        pub struct Vector { pub x: f64, pub y: f64, pub z: f64 }
        pub struct Quantity { pub x: f64, pub y: f64, pub z: f64 }
        #(#kinds)*
    }
}

/// The language's words: an item for each that the source has, by blocks, and for those that could stand where one of
/// these is not known; an expression for each where it stands.
fn words(source: &Source) -> TokenStream {
    let is_known = |spoken: &&Spoken| meaning(spoken.block, &spoken.word.text).is_some() && is_name(&spoken.word.text);
    let spoken: Vec<&Spoken> = source.heard.words.iter().filter(is_known).collect();
    let mut blocks: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for Spoken { block, word, .. } in &spoken {
        blocks.entry(block).or_default().insert(&word.text);
    }
    for Spoken { block, beginnings, .. } in &source.heard.unknown {
        let words = blocks.entry(block).or_default();
        first_words(beginnings).filter(|word| is_name(word)).for_each(|word| {
            words.insert(word);
        });
    }
    let blocks = blocks.iter().map(|(block, words)| {
        let words = words.iter().map(|word| {
            let (name, docs) = (identifier(word), meaning(block, word).unwrap_or_default());
            quote!(#[doc = #docs] pub struct #name;)
        });
        let block = block_of(block);
        quote!(pub mod #block { #(#words)* })
    });
    let uses = spoken.iter().map(|Spoken { block, word, .. }| {
        let (block, word) = (block_of(block), placed(&word.text, word.span));
        quote!(let _ = words::#block::#word;)
    });
    quote!(mod words { #(#blocks)* } fn spoken() { #(#uses)* })
}

/// The module of the words of a block: `a_joint`.
fn block_of(block: &str) -> Ident {
    let letters = block.chars().filter(|letter| letter.is_alphanumeric() || *letter == ' ');
    identifier(&letters.collect::<String>().replace(' ', "_"))
}

/// Whether a word can be the name of an item as it is: Rust has some of the language's words for itself.
fn is_name(word: &str) -> bool {
    !word.starts_with("r#") && syn::parse_str::<Ident>(word).is_ok()
}

/// The functions of the language as methods of each graph and part: so they are offered beside its names.
fn functions() -> TokenStream {
    let shape = |shape: functions::Shape| match shape {
        functions::Shape::Scalar => quote!(f64),
        functions::Shape::Vector => quote!(kinds::Vector),
        functions::Shape::Matrix => quote!([[f64; 3]; 3]),
    };
    let each = FUNCTIONS.iter().map(|function| {
        let (name, docs, gives) = (identifier(function.name), function.to_string(), shape(function.gives));
        let arguments = function.arguments.iter().map(|&(name, of)| {
            let (name, of) = (identifier(name), shape(of));
            quote!(#name: #of)
        });
        quote!(#[doc = #docs] fn #name(&self, #(#arguments),*) -> #gives { loop {} })
    });
    quote!(trait Functions { #(#each)* })
}

/// A field for what a thing can be asked for; `kinds` is the path of the kinds' module.
fn field_of(&(name, shape, docs): &Member, kinds: &TokenStream) -> TokenStream {
    let name = identifier(name);
    let shape = match shape {
        Shape::Scalar => quote!(f64),
        Shape::Vector => quote!(#kinds::Vector),
        Shape::Matrix => quote!([[f64; 3]; 3]),
        Shape::OfBond => quote!(#kinds::Quantity),
    };
    quote!(#[doc = #docs] pub #name: #shape,)
}

/// What names mean.
struct Meaning<'c> {
    parts: &'c [Scope],
}

/// Where a word of a path has led to.
#[derive(Clone, Copy)]
enum At<'c> {
    Declared(&'c Declared),
    Quantity(Shape),
}

impl<'c> Meaning<'c> {
    /// The struct of a graph or part, and what it mentions. `model` has the structs that its parameters and inputs are
    /// fields of.
    fn scope(&self, scope: &'c Scope, model: Option<&Compiled>) -> TokenStream {
        // The place of a graph's name is that of the generated model.
        let is_part = self.parts.iter().any(|part| std::ptr::eq(part, scope));
        let place = if is_part { scope.name.places()[0] } else { Span::call_site() };
        let (name, own_name) = (placed(&scope.name.text, place), identifier(&scope.name.text));
        let (own, docs) = (Fields { model }, &scope.docs);
        let fields = scope.fields.iter().map(|field| own.field(scope, field));
        let frames = scope.fields.iter().filter_map(|field| own.frame(scope, field));
        let outputs = scope.outputs.iter().enumerate().map(|(index, outputs)| {
            let name = format_ident!("{}_outputs_{index}", scope.name.text);
            let fields = outputs.iter().map(|field| own.field(scope, field));
            quote!(pub struct #name { #(#fields)* })
        });
        let mentions = scope.mentions.iter().filter(|path| own.is_field_of(path).is_none());
        let mentions = mentions.map(|path| self.mention(scope, path).0).filter(|words| !words.is_empty());
        let called = scope.mentions.iter().filter_map(|path| self.function(scope, path));
        let called: Vec<Ident> = called.map(|(word, place)| placed(word, *place)).collect();
        // Out of the modules of the names.
        let up = quote!(super);
        let of = |which: &'static str| {
            let paths = scope.mentions.iter().filter(|path| own.is_field_of(path) == Some(which));
            let words: Vec<Ident> = paths.map(|path| placed(&path[0].0, path[0].1)).collect();
            let (function, of) =
                (identifier(&which.to_lowercase()), format_ident!("{}{which}", model?.source.name.text));
            (!words.is_empty()).then(|| quote!(fn #function(of: &#up::#up::#up::#of) { #(let _ = of.#words;)* }))
        };
        let (parameters, inputs) = (of(PARAMETERS), of(INPUTS));
        quote! {
            #[doc = #docs]
            pub struct #name { #(#fields)* }
            #(#frames)*
            #(#outputs)*
            impl #own_name {
                fn mentions(of: &Self) { #(let _ = of #mentions;)* #(let _ = <Self as #up::Functions>::#called;)* }
                #parameters
                #inputs
            }
        }
    }

    /// The words of a path as far as they mean something, and how many of them do.
    fn mention(&self, scope: &'c Scope, path: &Path) -> (TokenStream, usize) {
        let mut words = TokenStream::new();
        let mut at = None;
        for (index, (text, place)) in path.iter().enumerate() {
            let next = match at {
                None => self.first(scope, text),
                Some(at) => self.after(at, text).map(|at| (None, at)),
            };
            let Some((around, next)) = next else { return (words, index) };
            let around = around.map(|part: &Declared| identifier(&part.word)).into_iter();
            // The ground's name is the language's.
            let is_ground = matches!(next, At::Declared(Declared { kind: DeclarationKind::Frame("Ground", ..), .. }));
            let word = if is_ground { identifier(text) } else { placed(text, *place) };
            words.extend(quote!(#(.#around)* .#word));
            at = Some(next);
        }
        (words, path.len())
    }

    /// The function of the language that a path is, where the scope calls nothing of its own so.
    fn function<'p>(&self, scope: &'c Scope, path: &'p Path) -> Option<&'p (String, Span)> {
        let [called] = path.as_slice() else { return None };
        (functions::named(&called.0).is_some() && self.first(scope, &called.0).is_none()).then_some(called)
    }

    /// The first name in which a word means nothing, up to that word, or else the first one that ends with a dot.
    fn at_caret(&self, scope: &'c Scope, faults: &[Fault], unfinished: &[Path]) -> Option<TokenStream> {
        let mut names = scope.mentions.iter().filter(|path| self.function(scope, path).is_none());
        let open = names.find_map(|path| {
            let (words, known) = self.mention(scope, path);
            let (text, place) = path.get(known)?;
            let last = &path[path.len() - 1].0;
            let quoted = if path.len() == 1 { format!("`{last}`") } else { format!(".{last}`") };
            let is_told = faults.iter().any(|fault| fault.message.contains(&quoted));
            let word = placed(text, *place);
            (is_told || text.contains(CARET)).then(|| quote!(#words.#word))
        });
        open.or_else(|| {
            let whole = |path| Some(self.mention(scope, path)).filter(|(_, known)| *known == path.len());
            unfinished.iter().find_map(whole).map(|(words, _)| words)
        })
    }

    /// What a name begins with, and the part without a name that it is in.
    fn first(&self, scope: &'c Scope, text: &str) -> Option<(Option<&'c Declared>, At<'c>)> {
        let named = |fields: &'c [Declared]| fields.iter().find(|field| field.word == text).map(At::Declared);
        if let Some(at) = named(&scope.fields) {
            return Some((None, at));
        }
        scope.fields.iter().find_map(|field| match &field.kind {
            DeclarationKind::Part { of, is_named: false } => Some((Some(field), named(&self.part(of)?.fields)?)),
            _ => None,
        })
    }

    fn after(&self, at: At<'c>, text: &str) -> Option<At<'c>> {
        let member = |members: &[Member]| {
            members.iter().find(|(name, ..)| *name == text).map(|&(_, shape, _)| At::Quantity(shape))
        };
        match at {
            At::Quantity(Shape::Vector | Shape::OfBond) => {
                ["x", "y", "z"].contains(&text).then_some(At::Quantity(Shape::Scalar))
            }
            At::Quantity(_) => None,
            At::Declared(field) => match &field.kind {
                DeclarationKind::Thing(_, members) => member(members),
                DeclarationKind::Point => member(&members::POINT),
                DeclarationKind::Frame(_, points, members) => {
                    points.iter().find(|point| point.word == text).map(At::Declared).or_else(|| member(members))
                }
                DeclarationKind::Part { of, .. } => {
                    self.part(of)?.fields.iter().find(|field| field.word == text).map(At::Declared)
                }
                DeclarationKind::Parameter
                | DeclarationKind::Input
                | DeclarationKind::Value
                | DeclarationKind::Port => None,
            },
        }
    }

    /// The part of this path, if this call describes it.
    fn part(&self, path: &Path) -> Option<&'c Scope> {
        let [(name, _)] = path.as_slice() else { return None };
        self.parts.iter().find(|part| part.name.text == *name)
    }
}

/// How a scope's declarations become fields.
struct Fields<'m> {
    model: Option<&'m Compiled>,
}

impl Fields<'_> {
    /// The struct that has the parameter or input that a path is, where the model has one.
    fn is_field_of(&self, path: &Path) -> Option<&'static str> {
        let ([(name, _)], Some(model)) = (path.as_slice(), self.model) else { return None };
        if model.equations.parameters.iter().any(|parameter| parameter.name.text == *name) {
            return Some(PARAMETERS);
        }
        model.derived.causal.graph.inputs.iter().any(|input| input.name.text == *name).then_some(INPUTS)
    }

    fn field(&self, scope: &Scope, field: &Declared) -> TokenStream {
        let is_elsewhere = matches!(field.kind, DeclarationKind::Parameter | DeclarationKind::Input)
            && self.is_field_of(&vec![(field.word.clone(), field.place)]).is_some();
        let name = if is_elsewhere { identifier(&field.word) } else { placed(&field.word, field.place) };
        let docs = self.docs(field);
        let kind = match &field.kind {
            DeclarationKind::Parameter => quote!(super::kinds::Parameter),
            DeclarationKind::Input => quote!(super::kinds::Input),
            DeclarationKind::Value => quote!(super::kinds::Value),
            DeclarationKind::Port => quote!(super::kinds::Port),
            DeclarationKind::Point => quote!(super::kinds::Point),
            DeclarationKind::Thing(kind, _) => {
                let kind = identifier(kind);
                quote!(super::kinds::#kind)
            }
            DeclarationKind::Frame(kind, ..) => {
                let (module, kind) = (module(scope, field), identifier(kind));
                quote!(#module::#kind)
            }
            DeclarationKind::Part { of, .. } => match of.as_slice() {
                [(part, place)] => {
                    let part = placed(part, *place);
                    quote!(super::parts::#part)
                }
                _ => quote!(super::kinds::Value),
            },
        };
        quote!(#[doc = #docs] pub #name: #kind,)
    }

    /// The struct of something with points, in a module of its own so that its name can be short.
    fn frame(&self, scope: &Scope, field: &Declared) -> Option<TokenStream> {
        let DeclarationKind::Frame(kind, points, members) = &field.kind else { return None };
        let (module, kind) = (module(scope, field), identifier(kind));
        let points = points.iter().map(|point| {
            let (name, docs) = (placed(&point.word, point.place), &point.docs);
            quote!(#[doc = #docs] pub #name: super::super::kinds::Point,)
        });
        let kinds = quote!(super::super::kinds);
        let members = members.iter().map(|member| field_of(member, &kinds));
        Some(quote!(pub mod #module { pub struct #kind { #(#points)* #(#members)* } }))
    }

    /// What is said of a name, with its states.
    fn docs(&self, field: &Declared) -> String {
        let states = self.model.map_or(&[][..], |model| &model.equations.states);
        let is_inside = |name: &str| name.strip_prefix(&*field.word).is_some_and(|rest| rest.starts_with(['.', '[']));
        let mut states: Vec<String> = states
            .iter()
            .filter(|state| is_inside(&state.name))
            .map(|state| format!("`{}` {}", whole(&state.name), state.unit))
            .collect();
        states.dedup();
        if states.is_empty() {
            return field.docs.clone();
        }
        let more = states.len().saturating_sub(MOST_STATES);
        states.truncate(MOST_STATES);
        let more = if more > 0 { format!(", and {more} more") } else { String::new() };
        format!("{}\n\nStates: {}{more}.", field.docs, states.join(", "))
    }
}

/// The state of which this is a component.
fn whole(state: &str) -> &str {
    let is_component = |end: &str| matches!(end, "x" | "y" | "z") || end.len() == 2 && end.parse::<u8>().is_ok();
    state.rsplit_once('_').filter(|(_, end)| is_component(end)).map_or(state, |(whole, _)| whole)
}

/// The module of something with points.
fn module(scope: &Scope, field: &Declared) -> Ident {
    format_ident!("{}__{}", scope.name.text, field.word)
}
