//! The gallery of the workbench's examples, from their head comments: `docs/gallery.md` with pictures, or a folder of
//! pages.

mod programs;
mod texts;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use bg_workbench::figures::compact::compact;
use clap::Parser;

use bg_gallery::example::Example;
use programs::Programs;

/// Makes docs/gallery.md with its pictures, or a folder of pages in which the examples move
#[derive(Parser)]
#[command(name = "bg-gallery", version)]
struct Arguments {
    /// Write a folder with a page for each example and an index.html, in place of docs/gallery.md
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Pages that show a run and have no model inside: for --out where the target wasm32-unknown-unknown is missing
    #[arg(long, requires = "out")]
    still: bool,
}

/// What goes wrong, in a sentence.
type Fault = Box<dyn std::error::Error>;

fn main() -> ExitCode {
    match make(&Arguments::parse()) {
        Ok(told) => {
            println!("{told}");
            ExitCode::SUCCESS
        }
        Err(fault) => {
            eprintln!("error: {fault}");
            ExitCode::FAILURE
        }
    }
}

/// The package of the workbench.
fn workbench() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the gallery is in the workbench's folder")
}

fn make(arguments: &Arguments) -> Result<String, Fault> {
    let examples = Example::all(&workbench().join("examples"))?;
    let folder = programs::build(workbench())?;
    let programs = Programs { package: workbench(), folder: &folder };
    let browser = programs::browser();
    let docs = workbench().join("../../docs");
    let place = arguments.out.clone().unwrap_or_else(|| docs.join("gallery"));
    std::fs::create_dir_all(&place)?;
    for (index, example) in examples.iter().enumerate() {
        eprintln!("{} of {}: {}", index + 1, examples.len(), example.name);
        let page = match &arguments.out {
            Some(_) if arguments.still => Page::Kept(&[]),
            Some(_) => Page::Kept(&["--live"]),
            None => Page::ForPictures,
        };
        pictures(example, programs, browser, &place, page)?;
    }
    let has = |file: &str| place.join(file).exists();
    let without = if browser.is_some() { "" } else { "; no Chromium was found, so no machine was drawn" };
    if let Some(out) = &arguments.out {
        std::fs::write(out.join("index.html"), texts::index(&examples, has))?;
        return Ok(format!("written: {} pages in {}; open index.html there{without}", examples.len(), out.display()));
    }
    std::fs::write(docs.join("gallery.md"), texts::markdown(&examples, has))?;
    Ok(format!("written: docs/gallery.md with pictures of {} examples{without}", examples.len()))
}

/// What becomes of an example's report page.
#[derive(Clone, Copy)]
enum Page {
    /// It stays, made with these options.
    Kept(&'static [&'static str]),
    /// The machine's picture is taken of it.
    ForPictures,
}

/// Writes an example's pictures, and its page, into `place`.
fn pictures(
    example: &Example,
    programs: Programs<'_>,
    browser: Option<&str>,
    place: &Path,
    page: Page,
) -> Result<(), Fault> {
    let folder = tempfile::tempdir()?;
    let call = |command: &[&str], more: &[&str]| {
        let arguments: Vec<&str> =
            command.iter().copied().chain(example.arguments.iter().map(String::as_str)).collect();
        programs.call(&example.name, folder.path(), &[&arguments, more].concat())
    };
    call(&["run"], &["--out", "run"])?;
    let chart = std::fs::read_to_string(folder.path().join(format!("run/{}.svg", example.output)))?;
    std::fs::write(place.join(texts::chart(example)), compact(&chart))?;

    let options = if let Page::Kept(options) = page { options } else { &[] };
    call(&["report"], &[&["--out", "page"], options].concat())?;
    let html = html_in(&folder.path().join("page"))?;
    let text = std::fs::read_to_string(&html)?;
    let has_machine = text.contains("id=\"machine\"");
    // All of a small graph can be read at the width of a page; of a machine the bodies and joints.
    let level = if has_machine { "words" } else { "full" };
    let scene = example.arguments.iter().skip_while(|word| *word != "--scene").take(2).map(String::as_str);
    let graph: Vec<&str> = ["graph", "--svg", "graph.svg", "--level", level].into_iter().chain(scene).collect();
    programs.call(&example.name, folder.path(), &graph)?;
    std::fs::copy(folder.path().join("graph.svg"), place.join(texts::graph(example)))?;

    if let Some(browser) = browser.filter(|_| has_machine) {
        // A third of the run: most machines are well in motion, none is back at its start.
        let last = std::fs::read_to_string(folder.path().join("page/trajectory.csv"))?;
        let end: f64 = last.lines().last().and_then(|row| row.split(',').next()?.parse().ok()).unwrap_or(0.0);
        programs::picture(browser, &html, end / 3.0, &place.join(texts::machine(example)))?;
    }
    if let Page::Kept(_) = page {
        std::fs::copy(&html, place.join(format!("{}.html", example.name)))?;
    }
    Ok(())
}

/// The page in a folder of results.
fn html_in(folder: &Path) -> Result<PathBuf, Fault> {
    for file in std::fs::read_dir(folder)? {
        let path = file?.path();
        if path.extension().is_some_and(|end| end == "html") {
            return Ok(path);
        }
    }
    Err(format!("no page in {}", folder.display()).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_of_the_documentation_is_that_of_the_examples() {
        let docs = workbench().join("../../docs");
        let examples = Example::all(&workbench().join("examples")).unwrap();
        assert!(examples.len() >= 12);
        let has = |file: &str| docs.join("gallery").join(file).exists();
        for example in &examples {
            assert!(has(&texts::graph(example)) && has(&texts::chart(example)), "{}: no pictures", example.name);
        }
        let written = std::fs::read_to_string(docs.join("gallery.md")).unwrap();
        assert!(written == texts::markdown(&examples, has), "docs/gallery.md: cargo run --release -p bg-gallery");
    }

    #[test]
    fn an_index_has_a_card_for_each_example() {
        let examples = Example::all(&workbench().join("examples")).unwrap();
        let html = texts::index(&examples, |file| file.starts_with("pendulum"));
        assert_eq!(html.matches("<a href=").count(), examples.len());
        assert!(html.contains("src=\"pendulum_machine.png\"") && html.contains("src=\"orifice_chart.svg\""));
    }
}
