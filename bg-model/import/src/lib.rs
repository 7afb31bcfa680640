//! Descriptions of robots, URDF and MJCF, as text of `bond_graph!`.
//!
//! In: the text of a file. Out: the text of a Rust file with one graph, and what was left out. Method: three pure stages.
//!
//! | stage | from -> to | what no longer occurs after it |
//! |---|---|---|
//! | [`urdf`], [`mjcf`] | XML -> [`robot::Robot`] | elements, defaults, degrees, shapes |
//! | [`merge`] | -> [`robot::Robot`] | fixed joints, links without mass, moments that no body has |
//! | [`text`] | -> `String` | |

pub mod error;
pub mod merge;
pub mod mjcf;
pub mod robot;
pub mod text;
pub mod urdf;

mod geometry;
mod names;
mod number;
mod xml;

pub use error::ImportError;

/// What describes the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// The Unified Robot Description Format of ROS.
    Urdf,
    /// MuJoCo's XML.
    Mjcf,
}

/// What the text is to be like.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// The root link of a URDF moves freely; else it is the ground.
    pub free_base: bool,
    /// Fixed joints stay; else what they join is one body.
    pub keep_fixed: bool,
    /// Joints give way, and a scene has them rigid; else they are rigid.
    pub compliant: bool,
    /// Each joint has an input that drives it.
    pub drives: bool,
    /// Limits become stops.
    pub limits: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { free_base: false, keep_fixed: false, compliant: false, drives: true, limits: true }
    }
}

/// A graph made of a file.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The Rust file.
    pub text: String,
    /// What it has in another way than the file, or not at all; a sentence each. The text's head has them, too.
    pub notes: Vec<String>,
}

/// Makes a graph of the text of a file; `file` is its name, for the head comment.
///
/// # Errors
/// What is no XML, no robot, or has values that cannot be: with the line.
pub fn import(format: Format, file: &str, text: &str, options: Options) -> Result<Imported, ImportError> {
    let robot = match format {
        Format::Urdf => urdf::read(text, options.free_base)?,
        Format::Mjcf => mjcf::read(text)?,
    };
    let robot = merge::merge(robot, options.keep_fixed);
    Ok(Imported { text: text::write(&robot, file, options), notes: robot.notes })
}
