//! The command that records a golden output anew, as it is typed.

use std::path::Path;

use super::FOLDER;
use super::file::Golden;
use crate::ask::parameters::{Values, number};
use crate::ask::request::Integration;

/// The command of the program called `program` that records `golden` anew with these parameters.
pub(super) fn command(program: &str, golden: &Golden, parameters: &Values) -> String {
    let scene = golden.record.scene.as_str();
    let Integration { t_end, step, method, hint, rtol, atol, fixed_step } = golden.record.run;
    let mut words: Vec<String> = [program, "golden", "record", "--scene", scene].map(str::to_owned).to_vec();
    let mut option = |name: &str, value: String| words.extend([format!("--{name}"), value]);
    for (info, value) in parameters.changed() {
        option("set", format!("{}={}", info.name, number(value)));
    }
    for input in &golden.record.inputs {
        option("input", input.clone());
    }
    option("t-end", number(t_end));
    option("step", number(step));
    option("method", method.name().to_owned());
    if let Some(hint) = hint {
        option("hint", hint.name().to_owned());
    }
    if method.has_fixed_step() {
        option("fixed-step", number(fixed_step));
    }
    option("rtol", number(rtol));
    if let Some(atol) = atol {
        option("atol", number(atol));
    }
    if golden.files.name != scene {
        option("name", golden.files.name.clone());
    }
    words.extend(out(&golden.files.folder));
    words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
}

/// The command that records a first golden output into `folder`.
pub(super) fn first(program: &str, folder: &Path) -> String {
    let words = [program, "golden", "record"].map(str::to_owned).into_iter().chain(out(folder));
    words.map(|word| quoted(&word)).collect::<Vec<_>>().join(" ")
}

/// The option that says `folder`, where it takes one.
fn out(folder: &Path) -> Vec<String> {
    let is_default = folder == Path::new(FOLDER);
    if is_default { Vec::new() } else { vec!["--out".to_owned(), folder.display().to_string()] }
}

/// `word` as a shell takes it for one.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_./=+:,@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_stays_one_for_a_shell() {
        assert_eq!(["a=-1e-7", "my golden", "it's", ""].map(quoted), ["a=-1e-7", "'my golden'", r"'it'\''s'", "''"]);
        assert_eq!(first("pendulum", Path::new("golden")), "pendulum golden record");
        assert_eq!(first("pendulum", Path::new("/a b")), "pendulum golden record --out '/a b'");
    }
}
