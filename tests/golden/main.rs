//! Golden outputs: generated code as text, and the hacksaw's trajectory beside an independent one.
//!
//! `golden/hacksaw_paper.csv` is the project's reference solution of the paper's case, 51 instants of 5 s: an
//! independent implementation's, copied unchanged from `reference/hacksaw_paper.csv` of the project's shared files.
//! `README.md` says how the snapshots are renewed. What the program itself gives, with exact counts, is recorded in
//! `hacksaw/golden`.

use std::collections::BTreeSet;
use std::path::Path;

use bg_model::integrator::{Dop853, Tolerances};
use bg_model::mechanism::Mechanism;
use bg_model::simulation::{Part, Recorder, Recording, Samples, Settings, Span, integrate};
use bg_model::statistics::Statistics;
use bg_model::system::Model;
use hacksaw::mechanism::{Hacksaw, HacksawParameters};

fn file(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Relative and absolute tolerance of `hacksaw run` by default and with `--rtol 1e-10`.
const DEFAULT: [f64; 2] = [1e-8, 1e-9];
const CLOSE: [f64; 2] = [1e-10, 1e-11];

/// The code that is generated for a call with this text, formatted.
fn code(text: &str) -> String {
    let tokens = text.parse().expect("a model is tokens");
    let mut items: syn::File = syn::parse2(bg_compiler::compile(tokens)).expect("generated code is Rust");
    items.items.retain(|item| !is_for_editors(item));
    prettyplease::unparse(&items)
}

/// The generated code of a model of the stages suite.
fn generated(model: &str) {
    let code = code(&file(&format!("stages/{model}.bond")));
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(".");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!(model, without_graph_text(&code)));
}

/// Whether it is the module that rust-analyzer alone reads; the suite `editor` asks what it makes of it.
fn is_for_editors(item: &syn::Item) -> bool {
    matches!(item, syn::Item::Mod(module) if module.ident.to_string().starts_with("__bond_graph_names_of_"))
}

/// The code without the expanded graph's text, one long line that the stages' snapshots show better.
fn without_graph_text(code: &str) -> String {
    let shown =
        |line: &str| if line.trim_start().starts_with("graph: \"") { "graph: \"...\"," } else { line }.to_owned();
    code.lines().map(|line| shown(line) + "\n").collect()
}

#[test]
fn the_code_of_the_motor() {
    generated("motor");
}

#[test]
fn the_code_of_the_pendulum() {
    generated("pendulum");
}

/// The statements of the rate in a text of Rust, without comments.
fn statements_of_the_rate(code: &str) -> Vec<&str> {
    let (_, inlined) = code.split_once("Inlined<").expect("inlined functions");
    let (_, function) = inlined.split_once("fn rate(").expect("a rate");
    let (_, body) = function.split_once(") {\n").expect("a body");
    let lines = body.lines().map(|line| line.split("//").next().unwrap_or_default().trim());
    lines.take_while(|&line| line != "}").collect()
}

/// The traits that a text says a motor has: of the document in comments, of generated code by path.
fn traits(code: &str) -> BTreeSet<&str> {
    let heads = code.lines().filter_map(|line| line.split_once("impl")?.1.split_once(" for M"));
    let paths = heads.map(|(head, _)| head.strip_prefix("<S: Scalar>").unwrap_or(head).trim());
    let names = paths.map(|path| path.split_once('<').map_or(path, |(path, _)| path));
    names.map(|path| path.rsplit_once("::").map_or(path, |(_, name)| name)).collect()
}

#[test]
fn the_documented_code_is_what_is_generated() {
    let document = file("../docs/generated-code.md");
    let blocks: Vec<&str> = document.split("```rust\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    let [call, shown] = blocks[..] else { panic!("a call and its code") };
    let graph = call.trim().strip_prefix("bond_graph! {").and_then(|text| text.strip_suffix('}')).expect("a call");
    let code = code(graph);
    assert_eq!(statements_of_the_rate(shown), statements_of_the_rate(&code));
    let missing = |name: &&str| !traits(shown).contains(name);
    assert!(traits(shown).is_subset(&traits(&code)), "{:?}", traits(&code));
    assert_eq!(traits(&code).into_iter().filter(missing).collect::<Vec<_>>(), ["Scenes"]);
}

/// A table of numbers with named columns, the first of them `t`.
struct Table {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn read(name: &str) -> Self {
        let text = file(name);
        let mut lines = text.lines();
        let names = lines.next().expect("a header").split(',').map(str::to_owned).collect();
        let number = |field: &str| field.parse().unwrap_or_else(|_| panic!("`{field}` is no number"));
        Self { names, rows: lines.map(|line| line.split(',').map(number).collect()).collect() }
    }
}

/// Samples of all outputs and of the energy stored, and the cost.
struct Run {
    samples: Recording,
    statistics: Statistics,
}

fn run(t_end: f64, relative: f64, absolute: f64, instants: &[f64]) -> Run {
    let model = Hacksaw::new(HacksawParameters::default()).expect("the defaults are in range");
    let start = model.start().expect("the paper's pose closes");
    let settings = Settings {
        tolerances: Tolerances::new(relative, absolute),
        samples: Samples::At(instants.to_vec()),
        ..Settings::default()
    };
    let machine = model.machine();
    let mut observer = Recorder::new(&*machine, &[Part::Outputs, Part::Energy]);
    let span = Span { t0: 0.0, t_end };
    let finish = integrate(&model, &mut Dop853::new(), &start, span, &settings, &mut observer).expect("the run ends");
    Run { samples: observer.recording, statistics: finish.statistics }
}

/// The largest deviation from the first rows of the reference, and the column that has it.
fn deviation(run: &Run, table: &Table) -> (f64, String) {
    let column = |name: &String| run.samples.column(name).unwrap_or_else(|| panic!("no output {name}"));
    let columns: Vec<&[f64]> = table.names[1..].iter().map(column).collect();
    let mut largest = (0.0, String::new());
    for (k, expected) in table.rows[..run.samples.times.len()].iter().enumerate() {
        for ((values, name), value) in columns.iter().zip(&table.names[1..]).zip(&expected[1..]) {
            let error = (values[k] - value).abs();
            assert!(error.is_finite(), "{name} at {}", expected[0]);
            if error > largest.0 {
                largest = (error, format!("{name} at {} s", expected[0]));
            }
        }
    }
    largest
}

/// |stored - stored at the start - supplied + dissipated| at the end, in units of the energy supplied.
fn imbalance(run: &Run) -> f64 {
    let column = |name: &str| run.samples.column(name).unwrap_or_else(|| panic!("no output {name}"));
    let last = |name: &str| *column(name).last().expect("a sample");
    let supplied = last("supplied_energy");
    (last("stored energy") - column("stored energy")[0] - supplied + last("dissipated_energy")).abs() / supplied
}

fn reference() -> Table {
    let table = Table::read("golden/hacksaw_paper.csv");
    assert_eq!((table.names.len(), table.rows.len()), (73, 51));
    table
}

fn check(t_end: f64, [relative, absolute]: [f64; 2], bound: f64) -> Run {
    let table = reference();
    let instants: Vec<f64> = table.rows.iter().map(|row| row[0]).filter(|&t| t <= t_end).collect();
    let run = run(t_end, relative, absolute, &instants);
    assert_eq!(run.samples.times.len(), instants.len());
    let (error, place) = deviation(&run, &table);
    println!("rtol {relative:e}: error {error:.3e} in {place}, imbalance {:.3e}, {}", imbalance(&run), run.statistics);
    assert!(error < bound, "{error:e} in {place}");
    run
}

#[test]
fn one_second_at_loose_tolerances() {
    check(1.0, [1e-8, 1e-10], 1e-5);
}

#[test]
fn one_second_at_close_tolerances() {
    check(1.0, [1e-10, 1e-12], 1e-8);
}

#[test]
fn the_paper_s_five_seconds_at_the_default_tolerance() {
    check(5.0, DEFAULT, 1e-5);
}

#[test]
fn the_paper_s_five_seconds_at_a_close_tolerance() {
    let run = check(5.0, CLOSE, 1e-8);
    assert_eq!(run.statistics.events, 60);
    assert!(imbalance(&run) < 1e-9, "{:e}", imbalance(&run));
}
