//! The library of parts: files that every text and every call of the macro has, `use gears;`.
//!
//! In: the name of one. Out: its text. They stand in the folder `parts` of this package, so that whatever compiles the
//! language has them, and are written in the language alone. Each has parts only.

use std::path::PathBuf;

/// The files: names and texts.
const FILES: [(&str, &str); 7] = [
    ("belts", include_str!("../../parts/belts.bond")),
    ("controllers", include_str!("../../parts/controllers.bond")),
    ("drives", include_str!("../../parts/drives.bond")),
    ("gears", include_str!("../../parts/gears.bond")),
    ("hydraulics", include_str!("../../parts/hydraulics.bond")),
    ("motors", include_str!("../../parts/motors.bond")),
    ("screws", include_str!("../../parts/screws.bond")),
];

/// What the files are called, in alphabetical order.
pub fn names() -> impl Iterator<Item = &'static str> {
    FILES.iter().map(|(name, _)| *name)
}

/// The text of the file of this name.
#[must_use]
pub fn text(name: &str) -> Option<&'static str> {
    FILES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// What messages call the file of this name.
#[must_use]
pub fn path(name: &str) -> PathBuf {
    PathBuf::from(format!("library/{name}.bond"))
}

/// A part of the library.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LibraryPart {
    /// The file in which it stands.
    pub file: &'static str,
    /// Its name.
    pub name: &'static str,
    /// What it is: its documentation comment, on one line.
    pub docs: String,
    /// It as it stands there, with that comment.
    pub text: &'static str,
}

impl LibraryPart {
    /// Whether other parts are made of it, and graphs are not.
    #[must_use]
    pub fn is_piece(&self) -> bool {
        self.docs.ends_with("A piece of other parts.")
    }
}

/// All parts, by the names of their files and in these by their places.
pub fn parts() -> impl Iterator<Item = LibraryPart> {
    FILES.iter().flat_map(|&(file, text)| text.split_inclusive("\n}\n").filter_map(move |piece| part(file, piece)))
}

/// The part at the end of a piece of a file.
fn part(file: &'static str, piece: &'static str) -> Option<LibraryPart> {
    let text = &piece[piece.find("/// ")?..];
    let docs: Vec<&str> = text.lines().map_while(|line| line.strip_prefix("/// ")).collect();
    let name = text.lines().find_map(|line| line.strip_prefix("part ")?.split(' ').next())?;
    Some(LibraryPart { file, name, docs: docs.join(" "), text })
}

/// The file in which the part of this name stands.
#[must_use]
pub fn home(name: &str) -> Option<&'static str> {
    parts().find(|part| part.name == name).map(|part| part.file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline;
    use crate::source::syntax::files;

    #[test]
    fn each_file_has_documented_parts_alone() {
        for (name, text) in FILES {
            let known: Vec<LibraryPart> = parts().filter(|part| part.file == name).collect();
            let read = crate::source::syntax::parse(files::alone(text).expect("tokens")).expect("parts");
            let names: Vec<&str> = read.parts.iter().map(|part| part.name.text.as_str()).collect();
            assert!(read.graphs.is_empty(), "{name}");
            assert_eq!(known.iter().map(|part| part.name).collect::<Vec<_>>(), names);
            assert!(known.iter().all(|part| part.docs.ends_with('.') && !part.docs.contains("  ")), "{name}");
            assert!(text.lines().all(|line| line.chars().count() <= 120), "{name}");
        }
        assert!(names().is_sorted());
    }

    /// The models of a call, or its first fault.
    fn called(text: &str) -> Result<Vec<usize>, String> {
        let (tokens, faults) = files::call(text.parse().expect("tokens"));
        let source = crate::source::syntax::parse(tokens).map_err(|faults| faults[0].to_string())?;
        if let Some(fault) = faults.first() {
            return Err(fault.to_string());
        }
        let models = pipeline::models(&source).map_err(|faults| faults[0].to_string())?;
        Ok(models.iter().map(|model| model.equations.states.len()).collect())
    }

    #[test]
    fn a_call_has_what_it_uses() {
        let graph = "graph G { part p: GearPair; Se m = 1; 1 a: rotation; 1 b: rotation; I i = 1; m -> a -> p.first; \
            p.second -> b -> i; }";
        assert_eq!(called(&format!("use gears; {graph}")), Ok(vec![1]));
        let said = |text: &str, words: &str| {
            let fault = called(text).expect_err(text);
            assert!(fault.contains(words), "{fault}");
        };
        said(
            graph,
            "[BG0801] there is no part `GearPair`\nhelp: write `use gears;` above it: it is a part of the library",
        );
        said(
            &format!("use gear; {graph}"),
            "[BG0908] the library of parts has no file `gear`\nhelp: write `use gears;`",
        );
        said(&format!("use spline; {graph}"), "or the path of a file of yours in quotes");
        said(
            &format!("use gears; part GearPair {{ let a = 1; }} {graph}"),
            "[BG0302] `GearPair` is the name of a part of the library",
        );
        said(&format!("use gears; use \"shaft.bond\"; {graph}"), "[BG0123]");
    }

    #[test]
    fn only_what_is_used_is_there() {
        let tokens = |text: &str| files::call(text.parse().expect("tokens")).0.to_string();
        assert_eq!(tokens("use gears; graph G { }"), tokens("graph G { }"));
        let elastic = tokens("use gears; graph G { part p: ElasticGearPair; }");
        assert!(
            elastic.contains("part Teeth") && elastic.contains("part StickingLoss") && !elastic.contains("Planetary")
        );
        // A fault of syntax brings no more of it.
        let graph = |watched: &str| format!("use gears; graph G {{ part p: GearPair; observe {{ {watched} }} }}");
        let parts = |watched: &str| tokens(&graph(watched)).matches("part ").count();
        assert_eq!((parts("p."), parts("p.torque")), (2, 2));
        // Nothing is done to a call that uses none.
        let own = "pub graph G { param a : m = 1 ; }";
        assert_eq!(tokens(own), own.parse::<proc_macro2::TokenStream>().expect("tokens").to_string());
    }
}
