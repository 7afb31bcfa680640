//! The command `sweep`: runs for many values of parameters, into a folder of Parquet files.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Subcommand};

use super::progress::bar;
use super::{InputError, ended, say};
use crate::ask::parameters::number;
use crate::files::{console, json, whole};
use crate::program::Program;
use crate::studies::sweep::folder::{Folder, ShardFile};
use crate::studies::sweep::plan::Plan;
use crate::studies::sweep::shown::{self, Progress};
use crate::studies::sweep::{Outcome, Share, SweepError, drawn, recipe, sweep};

#[derive(Debug, Args)]
#[command(subcommand_negates_reqs = true, args_conflicts_with_subcommands = true)]
pub struct SweepArguments {
    #[command(subcommand)]
    command: Option<SweepCommand>,

    /// What is run: a TOML file with the values, docs/sweeps.md says how
    #[arg(long, value_name = "FILE.toml", required = true)]
    plan: Option<PathBuf>,

    /// Folder for the Parquet files; made if it is not there. A sweep that was stopped goes on there
    #[arg(long, value_name = "DIR", default_value = "out/sweep")]
    out: PathBuf,

    /// Threads; 0 are as many as there are cores. Files do not depend on it
    #[arg(long, value_name = "COUNT", default_value_t = 0)]
    threads: usize,

    /// Only every n-th file from the i-th on, for one of n processes that share the folder
    #[arg(long, value_name = "I/N")]
    shard: Option<String>,

    /// Print what was done as JSON in place of the text, with the statistics of tolerances
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Subcommand)]
enum SweepCommand {
    /// Say how much of a sweep is there and what failed; write its tables as CSV
    Show {
        /// The folder of the sweep
        #[arg(value_name = "DIR")]
        folder: PathBuf,

        /// Write a row for each run here. Replaces a file that is there
        #[arg(long, value_name = "FILE.csv")]
        csv: Option<PathBuf>,

        /// Write a row for each sample here, of a sweep that keeps trajectories
        #[arg(long, value_name = "FILE.csv")]
        trajectories: Option<PathBuf>,

        /// Print what is there as JSON in place of the text
        #[arg(long)]
        json: bool,
    },
}

pub fn obey(program: &Program, arguments: &SweepArguments) -> Result<ExitCode, InputError> {
    let SweepArguments { command, plan, out, threads, shard, json } = arguments;
    if let Some(SweepCommand::Show { folder, csv, trajectories, json }) = command {
        let folder = Folder::open(folder).map_err(SweepError::from)?;
        let progress = Progress::of(&folder).map_err(SweepError::from)?;
        let told = drawn::write(program, &folder)?;
        for (kind, path) in [(ShardFile::Runs, csv), (ShardFile::Trajectories, trajectories)] {
            path.iter().try_for_each(|path| whole::write(path, |file| shown::write_csv(&folder, kind, file)))?;
        }
        let as_json = || {
            let mut json = progress.json();
            json["statistics"] = statistics(&folder);
            json
        };
        let text = format!("{progress}{told}");
        return Ok(if *json { say(&format!("{:#}\n", as_json())) } else { say(&text) });
    }
    let share = shard.as_deref().map_or(Ok(Share::ALL), Share::parse)?;
    let plan = Plan::read(program, plan.as_deref().expect("clap asks for it")).map_err(SweepError::from)?;
    let folder = Folder::claim(out, &recipe::of(program, &plan)).map_err(SweepError::from)?;
    let bar = bar(1, "sweeping {bar:40} {pos} of {len} runs, {eta} to go");
    let first = std::sync::Once::new();
    let outcome = sweep(program, &plan, &folder, share, *threads, &|done, runs| {
        first.call_once(|| {
            bar.set_length(runs as u64);
            bar.set_position(done as u64);
            // The time left is that of runs made now, not of those that were found.
            bar.reset_eta();
        });
        bar.set_position(done as u64);
        true
    });
    bar.finish_and_clear();
    match outcome {
        Ok(outcome) => {
            // The last one of several processes draws what all have made; where it was killed before, another one.
            let draws = outcome.is_last || !drawn::is_there(&folder) && folder.is_complete(outcome.shards);
            let told = if draws { drawn::write(program, &folder)? } else { String::new() };
            let page = if draws { format!("; open {} there", drawn::PAGE) } else { String::new() };
            let told = format!("{told}{}{page}\n", sentence(program, &outcome, &folder, &plan));
            Ok(ended(console::tell_as(*json, &told, || json_of(&outcome, &folder)).err()))
        }
        // What could be made is there.
        Err(fault @ SweepError::File(_)) => Ok(ended([fault])),
        Err(fault) => Err(fault.into()),
    }
}

/// What was done, for programs.
fn json_of(outcome: &Outcome, folder: &Folder) -> serde_json::Value {
    let Outcome { runs, made, found, made_runs, failed, .. } = *outcome;
    serde_json::json!({
        "folder": folder.path().display().to_string(), "runs": runs, "made": made_runs, "failed": failed, "files": made,
        "found": found, "statistics": statistics(folder),
    })
}

/// The statistics of a sweep's columns; null where it is not done.
fn statistics(folder: &Folder) -> serde_json::Value {
    let csv = std::fs::read_to_string(folder.path().join(drawn::STATISTICS)).ok();
    csv.map_or(serde_json::Value::Null, |csv| json::rows(&csv))
}

/// What was done, and how to look at it.
fn sentence(program: &Program, outcome: &Outcome, folder: &Folder, plan: &Plan) -> String {
    let Outcome { runs, shards, own, found, made, made_runs, failed, .. } = *outcome;
    let part = if own == shards { String::new() } else { format!("{own} of its {shards} files are of this part; ") };
    let before = if found == 0 { String::new() } else { format!(", {found} were there") };
    let samples = if plan.wanted.has_sums() {
        format!("mean and integral are those of samples every {} s\n", number(plan.integration.step))
    } else {
        String::new()
    };
    let place = folder.path().display();
    let of = program.texts.file.as_ref().map_or_else(String::new, |file| format!("{file} "));
    format!(
        "sweep of {runs} runs: {part}{made} files made{before}; {made_runs} runs, {failed} of them failed\n\
         {samples}written: {place}; `sweep {of}show {place}` says what is there, with --csv FILE as a table",
    )
}
