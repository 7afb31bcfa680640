//! Why a file cannot become a graph.

use thiserror::Error;

/// What is wrong with the file, where, and what to do.
#[derive(Debug, Error)]
pub enum ImportError {
    /// No XML.
    #[error("not XML: {0}")]
    NotXml(#[from] roxmltree::Error),
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
    #[error("line {line}: <{element}> is not read here: {action}")]
    NotExpanded {
        /// Where.
        line: u32,
        /// Which.
        element: String,
        /// What to do.
        action: &'static str,
    },
    /// An attribute or a child element is not there.
    #[error("line {line}: <{element}> has no `{missing}`: add it")]
    Missing {
        /// Where.
        line: u32,
        /// Which element.
        element: String,
        /// What is missing.
        missing: &'static str,
    },
    /// A value that is no number, or too few of them.
    #[error("line {line}: `{name}` of <{element}> is \"{value}\": it must be {wanted}")]
    Value {
        /// Where.
        line: u32,
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
    #[error("line {line}: there is no {what} `{name}`: check the spelling")]
    Unknown {
        /// Where.
        line: u32,
        /// What should have it.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// A name that two have.
    #[error("line {line}: a second {what} `{name}`: rename one of the two")]
    Twice {
        /// Where.
        line: u32,
        /// What has it.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// Joints that are no tree.
    #[error("{0}: the joints of a URDF are a tree with one root")]
    NoTree(String),
}
