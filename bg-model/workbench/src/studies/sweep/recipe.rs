//! Whether two sweeps are the same: all that the bytes of a shard depend on, as a small TOML file.
//!
//! In: a program, a plan. Out: the text of `sweep.toml`, which every shard has in its metadata as well, and where it
//! differs from another one. The model is known by the CRC-32 of its equations, the values of the parameters by that of
//! all their bytes: they guard against mistakes, not against forgery.

use std::path::Path;

use toml::{Table, Value};

use super::plan::Plan;
use crate::ask::inputs::{Setting, Source};
use crate::files::crc32;
use crate::program::Program;
use crate::run::recipe::fingerprint;
use crate::run::running::Begin;

/// The entries that may differ, since they are for people: the plan as it was written, and the files that inputs are
/// from.
const FOR_PEOPLE: [&str; 2] = [PLAN, INPUT_FILES];
const PLAN: &str = "plan";
/// The entry with the inputs: values, or of tables how many rows they have and the CRC-32 of the numbers in them.
pub(super) const INPUTS: &str = "inputs";
/// The entry with the files of those that are tables.
pub(super) const INPUT_FILES: &str = "input_files";
/// What shards have and what their numbers mean; counts up where that changes.
const FORMAT: usize = 2;
/// What stands for an absolute tolerance where the sizes of the states give it.
pub(super) const OF_SIZES: &str = "by the sizes of the states";

/// The recipe of a sweep by `plan`.
#[must_use]
pub fn of(program: &Program, plan: &Plan<'_>) -> Table {
    let Plan { scene, integration, request, begin, chosen, settings, design, wanted, numbers, shard, text } = plan;
    let model = scene.description;
    let of_strings = |names: &mut dyn Iterator<Item = String>| Value::Array(names.map(Value::String).collect());
    let values = (0..design.runs).flat_map(|run| design.values(run)).flat_map(f64::to_le_bytes);
    let base = chosen.values.all().filter(|(info, _)| !design.names.iter().any(|name| name == info.name));
    let base = base.map(|(info, value)| (info.name.to_owned(), Value::Float(value)));
    let inputs = model.inputs.iter().zip(settings).map(|(info, setting)| (info.name.to_owned(), input(setting)));
    let files = model.inputs.iter().zip(settings);
    let files = files.filter_map(|(info, setting)| Some((info.name.to_owned(), Value::String(file(setting)?))));
    let numbers = numbers.iter().flat_map(|numbers| &numbers.named);
    let numbers = numbers.map(|(name, number)| format!("{name} = {}", number.text));
    let columns = wanted.columns(model).into_iter().map(|(name, _)| name).chain(numbers);
    let trajectories = wanted.trajectories.iter().map(|&output| model.outputs[output].name.to_owned());
    let entries = [
        ("program", Value::String(program.texts.name.clone())),
        ("version", Value::String(program.texts.version.clone())),
        ("format", whole(FORMAT)),
        ("scene", Value::String(scene.name.clone())),
        ("model", Value::String(fingerprint(model))),
        ("start", Value::String(if *begin == Begin::Equilibrium { "equilibrium" } else { "model" }.to_owned())),
        ("t_end", Value::Float(integration.t_end)),
        ("step", Value::Float(integration.step)),
        ("method", Value::String(integration.method.name().to_owned())),
        ("rtol", Value::Float(request.rtol)),
        ("atol", request.atol.map_or_else(|| Value::String(OF_SIZES.to_owned()), Value::Float)),
        ("fixed_step", Value::Float(request.fixed_step)),
        ("step_limit", whole(usize::try_from(request.step_limit).unwrap_or(usize::MAX))),
        ("runs", whole(design.runs)),
        ("shard", whole(*shard)),
        ("swept", of_strings(&mut design.names.iter().cloned())),
        ("values", Value::String(crc32(&values.collect::<Vec<_>>()))),
        ("columns", of_strings(&mut columns.into_iter())),
        ("trajectories", of_strings(&mut trajectories.into_iter())),
        ("parameters", Value::Table(base.collect())),
        (INPUTS, Value::Table(inputs.collect())),
        (INPUT_FILES, Value::Table(files.collect())),
        (PLAN, Value::String(text.clone())),
    ];
    let hint = request.hint.map(|hint| ("hint", Value::String(hint.name().to_owned())));
    entries.into_iter().chain(hint).map(|(name, value)| (name.to_owned(), value)).collect()
}

fn whole(value: usize) -> Value {
    Value::Integer(i64::try_from(value).unwrap_or(i64::MAX))
}

fn input(setting: &Setting) -> Value {
    match setting {
        Setting::NotGiven => Value::Float(0.0),
        Setting::Constant(value) => Value::Float(*value),
        // A plan is a text, in which there is none.
        Setting::Function(_) => Value::String("a function".to_owned()),
        Setting::Table { times, values, cubic, .. } => {
            let bytes: Vec<u8> = times.iter().chain(values).flat_map(|value| value.to_le_bytes()).collect();
            Value::String(format!("{} rows, cubic {cubic}, {}", times.len(), crc32(&bytes)))
        }
    }
}

/// The name of the file that a table is from, and its CRC-32. Without the folder, which may have another place on each
/// machine.
fn file(setting: &Setting) -> Option<String> {
    let Setting::Table { source: Some(Source { file, column, crc32 }), .. } = setting else { return None };
    let name = Path::new(file).file_name().map_or_else(|| file.clone(), |name| name.to_string_lossy().into_owned());
    let column = column.as_ref().map_or_else(String::new, |column| format!(", column `{column}`"));
    Some(format!("{name}{column}, CRC-32 {crc32}"))
}

/// The first entry in which a recipe differs from the one that is there, with both values; none if the bytes would be
/// the same.
#[must_use]
pub fn difference(there: &Table, here: &Table) -> Option<String> {
    let names = there.keys().chain(here.keys().filter(|name| !there.contains_key(*name)));
    for name in names.filter(|name| !FOR_PEOPLE.contains(&name.as_str())) {
        match (there.get(name), here.get(name)) {
            (there, here) if there == here => {}
            (Some(Value::Table(there)), Some(Value::Table(here))) => {
                return difference(there, here).map(|inner| format!("{name}: {inner}"));
            }
            (there, here) => {
                let [there, here] = [there, here].map(|value| value.map_or_else(|| "absent".to_owned(), short));
                return Some(format!("`{name}` is {there} there and {here} here"));
            }
        }
    }
    None
}

/// A value in a line.
fn short(value: &Value) -> String {
    const MOST: usize = 80;
    let text = value.to_string();
    if text.chars().count() > MOST { text.chars().take(MOST).chain("..".chars()).collect() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_is_named_and_the_words_of_the_plan_are_none() {
        let table = |text: &str| text.parse::<Table>().unwrap();
        let there = table("rtol = 1e-8\nplan = 'a'\n[parameters]\nmass = 2.0\nlength = 1.0");
        assert_eq!(difference(&there, &table("rtol = 1e-8\nplan = 'b'\n[parameters]\nmass = 2.0\nlength = 1.0")), None);
        let mass = table("rtol = 1e-8\n[parameters]\nmass = 3.0\nlength = 1.0");
        assert_eq!(difference(&there, &mass).unwrap(), "parameters: `mass` is 2.0 there and 3.0 here");
        let less = table("rtol = 1e-8\nplan = 'a'");
        assert!(difference(&there, &less).unwrap().ends_with("there and absent here"));
    }
}
