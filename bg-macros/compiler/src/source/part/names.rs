//! What names mean on one level of the description.
//!
//! In: its statements, written out, and the parts that it uses. Out: paths of things inside in place of the ports'
//! names, what a part observes in place of the output's name, and faults where an array has no such element.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::Span;

use super::PartFault;
use super::flat::{Flat, is_at};
use super::index::elements;
use crate::fault::{Fault, Faults, near_miss};
use crate::source::ast::{Expression, ExpressionKind, Item, Name, Observation, Port};
use crate::source::walk::{Met, each_name, walk};

/// The names of one level.
#[derive(Default)]
pub(super) struct Names {
    /// Everything that is declared, with its path.
    declared: BTreeSet<String>,
    /// The numbers of each array.
    arrays: BTreeMap<String, BTreeSet<i64>>,
    /// Paths in place of ports.
    aliases: BTreeMap<String, String>,
    /// What parts inside observe.
    outputs: BTreeMap<String, Observation>,
    /// The paths of parts inside.
    parts: BTreeSet<String>,
    /// What the expressions of this level name.
    used: BTreeSet<String>,
}

impl Names {
    /// The names of these statements and of the parts inside.
    pub fn of(items: &mut [Item], inside: &[Flat]) -> Self {
        let mut names = Self::default();
        for item in items {
            if let Item::Port(Port::Alias(name, of)) = item {
                names.aliases.insert(name.text.clone(), of.text.clone());
            }
            // Outputs have names among themselves.
            if matches!(item, Item::Observe(_) | Item::Scene(_)) {
                continue;
            }
            walk(item, &mut |met| {
                if let Met::Declared(name) = met {
                    names.declare(&name.text);
                }
            });
        }
        for flat in inside {
            flat.names.iter().for_each(|name| names.declare(name));
            flat.uses.iter().for_each(|used| names.declare(&used.path));
            names.parts.extend(flat.uses.iter().map(|used| used.path.clone()).filter(|path| !path.is_empty()));
            names.aliases.extend(flat.aliases.iter().cloned());
            let named = |output: &Observation| Some((output.name.as_ref()?.text.clone(), output.clone()));
            names.outputs.extend(flat.outputs.iter().filter_map(named));
        }
        names
    }

    fn declare(&mut self, name: &str) {
        if name.is_empty() {
            return;
        }
        for (array, number) in elements(name) {
            self.arrays.entry(array.to_owned()).or_default().insert(number);
        }
        self.declared.insert(name.to_owned());
    }

    /// The declared names.
    pub fn declared(&self) -> impl Iterator<Item = &str> {
        self.declared.iter().map(String::as_str)
    }

    /// Whether something is declared that has this name.
    pub fn has(&self, name: &str) -> bool {
        self.declared.contains(name)
    }

    /// The elements of an array, in order.
    pub fn elements_of(&self, array: &str) -> impl Iterator<Item = String> {
        self.arrays.get(array).into_iter().flatten().map(move |number| format!("{array}[{number}]"))
    }

    /// Whether an expression of this level names `name`. What a scene tunes is no use of it.
    pub fn uses(&self, name: &str) -> bool {
        self.used.contains(name)
    }

    /// Gives the names of a statement the meaning that they have here.
    pub fn resolve(&mut self, item: &mut Item, faults: &mut Faults) {
        walk(item, &mut |met| match met {
            Met::Declared(_) | Met::Index(_) => {}
            Met::Named(name) => self.name(name, faults),
            Met::Value(value, variable) => self.value(value, variable, faults),
        });
    }

    /// Gives a name the meaning that it has here.
    pub fn name(&mut self, name: &mut Name, faults: &mut Faults) {
        self.check(&name.text, name.span, faults);
        name.text = self.path(&name.text);
    }

    /// Gives the names of an expression the meaning that they have here.
    pub fn value(&mut self, value: &mut Expression, variable: Option<&str>, faults: &mut Faults) {
        each_name(value, &mut |value| {
            let ExpressionKind::Name(name) = &value.kind else { return };
            if variable.is_some_and(|variable| is_at(&name.text, variable)) {
                return;
            }
            self.used.insert(name.text.clone());
            self.check(&name.text, value.span, faults);
            let path = Name::new(self.path(&name.text), value.span);
            // Of an output and a thing of one name an expression means the thing, as in a graph.
            let observed = if self.is_of_thing(&path.text) { None } else { self.observed(&path.text) };
            if observed.is_none()
                && let Some(fault) = self.of_part(&path.text)
            {
                faults.push(Fault::new(value.span, &fault));
            }
            value.kind = observed.unwrap_or(ExpressionKind::Name(path));
        });
    }

    /// Whether a name is that of something declared, or of what this has.
    fn is_of_thing(&self, name: &str) -> bool {
        self.has(name)
            || name.rsplit_once('.').is_some_and(|(whole, _)| self.has(whole) && self.outputs.contains_key(whole))
    }

    /// The output of a part inside that has this name.
    pub fn output(&self, name: &str) -> Option<&Observation> {
        self.outputs.get(name)
    }

    /// The path that a name stands for; ports of parts inside of parts are followed to their end.
    pub fn path(&self, name: &str) -> String {
        let mut path = name.to_owned();
        for _ in 0..=self.aliases.len() {
            let ends = path.match_indices('.').map(|(at, _)| at).chain([path.len()]);
            let known = ends.rev().find_map(|end| Some((end, self.aliases.get(&path[..end])?)));
            let Some((end, of)) = known else { break };
            path = format!("{of}{}", &path[end..]);
        }
        path
    }

    /// What a part observes under this name, or a component of it.
    fn observed(&self, name: &str) -> Option<ExpressionKind> {
        if let Some(output) = self.output(name) {
            return Some(output.value.kind.clone());
        }
        let (whole, component) = name.rsplit_once('.')?;
        let place = ["x", "y", "z"].iter().position(|letter| *letter == component)?;
        let value = &self.output(whole)?.value;
        if let ExpressionKind::Name(path) = &value.kind {
            return Some(ExpressionKind::Name(Name::new(format!("{path}.{component}"), path.span)));
        }
        let span = value.span;
        let axis = std::array::from_fn::<f64, 3, _>(|k| if k == place { 1.0 } else { 0.0 });
        let axis = axis.map(|number| Expression { kind: ExpressionKind::Number(number), span });
        let axis = Expression { kind: ExpressionKind::Vector(axis.into()), span };
        Some(ExpressionKind::Call(Name::new("dot", span), vec![axis, value.clone()]))
    }

    /// The fault of a name that is a part's, or that nothing in a part has.
    fn of_part(&self, name: &str) -> Option<PartFault> {
        if self.parts.contains(name) {
            return Some(PartFault::IsAPart { name: name.to_owned(), outputs: self.outputs_of(name) });
        }
        let ends = name.match_indices('.').map(|(at, _)| at);
        let part = ends.map(|end| &name[..end]).rfind(|part| self.parts.contains(*part))?;
        let inside = name[part.len() + 1..].split(['.', '[']).next().unwrap_or_default();
        let path = format!("{part}.{inside}");
        let is_in =
            |known: &str| known.strip_prefix(&path).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']));
        let mut known = self.declared.iter().chain(self.aliases.keys()).chain(self.outputs.keys());
        if known.any(|known| is_in(known)) {
            return None;
        }
        let outputs = self.outputs_of(part);
        let all = self.declared.iter().chain(self.aliases.keys()).chain(&outputs).map(String::as_str);
        let near = near_miss(&path, all.filter(|known| *known != part)).map(str::to_owned);
        Some(PartFault::NotInPart { part: part.to_owned(), name: inside.to_owned(), near, outputs })
    }

    /// The outputs of the part at this path itself.
    fn outputs_of(&self, part: &str) -> Vec<String> {
        let is_own = |name: &&String| name.strip_prefix(part).is_some_and(|rest| rest.rfind('.') == Some(0));
        self.outputs.keys().filter(is_own).cloned().collect()
    }

    /// Faults of numbers in brackets, and of arrays without.
    fn check(&mut self, name: &str, span: Span, faults: &mut Faults) {
        let wrong = elements(name).find_map(|(array, index)| match self.arrays.get(array) {
            None => Some(PartFault::NotAnArray { name: array.to_owned() }),
            Some(numbers) if numbers.contains(&index) => None,
            Some(numbers) => {
                let numbers = numbers.iter().copied().collect();
                Some(PartFault::NoElement { array: array.to_owned(), index, numbers })
            }
        });
        if let Some(fault) = wrong.or_else(|| self.whole_array(name)) {
            faults.push(Fault::new(span, &fault));
        }
    }

    /// The fault of an array that is named without a number.
    fn whole_array(&self, name: &str) -> Option<PartFault> {
        let ends = name.match_indices('.').map(|(at, _)| at).chain([name.len()]);
        let whole = ends
            .map(|end| &name[..end])
            .find(|whole| !self.declared.contains(*whole) && self.arrays.contains_key(*whole))?;
        let numbers = &self.arrays[whole];
        let first = numbers.first().copied().unwrap_or_default();
        Some(PartFault::IsAnArray { name: whole.to_owned(), first, count: numbers.len() })
    }
}
