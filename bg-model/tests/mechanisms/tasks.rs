//! The texts of `docs/tasks.md` run, and give what their last lines say.

use bg_model::dynamics::Machine;

use super::hand::run;
use super::text::{graphs, model, outputs};

const DOCUMENT: &str = include_str!("../../../docs/tasks.md");

/// What a text says of a run: `// After 2 s: speed 1448 rpm, torque 7.505 N*m.`, `// With ratio = 4, after 2 s: speed
/// 90 rpm.`
struct Said<'t> {
    /// Parameters with values, in their units.
    parameters: Vec<(&'t str, f64)>,
    t_end: f64,
    /// Names of outputs with their values.
    values: Vec<(&'t str, f64)>,
}

/// What a line says, if it is such a line.
fn said(line: &str) -> Option<Said<'_>> {
    let line = line.strip_prefix("// ")?.trim_end_matches('.');
    let (parameters, run) = match line.strip_prefix("With ") {
        Some(with) => with.split_once(", after ").expect("a time"),
        None => ("", line.strip_prefix("After ")?),
    };
    let (t_end, values) = run.split_once(" s: ").expect("a time");
    let number = |text: &str| text.trim().parse().unwrap_or_else(|_| panic!("a number, not {text}: {line}"));
    let given = parameters.split(", ").filter_map(|given| given.split_once(" = "));
    let value = |part| {
        let mut words = str::split(part, ' ');
        (words.next().expect("a name"), number(words.next().expect("a value")))
    };
    Some(Said {
        parameters: given.map(|(name, value)| (name, number(value))).collect(),
        t_end: number(t_end),
        values: values.split(", ").map(value).collect(),
    })
}

/// The texts that say what their runs give.
fn texts() -> impl Iterator<Item = (&'static str, Vec<Said<'static>>)> {
    DOCUMENT.split("```bond\n").skip(1).filter_map(|rest| {
        let text = rest.split("```").next().unwrap_or_default();
        let said: Vec<Said> = text.lines().filter_map(said).collect();
        (!said.is_empty()).then_some((text, said))
    })
}

#[test]
fn each_text_gives_what_it_says() {
    assert!(texts().count() >= 14);
    for (text, said) in texts() {
        let graphs = graphs(text);
        for Said { parameters, t_end, values } in said {
            let first = graphs[0].models[0].description;
            let model = model(&graphs, first.name, &parameters);
            let name = &graphs[0].name;
            let start = model.start().unwrap_or_else(|error| panic!("{name}: {error}"));
            let finish = run(&*model, &start, t_end);
            let found = outputs(&*model, finish.t, finish.x.as_slice(), &finish.negative);
            for (output, expected) in values {
                let index = first.outputs.iter().position(|info| info.name == output);
                let value = found[index.unwrap_or_else(|| panic!("{name} has no output {output}"))];
                // Numbers stand there with four digits.
                assert!(
                    (value - expected).abs() <= 5e-4 * expected.abs() + 1e-9,
                    "{name}: {output} is {value}, not {expected}, after {t_end} s"
                );
            }
        }
    }
}

#[test]
fn all_twenty_three_tasks_are_there() {
    let rows = DOCUMENT.lines().filter_map(|line| line.strip_prefix("| ")?.split(" | ").next());
    let numbers = rows.flat_map(|row| row.split([' ', ',']).filter_map(|word| word.parse::<usize>().ok()));
    assert_eq!(numbers.collect::<Vec<_>>(), (1..=23).collect::<Vec<_>>());
}
