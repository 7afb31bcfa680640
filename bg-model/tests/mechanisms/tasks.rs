//! The texts of `docs/tasks.md` run, and give what their last lines say.

use bg_model::dynamics::Machine;

use super::hand::run;
use super::text::{graphs, model, outputs};

const DOCUMENT: &str = include_str!("../../../docs/tasks.md");

/// What a text says of its run: `// After 2 s: speed 1448 rpm, torque 7.505 N*m.`
struct Said<'t> {
    t_end: f64,
    /// Names of outputs with their values.
    values: Vec<(&'t str, f64)>,
}

/// The texts, each with what it says.
fn texts() -> impl Iterator<Item = (&'static str, Said<'static>)> {
    DOCUMENT.split("```bond\n").skip(1).map(|rest| {
        let text = rest.split("```").next().unwrap_or_default();
        let line = text.lines().rev().find_map(|line| line.strip_prefix("// After ")).expect("a last line");
        let (t_end, values) = line.trim_end_matches('.').split_once(" s: ").expect("a time");
        let value = |part: &'static str| {
            let mut words = part.split(' ');
            let name = words.next().expect("a name");
            (name, words.next().and_then(|number| number.parse().ok()).expect("a number"))
        };
        (text, Said { t_end: t_end.parse().expect("a number"), values: values.split(", ").map(value).collect() })
    })
}

#[test]
fn each_text_gives_what_it_says() {
    assert!(texts().count() >= 6);
    for (text, said) in texts() {
        let graphs = graphs(text);
        let name = &graphs[0].name;
        let model = model(&graphs, name, &[]);
        let start = model.start().unwrap_or_else(|error| panic!("{name}: {error}"));
        let finish = run(&*model, &start, said.t_end);
        let found = outputs(&*model, finish.t, finish.x.as_slice(), &finish.negative);
        for (output, expected) in said.values {
            let index = model.description().outputs.iter().position(|info| info.name == output);
            let value = found[index.unwrap_or_else(|| panic!("{name} has no output {output}"))];
            // Numbers stand there with four digits.
            assert!((value - expected).abs() <= 5e-4 * expected.abs(), "{name}: {output} is {value}, not {expected}");
        }
    }
}
