//! The hard cases with every integrator at four tolerances, the hacksaw's other measurements, and the long-term
//! behaviour of conservative scenes: one report, as text, JSON and a page.
//!
//! `cargo bench -p bond-graph-tests --bench stability -- [--only PART] [--limit STEPS] [--periods COUNT] [FOLDER]`
//! writes into the folder, `target/stability` by default. `--only` takes the cases and sheets whose name contains it;
//! `--periods` is the length of the longest runs, 1e6 by default.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use bond_graph_tests::hardcases::case::Case;
use bond_graph_tests::hardcases::report::{Row, json, page, table};
use bond_graph_tests::hardcases::sheet::Sheet;
use bond_graph_tests::hardcases::{cases, integrators};
use bond_graph_tests::{hard_hacksaw, long_term};

const TOLERANCES: [f64; 4] = [1e-4, 1e-6, 1e-8, 1e-10];

/// What is asked for.
struct Arguments {
    folder: PathBuf,
    only: String,
    limit: u64,
    periods: f64,
}

fn arguments() -> Result<Arguments, Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/stability");
    let mut found = Arguments { folder, only: String::new(), limit: 200_000, periods: 1e6 };
    let mut given = std::env::args().skip(1);
    while let Some(argument) = given.next() {
        match argument.as_str() {
            // What `cargo bench` hands to every bench.
            "--bench" => {}
            "--only" => found.only = given.next().ok_or("--only wants a part of a name")?,
            "--limit" => found.limit = given.next().ok_or("--limit wants a number of steps")?.parse()?,
            "--periods" => found.periods = given.next().ok_or("--periods wants a number")?.parse()?,
            folder if !folder.starts_with('-') => found.folder = folder.into(),
            unknown => return Err(format!("unknown argument {unknown}").into()),
        }
    }
    Ok(found)
}

fn rows(cases: &[Case], limit: u64) -> Vec<Row> {
    let mut rows = Vec::new();
    for case in cases {
        for integrator in integrators() {
            let name = integrator.name();
            eprint!("{} {name}:", case.name);
            for tolerance in TOLERANCES {
                let begin = Instant::now();
                let outcome = case.run(*integrator, tolerance, limit);
                eprint!(" {}", outcome.verdict.word());
                let seconds = begin.elapsed().as_secs_f64();
                rows.push(Row { case: case.name, integrator: name.to_owned(), tolerance, outcome, seconds });
            }
            eprintln!();
        }
    }
    rows
}

/// A sheet by its name, made on demand.
type Make = fn(f64, &mut dyn FnMut(&str)) -> Sheet;

const SHEETS: [(&str, Make); 7] = [
    ("hacksaw-out-of-plane", |_, progress| hard_hacksaw::sheets::growth(progress)),
    ("hacksaw-fine-samples", |_, progress| hard_hacksaw::sheets::sampling(progress)),
    ("hacksaw-ends-at-switchings", |_, progress| hard_hacksaw::sheets::ending(progress)),
    ("hacksaw-extreme-parameters", |_, progress| hard_hacksaw::sheets::extreme_parameters(0.1, 200_000, progress)),
    ("hacksaw-endurance", |_, progress| hard_hacksaw::sheets::endurance_of(1000, progress)),
    ("drift-against-step", |periods, progress| long_term::sheets::against_step(periods / 100.0, progress)),
    ("drift-against-time", long_term::sheets::against_time),
];

fn sheets(only: &str, periods: f64) -> Vec<Sheet> {
    let wanted = SHEETS.iter().filter(|(name, _)| name.contains(only));
    wanted.map(|(name, make)| make(periods, &mut |what| eprintln!("{name}: {what}"))).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { folder, only, limit, periods } = arguments()?;
    let cases: Vec<Case> =
        cases().into_iter().chain(hard_hacksaw::cases::cases()).filter(|case| case.name.contains(&only)).collect();
    let rows = rows(&cases, limit);
    print!("{}", table(&rows));
    let sheets = sheets(&only, periods);
    sheets.iter().for_each(|sheet| print!("{}", sheet.text()));
    fs::create_dir_all(&folder)?;
    fs::write(folder.join("stability.json"), json(&cases, &rows, &sheets))?;
    fs::write(folder.join("index.html"), page(&cases, &rows, &TOLERANCES, &sheets))?;
    eprintln!("written into {}", folder.display());
    Ok(())
}
