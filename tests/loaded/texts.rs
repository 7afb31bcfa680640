//! The texts of models that are compiled by rustc: the macro's calls in source files, and files that it takes.

use std::fs;
use std::path::Path;

use proc_macro2::{TokenStream, TokenTree};

/// Folders that have the files of the models.
const FOLDERS: [&str; 3] = ["tests/models", "bg-model/workbench/examples", "hacksaw"];

/// The text in the file `name` that has the graph `graph`: a call of the macro, or all of a text's own file.
pub fn of(name: &str, graph: &str) -> String {
    let text = call(name, &format!("graph {graph} "));
    if !text.contains("hacksaw :: Mechanism") {
        return text;
    }
    // A text has no crates: the part of another one stands in it.
    let parts = call("hacksaw.bond", "graph Hacksaw ");
    let graph = parts.find("pub graph").expect("a graph after the part");
    let end = parts[..graph].rfind('}').expect("the part's end");
    format!("{} {}", &parts[..=end], text.replace("hacksaw :: Mechanism", "Mechanism"))
}

fn call(name: &str, having: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace");
    let path = FOLDERS.iter().map(|folder| root.join(folder).join(name)).find(|path| path.exists());
    let path = path.unwrap_or_else(|| panic!("{name} is in one of the folders"));
    let file = fs::read_to_string(&path).expect("a text");
    let tokens: TokenStream = file.parse().expect("tokens");
    let texts = if name.ends_with(".bond") { vec![tokens.to_string()] } else { calls(tokens) };
    let found = texts.into_iter().find(|call| call.contains(having));
    found.unwrap_or_else(|| panic!("{} has {having}", path.display()))
}

/// What stands in the braces of the macro's calls.
fn calls(tokens: TokenStream) -> Vec<String> {
    let mut found = Vec::new();
    let mut is_call = false;
    for token in tokens {
        match token {
            TokenTree::Ident(ident) => is_call = ident == "bond_graph",
            TokenTree::Group(group) if is_call => found.push(group.stream().to_string()),
            TokenTree::Group(group) => found.extend(calls(group.stream())),
            _ => {}
        }
    }
    found
}
