//! Why a file cannot become a graph.

use thiserror::Error;

use crate::xml::FilePlace;

/// What is wrong with the file, where, and what to do.
#[derive(Debug, Error)]
pub enum ImportError {
    /// Bytes that are no text.
    #[error("the file is not in {encoding}: save it in UTF-8, or name its encoding in the first line")]
    Encoding {
        /// As which they were read.
        encoding: String,
    },
    /// A file that cannot be read.
    #[error("cannot read {file}: {fault}")]
    Unreadable {
        /// Which.
        file: String,
        /// Why.
        fault: String,
    },
    /// No XML.
    #[error("{}not XML: {fault}", file.as_ref().map(|file| format!("{file}: ")).unwrap_or_default())]
    NotXml {
        /// An included file.
        file: Option<String>,
        /// What it is not.
        fault: roxmltree::Error,
    },
    /// Elements inside of elements.
    #[error("elements are more than {most} deep inside of each other: no robot is so deep; correct the file")]
    TooDeep {
        /// How deep they may be.
        most: usize,
    },
    /// The root element is another one.
    #[error("the file begins with <{found}>, not with <{wanted}>: {action}")]
    WrongRoot {
        /// What it is.
        found: String,
        /// What it should be.
        wanted: &'static str,
        /// What to do.
        action: &'static str,
    },
    /// An element that has to be expanded before.
    #[error("{place}: <{element}> is not read here: {action}")]
    NotExpanded {
        /// Where.
        place: FilePlace,
        /// Which.
        element: String,
        /// What to do.
        action: String,
    },
    /// An attribute or a child element is not there.
    #[error("{place}: <{element}> has no `{missing}`: add it")]
    Missing {
        /// Where.
        place: FilePlace,
        /// Which element.
        element: String,
        /// What is missing.
        missing: &'static str,
    },
    /// A value that is no number, or too few of them.
    #[error("{place}: `{name}` of <{element}> is \"{value}\": it must be {wanted}")]
    Value {
        /// Where.
        place: FilePlace,
        /// Which element.
        element: String,
        /// Which attribute.
        name: String,
        /// Its text.
        value: String,
        /// What it must be.
        wanted: String,
    },
    /// A name that nothing has.
    #[error("{place}: there is no {what} `{name}`: check the spelling")]
    Unknown {
        /// Where.
        place: FilePlace,
        /// What should have it.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// A name that two have.
    #[error("{place}: a second {what} `{name}`: rename one of the two")]
    Twice {
        /// Where.
        place: FilePlace,
        /// What has it.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// Elements that do not go together.
    #[error("{place}: {what}")]
    Wrong {
        /// Where.
        place: FilePlace,
        /// What is wrong, and what to do.
        what: String,
    },
    /// Joints that are no tree.
    #[error("{0}: the joints of a URDF are a tree with one root")]
    NoTree(String),
    /// A robot without a motion.
    #[error(
        "nothing moves: no joint carries a link with mass; give the links a mass and a joint that is not fixed, or \
         take --free-base for a URDF whose root moves{}",
        listed("\nWhat is not there:", notes)
    )]
    NothingMoves {
        /// What has been left out until then, a sentence each.
        notes: Vec<String>,
    },
    /// A number that the calculation has not kept finite.
    #[error("{what} has numbers that are too large to calculate with: check its sizes, places and masses")]
    TooLarge {
        /// Which link or joint.
        what: String,
    },
    /// Something is not as in the file, and it has to be.
    #[error("{}", listed("not all of the file can be kept, so nothing is written:", notes))]
    NotAll {
        /// What, a sentence each.
        notes: Vec<String>,
    },
}

/// Notes below a head; nothing where there are none.
fn listed(head: &str, notes: &[String]) -> String {
    if notes.is_empty() {
        return String::new();
    }
    let lines: String = notes.iter().map(|note| format!("\n  {note}")).collect();
    format!("{head}{lines}")
}
