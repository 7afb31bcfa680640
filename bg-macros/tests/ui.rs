//! What a user sees: the messages of the compiler at their tokens, and nothing of rustc's besides.
//!
//! Each file of `ui/` has one faulty graph and uses the items that it promises; `accepted/` has the same without a fault.
//! `README.md` says how the expected messages are renewed.

use std::path::Path;

/// All in one, and none that passes: so trybuild checks them by one call of cargo, not by two for each.
#[test]
fn messages() {
    let cases = trybuild::TestCases::new();
    for stage in ["syntax", "mechanism", "graph", "causality", "equations", "scene", "values", "part"] {
        cases.compile_fail(format!("tests/ui/{stage}_*.rs"));
    }
    // Generated code and run time are of one version.
    cases.compile_fail("tests/version/*.rs");
}

/// The expected messages are ours alone: a code and a help line each, and no warning or error of rustc's.
#[test]
fn no_error_follows() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/ui");
    let mut files = 0;
    for entry in std::fs::read_dir(folder).expect("the folder is there") {
        let path = entry.expect("a readable folder").path();
        if path.extension().is_none_or(|extension| extension != "stderr") {
            continue;
        }
        files += 1;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).expect("messages are text");
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
