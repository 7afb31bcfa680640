//! A part as its user sees it: statements without parts, all names paths.
//!
//! In: what one level of the description gives. Out: the same under a name: `spring` becomes `front.spring`.

use std::collections::BTreeSet;

use proc_macro2::Span;

use crate::fault::Faults;
use crate::source::ast::{ExpressionKind, Item, Name, Observation, Part};
use crate::source::walk::{Met, each_name, of_observation, walk};
use crate::source::words::{GROUND, QUANTITIES, table_called};

/// A part, or a graph, without parts inside.
#[derive(Clone, Debug, Default)]
pub(super) struct Flat {
    /// Its statements.
    pub items: Vec<Item>,
    /// The names of all that these declare.
    pub names: Vec<String>,
    /// What its `observe` names.
    pub outputs: Vec<Observation>,
    /// The junctions that its user bonds to.
    pub ports: Vec<Name>,
    /// Other names of what is inside, each with the path of it.
    pub aliases: Vec<(String, String)>,
    /// The parts inside.
    pub uses: Vec<Placed>,
    /// Of a graph: a fault for each parameter and input that nothing uses.
    pub unused: Faults,
}

/// A use of a part.
#[derive(Clone, Debug)]
pub struct Placed {
    /// Its path; empty for a part whose names stay as they are.
    pub path: String,
    /// The part's name.
    pub part: String,
    /// Where the part is described.
    pub within: Span,
}

impl Placed {
    /// A use of a part whose names stay as they are.
    pub(super) fn of(part: &Part) -> Self {
        let block = part.written.0.clone().into_iter().last();
        let within = block.map_or(part.name.span, |block| block.span());
        Self { path: String::new(), part: part.name.text.clone(), within }
    }

    /// `front: Leg`
    pub(super) fn shown(&self) -> String {
        if self.path.is_empty() { self.part.clone() } else { format!("{}: {}", self.path, self.part) }
    }
}

impl Flat {
    /// The same with the names that it has under `path`.
    pub fn under(mut self, path: &str) -> Self {
        let points = self.ground_points();
        let moved = |name: &str| moved(name, path, &points);
        let tables = self.tables();
        self.items.iter_mut().for_each(|item| walk(item, &mut |met| rename(met, path, &moved, &tables)));
        self.names.iter_mut().for_each(|name| *name = format!("{path}.{name}"));
        self.outputs
            .iter_mut()
            .for_each(|output| of_observation(output, &mut |met| rename(met, path, &moved, &tables)));
        self.ports.iter_mut().for_each(|port| port.text = format!("{path}.{}", port.text));
        self.aliases = self.aliases.iter().map(|(name, of)| (format!("{path}.{name}"), moved(of))).collect();
        self.uses.iter_mut().for_each(|used| used.path = joined(path, &used.path));
        self
    }

    /// One more output; it takes the place of one of its name.
    pub fn output(&mut self, output: Observation) {
        let name = |output: &Observation| {
            output.name.as_ref().map_or_else(|| output.value.to_string(), |name| name.text.clone())
        };
        let text = name(&output);
        self.outputs.retain(|known| name(known) != text);
        let named = Some(Name::new(text, output.value.span));
        self.outputs.push(Observation { name: output.name.clone().or(named), ..output });
    }

    /// The names of its tables, which expressions call as they call functions.
    fn tables(&self) -> BTreeSet<String> {
        let tables =
            self.items.iter().filter_map(|item| if let Item::Table(table) = item { Some(table) } else { None });
        tables.map(|table| table.name.text.clone()).collect()
    }

    /// The ground's points of this part.
    fn ground_points(&self) -> BTreeSet<String> {
        let grounds =
            self.items.iter().filter_map(|item| if let Item::Ground(ground) = item { Some(ground) } else { None });
        grounds.flat_map(|ground| ground.points.iter().map(|point| point.name.text.clone())).collect()
    }
}

/// A path of what `name` is inside of `path`.
fn joined(path: &str, name: &str) -> String {
    if name.is_empty() { path.to_owned() } else { format!("{path}.{name}") }
}

fn rename(met: Met, path: &str, moved: &dyn Fn(&str) -> String, tables: &BTreeSet<String>) {
    match met {
        Met::Declared(name) => name.text = joined(path, &name.text),
        Met::Named(name) | Met::Index(name) => name.text = moved(&name.text),
        Met::Value(value, variable) => each_name(value, &mut |value| match &mut value.kind {
            ExpressionKind::Name(name) if !variable.is_some_and(|variable| is_at(&name.text, variable)) => {
                name.text = moved(&name.text);
            }
            ExpressionKind::Call(name, _) if tables.contains(table_called(&name.text).0) => {
                name.text = moved(&name.text);
            }
            _ => {}
        }),
    }
}

/// Whether a name is that of `whole`, or of something in it.
pub(super) fn is_at(name: &str, whole: &str) -> bool {
    name.strip_prefix(whole).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// The name that something has under `path`. The ground is one for all; what it has of this part has the part's path.
fn moved(name: &str, path: &str, points: &BTreeSet<String>) -> String {
    let first = name.split(['.', '[']).next().unwrap_or_default();
    if first != GROUND {
        return if QUANTITIES.contains(&first) { name.to_owned() } else { format!("{path}.{name}") };
    }
    let rest = name.strip_prefix("ground.").unwrap_or_default();
    if points.iter().any(|point| is_at(rest, point)) { format!("{GROUND}.{path}.{rest}") } else { name.to_owned() }
}
