//! What becomes of the files of a run that is killed, fails, is not alone, or has nowhere to write.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// A short run, so that the suite stays quick in debug.
const SHORT: [&str; 2] = ["--t-end", "0.02"];
/// A run that writes its trajectory for seconds.
const LONG_WRITING: [&str; 5] = ["--t-end", "0.02", "--step", "1e-6", "--no-figures"];

fn hacksaw(directory: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hacksaw"));
    command.current_dir(directory).args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn run(directory: &Path, arguments: &[&str]) -> Output {
    hacksaw(directory, arguments).output().unwrap()
}

fn succeed(directory: &Path, arguments: &[&str]) {
    let output = run(directory, arguments);
    assert!(output.status.success(), "{arguments:?}: {output:?}");
}

/// The one line of stderr.
fn line(output: &Output) -> &str {
    let line = std::str::from_utf8(&output.stderr).unwrap();
    assert!(line.starts_with("error: ") && line.lines().count() == 1, "{line:?}");
    line
}

/// The names of the results in a folder; what begins with a dot is none.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().to_str().unwrap().to_owned());
    let mut names: Vec<_> = entries.filter(|name| !name.starts_with('.')).collect();
    names.sort();
    names
}

/// The results in a folder with their contents.
fn results(folder: &Path) -> Vec<(String, Vec<u8>)> {
    names(folder).into_iter().map(|name| (name.clone(), fs::read(folder.join(name)).unwrap())).collect()
}

/// A run that has begun to write what `growing` finds.
fn started(directory: &Path, arguments: &[&str], growing: impl Fn() -> Option<PathBuf>) -> Child {
    let mut child = hacksaw(directory, arguments).spawn().unwrap();
    let begin = Instant::now();
    while growing().and_then(|path| fs::metadata(path).ok()).is_none_or(|file| file.len() == 0) {
        assert!(child.try_wait().unwrap().is_none(), "{arguments:?} ended before it was seen writing");
        assert!(begin.elapsed() < Duration::from_secs(300), "{arguments:?} does not write");
        std::thread::sleep(Duration::from_millis(1));
    }
    child
}

fn kill(mut child: Child) {
    assert!(child.try_wait().unwrap().is_none(), "it ended before it was killed");
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn a_run_that_is_killed_while_it_writes_leaves_what_was_there() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    let out = path.join("out");
    let growing = || Some(out.join(".run/unfinished/trajectory.csv"));
    kill(started(path, &LONG_WRITING, growing));
    assert!(names(&out).is_empty());

    succeed(path, &SHORT);
    let before = results(&out);
    assert_eq!(before.len(), 20);
    let child = started(path, &LONG_WRITING, growing);
    // A second run at once is refused, and the first does not notice.
    let second = run(path, &SHORT);
    assert_eq!(second.status.code(), Some(2));
    assert!(second.stdout.is_empty());
    assert!(line(&second).starts_with("error: another run is writing into out: wait for its end"));
    kill(child);
    assert!(results(&out) == before);

    succeed(path, &[&SHORT[..], &["--no-figures"]].concat());
    assert_eq!(names(&out), ["summary.json", "summary.txt", "trajectory.csv"]);
    assert!(!out.join(".run/unfinished").exists());
}

#[test]
fn a_csv_file_elsewhere_is_not_cut_either() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    fs::write(path.join("run.csv"), "before").unwrap();
    let unfinished = || {
        let paths = fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path());
        let mut found = paths.filter(|path| path.extension().is_some_and(|end| end == "unfinished"));
        found.next()
    };
    kill(started(path, &[&LONG_WRITING[..], &["--csv", "run.csv"]].concat(), unfinished));
    assert_eq!(fs::read_to_string(path.join("run.csv")).unwrap(), "before");
}

#[test]
fn a_run_that_fails_leaves_no_file_of_the_one_before() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    let out = path.join("out");
    succeed(path, &SHORT);
    fs::write(out.join("notes.txt"), "mine").unwrap();
    let output = run(path, &["--scene", "angles", "--set", "torque=1e300"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(line(&output).starts_with("error: the run failed: "));
    assert_eq!(names(&out), ["notes.txt", "summary.json", "summary.txt", "trajectory.csv"]);
    assert!(fs::read_to_string(out.join("summary.txt")).unwrap().contains("the run failed"));
    assert_eq!(fs::read_to_string(out.join("notes.txt")).unwrap(), "mine");
}

#[test]
fn what_no_run_wrote_is_not_replaced() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    fs::write(path.join("index.html"), "mine").unwrap();
    let output = run(path, &[&SHORT[..], &["--out", "."]].concat());
    assert_eq!(output.status.code(), Some(2));
    assert!(line(&output).contains("index.html is no file of an earlier run"));
    assert_eq!(names(path), ["index.html"]);
    assert!(!path.join(".run").exists());
}

#[test]
fn a_csv_file_that_the_user_names_is_left_by_later_runs() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    for file in ["out/a.csv", "out/b.csv", "out/trajectory.csv", "out/trajectory.csv"] {
        succeed(path, &[&SHORT[..], &["--csv", file]].concat());
    }
    // Sixteen figures, page and summary are the last run's.
    let all = names(&path.join("out"));
    assert_eq!(all.len(), 19 + 3);
    assert!(["a.csv", "b.csv", "trajectory.csv"].iter().all(|csv| all.iter().any(|name| name == csv)), "{all:?}");
    let output = run(path, &["--csv", "absent/run.csv", "--out", "new"]);
    assert!(line(&output).starts_with("error: cannot write absent/run.csv: No such file"));
    assert!(!path.join("new").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn standard_output_that_fails_is_said_and_keeps_no_file_back() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    let full = || Stdio::from(fs::OpenOptions::new().write(true).open("/dev/full").unwrap());
    let to_full = [
        &["--help"][..],
        &["--version"],
        &["scene"],
        &["graph", "--part", "bonds"],
        &["parameters", "--toml"],
        &["--t-end", "0.02"],
    ];
    for arguments in to_full {
        let output = hacksaw(path, arguments).stdout(full()).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert!(line(&output).starts_with("error: cannot write to standard output: No space left"), "{arguments:?}");
    }
    assert_eq!(names(&path.join("out")).len(), 20);
}

/// A run for which no file becomes larger than a megabyte, as on a full disk.
#[cfg(target_os = "linux")]
fn limited(directory: &Path, arguments: &[&str]) -> Output {
    // Units of 512 or 1024 bytes, as the shell has it. Without the signal the system refuses to write.
    let script = "trap '' XFSZ; ulimit -f 2048; exec \"$0\" \"$@\"";
    let mut command = Command::new("sh");
    command.args(["-c", script, env!("CARGO_BIN_EXE_hacksaw")]).args(arguments).current_dir(directory);
    command.output().unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_that_fails_is_said_and_keeps_no_other_back() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    // 2001 rows are three megabytes, and no figure has one.
    let many = ["--t-end", "0.02", "--step", "1e-5"];
    fs::write(path.join("run.csv"), "before").unwrap();
    let output = limited(path, &[&many[..], &["--csv", "run.csv"]].concat());
    assert_eq!(output.status.code(), Some(1));
    assert!(line(&output).starts_with("error: cannot write run.csv: File too large"));
    let summary = String::from_utf8(output.stdout).unwrap();
    assert!(summary.ends_with("written: 19 files in out; open index.html there\n"), "{summary}");
    assert_eq!(fs::read_to_string(path.join("run.csv")).unwrap(), "before");
    assert_eq!(names(path), ["out", "run.csv"]);

    let before = results(&path.join("out"));
    assert_eq!(before.len(), 19);
    let output = limited(path, &many);
    assert_eq!(output.status.code(), Some(1));
    assert!(line(&output).starts_with("error: cannot write out/trajectory.csv: File too large"));
    assert!(String::from_utf8(output.stdout).unwrap().ends_with("\nwritten: nothing\n"));
    assert!(results(&path.join("out")) == before);
}

#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_ends_a_run_quietly() {
    let directory = tempfile::tempdir().unwrap();
    let mut child = hacksaw(directory.path(), &SHORT).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    assert_eq!(names(&directory.path().join("out")).len(), 20);
}

#[cfg(target_os = "linux")]
#[test]
fn a_name_need_not_be_text() {
    use std::os::unix::ffi::OsStrExt;
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    let [out, csv, toml] = [b"o\xffx", b"c\xffx", b"t\xffx"].map(|bytes| std::ffi::OsStr::from_bytes(bytes));
    fs::write(path.join(toml), "torque = 11\n").unwrap();
    let mut command = hacksaw(path, &SHORT);
    let output = command.arg("--out").arg(out).arg("--csv").arg(csv).arg("--params").arg(toml).output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    assert_eq!(names(&path.join(out)).len(), 19);
    assert!(path.join(csv).is_file());
    let json: serde_json::Value =
        serde_json::from_slice(&fs::read(path.join(out).join("summary.json")).unwrap()).unwrap();
    assert_eq!(json["files"][0], "c\u{fffd}x");
    // An error line, too.
    let output = hacksaw(path, &[]).arg("--params").arg(out).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(line(&output).starts_with("error: cannot read o\u{fffd}x: "));
}

#[cfg(unix)]
#[test]
fn a_folder_that_cannot_be_written_is_refused_before_the_run() {
    use std::os::unix::fs::PermissionsExt;
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    let closed = path.join("closed");
    fs::create_dir(&closed).unwrap();
    fs::set_permissions(&closed, fs::Permissions::from_mode(0o555)).unwrap();
    if fs::write(closed.join("probe"), "").is_ok() {
        // An administrator may write everywhere; there is nothing to see then.
        return;
    }
    let cases: [(&[&str], &str); 2] = [
        (&["--out", "closed"], "cannot write closed: Permission denied"),
        (&["--csv", "closed/run.csv", "--no-figures"], "cannot write closed/run.csv: Permission denied"),
    ];
    for (arguments, told) in cases {
        let output = run(path, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(line(&output).contains(told), "{arguments:?}: {}", line(&output));
    }
}
