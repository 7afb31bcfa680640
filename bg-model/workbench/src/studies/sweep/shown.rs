//! What the folder of a sweep has: how much of it is done, what failed and why; its tables as CSV.
//!
//! In: a folder. Out: lines for the terminal, the same as JSON, rows for programs that read no Parquet. One shard is in
//! memory at a time.

use std::fmt::{self, Display, Formatter};
use std::io::{self, Write};

use super::folder::{Folder, FolderError, ShardFile};
use super::recipe::{INPUT_FILES, INPUTS};
use crate::files::parquet::{Table, Values};

/// The most reasons that are listed.
const MOST: usize = 10;

/// How much of a sweep is there. Shown as a line for each thing to know.
#[derive(Debug)]
pub struct Progress {
    recipe: toml::Table,
    /// Shards that are there.
    shards: usize,
    /// Runs in them.
    runs: usize,
    /// Runs that failed.
    failed: usize,
    /// Why: the reason, how many runs, the number of the first.
    reasons: Vec<(String, usize, i64)>,
}

impl Progress {
    /// That of the sweep in `folder`.
    ///
    /// # Errors
    /// A file cannot be read.
    pub fn of(folder: &Folder) -> Result<Self, FolderError> {
        let mut found = Self { recipe: folder.entries()?, shards: 0, runs: 0, failed: 0, reasons: Vec::new() };
        for table in tables(folder, ShardFile::Runs)? {
            found.shards += 1;
            found.count(&table?);
        }
        Ok(found)
    }

    /// Counts the runs of a shard.
    fn count(&mut self, table: &Table) {
        let (Some(Values::Whole(numbers)), Some(Values::Text(found))) = (values(table, "run"), values(table, "reason"))
        else {
            return;
        };
        self.runs += numbers.len();
        for (number, reason) in numbers.iter().zip(found).filter(|(_, reason)| !reason.is_empty()) {
            self.failed += 1;
            match self.reasons.iter().position(|(known, ..)| known == reason) {
                Some(place) => self.reasons[place].1 += 1,
                None if self.reasons.len() < MOST => self.reasons.push((reason.clone(), 1, *number)),
                None => {}
            }
        }
    }

    /// The number of shards of the whole sweep.
    fn all_shards(&self) -> usize {
        whole(&self.recipe, "runs").div_ceil(whole(&self.recipe, "shard").max(1))
    }

    /// The same for programs, with the recipe.
    ///
    /// # Panics
    /// Never: a recipe is a table of TOML.
    #[must_use]
    pub fn json(&self) -> serde_json::Value {
        let reason = |(reason, runs, first): &(String, usize, i64)| {
            serde_json::json!({ "reason": reason, "runs": runs,
            "first": first })
        };
        serde_json::json!({
            "recipe": serde_json::to_value(&self.recipe).expect("TOML has text keys only"),
            "runs": self.runs, "failed": self.failed, "reasons": self.reasons.iter().map(reason).collect::<Vec<_>>(),
            "shards": self.shards, "all_shards": self.all_shards(),
        })
    }
}

impl Display for Progress {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { recipe, shards, runs, failed, reasons } = self;
        let text = |name: &str| recipe.get(name).map_or_else(String::new, |value| value.to_string().replace('"', ""));
        writeln!(f, "sweep    {} {}, scene {}", text("program"), text("version"), text("scene"))?;
        writeln!(f, "swept    {}", text("swept").trim_matches(['[', ']']))?;
        writeln!(f, "runs     {runs} of {} in {shards} of {} shards", text("runs"), self.all_shards())?;
        writeln!(f, "failed   {failed}")?;
        for (reason, count, first) in reasons {
            let runs = if *count == 1 { format!("run {first}") } else { format!("{count} runs, the first is {first}") };
            writeln!(f, "         {runs}: {reason}")?;
        }
        f.write_str(&(inputs(recipe) + &samples(recipe)))
    }
}

/// Writes the rows of all shards that are there as CSV; every number in the shortest form that reads back to the same
/// bits, nothing where there is none.
///
/// # Errors
/// A file cannot be read, or `writer` fails.
pub fn write_csv(folder: &Folder, kind: ShardFile, writer: impl Write) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(writer);
    let mut has_header = false;
    for table in tables(folder, kind).map_err(io::Error::other)? {
        let table = table.map_err(io::Error::other)?;
        if !has_header {
            csv.write_record(table.columns.iter().map(|column| column.name.as_str()))?;
            has_header = true;
        }
        table.write_rows(&mut csv)?;
    }
    csv.flush()
}

/// All rows of the shards that are there as one table, for who has the memory.
///
/// # Errors
/// A file cannot be read.
pub fn joined(folder: &Folder, kind: ShardFile) -> Result<Table, FolderError> {
    let mut all = Table::default();
    for table in tables(folder, kind)? {
        all.append(table?);
    }
    Ok(all)
}

/// A line for each input, with its value or its file.
fn inputs(recipe: &toml::Table) -> String {
    let table = |name: &str| recipe.get(name).and_then(toml::Value::as_table);
    let line = |(name, value): (&String, &toml::Value)| {
        let file = table(INPUT_FILES).and_then(|files| files.get(name));
        format!("input    {name} = {}\n", file.unwrap_or(value).to_string().replace('"', ""))
    };
    table(INPUTS).into_iter().flatten().map(line).collect()
}

/// How far the samples are apart that columns are made from.
fn samples(recipe: &toml::Table) -> String {
    let step = recipe.get("step").map_or_else(String::new, ToString::to_string);
    let columns = recipe.get("columns").and_then(toml::Value::as_array).into_iter().flatten();
    let is_sum = |name: &str| name.ends_with("_mean") || name.ends_with("_integral");
    let sums = if columns.filter_map(toml::Value::as_str).any(is_sum) {
        "; mean and integral are those of samples"
    } else {
        ""
    };
    format!("samples  every {step} s{sums}\n")
}

fn whole(recipe: &toml::Table, name: &str) -> usize {
    recipe.get(name).and_then(toml::Value::as_integer).and_then(|value| usize::try_from(value).ok()).unwrap_or(0)
}

/// The tables that are there, in the order of the shards.
pub(super) fn tables(
    folder: &Folder,
    kind: ShardFile,
) -> Result<impl Iterator<Item = Result<Table, FolderError>>, FolderError> {
    let recipe = folder.entries()?;
    let shards = whole(&recipe, "runs").div_ceil(whole(&recipe, "shard").max(1));
    Ok((0..shards).filter_map(move |shard| folder.read(kind, shard).transpose()))
}

fn values<'a>(table: &'a Table, name: &str) -> Option<&'a Values> {
    table.columns.iter().find(|column| column.name == name).map(|column| &column.values)
}
