//! What a sweep by thousands of processes asks of the file system that they share: parts, retries and merging are
//! the real ones, one process after the other, and each name and byte is counted.
//!
//! `PROCESSES=10000 cargo test -p bg-workbench --test library traffic -- --nocapture` prints the table of
//! `docs/benchmarks/sweeps.md`.

use std::fs;
use std::path::Path;

use bg_workbench::Program;
use bg_workbench::sweep::folder::{Folder, ShardFile, Traffic};
use bg_workbench::sweep::plan::Plan;
use bg_workbench::sweep::shown::{Progress, joined};
use bg_workbench::sweep::{Outcome, Share, recipe, sweep};

use super::lanes::Block;

/// Two runs in each file, a file for each process.
fn plan(processes: usize) -> String {
    let grid = format!("[grid]\nmass = {{ from = 1, to = 2, count = {processes} }}\nstart = [0.1, 0.2]\n");
    format!("t_end = 0.01\nshard = 2\n{grid}[columns]\nx = [\"final\"]\n")
}

/// The sweep of so many processes in a folder.
struct Sweep<'a> {
    program: &'a Program,
    plan: Plan<'a>,
    processes: usize,
    folder: tempfile::TempDir,
}

impl<'a> Sweep<'a> {
    fn of(program: &'a Program, processes: usize) -> Self {
        let plan = Plan::parse(program, "plan.toml", Path::new(""), plan(processes)).unwrap();
        Self { program, plan, processes, folder: tempfile::tempdir().unwrap() }
    }

    /// What the process of a part does, and what it asks for.
    fn part(&self, part: usize) -> (Outcome, Traffic) {
        let claimed = Folder::claim(self.folder.path(), &recipe::of(self.program, &self.plan)).unwrap();
        let share = Share::new(part + 1, self.processes).unwrap();
        let outcome = sweep(self.program, &self.plan, &claimed, share, 1, &|_, _| true).unwrap();
        (outcome, claimed.traffic())
    }

    /// The same of several, one after the other.
    fn parts(&self, parts: impl Iterator<Item = usize>) -> (Vec<Outcome>, Traffic) {
        let mut all = Traffic::default();
        let one = |part| {
            let (outcome, traffic) = self.part(part);
            let Traffic { names, listed, read, written } = traffic;
            all.names += names;
            all.listed += listed;
            all.read += read;
            all.written += written;
            outcome
        };
        (parts.map(one).collect(), all)
    }

    /// Leaves what a process leaves that is killed while it writes the file of its part.
    fn kill(&self, part: usize) {
        fs::write(self.folder.path().join(format!(".runs-{part:06}.parqueta1B2c3.unfinished")), "half").unwrap();
    }

    fn names(&self) -> usize {
        fs::read_dir(self.folder.path()).unwrap().count()
    }
}

/// How many processes; some for a test.
fn processes() -> usize {
    std::env::var("PROCESSES").map_or(60, |number| number.parse().expect("PROCESSES is a number"))
}

#[test]
fn what_processes_ask_of_the_file_system_grows_as_their_number() {
    let program = Program::of::<Block>();
    let count = processes();
    println!("| {count} processes end | names | names listed | read, kB | written, kB |\n|---|---|---|---|---|");
    let tell = |what: &str, Traffic { names, listed, read, written }: Traffic| {
        println!("| {what} | {names} | {listed} | {} | {} |", read / 1000, written / 1000);
    };
    // Whoever asks whether all is there while k of n are missing asks for n / k names, so all ask for n ln n.
    let n = count as f64;
    let most = 12.0 * n + 2.0 * n * n.ln();
    let in_some_order = |k: usize| k * 7919 % count;
    let orders: [(&str, &dyn Fn(usize) -> usize); 3] =
        [("one after the other", &|k| k), ("the last one first", &|k| count - 1 - k), ("in any order", &in_some_order)];
    for (told, order) in orders {
        let sweep = Sweep::of(&program, count);
        let (outcomes, traffic) = sweep.parts((0..count).map(order));
        tell(told, traffic);
        assert!(outcomes.iter().all(|outcome| outcome.made == 1 && outcome.found == 0));
        // The last one alone lists the folder.
        assert!(outcomes.iter().enumerate().all(|(k, outcome)| outcome.is_last == (k + 1 == count)), "{told}");
        assert!((traffic.names as f64) < most && traffic.listed as usize == count + 1, "{told}: {traffic:?}");
    }
}

#[test]
fn parts_that_were_killed_are_made_again_and_merged_once() {
    let program = Program::of::<Block>();
    let count = processes();
    let sweep = Sweep::of(&program, count);
    let is_killed = |part: &usize| part % 10 == 3;
    sweep.parts((0..count).filter(|part| !is_killed(part)));
    (0..count).filter(is_killed).for_each(|part| sweep.kill(part));
    assert_eq!(sweep.names(), count + 1);
    // The array is submitted once more as a whole: who finds its file asks for little.
    let (outcomes, again) = sweep.parts(0..count);
    assert!(outcomes.iter().enumerate().all(|(part, outcome)| outcome.made == usize::from(is_killed(&part))));
    let left = count + 1 + count / 10;
    assert!(again.names < 20 * count as u64 && again.listed as usize == left, "{again:?}");
    // Nothing is left but the files and the recipe; who comes after the last one lists nothing and makes nothing.
    assert_eq!(sweep.names(), count + 1);
    let (outcomes, after) = sweep.parts(0..count);
    assert!(outcomes.iter().all(|outcome| outcome.made == 0 && !outcome.is_last), "{outcomes:?}");
    assert!(after.names <= 5 * count as u64 && after.listed == 0, "{after:?}");

    // Merged, each file is read once, and the rows are those of one process.
    let merged = Folder::open(sweep.folder.path()).unwrap();
    let before = merged.traffic();
    let rows = joined(&merged, ShardFile::Runs).unwrap();
    let asked = merged.traffic();
    assert_eq!(asked.names - before.names, count as u64);
    let files = (0..count).map(|part| sweep.folder.path().join(format!("runs-{part:06}.parquet")));
    assert_eq!(asked.read - before.read, files.map(|path| fs::metadata(path).unwrap().len()).sum::<u64>());
    let progress = Progress::of(&merged).unwrap().to_string();
    assert!(progress.contains(&format!("runs     {0} of {0} in {1} of {1} shards", 2 * count, count)), "{progress}");
    let alone = Sweep { folder: tempfile::tempdir().unwrap(), ..Sweep::of(&program, count) };
    let whole = Folder::claim(alone.folder.path(), &recipe::of(&program, &alone.plan)).unwrap();
    sweep_all(&program, &alone.plan, &whole);
    assert!(joined(&whole, ShardFile::Runs).unwrap().bytes() == rows.bytes());
}

fn sweep_all(program: &Program, plan: &Plan<'_>, folder: &Folder) {
    assert!(sweep(program, plan, folder, Share::ALL, 1, &|_, _| true).unwrap().is_last);
}
