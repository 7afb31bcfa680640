//! Sentences of the command line in Python's words.
//!
//! In: a sentence that names options as `--t-end`, `--starts 8`, `--input push=3`, and commands. Out: the same with the
//! arguments of Python's functions, `t_end=`, `starts=8`, `inputs={"push": 3}`, and these functions. Method: an option
//! is what begins with two dashes and a letter; what stands after it and looks like its value goes with it.

use std::borrow::Cow;
use std::iter;

use serde_json::Value;

/// Options whose arguments have other names.
const NAMES: [(&str, &str); 5] =
    [("input", "inputs"), ("output", "outputs"), ("column", "columns"), ("from", "start"), ("with", "others")];

/// The sentence in Python's words.
#[must_use]
pub fn in_python(sentence: &str) -> String {
    let sentence = with_functions(sentence);
    let mut rest = &*sentence;
    let mut told = String::with_capacity(sentence.len());
    while let Some(at) = next_option(rest) {
        told += &rest[..at];
        let after = &rest[at + DASHES.len()..];
        let (option, after) = after.split_at(after.find(|c: char| !is_of_option(c)).unwrap_or(after.len()));
        let value = value_of(option, after);
        told += &argument(option, value, after);
        rest = &after[value.map_or(0, |value| 1 + value.len())..];
    }
    told + rest
}

/// All texts in Python's words.
pub(crate) fn all_in_python(value: Value) -> Value {
    match value {
        Value::String(text) => Value::String(in_python(&text)),
        Value::Array(all) => all.into_iter().map(all_in_python).collect(),
        Value::Object(all) => all.into_iter().map(|(name, value)| (name, all_in_python(value))).collect(),
        other => other,
    }
}

/// The sentence with a function in place of a command that lists something.
fn with_functions(sentence: &str) -> Cow<'_, str> {
    let of = || {
        let (before, after) = sentence.split_once("the command `")?;
        let (command, after) = after.split_once("` lists ")?;
        let (command, scene) = command.split_once(' ').unwrap_or((command, ""));
        let kind = after.strip_prefix("the ").and_then(|after| after.split(|c: char| !c.is_alphabetic()).next());
        let function = match (command, kind) {
            ("parameters", _) | (_, Some("parameters")) => "parameters",
            (_, Some("outputs")) => "outputs",
            _ => "scenes",
        };
        let scene = if scene.is_empty() { String::new() } else { format!("\"{scene}\"") };
        Some(format!("{before}`{function}({scene})` lists {after}").into())
    };
    of().unwrap_or(Cow::Borrowed(sentence))
}

const DASHES: &str = "--";

const fn is_of_option(c: char) -> bool {
    c.is_ascii_lowercase() || c == '-'
}

/// Where the next option begins.
fn next_option(text: &str) -> Option<usize> {
    let begins = |&(at, _): &(usize, &str)| {
        let is_word = text[..at].chars().next_back().is_none_or(|before| !before.is_alphanumeric() && before != '-');
        is_word && text[at + DASHES.len()..].starts_with(|after: char| after.is_ascii_lowercase())
    };
    text.match_indices(DASHES).find(begins).map(|(at, _)| at)
}

/// What an option is given in a sentence: what stands after `=`; after one blank what is quoted, a number, a name in
/// capitals, a pair with `=`, or what a colon follows.
fn value_of<'a>(option: &str, after: &'a str) -> Option<&'a str> {
    let word = after.strip_prefix([' ', '='])?;
    if let Some(quoted) = word.strip_prefix('"') {
        return Some(&word[..2 + quoted.find('"')?]);
    }
    let word = word.split(char::is_whitespace).next()?;
    let is_place = word.ends_with(':') || after.starts_with('=') || option == "scene";
    let word = word.trim_end_matches([',', ';', ':', '.', '`', ')']);
    let looks_like_one = is_place && !word.is_empty()
        || word.contains('=')
        || word.starts_with(|c: char| c.is_ascii_digit())
        || word.len() > 1 && word.chars().all(|c| c.is_ascii_uppercase() || c == '_');
    looks_like_one.then_some(word)
}

fn argument<'a>(option: &'a str, value: Option<&'a str>, after: &str) -> Cow<'a, str> {
    let name = NAMES.iter().find(|(known, _)| *known == option).map_or(option, |(_, name)| name).replace('-', "_");
    match value {
        None if after.starts_with(':') => name.into(),
        None => format!("{name}=").into(),
        // A parameter is an argument itself.
        Some(pair) if option == "set" => pair.into(),
        Some(pair) if option == "input" => match pair.split_once('=') {
            Some((input, value)) => format!("{name}={{\"{input}\": {}}}", literal(value)).into(),
            None => format!("{name}={}", literal(pair)).into(),
        },
        Some(value) => format!("{name}={}", literal(value)).into(),
    }
}

/// A number, or what stands for one, as it is; else a text.
fn literal(value: &str) -> Cow<'_, str> {
    let is_bare = value.parse::<f64>().is_ok() || value == "VALUE" || value.starts_with(['[', '"']);
    if is_bare { value.into() } else { iter::once("\"").chain([value, "\""]).collect::<String>().into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_arguments() {
        let told = [
            ("--at -1: must be a finite number", "at=-1: must be a finite number"),
            ("--bounds: k=1: give it as NAME=LOWER..UPPER", "bounds: k=1: give it as NAME=LOWER..UPPER"),
            ("which graph? Say --graph NAME: there are `A`", "which graph? Say graph=\"NAME\": there are `A`"),
            ("leave --orders out", "leave orders= out"),
            ("raise it with --t-end; or not", "raise it with t_end=; or not"),
            ("many minima; --starts 8 sees more", "many minima; starts=8 sees more"),
            ("nothing may change: --by length=0.5..0.9", "nothing may change: by=\"length=0.5..0.9\""),
            ("--minimize \"max |w|\": there is none", "minimize=\"max |w|\": there is none"),
            ("none `k`; the command `parameters` lists them", "none `k`; `parameters()` lists them"),
            ("none `k`; the command `scene` lists the outputs", "none `k`; `outputs()` lists the outputs"),
            (
                "none `k`; the command `scene a` lists the parameters",
                "none `k`; `parameters(\"a\")` lists the parameters",
            ),
            ("no scene; the command `scene` lists the scenes", "no scene; `scenes()` lists the scenes"),
            ("--by k: there is none", "by=\"k\": there is none"),
            ("it is fixed; use --scene paper", "it is fixed; use scene=\"paper\""),
            ("say it as --hint=dop853", "say it as hint=\"dop853\""),
            ("--set mass=2: out of range", "mass=2: out of range"),
            ("start inside with --set", "start inside with set="),
            ("say it with --column NAME=OUTPUT", "say it with columns=\"NAME=OUTPUT\""),
            ("--input forse=1: no input", "inputs={\"forse\": 1}: no input"),
            (
                "set it with --input NAME=VALUE or NAME=FILE.csv",
                "set it with inputs={\"NAME\": VALUE} or NAME=FILE.csv",
            ),
            ("a--b, 3 -- 4, x --", "a--b, 3 -- 4, x --"),
        ];
        for (line, python) in told {
            assert_eq!(in_python(line), python);
        }
    }
}
