//! The grammar for editors gives words their colours: run by VS Code's own engine, vscode-textmate, where node and npm
//! are.
//!
//! npm fetches the engine into a folder of the build; where it cannot, there is nothing to run.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

/// The engine and the matcher of expressions that it is used with in VS Code.
const ENGINE: [&str; 2] = ["vscode-textmate@9.3.2", "vscode-oniguruma@2.0.1"];

/// The names of grammars.
const BOND: &str = "source.bond";
const RUST: &str = "source.rust";

/// A word of a text: its line, its scopes.
type Word = (usize, String, Vec<String>);

fn place(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The folder that has the engine, which is fetched once.
fn engine() -> Option<&'static Path> {
    static FOLDER: LazyLock<Option<PathBuf>> = LazyLock::new(fetched);
    FOLDER.as_deref()
}

fn fetched() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("colours");
    let is_there = |name: &&str| folder.join("node_modules").join(name.split('@').next().unwrap_or_default()).is_dir();
    if !ENGINE.iter().all(is_there) {
        fs::create_dir_all(&folder).expect("a folder");
        let mut npm = Command::new("npm");
        npm.args(["install", "--silent", "--no-audit", "--no-fund", "--prefix"]).arg(&folder).args(ENGINE);
        if !npm.output().is_ok_and(|output| output.status.success()) {
            println!("skipped: npm cannot install {}", ENGINE.join(" and "));
            return None;
        }
    }
    if !Command::new("node").arg("--version").output().is_ok_and(|output| output.status.success()) {
        println!("skipped: node is not installed");
        return None;
    }
    Some(folder)
}

/// The words of a text, and how many scopes are open at its end.
fn words(engine: &Path, scope: &str, file: &Path) -> (Vec<Word>, usize) {
    let mut node = Command::new("node");
    node.arg(place("editor/colours.js")).arg(engine).arg(place("../docs/editor")).arg(scope).arg(file);
    let output = node.output().expect("node runs");
    let told = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{told}{}", String::from_utf8_lossy(&output.stderr));
    let mut lines: Vec<&str> = told.lines().collect();
    let open = lines.pop().and_then(|line| line.parse().ok()).expect("the depth at the end");
    (lines.into_iter().map(|line| serde_json::from_str(line).expect("a word")).collect(), open)
}

/// The innermost scopes that each word of a text has, in the order of the text.
fn innermost(words: &[Word]) -> BTreeMap<&str, Vec<&str>> {
    let mut scopes = BTreeMap::<&str, Vec<&str>>::new();
    for (_, word, of) in words {
        let innermost = of.last().map_or("", String::as_str);
        let known = scopes.entry(word).or_default();
        if !known.contains(&innermost) {
            known.push(innermost);
        }
    }
    scopes
}

#[test]
fn words_of_a_slider_crank_have_their_scopes() {
    let Some(engine) = engine() else { return };
    let (words, _) = words(engine, BOND, &place("stages/slider_crank.bond"));
    let scopes = innermost(&words);
    for (word, wanted) in [
        ("pub", &["storage.modifier.bond"][..]),
        ("graph", &["keyword.other.declaration.bond"]),
        ("SliderCrank", &["entity.name.type.bond"]),
        ("body", &["keyword.other.declaration.bond"]),
        ("crank", &["variable.other.definition.bond", "variable.other.bond"]),
        ("ground", &["keyword.other.bond", "variable.other.bond"]),
        ("density", &["keyword.other.clause.bond"]),
        ("7850", &["constant.numeric.bond"]),
        ("N*m", &["support.type.unit.bond"]),
        ("rotation_z", &["support.function.bond"]),
        ("revolute", &["storage.type.joint.bond"]),
        ("prismatic", &["storage.type.joint.bond"]),
        ("z", &["constant.language.axis.bond"]),
        ("->", &["keyword.operator.arrow.bond"]),
        ("stiffness", &["keyword.other.clause.bond"]),
        ("observe", &["keyword.other.bond"]),
        ("force", &["variable.other.member.bond"]),
        // A parameter, its use, and what a drive prescribes.
        ("torque", &["variable.other.definition.bond", "keyword.other.clause.bond", "variable.other.bond"]),
    ] {
        assert_eq!(scopes.get(word).map(Vec::as_slice), Some(wanted), "{word}");
    }
    assert_eq!(words[0].2, ["comment.line.documentation.bond"], "{:?}", words[0]);
}

#[test]
fn every_example_is_read_to_its_end() {
    let Some(engine) = engine() else { return };
    let files = fs::read_dir(place("stages")).expect("the examples").map(|entry| entry.expect("a file").path());
    let examples: Vec<_> = files.filter(|path| path.extension().is_some_and(|ending| ending == "bond")).collect();
    assert!(examples.len() > 15, "only {} examples", examples.len());
    for path in examples {
        let (words, open) = words(engine, BOND, &path);
        assert_eq!(open, 1, "{} leaves a scope open", path.display());
        for (line, word, scopes) in words {
            let is_number = word.starts_with(|c: char| c.is_ascii_digit()) && word.parse::<f64>().is_ok();
            let innermost = scopes.last().map_or("", String::as_str);
            let is_known = innermost.starts_with("constant.numeric") || innermost.starts_with("storage.type.junction");
            let is_other = innermost.starts_with("support.type.unit") || innermost.starts_with("comment");
            assert!(!is_number || is_known || is_other, "{}:{line}: {word} is {innermost}", path.display());
        }
    }
}

#[test]
fn the_body_of_the_macro_is_coloured_in_rust_and_nothing_after_it() {
    let Some(engine) = engine() else { return };
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("in_rust.rs");
    let text = "// bond_graph! { body no { } }\nbond_graph! {\n    graph Pair { body rod { mass 2; \
        } }\n}\nfn mass() { body rod }\n";
    fs::write(&file, text).expect("a file");
    let (words, _) = words(engine, RUST, &file);
    let bond = |(_, _, scopes): &&Word| scopes.iter().any(|scope| scope == BOND);
    let lines: Vec<usize> = words.iter().filter(bond).map(|(line, ..)| *line).collect();
    assert!(!lines.is_empty() && lines.iter().all(|line| *line == 3), "{words:?}");
    let of = |wanted: &str| words.iter().find(|(line, word, _)| *line == 3 && word == wanted).map(|(.., of)| of.last());
    assert_eq!(of("mass"), Some(Some(&"keyword.other.clause.bond".to_owned())));
    assert_eq!(of("rod"), Some(Some(&"variable.other.definition.bond".to_owned())));
}
