//! The command `fmu`: a scene as a functional mock-up unit, for other programs.
//!
//! In: a scene, the library that exports it. Out: one file. The library is a package of its own: what it needs beside
//! the model is not compiled into the program.

use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use bg_fmi::archive::archive;
use bg_fmi::{AtDefaults, Packing, Version};
use bg_model::description::Description;
use thiserror::Error;

use super::arguments::FmuArguments;
use super::{InputError, ended};
use crate::ask::maker::Prebuilt;
use crate::ask::parameters::Values;
use crate::files::{console, whole};
use crate::program::Program;

/// A library that there is none of.
#[derive(Debug, Error)]
pub(super) enum LibraryError {
    #[error(
        "there is no library {file} in {}: build a package of crate-type \"cdylib\" with `bg_fmi::export!({model});` \
         in its lib.rs, or give it as --library FILE; docs/fmu.md shows one",
        folder.display()
    )]
    Absent { file: String, folder: PathBuf, model: &'static str },
    #[error(
        "there is no library {file} in {}: build it by `cargo build --release -p {package}`, or give it as --library \
        FILE",
        folder.display()
    )]
    Unbuilt { file: String, folder: PathBuf, package: &'static str },
    #[error("--library {}: {source}", path.display())]
    Unreadable { path: PathBuf, source: io::Error },
    #[error(
        "--library {}: it exports no model for FMI {}; give the file that cargo builds of a package with \
        `bg_fmi::export!(..)`",
        .0.display(), .1
    )]
    Foreign(PathBuf, &'static str),
    #[error(
        "--library {}: it has no `{model}` as this program has it: it exports another model, or one of other sources; \
         build both anew and pack again",
        path.display()
    )]
    OtherBuild { path: PathBuf, model: &'static str },
}

pub(super) fn pack(program: &Program, arguments: &FmuArguments) -> Result<ExitCode, InputError> {
    let FmuArguments { library, out, t_end, .. } = arguments;
    let scene = program.scene_called(&arguments.scene);
    let prebuilt = program.models.maker().prebuilt(scene.index);
    let name = prebuilt.as_ref().map_or(&program.texts.name, |prebuilt| &prebuilt.name);
    let is_own = scene.name == program.scene;
    let identifier = identifier_of(&if is_own { name.clone() } else { format!("{name}_{}", scene.name) });
    let library = match (library, &prebuilt) {
        (Some(path), _) => path.clone(),
        (None, Some(Prebuilt { package, .. })) => beside_the_program(&identifier_of(package))
            .map_err(|(file, folder)| LibraryError::Unbuilt { file, folder, package })?,
        (None, None) => beside_the_program(&format!("{}_fmu", identifier_of(name)))
            .map_err(|(file, folder)| LibraryError::Absent { file, folder, model: scene.description.name })?,
    };
    let bytes = std::fs::read(&library);
    let bytes = bytes.map_err(|source| LibraryError::Unreadable { path: library.clone(), source })?;
    let version = if arguments.fmi == Version::Two.name() { Version::Two } else { Version::Three };
    if !exports(&bytes, version) {
        return Err(LibraryError::Foreign(library, version.name()).into());
    }
    if prebuilt.is_none() && !is_built_of(&bytes, scene.description) {
        return Err(LibraryError::OtherBuild { path: library, model: scene.description.name }.into());
    }
    let path = out.clone().unwrap_or_else(|| PathBuf::from(format!("{identifier}.fmu")));
    let packing = Packing { version, identifier, stop_time: *t_end };
    let own = Values::new(scene.description.parameters);
    let machine = program.models.maker().make(scene.index, own.values(), &[]);
    let model = AtDefaults { description: scene.description, model: machine.ok().map(|machine| machine.model()) };
    let resources = prebuilt.as_ref().map_or(&[][..], |prebuilt| &prebuilt.resources);
    let unit = archive(&model, &packing, &bytes, resources);
    whole::write(&path, |file| file.write_all(&unit?))?;
    let (name, version, platform) = (scene.description.name, version.name(), bg_fmi::archive::platform(version));
    let told = format!("{}: {name} for FMI {version}, {platform}\n", path.display());
    let json = || {
        serde_json::json!({
            "file": path.display().to_string(), "model": name, "fmi": version, "platform": platform,
            "library": library.display().to_string(),
        })
    };
    Ok(ended(console::tell_as(arguments.json, &told, json).err()))
}

/// A name of letters, digits and underscores, for a library in a unit.
fn identifier_of(name: &str) -> String {
    let text: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if text.starts_with(|c: char| c.is_ascii_digit()) { format!("_{text}") } else { text }
}

/// The library `name` where cargo puts it: beside the program, or above it where that is an example; else the file that
/// is not there, and the folder where it should be.
fn beside_the_program(name: &str) -> Result<PathBuf, (String, PathBuf)> {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    let file = format!("{DLL_PREFIX}{name}{DLL_SUFFIX}");
    let program = std::env::current_exe().unwrap_or_default();
    let folder = program.parent().unwrap_or(Path::new(".")).to_owned();
    let above =
        if folder.ends_with("examples") { folder.parent().map(Path::to_owned) } else { Some(folder.join("examples")) };
    let found =
        std::iter::once(folder.clone()).chain(above).map(|folder| folder.join(&file)).find(|path| path.is_file());
    found.ok_or((file, folder))
}

/// Whether a library has the names of the standard among its symbols.
fn exports(library: &[u8], version: Version) -> bool {
    let name: &[u8] = match version {
        Version::Two => b"fmi2Instantiate",
        Version::Three => b"fmi3InstantiateModelExchange",
    };
    has(library, name)
}

/// Whether a library has the model of this description among its own: the text of its graph, in which every law, value
/// and name stands. Else a host would find out when it makes an instance.
fn is_built_of(library: &[u8], description: &Description) -> bool {
    has(library, description.graph.as_bytes())
}

fn has(library: &[u8], text: &[u8]) -> bool {
    text.is_empty() || library.windows(text.len()).any(|bytes| bytes == text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_are_names_of_c() {
        assert_eq!(["slider-crank", "3d", "a.b"].map(identifier_of), ["slider_crank", "_3d", "a_b"]);
    }

    #[test]
    fn a_library_that_is_not_there_is_told_with_what_to_do() {
        let (file, folder) = beside_the_program("no_such_fmu").unwrap_err();
        let own = LibraryError::Absent { file: file.clone(), folder: folder.clone(), model: "NoSuch" }.to_string();
        let parts = ["no_such_fmu", "`bg_fmi::export!(NoSuch);`", "--library FILE"];
        assert!(parts.iter().all(|part| own.contains(part)), "{own}");
        let prebuilt = LibraryError::Unbuilt { file, folder, package: "bond-fmu" }.to_string();
        let parts = ["no_such_fmu", "`cargo build --release -p bond-fmu`", "--library FILE"];
        assert!(parts.iter().all(|part| prebuilt.contains(part)), "{prebuilt}");
        let library = b"..fmi3InstantiateModelExchange..";
        assert!(
            exports(library, Version::Three) && !exports(library, Version::Two) && !exports(b"text", Version::Three)
        );
        let of = |graph: &'static str| Description { graph, ..Description::default() };
        let library = b"..graph P { param mass: kg = 1; }..";
        assert!(is_built_of(library, &of("graph P { param mass: kg = 1; }")));
        assert!(!is_built_of(library, &of("graph P { param mass: kg = 2; }")));
    }
}
