//! The texts that mutants are made of and that are replayed: models of the suites, the hacksaw, the corpus.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::Input;

/// The texts of valid macro calls below the workspace's folder: the stages' models, the example models, the gallery,
/// the hacksaw, the parser's example.
///
/// # Errors
/// A folder or file that cannot be read.
pub fn seeds(workspace: &Path) -> io::Result<Vec<String>> {
    let mut texts = Vec::new();
    for path in files(&workspace.join("tests/stages"), "bond")? {
        texts.push(fs::read_to_string(path)?);
    }
    texts.push(fs::read_to_string(workspace.join("bg-macros/compiler/src/source/syntax/tests/example.bond"))?);
    let mut models = files(&workspace.join("tests/models"), "rs")?;
    models.extend(files(&workspace.join("bg-model/workbench/examples"), "rs")?);
    // One order for both folders: seeds stay in their places when a model moves to the gallery.
    models.sort_unstable_by(|a, b| a.file_name().cmp(&b.file_name()));
    for path in models {
        texts.extend(calls(&fs::read_to_string(path)?));
    }
    texts.push(fs::read_to_string(workspace.join("hacksaw/hacksaw.bond"))?);
    Ok(texts)
}

/// The kept inputs of a folder by file name: `*.bond` is a macro call, `*.toml` a parameter file, `*.set` one text
/// after `--set` a line.
///
/// # Errors
/// A folder or file that cannot be read.
pub fn corpus(folder: &Path) -> io::Result<Vec<(String, Input)>> {
    let mut inputs = Vec::new();
    for path in files(folder, "")? {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let bytes = fs::read(&path)?;
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let input = match path.extension().and_then(|extension| extension.to_str()) {
            Some("bond") => Input::Call(text),
            Some("toml") => Input::Settings { file: bytes, set: Vec::new() },
            Some("set") => Input::Settings { file: Vec::new(), set: text.lines().map(str::to_owned).collect() },
            _ => continue,
        };
        inputs.push((name, input));
    }
    Ok(inputs)
}

/// The files of a folder with this extension, or all, in the order of their names.
fn files(folder: &Path, extension: &str) -> io::Result<Vec<PathBuf>> {
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if extension.is_empty() || path.extension().is_some_and(|found| found == extension) {
            paths.push(path);
        }
    }
    paths.sort_unstable();
    Ok(paths)
}

/// The bodies of the calls `bond_graph! { ... }` in a Rust file, without the repetitions of a macro by example.
fn calls(source: &str) -> Vec<String> {
    let mut found = Vec::new();
    for part in source.split("bond_graph! {").skip(1) {
        let mut depth = 1_usize;
        let end = part.find(|c| {
            depth = match c {
                '{' => depth + 1,
                '}' => depth.saturating_sub(1),
                _ => depth,
            };
            depth == 0
        });
        let body = &part[..end.unwrap_or(part.len())];
        let body = body.replace("$(#[$($documentation)*])*", "").replace("$($statements)*", "");
        found.push(body.replace('$', ""));
    }
    found
}
