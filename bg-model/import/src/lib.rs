//! Descriptions of robots, URDF and MJCF, as text of `bond_graph!`.
//!
//! In: the text of a file. Out: the text of a Rust file with one graph, and what was left out. Method: three pure
//! stages.
//!
//! | stage | from -> to | what no longer occurs after it |
//! |---|---|---|
//! | [`xml`] | bytes -> [`xml::Node`] | encodings, namespaces |
//! | [`urdf`], [`mjcf`] | -> [`robot::Robot`] | elements, defaults, degrees, shapes |
//! | [`merge`] | -> [`robot::Robot`] | fixed joints, links without mass, moments that no body has |
//! | [`text`] | -> `String` | |
//!
//! Whatever the second stage asks of the tree is marked there; what is left is a note ([`unread`]).

pub mod error;
pub mod merge;
pub mod mjcf;
pub mod robot;
pub mod text;
pub mod unread;
pub mod urdf;
pub mod xml;

mod check;
mod couple;
mod encoding;
mod geometry;
mod mesh;
mod names;
mod number;

use std::path::Path;

pub use error::ImportError;
pub use names::shown;

/// The folder of a file, from which the paths in it count; none where there is a text alone.
pub type Folder<'a> = Option<&'a Path>;

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
    /// That there are no contacts is a note; else it is known.
    pub contacts: bool,
    /// What drives a joint gives no more effort than the file says.
    pub actuators: bool,
    /// What is not as in the file is an error; else a note.
    pub strict: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            free_base: false,
            keep_fixed: false,
            compliant: false,
            drives: true,
            limits: true,
            contacts: true,
            actuators: false,
            strict: false,
        }
    }
}

/// A graph made of a file.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The Rust file.
    pub text: String,
    /// What it has in another way than the file, or not at all; a sentence each. The text's head has them, too.
    pub notes: Vec<String>,
    /// In which way it has what is not plain; nothing is lost by these.
    pub remarks: Vec<String>,
}

/// Makes a graph of a file.
///
/// # Errors
/// What cannot be read, is no XML, no robot, or has values that cannot be: with the line.
pub fn import_file(format: Format, file: &Path, options: Options) -> Result<Imported, ImportError> {
    let shown = file.display().to_string();
    let bytes = std::fs::read(file)
        .map_err(|fault| ImportError::Unreadable { file: shown.clone(), fault: fault.to_string() })?;
    let name = file.file_name().map_or(shown, |name| name.to_string_lossy().into_owned());
    let folder = file.parent().map(|folder| if folder.as_os_str().is_empty() { Path::new(".") } else { folder });
    robot(format, &name, &encoding::text(&bytes)?, folder, options)
}

/// Makes a graph of the text of a file; `file` is its name, for the head comment. Other files that it names are not
/// read.
///
/// # Errors
/// What is no XML, no robot, or has values that cannot be: with the line.
pub fn import(format: Format, file: &str, text: &str, options: Options) -> Result<Imported, ImportError> {
    robot(format, file, text, None, options)
}

fn robot(format: Format, file: &str, text: &str, folder: Folder, options: Options) -> Result<Imported, ImportError> {
    let robot = match format {
        Format::Urdf => urdf::read(text, options)?,
        Format::Mjcf => mjcf::read(text, folder, options)?,
    };
    let robot = merge::merge(robot, options)?;
    if options.strict && !robot.notes.is_empty() {
        return Err(ImportError::NotAll { notes: robot.notes });
    }
    Ok(Imported { text: text::write(&robot, file, options), notes: robot.notes, remarks: robot.remarks })
}
