//! The command `graph`: a scene's graph as text, or as pictures in files.

use std::path::Path;
use std::process::ExitCode;

use super::arguments::GraphArguments;
use super::{InputError, say};
use crate::files::whole;
use crate::program::Program;
use crate::show::{described, picture, tables};

pub(super) fn graph(program: &Program, arguments: &GraphArguments) -> Result<ExitCode, InputError> {
    let scene = program.scene_called(&arguments.scene);
    let GraphArguments { part, svg, dot, level, json, .. } = arguments;
    let told = || if *json { format!("{:#}\n", described::graph(scene, *part)) } else { tables::graph(scene, *part) };
    if svg.is_none() && dot.is_none() {
        return Ok(say(&told()));
    }
    let graph = picture::graph(scene.description);
    let write = |path: &Path, text: String| whole::write(path, |file| file.write_all(text.as_bytes()));
    for path in [svg, dot].into_iter().flatten() {
        whole::probe(path)?;
    }
    if let Some(path) = svg {
        write(path, bg_picture::svg(&graph, (*level).into()))?;
    }
    if let Some(path) = dot {
        write(path, bg_picture::dot(&graph, (*level).into()))?;
    }
    Ok(if *json { say(&told()) } else { ExitCode::SUCCESS })
}
