//! What is asked for.
//!
//! In: the words of the command line. Out: a command of this program, or one of the workbench with the file that comes
//! after it. The options are the workbench's: its own reader knows them, as it knows the names in the file.

use std::ffi::OsString;
use std::path::PathBuf;

/// What is asked for.
#[derive(Debug, PartialEq, Eq)]
pub enum Asked {
    Help(String),
    Check { files: Vec<PathBuf>, json: bool },
    New { name: String },
    Program(Call),
}

/// A command of the workbench.
#[derive(Debug, PartialEq, Eq)]
pub struct Call {
    pub file: PathBuf,
    /// Which graph of the file; the only one unless it is said.
    pub graph: Option<String>,
    /// Whether models run in the interpreter alone, without machine code.
    pub is_interpreted: bool,
    /// The words of the command.
    pub command: Vec<String>,
    pub options: Vec<OsString>,
}

/// The workbench's commands on a file, each with what it does.
const COMMANDS: [(&str, &str); 13] = [
    ("run", "Runs a model: a summary, and files with its outputs and figures"),
    ("report", "Runs it and writes one page: motion, charts, the graph"),
    ("graph", "Prints or draws the bond graph, its states, equations and operations"),
    ("linearize", "Linear model, modes and frequency responses"),
    ("sweep", "Many runs by a plan"),
    ("golden", "`golden record`, `golden check`: runs as regression tests"),
    ("compare", "Two scenes or runs beside each other"),
    ("precision", "Error and work of the integrators"),
    ("sensitivity", "Derivatives of outputs by parameters"),
    ("identify", "Parameters from measured data"),
    ("scene", "Lists the scenes, or says what one is"),
    ("parameters", "Lists the parameters"),
    ("fmu", "Packs a functional mock-up unit"),
];

/// What these words ask for.
///
/// # Errors
/// A sentence about what is missing.
pub fn asked(words: impl Iterator<Item = OsString>) -> Result<Asked, String> {
    let mut words: Vec<OsString> = words.collect();
    let is = |word: &OsString, of: &[&str]| of.iter().any(|of| word == of);
    let Some(first) = words.first().cloned() else { return Ok(Asked::Help(help())) };
    if is(&first, &["-h", "--help", "help"]) {
        return Ok(Asked::Help(help()));
    }
    if is(&first, &["-V", "--version"]) {
        return Ok(Asked::Help(format!("bond {}\n", env!("CARGO_PKG_VERSION"))));
    }
    let own = first.to_str().unwrap_or_default();
    if own == "check" {
        let is_json = |word: &OsString| word == "--json";
        let (options, files): (Vec<_>, Vec<_>) =
            words.drain(1..).partition(|word| word.as_encoded_bytes().starts_with(b"-"));
        if options.iter().any(|word| is(word, &["-h", "--help"])) {
            return Ok(Asked::Help("Usage: bond check FILE.. [--json]\n\nSays all faults of the files. Exit code: 0 none, 1 some, 2 a file cannot be read.\n".to_owned()));
        }
        if let Some(other) = options.iter().find(|word| !is_json(word)) {
            return Err(format!("check has no option {}; it has --json", other.display()));
        }
        if files.is_empty() {
            return Err("check what? Give files: bond check saw.bond".to_owned());
        }
        return Ok(Asked::Check {
            json: options.iter().any(is_json),
            files: files.into_iter().map(Into::into).collect(),
        });
    }
    if own == "new" {
        return match words.get(1).and_then(|name| name.to_str()) {
            Some(name) if !name.starts_with('-') => Ok(Asked::New { name: name.to_owned() }),
            _ => Err("give the new file a name: bond new swing".to_owned()),
        };
    }
    let command = match own {
        "golden" => words.drain(..words.len().min(2)).map(|word| word.to_string_lossy().into_owned()).collect(),
        _ if COMMANDS.iter().any(|(name, _)| *name == own) => vec![words.remove(0).to_string_lossy().into_owned()],
        // A file alone is run.
        _ if first.to_string_lossy().contains('.') => vec!["run".to_owned()],
        _ => return Err(format!("there is no command `{own}`; bond --help lists them")),
    };
    let told = command.join(" ");
    if words.first().is_none_or(|word| word.as_encoded_bytes().starts_with(b"-")) {
        let is_help = words.first().is_some_and(|word| is(word, &["-h", "--help"]));
        if is_help {
            return Ok(Asked::Help(help_of(&told)));
        }
        return Err(format!("give a file behind the command: bond {told} saw.bond"));
    }
    let file = words.remove(0).into();
    let graph = taken(&mut words, "--graph")?;
    let all = words.len();
    words.retain(|word| word != "--interpreted");
    Ok(Asked::Program(Call { file, graph, is_interpreted: words.len() < all, command, options: words }))
}

/// The commands that ask for one scene.
const OF_ONE_SCENE: [&str; 5] = ["run", "linearize", "sensitivity", "identify", "fmu"];

/// The only scene beside the one that stands for the graph that a command asks for; none where it may ask for all.
pub fn only_scene(command: &[String], options: &[OsString]) -> Option<String> {
    if command.len() != 1 || !OF_ONE_SCENE.contains(&command[0].as_str()) || options.iter().any(|word| word == "--help")
    {
        return None;
    }
    Some(taken(&mut options.to_vec(), "--scene").ok().flatten().unwrap_or_default())
}

/// The value of an option, which is taken out of the words.
fn taken(words: &mut Vec<OsString>, option: &str) -> Result<Option<String>, String> {
    let with_value = format!("{option}=");
    let Some(place) = words.iter().position(|word| word == option || word.to_string_lossy().starts_with(&with_value))
    else {
        return Ok(None);
    };
    let word = words.remove(place).to_string_lossy().into_owned();
    if let Some(value) = word.strip_prefix(&with_value) {
        return Ok(Some(value.to_owned()));
    }
    if place == words.len() {
        return Err(format!("{option}: give the name of a graph"));
    }
    Ok(Some(words.remove(place).to_string_lossy().into_owned()))
}

fn help() -> String {
    let commands: String = COMMANDS.iter().map(|(name, does)| format!("  {name:<12} {does}\n")).collect();
    format!(
        "Runs and studies mechanisms in text files: multibond graphs in the language of `bond_graph!`.\n\n\
         Usage: bond COMMAND FILE [OPTIONS]\n       bond FILE [OPTIONS]          as `bond run FILE`\n\n\
         Commands on a file; `bond COMMAND FILE --help` has their options:\n{commands}\n\
         Others:\n  check        Says all faults of files: bond check FILE.. [--json]\n  \
         new          Writes a first mechanism: bond new NAME\n\n\
         FILE is a text with graphs (`.bond`), a Rust file with calls of `bond_graph!` (`.rs`), a robot (`.urdf`, or `.xml`\n\
         and `.mjcf` of MuJoCo). Of a file with several graphs `--graph NAME` says which. Models run in machine code where\n\
         that pays, with `--interpreted` without it: slower, and to the bit the same.\n\n\
         Exit code: 0 done, 1 the run or an output failed, 2 the input cannot be used.\n"
    )
}

fn help_of(command: &str) -> String {
    let does = COMMANDS.iter().find(|(name, _)| command.starts_with(name)).map_or("", |(_, does)| does);
    format!(
        "{does}.\n\nUsage: bond {command} FILE [OPTIONS]\n\nThe options have the names in the file: bond {command} FILE --help\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(line: &str) -> Result<Asked, String> {
        asked(line.split_whitespace().map(Into::into))
    }

    fn call(file: &str, graph: Option<&str>, command: &[&str], options: &[&str]) -> Result<Asked, String> {
        Ok(Asked::Program(Call {
            file: file.into(),
            graph: graph.map(str::to_owned),
            is_interpreted: false,
            command: command.iter().map(|&word| word.to_owned()).collect(),
            options: options.iter().map(Into::into).collect(),
        }))
    }

    #[test]
    fn a_file_stands_behind_its_command() {
        assert_eq!(of("run saw.bond --set a=1"), call("saw.bond", None, &["run"], &["--set", "a=1"]));
        assert_eq!(of("saw.bond --t-end 2"), call("saw.bond", None, &["run"], &["--t-end", "2"]));
        assert_eq!(of("golden check a.bond x"), call("a.bond", None, &["golden", "check"], &["x"]));
        assert_eq!(of("graph a.bond --graph B -v"), call("a.bond", Some("B"), &["graph"], &["-v"]));
        assert_eq!(of("graph a.bond --graph=B"), call("a.bond", Some("B"), &["graph"], &[]));
    }

    #[test]
    fn machine_code_can_be_done_without() {
        let Ok(Asked::Program(call)) = of("run saw.bond --t-end 2 --interpreted") else { panic!("a command") };
        assert!(call.is_interpreted);
        assert_eq!(call.options, ["--t-end", "2"]);
    }

    #[test]
    fn what_is_missing_is_said() {
        assert_eq!(of("run"), Err("give a file behind the command: bond run saw.bond".to_owned()));
        assert_eq!(of("golden check"), Err("give a file behind the command: bond golden check saw.bond".to_owned()));
        assert_eq!(of("walk"), Err("there is no command `walk`; bond --help lists them".to_owned()));
        assert_eq!(of("check --jason a"), Err("check has no option --jason; it has --json".to_owned()));
        assert_eq!(of("run a.bond --graph"), Err("--graph: give the name of a graph".to_owned()));
        assert!(matches!(of("run --help"), Ok(Asked::Help(text)) if text.contains("bond run FILE [OPTIONS]")));
        assert!(matches!(of(""), Ok(Asked::Help(_))));
    }
}
