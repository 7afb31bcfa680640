//! What one graph or part declares, and which names it mentions, each word with its place.
//!
//! In: the statements as written. Out: a [`Scope`]. Nothing is resolved here.

use proc_macro2::Span;

use super::members::{self, Member};
use crate::source::ast::{
    Body, Expression, ExpressionKind, For, Ground, Item, Name, Observation, Parameter, Point, Port, Scene, Use, Watch,
};
use crate::source::walk::{Met, each_name, walk};
use crate::source::words::GROUND;

/// A path as somebody wrote it: its words, each with its place.
pub(super) type Path = Vec<(String, Span)>;

/// A graph or a part.
pub(super) struct Scope {
    pub name: Name,
    pub docs: String,
    /// What it declares.
    pub fields: Vec<Declared>,
    /// The outputs of each of its lists, which have names among themselves. Those of a part are fields.
    pub outputs: Vec<Vec<Declared>>,
    /// The names that it mentions.
    pub mentions: Vec<Path>,
}

/// What is declared.
#[derive(Clone)]
pub(super) struct Declared {
    pub word: String,
    pub place: Span,
    /// What an editor shows.
    pub docs: String,
    pub kind: DeclarationKind,
}

/// What something is, by which a name that goes on after it is read.
#[derive(Clone)]
pub(super) enum DeclarationKind {
    Parameter,
    Input,
    /// A value, an output.
    Value,
    Port,
    /// A point of a body.
    Point,
    /// A word of the language with what can be asked of it: `Revolute`.
    Thing(String, Vec<Member>),
    /// A body or the ground, with points.
    Frame(&'static str, Vec<Declared>, Vec<Member>),
    /// The use of a part; one without a name has its names here.
    Part {
        of: Path,
        is_named: bool,
    },
}

impl Scope {
    pub fn of((name, docs): (&Name, &str), items: &[Item], is_part: bool) -> Self {
        let (name, docs) = (name.clone(), docs.to_owned());
        let scope = Self { name, docs, fields: Vec::new(), outputs: Vec::new(), mentions: Vec::new() };
        let mut reading = Reading { scope, is_part, indices: Vec::new() };
        items.iter().for_each(|item| reading.item(item));
        reading.everywhere();
        reading.scope
    }
}

struct Reading {
    scope: Scope,
    is_part: bool,
    /// The indices around the present statement.
    indices: Vec<String>,
}

impl Reading {
    fn item(&mut self, item: &Item) {
        match item {
            Item::For(For { index, items, .. }) => {
                self.indices.push(index.text.clone());
                items.iter().for_each(|item| self.item(item));
                self.indices.pop();
                return;
            }
            Item::Observe(watched) => return self.watched(watched),
            Item::Scene(scene) => return self.scene(scene),
            Item::Ground(ground) => self.ground(ground),
            Item::Body(body) => self.body(body),
            Item::Use(used) => self.used(used),
            _ => {}
        }
        let (kind, docs) = (kind(item), shown(item));
        walk(&mut item.clone(), &mut |met| match met {
            Met::Declared(name) => {
                if let Some(kind) = &kind {
                    self.declared(name, kind.clone(), docs.clone());
                }
            }
            Met::Named(name) => self.mentioned(&[], name),
            Met::Value(value, variable) => self.value(value, variable),
            Met::Index(_) => {}
        });
    }

    /// A name of this scope. What has been declared already, such as another element of an array, is mentioned.
    fn declared(&mut self, name: &Name, kind: DeclarationKind, docs: String) {
        let Some((word, place)) = one_word(name) else { return };
        if self.scope.fields.iter().any(|known| known.word == word) {
            self.scope.mentions.push(vec![(word, place)]);
        } else {
            self.scope.fields.push(Declared { word, place, docs, kind });
        }
    }

    /// A name in something that this scope has declared, such as a point of a body.
    fn mentioned(&mut self, within: &[&str], name: &Name) {
        let Some(path) = path(name) else { return };
        let within = within.iter().map(|word| ((*word).to_owned(), Span::call_site()));
        self.scope.mentions.push(within.chain(path).collect());
    }

    fn value(&mut self, value: &mut Expression, variable: Option<&str>) {
        each_name(value, &mut |value| {
            let name = match &value.kind {
                ExpressionKind::Name(name) => name,
                ExpressionKind::Call(function, _) => return self.mentioned(&[], function),
                _ => return,
            };
            let first = name.text.split(['.', '[']).next().unwrap_or_default();
            if variable != Some(first) && !self.indices.iter().any(|index| index == first) {
                self.mentioned(&[], name);
            }
        });
    }

    /// The language's own names, but for what the scope declares itself.
    fn everywhere(&mut self) {
        for (word, docs) in members::EVERYWHERE {
            if !self.scope.fields.iter().any(|known| known.word == word) {
                let (word, docs) = (word.to_owned(), docs.to_owned());
                self.scope.fields.push(Declared { word, place: Span::call_site(), docs, kind: DeclarationKind::Value });
            }
        }
    }

    fn ground(&mut self, ground: &Ground) {
        let points = || ground.points.iter().map(point);
        let known = self.scope.fields.iter_mut().find(|known| known.word == GROUND);
        if let Some(Declared { kind: DeclarationKind::Frame(_, known, _), .. }) = known {
            known.extend(points());
            return;
        }
        let kind = DeclarationKind::Frame("Ground", points().collect(), Vec::new());
        let (word, place, docs) = (GROUND.to_owned(), Span::call_site(), "The inertial frame.".to_owned());
        self.scope.fields.push(Declared { word, place, docs, kind });
    }

    fn body(&mut self, body: &Body) {
        if let Some((Some(point), _)) = &body.start_position {
            let body = body.name.text.split('[').next().unwrap_or_default();
            self.mentioned(&[body], point);
        }
    }

    fn used(&mut self, used: &Use) {
        let of: Path = used.part.name.text.split("::").map(|word| (word.to_owned(), used.part.name.span)).collect();
        let word = used.name.as_ref().map_or_else(
            || format!("part_{}", of.last().map_or("", |(word, _)| word)),
            |name| name.text.split('[').next().unwrap_or_default().to_owned(),
        );
        if used.name.is_none() {
            let (place, docs) = (Span::call_site(), shown(&Item::Use(used.clone())));
            let kind = DeclarationKind::Part { of, is_named: false };
            self.scope.fields.push(Declared { word: word.clone(), place, docs, kind });
        }
        used.arguments.iter().for_each(|argument| self.mentioned(&[&word], &argument.name));
        used.starts.iter().for_each(|start| self.mentioned(&[&word], &start.of));
    }

    fn watched(&mut self, watched: &[Watch]) {
        let outputs: Vec<Declared> = watched.iter().filter_map(Watch::value).filter_map(output).collect();
        if self.is_part {
            self.scope.fields.extend(outputs);
        } else {
            self.scope.outputs.push(outputs);
        }
        for watch in watched {
            match watch {
                Watch::Value(observation) => self.value(&mut observation.value.clone(), None),
                Watch::All(name) => self.mentioned(&[], name),
            }
        }
    }

    fn scene(&mut self, scene: &Scene) {
        self.watched(&scene.observe);
        let lists = Scene { observe: Vec::new(), ..scene.clone() };
        walk(&mut Item::Scene(lists), &mut |met| {
            if let Met::Named(name) = met {
                self.mentioned(&[], name);
            }
        });
    }
}

/// The words of a name with their places, without numbers in brackets; none where nobody wrote them one by one.
pub(super) fn path(name: &Name) -> Option<Path> {
    let mut depth = 0;
    let plain: String = name
        .text
        .chars()
        .filter(|letter| {
            depth += i32::from(*letter == '[') - i32::from(*letter == ']');
            depth == 0 && *letter != ']'
        })
        .collect();
    let words: Vec<&str> = plain.split('.').collect();
    let places = name.places();
    (words.len() == places.len()).then(|| words.into_iter().map(str::to_owned).zip(places.iter().copied()).collect())
}

/// A name without dots.
fn one_word(name: &Name) -> Option<(String, Span)> {
    path(name).filter(|path| path.len() == 1)?.pop()
}

/// What a statement declares; none where its names are looked at one by one.
fn kind(item: &Item) -> Option<DeclarationKind> {
    Some(match item {
        Item::Parameter(_) => DeclarationKind::Parameter,
        Item::Input(_) => DeclarationKind::Input,
        Item::Table(_) => DeclarationKind::Thing("Table".to_owned(), members::of(item)),
        Item::Let(_) | Item::State(_) | Item::Memory(_) | Item::Track(_) => DeclarationKind::Value,
        Item::Every(_) => DeclarationKind::Thing("Sample".to_owned(), members::SAMPLE.to_vec()),
        Item::Port(Port::Alias(..)) => DeclarationKind::Port,
        Item::Port(Port::Junction(junction)) => {
            let item = Item::Junction(junction.clone());
            DeclarationKind::Thing(word(&item), members::of(&item))
        }
        Item::Body(body) => DeclarationKind::Frame("Body", body.points.iter().map(point).collect(), members::of(item)),
        Item::Use(used) => {
            let name = &used.part.name;
            DeclarationKind::Part {
                of: name.text.split("::").map(|word| (word.to_owned(), name.span)).collect(),
                is_named: true,
            }
        }
        Item::Ground(_) => return None,
        _ => DeclarationKind::Thing(word(item), members::of(item)),
    })
}

/// The type that an editor shows: the first word of the statement, of a joint its kind.
fn word(item: &Item) -> String {
    let text = match item {
        Item::Joint(joint) => joint.kind.to_string(),
        Item::Junction(junction) => return format!("Junction{}", junction.kind as u8),
        Item::Element(element) => return format!("{:?}", element.kind),
        other => other.to_string(),
    };
    let first = text.split_whitespace().next().unwrap_or_default();
    let mut letters = first.chars();
    letters.next().map_or_else(String::new, |letter| letter.to_uppercase().chain(letters).collect())
}

fn point(point: &Point) -> Declared {
    let docs = format!("```text\n{point}\n```");
    Declared { word: point.name.text.clone(), place: point.name.places()[0], docs, kind: DeclarationKind::Point }
}

fn output(observation: &Observation) -> Option<Declared> {
    let (word, place) = one_word(observation.name.as_ref()?)?;
    Some(Declared {
        word,
        place,
        docs: format!("Output.\n\n```text\n{observation}\n```"),
        kind: DeclarationKind::Value,
    })
}

/// The statement, after what its author says of it.
fn shown(item: &Item) -> String {
    let (docs, text) = match item {
        Item::Parameter(parameter) => {
            (&*parameter.docs, Parameter { docs: String::new(), ..parameter.clone() }.to_string())
        }
        Item::Input(input) => {
            let text = format!("input {}: {};", input.name, input.unit);
            (&*input.docs, text)
        }
        other => ("", other.to_string()),
    };
    let gap = if docs.is_empty() { "" } else { "\n\n" };
    format!("{docs}{gap}```text\n{text}\n```")
}
