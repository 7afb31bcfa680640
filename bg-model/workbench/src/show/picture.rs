//! The graph of a scene as a picture.
//!
//! In: a description. Out: the tables that `bg-picture` draws, with the same indices of elements and bonds.

use std::collections::BTreeMap;
#[cfg(not(target_arch = "wasm32"))]
use std::path::{Path, PathBuf};

use bg_model::description::{BondEnd, Description};
use bg_picture::{Bond, End, Graph, Node, Part};

#[cfg(not(target_arch = "wasm32"))]
use crate::files::whole;

/// How much of a graph is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(not(target_arch = "wasm32"), derive(clap::ValueEnum))]
pub enum Level {
    /// One box for each body, joint, spring, contact and drive
    Words,
    /// Every junction and element
    #[default]
    Full,
}

impl From<Level> for bg_picture::Level {
    fn from(level: Level) -> Self {
        match level {
            Level::Words => Self::Words,
            Level::Full => Self::Full,
        }
    }
}

/// The whole graph of a description as an SVG text.
#[must_use]
pub fn svg(description: &Description) -> String {
    bg_picture::svg(&graph(description), bg_picture::Level::Full)
}

/// A picture that is being drawn in a thread of its own, since that may take longer than a run; in a page, which has no
/// threads, when it is asked for.
pub struct Drawn(Pending);

#[cfg(target_arch = "wasm32")]
type Pending = &'static Description;
#[cfg(not(target_arch = "wasm32"))]
type Pending = std::thread::JoinHandle<String>;

impl Drawn {
    /// Begins to draw the whole graph of a description.
    ///
    /// # Panics
    /// The machine has no memory for a thread.
    #[must_use]
    pub fn begun(description: &'static Description) -> Self {
        Self(cfg_select! {
            target_arch = "wasm32" => description,
            _ => std::thread::spawn(move || svg(description)),
        })
    }

    /// The same by [`svg_kept`].
    ///
    /// # Panics
    /// As [`Drawn::begun`].
    #[cfg(not(target_arch = "wasm32"))]
    #[must_use]
    pub fn begun_or_kept(description: &'static Description, file: PathBuf) -> Self {
        Self(std::thread::spawn(move || svg_kept(description, &file)))
    }

    /// The picture, as soon as it is there: an SVG text.
    ///
    /// # Panics
    /// Drawing has panicked.
    #[must_use]
    pub fn svg(self) -> String {
        cfg_select! {
            target_arch = "wasm32" => svg(self.0),
            _ => self.0.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
        }
    }
}

/// The same, taken from a file where that has the picture of this very graph, else drawn and kept there. A file that
/// cannot be used is as none.
#[cfg(not(target_arch = "wasm32"))]
#[must_use]
pub fn svg_kept(description: &Description, file: &Path) -> String {
    let graph = graph(description).to_string();
    let kept = std::fs::read_to_string(file).unwrap_or_default();
    if let Some((_, svg)) = kept.split_once(END).filter(|(of, _)| *of == graph) {
        return svg.to_owned();
    }
    let svg = svg(description);
    // Next time it is drawn again.
    let _ = whole::write(file, |file| write!(file, "{graph}{END}{svg}"));
    svg
}

/// What stands between a graph's text and its picture in a file: neither has it.
#[cfg(not(target_arch = "wasm32"))]
const END: char = '\0';

/// The graph of a description.
#[must_use]
pub fn graph(description: &Description) -> Graph {
    let Description { name, parts, elements, bonds, states, .. } = description;
    let nodes: BTreeMap<&str, usize> =
        elements.iter().enumerate().map(|(index, element)| (element.name, index)).collect();
    let node = |element: &bg_model::description::ElementInfo| Node {
        kind: element.kind.to_owned(),
        name: element.name.to_owned(),
        law: element.law.to_owned(),
        states: states
            .iter()
            .filter(|state| state.element == element.name)
            .map(|state| bg_picture::quantity(state.name, state.unit))
            .collect(),
        part: parts.iter().position(|part| part.name == element.part),
    };
    let bond = |bond: &bg_model::description::BondInfo| {
        Some(Bond {
            from: *nodes.get(bond.from)?,
            to: *nodes.get(bond.to)?,
            cardinality: bond.cardinality,
            stroke: match bond.stroke {
                BondEnd::From => End::From,
                BondEnd::To => End::To,
            },
            effort: bond.effort.to_owned(),
            flow: bond.flow.to_owned(),
        })
    };
    Graph {
        name: (*name).to_owned(),
        parts: parts.iter().map(|part| Part { word: part.word.to_owned(), name: part.name.to_owned() }).collect(),
        nodes: elements.iter().map(node).collect(),
        bonds: bonds.iter().filter_map(bond).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn described(name: &'static str) -> Description {
        Description { name, ..Description::default() }
    }

    #[test]
    fn a_picture_is_kept_while_the_graph_is_the_same() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("kept");
        let drawn = svg_kept(&described("first"), &file);
        assert_eq!(drawn, svg(&described("first")));
        let kept = std::fs::read_to_string(&file).expect("a file");
        std::fs::write(&file, kept.replace("<svg", "<svg id=\"kept\"")).expect("written");
        assert!(svg_kept(&described("first"), &file).contains("id=\"kept\""));
        assert_eq!(svg_kept(&described("second"), &file), svg(&described("second")));
    }
}
