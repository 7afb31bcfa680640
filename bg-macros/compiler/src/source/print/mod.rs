//! The tree as text in one canonical layout, so that parsing the text gives an equal tree.
//!
//! In: any tree of [`crate::source::ast`]. Out: its text: four blanks per level, one statement per line, no parenthesis
//! and no digit more than needed. No text ends with a line feed but that of a whole source.

mod bodies;
mod elements;
mod expression;
mod joints;
mod part;
mod signals;
mod studies;

use std::fmt::{Display, Formatter, Result};

use crate::source::ast::{Baumgarte, Expectation, Expression, Graph, Gravity, Item, Name, Part, Source};
use crate::source::print::studies::observe;

impl Display for Source {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let texts = self.parts.iter().map(Part::to_string).chain(self.graphs.iter().map(Graph::to_string));
        for (i, text) in texts.enumerate() {
            let gap = if i > 0 { "\n" } else { "" };
            writeln!(f, "{gap}{text}")?;
        }
        Ok(())
    }
}

impl Display for Graph {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        documentation(f, &self.docs)?;
        write!(f, "{}graph {} ", self.visibility.text(), self.name)?;
        statements(f, &self.items)
    }
}

/// A block of statements with blank lines between its sections.
fn statements(f: &mut Formatter<'_>, items: &[Item]) -> Result {
    f.write_str("{")?;
    for (i, item) in items.iter().enumerate() {
        let before = i.checked_sub(1).and_then(|before| items.get(before));
        let gap = before.is_some_and(|before| section(item).is_none() || section(item) != section(before));
        write!(f, "{}", if gap { "\n\n" } else { "\n" })?;
        indented(f, &item.to_string())?;
    }
    f.write_str(if items.is_empty() { "}" } else { "\n}" })
}

/// Which items stand together without a blank line; none beside one with a block.
const fn section(item: &Item) -> Option<u8> {
    match item {
        Item::Parameter(_) | Item::Input(_) => Some(0),
        Item::Let(_) | Item::Table(_) | Item::State(_) | Item::Memory(_) => Some(1),
        Item::Junction(_) | Item::Element(_) => Some(2),
        Item::Chain(_) => Some(3),
        Item::Track(_) => Some(4),
        Item::Close(_) => Some(5),
        _ => None,
    }
}

/// Documentation as lines of `///`.
fn documentation(f: &mut Formatter<'_>, docs: &str) -> Result {
    for line in docs.lines() {
        writeln!(f, "///{}{line}", if line.is_empty() { "" } else { " " })?;
    }
    Ok(())
}

/// Every line of `text` one level deeper, without a line feed at the end.
fn indented(f: &mut Formatter<'_>, text: &str) -> Result {
    for (i, line) in text.lines().enumerate() {
        let feed = if i > 0 { "\n" } else { "" };
        let indent = if line.is_empty() { "" } else { "    " };
        write!(f, "{feed}{indent}{line}")?;
    }
    Ok(())
}

/// A block of statements, one per line.
fn block(f: &mut Formatter<'_>, entries: &[String]) -> Result {
    if entries.is_empty() {
        return f.write_str("{}");
    }
    f.write_str("{\n")?;
    indented(f, &entries.join("\n"))?;
    f.write_str("\n}")
}

/// A braced list on one line.
fn list<T: Display>(entries: &[T], separator: &str) -> String {
    let entries: Vec<String> = entries.iter().map(T::to_string).collect();
    if entries.is_empty() { "{}".into() } else { format!("{{ {} }}", entries.join(separator)) }
}

/// A clause in front of a value that may be left out.
fn clause<T: Display>(word: &str, value: Option<&T>) -> String {
    value.map_or_else(String::new, |value| format!(" {word} {value}"))
}

/// A statement of a block that may be left out.
fn setting(entries: &mut Vec<String>, word: &str, value: Option<&Expression>) {
    entries.extend(value.map(|value| format!("{word} {value};")));
}

impl Display for Name {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str(&self.text)
    }
}

impl Display for Item {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Parameter(parameter) => parameter.fmt(f),
            Self::Table(table) => table.fmt(f),
            Self::State(state) => state.fmt(f),
            Self::Memory(memory) => memory.fmt(f),
            Self::Every(every) => every.fmt(f),
            Self::Input(input) => input.fmt(f),
            Self::Let(binding) => binding.fmt(f),
            Self::Junction(junction) => junction.fmt(f),
            Self::Element(element) => element.fmt(f),
            Self::Chain(names) => {
                let names: Vec<&str> = names.iter().map(|name| name.text.as_str()).collect();
                write!(f, "{};", names.join(" -> "))
            }
            Self::Track(track) => track.fmt(f),
            Self::Close(close) => close.fmt(f),
            Self::Observe(watched) => observe(f, watched),
            Self::Scene(scene) => scene.fmt(f),
            Self::ScenesOnly(_) => f.write_str("scenes only;"),
            Self::Ground(ground) => ground.fmt(f),
            Self::Gravity(Gravity { acceleration, .. }) => write!(f, "gravity {acceleration};"),
            Self::Impulse(_) => f.write_str("start impulse;"),
            Self::Baumgarte(Baumgarte { rate, .. }) => write!(f, "baumgarte {rate};"),
            Self::IntegralCausality => Expectation::IntegralCausality.fmt(f),
            Self::Body(body) => body.fmt(f),
            Self::Joint(joint) => joint.fmt(f),
            Self::Spring(spring) => spring.fmt(f),
            Self::Drive(drive) => drive.fmt(f),
            Self::Contact(contact) => contact.fmt(f),
            Self::ShapeContact(contact) => contact.fmt(f),
            Self::Friction(friction) => friction.fmt(f),
            Self::Stop(stop) => stop.fmt(f),
            Self::Orifice(orifice) => orifice.fmt(f),
            Self::Use(used) => used.fmt(f),
            Self::Port(port) => port.fmt(f),
            Self::Start(start) => start.fmt(f),
            Self::For(repeated) => repeated.fmt(f),
        }
    }
}
