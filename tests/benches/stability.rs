//! The hard cases with every integrator at four tolerances: one table, as text, JSON and a page.
//!
//! `cargo bench -p bond-graph-tests --bench stability -- [--only PART] [--limit STEPS] [FOLDER]` writes into the folder,
//! `target/stability` by default. `--only` takes the cases whose name contains it.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use bond_graph_tests::hardcases::case::Case;
use bond_graph_tests::hardcases::report::{Row, json, page, table};
use bond_graph_tests::hardcases::{cases, integrators};

const TOLERANCES: [f64; 4] = [1e-4, 1e-6, 1e-8, 1e-10];

/// What is asked for.
struct Arguments {
    folder: PathBuf,
    only: String,
    limit: u64,
}

fn arguments() -> Result<Arguments, Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/stability");
    let mut found = Arguments { folder, only: String::new(), limit: 200_000 };
    let mut given = std::env::args().skip(1);
    while let Some(argument) = given.next() {
        match argument.as_str() {
            // What `cargo bench` hands to every bench.
            "--bench" => {}
            "--only" => found.only = given.next().ok_or("--only wants a part of a name")?,
            "--limit" => found.limit = given.next().ok_or("--limit wants a number of steps")?.parse()?,
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
                rows.push(Row { case: case.name, integrator: name.clone(), tolerance, outcome, seconds });
            }
            eprintln!();
        }
    }
    rows
}

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { folder, only, limit } = arguments()?;
    let cases: Vec<Case> = cases().into_iter().filter(|case| case.name.contains(&only)).collect();
    let rows = rows(&cases, limit);
    print!("{}", table(&rows));
    fs::create_dir_all(&folder)?;
    fs::write(folder.join("stability.json"), json(&cases, &rows))?;
    fs::write(folder.join("index.html"), page(&cases, &rows, &TOLERANCES))?;
    eprintln!("written into {}", folder.display());
    Ok(())
}
