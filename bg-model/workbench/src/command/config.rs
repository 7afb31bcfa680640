//! Options from a file: `--config run.toml`.
//!
//! In: the words of a command line. Out: the same with the options of the file in front of the others, so that those on
//! the command line win. A key is the name of an option, its value a number, a text, `true`, a list for an option that
//! can be given again and again, or a table for one that takes `NAME=VALUE`.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use thiserror::Error;
use toml::{Table, Value};

/// The option.
pub const OPTION: &str = "--config";

/// A file that has no options.
#[derive(Debug, Error)]
#[error("--config {}: {fault}", path.display())]
pub struct ConfigError {
    path: PathBuf,
    fault: String,
}

/// The words of a command line, those of the file apart.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Words {
    /// The file.
    pub path: Option<PathBuf>,
    /// The program's name and the command's.
    pub command: Vec<OsString>,
    /// What the file says.
    pub of_file: Vec<OsString>,
    /// What stands on the command line.
    pub own: Vec<OsString>,
}

impl Words {
    /// All in the order in which the later ones win.
    pub fn all(&self) -> impl Iterator<Item = OsString> {
        self.command.iter().chain(&self.of_file).chain(&self.own).cloned()
    }

    /// Those of them that are no part of the command.
    pub fn options(&self) -> Vec<OsString> {
        self.of_file.iter().chain(&self.own).cloned().collect()
    }
}

/// Takes the words apart, and reads the file that they name.
///
/// # Errors
/// [`ConfigError`].
pub fn words(words: impl IntoIterator<Item = OsString>) -> Result<Words, ConfigError> {
    let mut words: Vec<OsString> = words.into_iter().collect();
    let path = taken(&mut words)?;
    let is_option = |word: &OsString| word.as_encoded_bytes().starts_with(b"-");
    let own = words.split_off(words.iter().position(is_option).unwrap_or(words.len()));
    let of_file = path.as_deref().map_or(Ok(Vec::new()), options)?;
    Ok(Words { path, command: words, of_file, own })
}

/// The value of the option, which is taken out of the words.
fn taken(words: &mut Vec<OsString>) -> Result<Option<PathBuf>, ConfigError> {
    let value = |word: &OsStr| Some(word.to_str()?.strip_prefix(OPTION)?.strip_prefix('=')?.into());
    let Some(place) = words.iter().position(|word| word == OPTION || value(word).is_some()) else { return Ok(None) };
    let word = words.remove(place);
    let path: PathBuf = match value(&word) {
        Some(path) => path,
        None if place < words.len() => words.remove(place).into(),
        None => return Err(ConfigError { path: PathBuf::new(), fault: "give it a file".to_owned() }),
    };
    if words.iter().any(|word| word == OPTION || value(word).is_some()) {
        return Err(ConfigError { path, fault: "there can be only one".to_owned() });
    }
    Ok(Some(path))
}

/// The options in a file as words.
fn options(path: &Path) -> Result<Vec<OsString>, ConfigError> {
    let failed = |fault: String| ConfigError { path: path.to_owned(), fault };
    let text = std::fs::read_to_string(path).map_err(|fault| failed(format!("cannot be read: {fault}")))?;
    let table: Table = text.parse().map_err(|fault: toml::de::Error| failed(fault.to_string().trim().to_owned()))?;
    let mut words = Vec::new();
    for (key, value) in &table {
        let name = format!("--{}", key.replace('_', "-"));
        if name == OPTION {
            return Err(failed("a file of options names no other one".to_owned()));
        }
        let refused = |what: &str| failed(format!("`{key}` is {what}"));
        match value {
            Value::Boolean(true) => words.push(name.into()),
            Value::Boolean(false) => {}
            Value::Array(values) => {
                for value in values {
                    let text =
                        text_of(value).ok_or_else(|| refused("a list of something else than numbers and texts"))?;
                    words.push(format!("{name}={text}").into());
                }
            }
            Value::Table(values) => {
                for (own, value) in values {
                    let text =
                        text_of(value).ok_or_else(|| refused("a table of something else than numbers and texts"))?;
                    words.push(format!("{name}={own}={text}").into());
                }
            }
            other => {
                let text = text_of(other).ok_or_else(|| refused("a date; give a number or a text"))?;
                words.push(format!("{name}={text}").into());
            }
        }
    }
    Ok(words)
}

/// A number or a text as a word.
fn text_of(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => Some(text.clone()),
        Value::Integer(number) => Some(number.to_string()),
        Value::Float(number) => Some(format!("{number:?}")),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(text: &str) -> tempfile::NamedTempFile {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        file
    }

    fn of(line: &[&str]) -> Result<Vec<String>, String> {
        let words = words(line.iter().map(Into::into)).map_err(|fault| fault.to_string())?;
        Ok(words.all().map(|word| word.into_string().unwrap()).collect())
    }

    #[test]
    fn options_of_a_file_stand_before_those_of_the_command_line() {
        let file = file(
            "t_end = 2\nmethod = \"dop853\"\nrtol = 1e-9\nno-figures = true\njson = false\noutput = [\"a\", \"b\"]\n\
             [set]\nlength = \"75mm\"\nmass = 3.5\n",
        );
        let path = file.path().to_str().unwrap();
        let expected = [
            "saw",
            "run",
            "--method=dop853",
            "--no-figures",
            "--output=a",
            "--output=b",
            "--rtol=1e-9",
            "--set=length=75mm",
            "--set=mass=3.5",
            "--t-end=2",
            "--t-end",
            "1",
            "--set",
            "a=1",
        ];
        let joined = format!("--config={path}");
        assert_eq!(of(&["saw", "run", "--t-end", "1", "--config", path, "--set", "a=1"]).unwrap(), expected);
        assert_eq!(of(&["saw", "run", "--t-end", "1", &joined, "--set", "a=1"]).unwrap(), expected);
        assert_eq!(of(&["saw", "run", "--t-end", "1"]).unwrap(), ["saw", "run", "--t-end", "1"]);
    }

    #[test]
    fn a_file_without_options_is_refused() {
        let fault = |text: &str| {
            let file = file(text);
            let fault = of(&["saw", "--config", file.path().to_str().unwrap()]).unwrap_err();
            fault.split_once(": ").unwrap().1.to_owned()
        };
        assert_eq!(fault("config = \"b.toml\""), "a file of options names no other one");
        assert_eq!(fault("from = 1979-05-27"), "`from` is a date; give a number or a text");
        assert_eq!(fault("set = [[1]]"), "`set` is a list of something else than numbers and texts");
        assert!(fault("set length = 3").contains("TOML parse error at line 1"));
        assert_eq!(of(&["saw", "--config"]).unwrap_err(), "--config : give it a file");
        assert!(of(&["saw", "--config", "none.toml"]).unwrap_err().starts_with("--config none.toml: cannot be read: "));
        let file = file("");
        let path = file.path().to_str().unwrap();
        assert!(of(&["saw", "--config", path, "--config", path]).unwrap_err().ends_with("there can be only one"));
    }
}
