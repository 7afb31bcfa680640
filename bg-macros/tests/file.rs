//! A call that names a file: as one with the graphs in it, with places of faults in the file.

extern crate proc_macro;

#[path = "../src/file.rs"]
mod file;

use std::path::Path;

use file::{compile, named};
use proc_macro2::TokenStream;

/// The items of the first of these files, in a folder of their own.
fn compiled(files: &[(&str, &str)]) -> String {
    let name = files[0].0;
    let folder = std::env::temp_dir().join(format!("bond-graph-file-{}-{name}", std::process::id()));
    std::fs::create_dir_all(folder.join("parts")).expect("a folder");
    files.iter().for_each(|(name, text)| std::fs::write(folder.join(name), text).expect("a file"));
    let tokens = format!("file \"{name}\"").parse().expect("tokens");
    let items = compile(&named(&tokens).expect("a file is named"), &folder).to_string();
    std::fs::remove_dir_all(folder).expect("it is there");
    items
}

#[test]
fn a_file_is_as_a_call() {
    let graph = "graph Coil { 1 wire: electrical; I coil = 2; wire -> coil; }";
    let tokens: TokenStream = graph.parse().expect("tokens");
    let own = bg_compiler::compile(tokens.clone()).to_string();
    assert!(named(&tokens).is_none() && compiled(&[("coil.bond", graph)]).ends_with(&own));
}

#[test]
fn faults_say_line_and_column_in_the_file() {
    let text = compiled(&[("bad.bond", "graph Coil {\n    1 wire: electrical;\n    I coil = 2; wire -> coli;\n}")]);
    assert!(text.contains("bad.bond:3:25: [BG0303] nothing is called `coli`"), "{text}");
    let text = compiled(&[("open.bond", "graph Coil {\n    1 wire")]);
    assert!(text.contains("open.bond:1:12: [BG0906]"), "{text}");
    let tokens = "file \"missing.bond\"".parse().expect("tokens");
    let text = compile(&named(&tokens).expect("a file"), Path::new("nowhere")).to_string();
    assert!(text.contains("cannot read `missing.bond`"), "{text}");
}

#[test]
fn a_table_may_stand_in_a_file() {
    let graph = |points: &str| {
        format!(
            "graph Coil {{ table flux: A -> Wb = {points}; 1 wire: electrical; R coil(i) = flux(i) / (1 s); \
            I core = 2; wire -> coil; wire -> core; }}"
        )
    };
    let of_file =
        compiled(&[("table.bond", &graph("\"flux.csv\"")), ("flux.csv", "current [mA],flux\n0,0\n500,0.1\n")]);
    let own = compiled(&[("points.bond", &graph("[[0 mA, 0], [500 mA, 0.1]]"))]);
    // Rust builds anew where the points change.
    assert_eq!(of_file.matches("include_bytes").count(), 2, "{of_file}");
    let after = |items: &str| {
        items.split("include_bytes").last().and_then(|rest| rest.split_once(';')).map(|(_, items)| items.to_owned())
    };
    assert!(after(&of_file).is_some() && after(&of_file) == after(&own), "{of_file}");
    let missing = compiled(&[("none.bond", &graph("\"none.csv\""))]);
    assert!(missing.contains("none.bond:1:36: [BG0901] cannot read `none.csv`"), "{missing}");
}

#[test]
fn a_file_uses_others() {
    let graph = "graph Driven { part shaft: Shaft; Se f = 1; 1 j: rotation; f -> j -> shaft.end; }";
    let driven = &format!("use \"parts/shaft.bond\"; {graph}");
    let shaft = "pub part Shaft { port end: rotation; I wheel = 2; end -> wheel; }";
    let items = compiled(&[("driven.bond", driven), ("parts/shaft.bond", shaft)]);
    assert!(items.contains("struct Driven"), "{items}");
    // Rust builds anew where either file changes; the part is no item of this call.
    assert_eq!(items.matches("include_bytes").count(), 2, "{items}");
    assert!(!items.contains("macro_rules"), "{items}");
    let items = compiled(&[("faulty.bond", driven), ("parts/shaft.bond", &shaft.replace("= 2", "= two"))]);
    assert!(items.contains("parts/shaft.bond:1:48: [BG0303]"), "{items}");
    let items = compiled(&[("alone.bond", driven)]);
    assert!(items.contains("alone.bond:1:5: [BG0901] cannot read `parts/shaft.bond`"), "{items}");
}
