//! The page of the reference that lists the library, and what is said of beginners' mistakes with each of its parts.
//!
//! Both are made from the parts themselves: `RENEW=1` writes them anew.

use std::fmt::Write as _;
use std::fs;

use bg_compiler::source::library::{LibraryPart, names, parts};
use bg_model::description::{Description, ParameterInfo};

use super::super::text::{file, graphs, held, said};

/// Where the made part of the page begins.
const MARK: &str =
    "<!-- From here on made from the parts: RENEW=1 cargo test -p bg-model-tests --test mechanisms page -->\n";

/// What users use.
fn whole() -> impl Iterator<Item = LibraryPart> {
    parts().filter(|part| !part.is_piece())
}

/// The ports of a part with their domains.
fn ports(part: &LibraryPart) -> Vec<(&'static str, &'static str)> {
    let lines = part.text.lines().filter_map(|line| line.trim().strip_prefix("port "));
    lines.filter_map(|line| line.trim_end_matches(';').split_once(": ")).collect()
}

/// Its inputs with their units.
fn inputs(part: &LibraryPart) -> Vec<(&'static str, &'static str)> {
    let lines = part.text.lines().filter_map(|line| line.trim().strip_prefix("input "));
    lines.filter_map(|line| line.trim_end_matches(';').split_once(": ")).collect()
}

/// A graph with one part, `p`, and something at each of its ports but those that `left` out; `clauses` inside of its
/// use.
fn graph(part: &LibraryPart, left: usize, clauses: &str) -> String {
    let bonds: String = ports(part)
        .iter()
        .enumerate()
        .skip(left)
        .map(|(k, (port, domain))| match *domain {
            _ if port.ends_with("[3]") => {
                format!("1 j{k}[3]: {domain}; I i{k} = 1; p.{} -> j{k} -> i{k}; ", port.trim_end_matches("[3]"))
            }
            "rotation" | "translation" => format!("1 j{k}: {domain}; I i{k} = 1; p.{port} -> j{k} -> i{k}; "),
            _ => format!("0 j{k}: {domain}; R r{k} = 1; p.{port} -> j{k} -> r{k}; "),
        })
        .collect();
    // What has no ports is signals beside a shaft.
    let bonds =
        if ports(part).is_empty() { "1 j: rotation; I i = 1; Se s = 1; s -> j -> i;".to_owned() } else { bonds };
    format!("use {}; graph Tried {{ part p: {} {{ {clauses} }} {bonds} observe {{ all of p }} }}", part.file, part.name)
}

fn description(part: &LibraryPart) -> &'static Description {
    graphs(&graph(part, 0, ""))[0].models[0].description
}

fn range(parameter: &ParameterInfo) -> String {
    let range = &parameter.range;
    let end = |value: f64, is_in: bool, words: [&str; 2]| {
        value.is_finite().then(|| format!("{} {value}", if is_in { words[0] } else { words[1] }))
    };
    let lower = end(range.lower, range.lower_included, ["at least", "above"]);
    let upper = end(range.upper, range.upper_included, ["at most", "below"]);
    lower.into_iter().chain(upper).collect::<Vec<_>>().join(", ")
}

/// A name without the path of the part, and without the asterisks that Markdown would read.
fn cell(text: &str) -> String {
    text.strip_prefix("p.").unwrap_or(text).replace('*', "\\*")
}

/// What the page says of a part.
fn section(part: &LibraryPart) -> String {
    let description = description(part);
    let mut text = format!("### `{}`\n\n{}\n", part.name, part.docs);
    let listed = |of: &[(&str, &str)]| {
        of.iter().map(|(name, kind)| format!("`{name}` ({})", cell(kind))).collect::<Vec<_>>().join(", ")
    };
    let ports = ports(part);
    if !ports.is_empty() {
        write!(text, "\nPorts: {}.", listed(&ports)).expect("a string");
    }
    let inputs = inputs(part);
    if !inputs.is_empty() {
        write!(text, "\nInputs: {}.", listed(&inputs)).expect("a string");
    }
    let outputs: Vec<(&str, &str)> = description
        .outputs
        .iter()
        .map(|output| (output.name.strip_prefix("p.").unwrap_or(output.name), output.unit))
        .collect();
    if !outputs.is_empty() {
        write!(text, "\nOutputs: {}.", listed(&outputs)).expect("a string");
    }
    text += "\n\n| parameter | default | range | |\n|---|---|---|---|\n";
    for parameter in description.parameters {
        let unit = if parameter.unit == "1" { String::new() } else { format!(" {}", cell(parameter.unit)) };
        let (name, range) = (cell(parameter.name), range(parameter));
        writeln!(text, "| `{name}` | {}{unit} | {range} | {} |", parameter.default, parameter.doc).expect("a string");
    }
    text
}

fn made() -> String {
    let mut text = String::from(MARK);
    for file in names() {
        write!(text, "\n## `use {file};`\n").expect("a string");
        whole().filter(|part| part.file == file).for_each(|part| {
            write!(text, "\n{}", section(&part)).expect("a string");
        });
    }
    text
}

#[test]
fn the_page_lists_the_library() {
    let path = file("../../bg-macros/docs/language/library.md");
    let text = fs::read_to_string(&path).expect("the page");
    let (own, _) = text.split_once(MARK).expect("a mark");
    held(&path, &format!("{own}{}", made()));
}

/// A mistake: what it is, and a text with it.
type Mistake = (String, String);

/// Five of a part with ports.
fn of_bonds(part: &LibraryPart) -> Vec<Mistake> {
    let parameter = &description(part).parameters[0];
    let name = parameter.name.trim_start_matches("p.");
    let near = format!("{}{}", &name[..name.len() - 2], &name[name.len() - 1..]);
    let wrong = if parameter.range.lower_included { -1.0 } else { parameter.range.lower };
    let unit = if parameter.unit == "kg" { "A" } else { "kg" };
    let port = ports(part)[0].0.trim_end_matches("[3]");
    let other = graph(part, 1, "")
        .replace("observe", &format!("0 wall: thermal; R heat = 1; p.{port} -> wall -> heat; observe"));
    vec![
        ("a port is left out".to_owned(), graph(part, 1, "")),
        (format!("a slip of the pen, {near}"), graph(part, 0, &format!("{near} = 1;"))),
        (format!("{name} = {wrong}"), graph(part, 0, &format!("{name} = {wrong};"))),
        (format!("{name} = 3 {unit}"), graph(part, 0, &format!("{name} = 3 {unit};"))),
        (format!("{port} on a wall of heat"), other),
    ]
}

/// Five of a part of signals.
fn of_signals(part: &LibraryPart) -> Vec<Mistake> {
    let given = "wanted = 1; measured = j.displacement;";
    let text = |clauses: &str, law: &str| {
        format!(
            "use {}; graph Tried {{ part p: {} {{ {clauses} }} 1 j: rotation; I i = 1; MSe m = {law}; m -> j -> i; \
            observe {{ all of p }} }}",
            part.file, part.name
        )
    };
    let mistake = |what: &str, clauses: &str, law: &str| (what.to_owned(), text(clauses, law));
    vec![
        mistake("the part in place of its output", given, "p"),
        mistake("an output that it has not", given, "p.torque"),
        mistake("a slip of the pen, mesured", "wanted = 1; mesured = 1;", "0"),
        mistake("a temperature is measured", "wanted = 1; measured = 300 K;", "0"),
        mistake("gain = 0", &format!("{given} gain = 0;"), "0"),
    ]
}

#[test]
fn beginners_are_told_what_to_do() {
    let mut text = String::new();
    for part in whole() {
        let mistakes = if ports(&part).is_empty() { of_signals(&part) } else { of_bonds(&part) };
        assert_eq!(mistakes.len(), 5);
        for (what, wrong) in mistakes {
            let found = said(&wrong);
            assert!(found.starts_with("[BG"), "{}: {what}: {found}\n{wrong}", part.name);
            let named = ["`p", "`wall`", part.name];
            assert!(named.iter().any(|name| found.contains(name)), "{}: {what}: {found}", part.name);
            write!(text, "{}: {what}\n{found}\n", part.name).expect("a string");
        }
    }
    held(&file("mechanisms/library/mistakes.txt"), &text);
}
