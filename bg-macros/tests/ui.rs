//! What a user sees: the messages of the compiler at their tokens, and nothing of rustc's besides.
//!
//! Each file of `ui/` has one faulty graph and uses the items that it promises; `accepted/` has the same without a
//! fault. Renewed by `MESSAGES=overwrite`.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The messages of a file beside those that are expected, where they differ.
///
/// rustc is called as it is: a project of its own would build the compiler and all that bg-model needs a second time,
/// for two and a half minutes.
fn differing(case: &Path, bg_model: &Path, out: &Path) -> Option<String> {
    let dependencies = bg_model.parent().expect("a folder");
    let output = Command::new(env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()))
        .args(["--edition=2024", "--crate-type=bin", "--emit=metadata", "--color=never"])
        .arg(format!("--extern=bg_model={}", bg_model.display()))
        .arg(format!("-Ldependency={}", dependencies.display()))
        .arg(format!("--out-dir={}", out.display()))
        .arg(case)
        .output()
        .expect("rustc runs");
    let printed = String::from_utf8(output.stderr).expect("messages are text");
    // What follows the messages counts them.
    let messages: Vec<&str> = printed.split("\n\n").filter(|text| !text.starts_with("error: aborting")).collect();
    let found = format!("{}\n", messages.join("\n\n").trim_end());
    let expected = case.with_extension("stderr");
    if env::var_os("MESSAGES").is_some_and(|wish| wish == "overwrite") {
        fs::write(&expected, &found).expect("the file can be written");
    }
    let wanted = fs::read_to_string(&expected).unwrap_or_default();
    let is_right = !output.status.success() && found == wanted;
    (!is_right).then(|| format!("{}\n--- found\n{found}--- expected\n{wanted}", case.display()))
}

/// The library of this build: the youngest, where others have been made.
fn bg_model() -> PathBuf {
    let program = env::current_exe().expect("a test has a file");
    let entries = fs::read_dir(program.parent().expect("a folder")).expect("the folder is there");
    let paths = entries.map(|entry| entry.expect("a readable folder").path());
    let is_library = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("libbg_model-") && name.ends_with(".rlib")
    };
    let written = |path: &PathBuf| fs::metadata(path).and_then(|of| of.modified()).expect("the file has a time");
    paths.filter(is_library).max_by_key(written).expect("cargo has built bg-model")
}

/// `MESSAGES=overwrite cargo test -p bg-macros --test ui` renews what is expected.
#[test]
fn messages() {
    let (bg_model, out) = (bg_model(), tempfile::tempdir().expect("a folder"));
    let mut cases: Vec<PathBuf> = ["tests/ui", "tests/version"]
        .into_iter()
        .flat_map(|folder| fs::read_dir(folder).expect("the folder is there"))
        .map(|entry| entry.expect("a readable folder").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .collect();
    cases.sort();
    let (some, others) = cases.split_at(cases.len() / 2);
    let of = |cases: &[PathBuf]| -> Vec<String> {
        cases.iter().filter_map(|case| differing(case, &bg_model, out.path())).collect()
    };
    let wrong = std::thread::scope(|scope| {
        let beside = scope.spawn(|| of(others));
        [of(some), beside.join().expect("the other half")].concat()
    });
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(cases.len(), 25);
}

/// The expected messages are ours alone: a code and a help line each, and no warning or error of rustc's.
#[test]
fn no_error_follows() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/ui");
    let mut files = 0;
    for entry in fs::read_dir(folder).expect("the folder is there") {
        let path = entry.expect("a readable folder").path();
        if path.extension().is_none_or(|extension| extension != "stderr") {
            continue;
        }
        files += 1;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let text = fs::read_to_string(&path).expect("messages are text");
        let heads: Vec<&str> =
            text.lines().filter(|line| line.starts_with("error") || line.starts_with("warning")).collect();
        assert!(!heads.is_empty(), "{name}");
        assert!(heads.iter().all(|head| head.starts_with("error: [BG0")), "{name}:\n{text}");
        assert_eq!(text.matches("help: ").count(), heads.len(), "{name}:\n{text}");
        let expected = match name.as_str() {
            "graph_several.stderr" => 3,
            "scene_same_names.stderr" => 2,
            _ => 1,
        };
        assert_eq!(heads.len(), expected, "{name}:\n{text}");
        // A fault is at its token, not at the whole call.
        assert!(!text.contains("bond_graph! {"), "{name}:\n{text}");
    }
    assert_eq!(files, 24);
}
