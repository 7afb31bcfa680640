//! The folder of a sweep: its recipe, its shards.
//!
//! In: a folder, a recipe. Out: the folder with `sweep.toml`, and in it `runs-000000.parquet` and so on; with
//! trajectories `trajectories-000000.parquet` as well, which is there before. Each file is written aside and renamed,
//! so a file of such a name is whole. Several processes may work in one folder, even on the same shard: they write the
//! same bytes.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use thiserror::Error;
use toml::Table as Recipe;

use super::recipe::difference;
use crate::files::parquet::{ParquetError, Table};
use crate::files::{FileError, check_is_no_file, whole};

const RECIPE: &str = "sweep.toml";
/// The end of the name of a file that is being written, and how many letters before it make it a new one.
const ASIDE: &str = ".unfinished";
const RANDOM: usize = 6;
const HEAD: &str =
    "# What the files in this folder were made with. A sweep by another plan goes into another folder.\n";
/// The entry of a file's metadata that has the recipe.
const SAID: &str = "sweep";

/// A folder that is not this sweep's.
#[derive(Debug, Error)]
pub enum FolderError {
    /// It has another sweep.
    #[error("{} has another sweep: {difference}; choose another folder with --out", folder.display())]
    Other {
        /// The folder.
        folder: PathBuf,
        /// What differs.
        difference: String,
    },
    /// It has no sweep.
    #[error("{} has no sweep: {source}", folder.display())]
    None {
        /// The folder.
        folder: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// Its recipe is none.
    #[error("{}: not a file that a sweep wrote; choose another folder with --out", .0.display())]
    Recipe(PathBuf),
    /// A shard cannot be read.
    #[error("cannot read {}: {fault}; remove it, and the sweep makes it again", path.display())]
    Shard {
        /// The file.
        path: PathBuf,
        /// Why.
        fault: ParquetError,
    },
    /// Something cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
}

/// What a file of a shard has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShardFile {
    /// A row for each run.
    Runs,
    /// A row for each sample.
    Trajectories,
}

impl ShardFile {
    const fn name(self) -> &'static str {
        match self {
            Self::Runs => "runs",
            Self::Trajectories => "trajectories",
        }
    }

    fn file(self, shard: usize) -> String {
        format!("{}-{shard:06}.parquet", self.name())
    }
}

/// What a process has asked of the file system that a sweep's folder is on. Where thousands of processes share a
/// folder it is this that they wait for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Names that were looked up, made, replaced or removed.
    pub names: u64,
    /// Names in listings of the folder.
    pub listed: u64,
    /// Bytes of files that were read.
    pub read: u64,
    /// Bytes of files that were written.
    pub written: u64,
}

/// Names that writing a file aside takes: what there is, a new one, its permissions' model, the renaming.
const OF_A_FILE: u64 = 4;

/// The same while it grows, in many threads.
#[derive(Debug, Default)]
struct Counters {
    names: AtomicU64,
    listed: AtomicU64,
    read: AtomicU64,
    written: AtomicU64,
}

/// Counts so many more.
fn count(counter: &AtomicU64, more: u64) {
    counter.fetch_add(more, Ordering::Relaxed);
}

/// A sweep's folder.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
    /// The text of its recipe.
    recipe: String,
    counters: Arc<Counters>,
}

impl Folder {
    /// The folder at `path`, made if it is not there, for a sweep by `recipe`.
    ///
    /// # Errors
    /// It cannot be written, or has another sweep.
    pub fn claim(path: &Path, recipe: &Recipe) -> Result<Self, FolderError> {
        check_is_no_file(path)?;
        let file = path.join(RECIPE);
        let failed = |source| FileError::Write { path: path.to_owned(), source };
        fs::create_dir_all(path).map_err(failed)?;
        let is_new = !file.exists();
        if is_new {
            // The first of several processes wins; what it wrote is compared below by all of them.
            let mut aside = whole::beside(&file).map_err(failed)?;
            aside.write_all(format!("{HEAD}{recipe}").as_bytes()).map_err(failed)?;
            match aside.persist_noclobber(&file) {
                Err(fault) if fault.error.kind() != io::ErrorKind::AlreadyExists => {
                    return Err(failed(fault.error).into());
                }
                _ => {}
            }
        }
        let folder = Self::open(path)?;
        // The folder and the recipe have been looked for.
        count(&folder.counters.names, 2 + if is_new { OF_A_FILE } else { 0 });
        match difference(&folder.entries()?, recipe) {
            None => Ok(folder),
            Some(difference) => Err(FolderError::Other { folder: path.to_owned(), difference }),
        }
    }

    /// The folder at `path`, which has a sweep.
    ///
    /// # Errors
    /// It has none.
    pub fn open(path: &Path) -> Result<Self, FolderError> {
        let recipe = fs::read_to_string(path.join(RECIPE));
        let recipe = recipe.map_err(|source| FolderError::None { folder: path.to_owned(), source })?;
        let folder = Self { path: path.to_owned(), recipe, counters: Arc::default() };
        count(&folder.counters.names, 1);
        count(&folder.counters.read, folder.recipe.len() as u64);
        Ok(folder)
    }

    /// What this process has asked of the file system so far.
    #[must_use]
    pub fn traffic(&self) -> Traffic {
        let Counters { names, listed, read, written } = &*self.counters;
        let [names, listed, read, written] =
            [names, listed, read, written].map(|counter| counter.load(Ordering::Relaxed));
        Traffic { names, listed, read, written }
    }

    /// The text of its recipe.
    #[must_use]
    pub fn recipe(&self) -> &str {
        &self.recipe
    }

    /// The entries of its recipe.
    ///
    /// # Errors
    /// It is none.
    pub fn entries(&self) -> Result<Recipe, FolderError> {
        self.recipe.parse().map_err(|_| FolderError::Recipe(self.path.join(RECIPE)))
    }

    /// Whether a shard is there, whole and of this recipe.
    #[must_use]
    pub fn has(&self, shard: usize, with_trajectories: bool) -> bool {
        let is_ours = |table: Table| table.texts.iter().any(|(name, text)| name == SAID && *text == self.recipe);
        let is_there = !with_trajectories || self.has_file(ShardFile::Trajectories, shard);
        is_there && self.read(ShardFile::Runs, shard).is_ok_and(|table| table.is_some_and(is_ours))
    }

    /// Whether there is a file of this name.
    fn has_file(&self, kind: ShardFile, shard: usize) -> bool {
        count(&self.counters.names, 1);
        self.path.join(kind.file(shard)).exists()
    }

    /// Whether each of so many shards is there, by the names alone. One that is missing is soon found, whichever they
    /// are: processes that begin one after the other also end so, but shards are looked for in another order.
    #[must_use]
    pub fn is_complete(&self, shards: usize) -> bool {
        scattered(shards).all(|shard| self.has_file(ShardFile::Runs, shard))
    }

    /// A file of a shard; none where it is not there.
    ///
    /// # Errors
    /// It is there and cannot be read.
    pub fn read(&self, kind: ShardFile, shard: usize) -> Result<Option<Table>, FolderError> {
        let path = self.path.join(kind.file(shard));
        let file = fs::read(&path);
        count(&self.counters.names, 1);
        count(&self.counters.read, file.as_ref().map_or(0, Vec::len) as u64);
        match file {
            Ok(bytes) => Table::read(&bytes).map(Some).map_err(|fault| FolderError::Shard { path, fault }),
            Err(fault) if fault.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(_) => Err(FolderError::Shard { path, fault: ParquetError::Cut }),
        }
    }

    /// Writes a file of a shard.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write(&self, kind: ShardFile, shard: usize, table: &Table) -> Result<(), FileError> {
        let (path, bytes) = (self.path.join(kind.file(shard)), table.bytes());
        count(&self.counters.names, OF_A_FILE);
        count(&self.counters.written, bytes.len() as u64);
        match whole::write(&path, |file| file.write_all(&bytes)) {
            // Another process has made the same shard at the same time, and has cleared up.
            Err(_) if fs::read(&path).is_ok_and(|there| there == bytes) => Ok(()),
            outcome => outcome,
        }
    }

    /// Removes what earlier processes left on their way to the recipe and to the files of so many shards, which are
    /// there now. The whole folder is listed.
    pub fn clear(&self, shards: usize) {
        let of_shard = |shard: usize| [ShardFile::Runs, ShardFile::Trajectories].map(|kind| kind.file(shard));
        let names: BTreeSet<String> = (0..shards).flat_map(of_shard).chain([RECIPE.to_owned()]).collect();
        for entry in fs::read_dir(&self.path).into_iter().flatten().flatten() {
            count(&self.counters.listed, 1);
            let name = entry.file_name().to_string_lossy().into_owned();
            // A dot, the name of the file, what makes it a new one, the end.
            let of = name.strip_prefix('.').and_then(|name| name.strip_suffix(ASIDE));
            let of = of.and_then(|of| of.get(..of.len().checked_sub(RANDOM)?));
            if of.is_some_and(|of| names.contains(of)) {
                count(&self.counters.names, 1);
                // What cannot be removed is in nobody's way.
                let _ = fs::remove_file(entry.path());
            }
        }
    }

    /// Its path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// The numbers below `count`, each once, neighbours far apart: multiples of the golden ratio lie evenly.
fn scattered(count: usize) -> impl Iterator<Item = usize> {
    let golden = count - (0.382 * count as f64) as usize;
    let shared = |mut a: usize, mut b: usize| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let stride = (golden..).find(|&stride| shared(count, stride) <= 1).unwrap_or(1);
    (0..count).map(move |k| k * stride % count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::parquet::{Column, Values};

    #[test]
    fn what_a_killed_process_left_is_removed_and_nothing_else() {
        let place = tempfile::tempdir().unwrap();
        let folder = Folder { path: place.path().to_owned(), recipe: String::new(), counters: Arc::default() };
        // As `whole` and `claim` name what they write.
        let left = |name: &str| {
            let file = tempfile::Builder::new().prefix(&format!(".{name}")).suffix(ASIDE).tempfile_in(&place).unwrap();
            file.keep().unwrap();
        };
        for name in ["runs-000003.parquet", "trajectories-000003.parquet", "sweep.toml", "runs-000004.parquet", "mine"]
        {
            left(name);
        }
        fs::write(place.path().join("runs-000003.parquet"), "").unwrap();
        folder.clear(4);
        let mut names: Vec<String> =
            fs::read_dir(&place).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        let starts = [".mine", ".runs-000004.parquet", "runs-000003.parquet"];
        assert!(names.len() == 3 && names.iter().zip(starts).all(|(name, start)| name.starts_with(start)), "{names:?}");
    }

    #[test]
    fn a_shard_is_there_with_its_trajectories_and_its_own_recipe() {
        let place = tempfile::tempdir().unwrap();
        let of = |recipe: &str| Folder {
            path: place.path().to_owned(),
            recipe: recipe.to_owned(),
            counters: Arc::default(),
        };
        let folder = of("t_end = 1.0");
        let texts = vec![(SAID.to_owned(), folder.recipe.clone())];
        let table = Table { columns: vec![Column { name: "run".to_owned(), values: Values::Whole(vec![0]) }], texts };
        assert!(!folder.has(2, false));
        folder.write(ShardFile::Runs, 2, &table).unwrap();
        assert!(folder.has(2, false) && !folder.has(2, true) && !folder.has(1, false));
        folder.write(ShardFile::Trajectories, 2, &table).unwrap();
        assert!(folder.has(2, true));
        assert!(!of("t_end = 2.0").has(2, false), "it is one of another sweep");
    }

    #[test]
    fn scattered_numbers_are_each_once_and_neighbours_far_apart() {
        for count in [0, 1, 2, 3, 10, 89, 120, 1000] {
            let numbers: Vec<usize> = scattered(count).collect();
            let all: BTreeSet<usize> = numbers.iter().copied().collect();
            assert!(all.len() == count && numbers.len() == count && all.last().is_none_or(|most| *most < count));
            // Whatever half is missing, one of it is among the first three.
            let is_near = |pair: &[usize]| pair[0].abs_diff(pair[1]) < count / 3;
            assert!(!numbers.windows(2).any(is_near), "{count}");
        }
    }
}
