//! The command `fmu`: a scene as a functional mock-up unit, for other programs.
//!
//! In: a scene, the library that exports it. Out: one file. The library is a package of its own: what it needs beside
//! the model is not compiled into the program.

use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use bg_fmi::archive::archive;
use bg_fmi::{AtDefaults, Packing, Version};
use thiserror::Error;

use super::arguments::FmuArguments;
use super::{InputError, say};
use crate::Program;
use crate::files::whole;
use crate::parameters::Values;

/// A library that there is none of.
#[derive(Debug, Error)]
pub(super) enum LibraryError {
    #[error(
        "there is no library {file} in {}: build a package of crate-type \"cdylib\" with `bg_fmi::export!({model});` in its lib.rs, \
         or give it as --library FILE; docs/fmu.md shows one",
        folder.display()
    )]
    Absent { file: String, folder: PathBuf, model: &'static str },
    #[error("--library {}: {source}", path.display())]
    Unreadable { path: PathBuf, source: io::Error },
    #[error(
        "--library {}: it exports no model for FMI {}; give the file that cargo builds of a package with `bg_fmi::export!(..)`",
        .0.display(), .1
    )]
    Foreign(PathBuf, &'static str),
}

pub(super) fn pack(program: &Program, arguments: &FmuArguments) -> Result<ExitCode, InputError> {
    let FmuArguments { library, out, t_end, .. } = arguments;
    let scene = program.scene_called(&arguments.scene);
    let name = &program.texts.name;
    let is_own = scene.name == program.scene;
    let identifier = identifier(&if is_own { name.clone() } else { format!("{name}_{}", scene.name) });
    let library = match library {
        Some(path) => path.clone(),
        None => beside_the_program(name, scene.description.name)?,
    };
    let bytes = std::fs::read(&library);
    let bytes = bytes.map_err(|source| LibraryError::Unreadable { path: library.clone(), source })?;
    let version = if arguments.fmi == Version::Two.name() { Version::Two } else { Version::Three };
    if !exports(&bytes, version) {
        return Err(LibraryError::Foreign(library, version.name()).into());
    }
    let path = out.clone().unwrap_or_else(|| PathBuf::from(format!("{identifier}.fmu")));
    let packing = Packing { version, identifier, stop_time: *t_end };
    let own = Values::new(scene.description.parameters);
    let machine = program.models.maker().make(scene.index, own.values(), &[]);
    let model = AtDefaults { description: scene.description, model: machine.ok().map(|machine| machine.model()) };
    let unit = archive(&model, &packing, &bytes);
    whole::write(&path, |file| file.write_all(&unit?))?;
    let (name, version, platform) = (scene.description.name, version.name(), bg_fmi::archive::platform(version));
    Ok(say(&format!("{}: {name} for FMI {version}, {platform}\n", path.display())))
}

/// A name of letters, digits and underscores, for a library in a unit.
fn identifier(name: &str) -> String {
    let text: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if text.starts_with(|c: char| c.is_ascii_digit()) { format!("_{text}") } else { text }
}

/// The library of the program `name` where cargo puts it: beside the program, or above it where that is an example.
fn beside_the_program(name: &str, model: &'static str) -> Result<PathBuf, LibraryError> {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    let file = format!("{DLL_PREFIX}{}_fmu{DLL_SUFFIX}", identifier(name));
    let program = std::env::current_exe().unwrap_or_default();
    let folder = program.parent().unwrap_or(Path::new(".")).to_owned();
    let above =
        if folder.ends_with("examples") { folder.parent().map(Path::to_owned) } else { Some(folder.join("examples")) };
    let found =
        std::iter::once(folder.clone()).chain(above).map(|folder| folder.join(&file)).find(|path| path.is_file());
    found.ok_or(LibraryError::Absent { file, folder, model })
}

/// Whether a library has the names of the standard among its symbols.
fn exports(library: &[u8], version: Version) -> bool {
    let name: &[u8] = match version {
        Version::Two => b"fmi2Instantiate",
        Version::Three => b"fmi3InstantiateModelExchange",
    };
    library.windows(name.len()).any(|bytes| bytes == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_are_names_of_c() {
        assert_eq!(["slider-crank", "3d", "a.b"].map(identifier), ["slider_crank", "_3d", "a_b"]);
    }

    #[test]
    fn a_library_that_is_not_there_is_told_with_what_to_do() {
        let fault = beside_the_program("no-such", "NoSuch").unwrap_err().to_string();
        assert!(
            fault.contains("no_such_fmu")
                && fault.contains("`bg_fmi::export!(NoSuch);`")
                && fault.contains("--library FILE"),
            "{fault}"
        );
        let library = b"..fmi3InstantiateModelExchange..";
        assert!(
            exports(library, Version::Three) && !exports(library, Version::Two) && !exports(b"text", Version::Three)
        );
    }
}
