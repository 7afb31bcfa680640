//! What is asked for.
//!
//! In: the words of the command line. Out: a command of this program, or one of the workbench with the file that comes
//! after it. The options of those are the workbench's: its own reader knows them, as it knows the names in the file.

use std::ffi::OsString;
use std::path::PathBuf;

use bg_compiler::fault::near_miss;
use clap::error::ErrorKind;
use clap::{Arg, ArgAction, ArgMatches, ColorChoice, Command, Error, FromArgMatches, Subcommand, value_parser};
use clap_complete::Shell;

use bg_workbench::command::colour;
use bond_graph::text::Counted;

use crate::served::Served;

/// What is asked for.
#[derive(Debug, PartialEq, Eq)]
pub enum Asked {
    Own(Own),
    Program(Call),
}

/// A command of this program.
#[derive(Debug, PartialEq, Eq, Subcommand)]
pub enum Own {
    /// Says all faults of files; exit code 1 where there are any
    Check {
        /// The files
        #[arg(value_name = "FILE", required = true)]
        files: Vec<PathBuf>,
        /// Each fault as a line of JSON
        #[arg(long)]
        json: bool,
        /// The most statements of a graph, with its repetitions and parts written out [default: 20000]
        #[arg(long = "limit-statements", value_name = "NUMBER")]
        most: Option<usize>,
    },
    /// Brings texts into one form: lines, indentation, blanks; what they say stays, and their comments
    Fmt {
        /// The files; `-` takes a text from the standard input to the standard output
        #[arg(value_name = "FILE", required = true)]
        files: Vec<PathBuf>,
        /// Changes nothing and names the files that have another form; exit code 1 where there are any
        #[arg(long)]
        check: bool,
    },
    /// Keeps the report of a file open in the browser, and makes it anew whenever the file is saved
    Watch {
        #[command(flatten)]
        served: Served,
        /// The file
        file: PathBuf,
        /// Options of `report`
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        options: Vec<OsString>,
    },
    /// Serves a page for the browser, on this machine alone, in which texts are written, compiled and run
    Serve {
        #[command(flatten)]
        served: Served,
        /// The folder of the page, as `cargo run --release -p bond-page -- FOLDER` writes it; `bond-site` beside this
        /// program unless given
        #[arg(long, value_name = "FOLDER")]
        page: Option<PathBuf>,
    },
    /// Prints what makes a shell complete commands and options
    Completions {
        /// The shell
        #[arg(value_name = "SHELL")]
        shell: Shell,
    },
    /// Prints the manual page, or writes those of all commands
    Man {
        /// Folder for a page of each command
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
    /// Lists the library of parts, which texts have by `use gears;`, or prints one of them
    Parts {
        /// The part to print
        name: Option<String>,
    },
    /// Writes a first mechanism
    New {
        /// What it is called: the file is NAME.bond
        name: String,
    },
}

/// A command of the workbench.
#[derive(Debug, PartialEq, Eq)]
pub struct Call {
    pub file: PathBuf,
    /// Which graph of the file; the only one unless it is said.
    pub graph: Option<String>,
    /// Whether models run in the interpreter alone, without machine code.
    pub is_interpreted: bool,
    /// The most statements of a graph, where that is said.
    pub most: Option<usize>,
    /// Tables with the files that their points are from.
    pub tables: Vec<(String, PathBuf)>,
    /// The words of the command.
    pub command: Vec<String>,
    pub options: Vec<OsString>,
}

/// The workbench's commands on a file, each with what it does.
const COMMANDS: [(&str, &str); 15] = [
    ("run", "Runs a model: a summary, and files with its outputs and figures"),
    ("report", "Runs it and writes one page: motion, charts, the graph"),
    ("plot", "Draws outputs over time, against each other, as spectra"),
    ("graph", "Prints or draws the bond graph, its states, equations and operations"),
    ("linearize", "Linear model, modes and frequency responses"),
    ("campbell", "Natural frequencies over a parameter, critical speeds"),
    ("sweep", "Many runs by a plan"),
    ("compare", "Two scenes or runs beside each other"),
    ("precision", "Error and work of the integrators"),
    ("sensitivity", "Derivatives of outputs by parameters"),
    ("optimize", "Parameters with which a number of a run is least"),
    ("identify", "Parameters from measured data"),
    ("scene", "Lists the scenes, or says what one is"),
    ("parameters", "Lists the parameters"),
    ("fmu", "Packs a functional mock-up unit"),
];
/// Those of its command `golden`.
const GOLDEN: [(&str, &str); 2] =
    [("record", "Runs and records"), ("check", "Runs again what is recorded and says what differs")];

/// A file and its options, for clap.
const WORDS: &str = "words";

/// The option for one of several graphs.
const GRAPH: &str = "--graph";

/// The option for other points of a table.
const TABLE: &str = "--table";

/// The option for no machine code.
const INTERPRETED: &str = "--interpreted";

/// The option for larger graphs.
const LIMIT: &str = "--limit-statements";

const AFTER: &str =
    "`bond FILE [OPTIONS]` is `bond run FILE [OPTIONS]`. `bond COMMAND FILE --help` has the options of \
    a command with the
names in the file, and without FILE the options.

FILE is a text with graphs (`.bond`), a Rust file with calls of `bond_graph!` (`.rs`), a robot (`.urdf`, or `.xml` and
`.mjcf` of MuJoCo). Of a file with several graphs `--graph NAME` says which. A graph has at most 20000 statements, with
its repetitions and parts written out; `--limit-statements NUMBER` allows others. Models run in machine code where that
pays, with `--interpreted` without it: slower, and to the bit the same. `--table NAME=FILE.csv` gives a table of the \
file
other points, any number of them, in every command.

Exit code: 0 done, 1 the run or an output failed, 2 the input cannot be used.";

impl Own {
    /// With its own options that stand among those of the workbench.
    fn complete(mut self) -> Result<Self, Error> {
        if let Self::Watch { served, options, .. } = &mut self {
            if let Some(port) = taken(options, "--port")? {
                served.port = port.parse().map_err(|_| unusable(format!("--port {port}: not the number of a port")))?;
            }
            let before = options.len();
            options.retain(|word| word != "--no-open");
            served.no_open |= options.len() < before;
        }
        Ok(self)
    }
}

/// What these words ask for, the program's name first.
///
/// # Errors
/// What is missing or wrong; or the help or version that is asked for.
pub fn asked(words: impl IntoIterator<Item = OsString>) -> Result<Asked, Error> {
    let words: Vec<OsString> = words.into_iter().collect();
    let colour = colour::set(words.iter().cloned());
    let matches = command().color(colour).try_get_matches_from(&words);
    // A command on a file reads its options when it has the file; the help is of all.
    let all_of = |help: Error| whole().color(colour).try_get_matches_from(&words).err().unwrap_or(help);
    let matches =
        matches.map_err(|fault| if fault.kind() == ErrorKind::DisplayHelp { all_of(fault) } else { fault })?;
    let own = || Own::from_arg_matches(&matches).and_then(Own::complete).map(Asked::Own);
    match matches.subcommand() {
        Some(("golden", inside)) => match inside.subcommand() {
            Some((name, inside)) => call(&["golden", name], words_of(inside, WORDS)),
            None => own(),
        },
        Some((name, inside)) if COMMANDS.iter().any(|(known, _)| *known == name) => {
            call(&[name], words_of(inside, WORDS))
        }
        // A file alone is run.
        Some((file, inside)) if file.contains('.') => {
            call(&["run"], [file.into()].into_iter().chain(words_of(inside, "")))
        }
        Some((name, _)) if command().find_subcommand(name).is_none() => Err(unknown(name)),
        _ => own(),
    }
}

/// The version, with the commit where the program was built with `BG_COMMIT=$(git rev-parse HEAD)`.
pub fn version() -> String {
    let commit = option_env!("BG_COMMIT").map_or_else(String::new, |commit| format!("+{commit:.12}"));
    format!("{}{commit}", env!("CARGO_PKG_VERSION"))
}

fn command() -> Command {
    let program = Command::new("bond").version(version()).arg_required_else_help(true);
    let program = program.disable_help_subcommand(true).allow_external_subcommands(true);
    let program =
        program.external_subcommand_value_parser(value_parser!(OsString)).subcommands(COMMANDS.map(of_workbench));
    let golden = Command::new("golden").about("Runs as regression tests").subcommand_required(true);
    let golden =
        golden.disable_help_subcommand(true).subcommands(GOLDEN.map(|(name, does)| {
            of_workbench((name, does)).override_usage(format!("bond golden {name} FILE [OPTIONS]"))
        }));
    let program = Own::augment_subcommands(program.subcommand(golden)).override_usage("bond COMMAND FILE [OPTIONS]");
    // That of commands on a file stands among their own options.
    let colour = Arg::new("color").long("color").global(true).value_name("WHEN").default_value("auto");
    let colour =
        colour.value_parser(value_parser!(ColorChoice)).help("Colour help and faults: on a terminal, always or never");
    let program = program.arg(colour);
    program.about("Runs and studies mechanisms in text files, in the language of `bond_graph!`").after_help(AFTER)
}

/// The command line with all options of the workbench's commands, for manual pages, shells and the help without a file.
pub fn whole() -> Command {
    let of_workbench = bg_workbench::command::commands();
    let file = || Arg::new("FILE").index(1).required(true).help("The file");
    let own = || {
        let option = |name: &'static str, value: &'static str, help: &'static str| {
            Arg::new(name).long(name.trim_start_matches('-')).value_name(value).help(help).help_heading("Of the file")
        };
        [
            option(GRAPH, "NAME", "Which graph of a file that has several"),
            option(TABLE, "NAME=FILE.csv", "Other points for a table of the file, any number of them")
                .action(ArgAction::Append),
            option(LIMIT, "NUMBER", "The most statements of a graph, with its repetitions and parts [default: 20000]"),
            option(INTERPRETED, "", "No machine code: slower, and to the bit the same").action(ArgAction::SetTrue),
        ]
    };
    // What the workbench's commands have without an option's name comes after the file.
    let full = |known: &Command, words: &str| {
        let names: String = known.get_positionals().map(|place| format!(" {place}")).collect();
        let known = known.clone().override_usage(format!("bond {words} FILE{names} [OPTIONS]"));
        let known = known.after_help(format!("`bond {words} FILE --help` has the names in the file, too."));
        let mut place = 1;
        let after = |arg: Arg| {
            if arg.is_positional() {
                place += 1;
                arg.index(place)
            } else {
                arg
            }
        };
        known.mut_args(after).arg(file()).args(own())
    };
    let mut program = command();
    for (name, _) in COMMANDS {
        let known = of_workbench.find_subcommand(name).expect("a command of the workbench");
        program = program.mut_subcommand(name, |_| full(known, name));
    }
    let golden = of_workbench.find_subcommand("golden").expect("a command of the workbench");
    program.mut_subcommand("golden", |own| {
        GOLDEN.iter().fold(own, |own, (name, _)| {
            let known = golden.find_subcommand(name).expect("a command of the workbench");
            own.mut_subcommand(name, |_| full(known, &format!("golden {name}")))
        })
    })
}

/// A command on a file. All words after the file are the workbench's.
fn of_workbench((name, does): (&'static str, &'static str)) -> Command {
    let words = Arg::new(WORDS).value_name("FILE").num_args(1..).trailing_var_arg(true).required(true);
    let words = words.value_parser(value_parser!(OsString)).help("The file; its options come after it");
    Command::new(name).about(does).arg(words).override_usage(format!("bond {name} FILE [OPTIONS]"))
}

fn words_of(matches: &ArgMatches, id: &str) -> impl Iterator<Item = OsString> {
    matches.get_many::<OsString>(id).into_iter().flatten().cloned()
}

fn unknown(name: &str) -> Error {
    let program = command();
    let near = near_miss(name, program.get_subcommands().map(Command::get_name));
    let near = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
    Error::raw(ErrorKind::InvalidSubcommand, format!("there is no command `{name}`{near}\n"))
}

fn unusable(fault: String) -> Error {
    Error::raw(ErrorKind::InvalidValue, fault + "\n")
}

fn call(command: &[&str], mut words: impl Iterator<Item = OsString>) -> Result<Asked, Error> {
    let file = words.next().expect("a file is required").into();
    let mut options: Vec<OsString> = words.collect();
    let graph = taken(&mut options, GRAPH)?;
    let most = match taken(&mut options, LIMIT)? {
        Some(most) => Some(most.parse().map_err(|_| unusable(format!("{LIMIT} {most}: not a number of statements")))?),
        None => None,
    };
    let mut tables = Vec::new();
    while let Some(given) = taken(&mut options, TABLE)? {
        let (name, file) =
            given.split_once('=').filter(|(name, file)| !(name.is_empty() || file.is_empty())).ok_or_else(|| {
                unusable(format!("{TABLE} {given}: write {TABLE} NAME=FILE.csv, the table and the file of its points"))
            })?;
        tables.push((name.trim().to_owned(), file.trim().into()));
    }
    // As they stand on the command line.
    tables.reverse();
    let all = options.len();
    options.retain(|word| word != INTERPRETED);
    let command = command.iter().map(|&word| word.to_owned()).collect();
    Ok(Asked::Program(Call { file, graph, is_interpreted: options.len() < all, most, tables, command, options }))
}

/// The summary of the run that is to be made again, where one is.
pub fn again(options: &[OsString]) -> Option<PathBuf> {
    taken(&mut options.to_vec(), "--again").ok().flatten().map(PathBuf::from)
}

/// The commands that ask for one scene.
const OF_ONE_SCENE: [&str; 9] =
    ["run", "report", "plot", "graph", "linearize", "sensitivity", "optimize", "identify", "fmu"];

/// The commands that tell the operations of all programs.
const OF_OPERATIONS: [&str; 2] = ["graph", "scene"];

/// Of what a command tells the operations.
pub fn counted(command: &[String]) -> Counted {
    if command.iter().any(|word| OF_OPERATIONS.contains(&word.as_str())) { Counted::All } else { Counted::Made }
}

/// The only scene beside the one that stands for the graph that a command asks for; none where it may ask for all.
pub fn only_scene(command: &[String], options: &[OsString]) -> Option<String> {
    if command.len() != 1 || !OF_ONE_SCENE.contains(&command[0].as_str()) || options.iter().any(|word| word == "--help")
    {
        return None;
    }
    Some(taken(&mut options.to_vec(), "--scene").ok().flatten().unwrap_or_default())
}

/// The value of an option, which is taken out of the words; where it is there twice, the last one counts.
fn taken(words: &mut Vec<OsString>, option: &str) -> Result<Option<String>, Error> {
    let with_value = format!("{option}=");
    let Some(place) = words.iter().rposition(|word| word == option || word.to_string_lossy().starts_with(&with_value))
    else {
        return Ok(None);
    };
    let word = words.remove(place).to_string_lossy().into_owned();
    if let Some(value) = word.strip_prefix(&with_value) {
        return Ok(Some(value.to_owned()));
    }
    if place == words.len() {
        return Err(unusable(format!("{option}: give it a value")));
    }
    Ok(Some(words.remove(place).to_string_lossy().into_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(line: &str) -> Result<Asked, String> {
        let words = ["bond"].into_iter().chain(line.split_whitespace());
        asked(words.map(Into::into)).map_err(|fault| fault.to_string())
    }

    fn call(file: &str, graph: Option<&str>, command: &[&str], options: &[&str]) -> Result<Asked, String> {
        Ok(Asked::Program(Call {
            file: file.into(),
            graph: graph.map(str::to_owned),
            is_interpreted: false,
            most: None,
            tables: Vec::new(),
            command: command.iter().map(|&word| word.to_owned()).collect(),
            options: options.iter().map(Into::into).collect(),
        }))
    }

    #[test]
    fn a_file_stands_after_its_command() {
        assert_eq!(of("run saw.bond --set a=1"), call("saw.bond", None, &["run"], &["--set", "a=1"]));
        assert_eq!(of("run saw.bond --help"), call("saw.bond", None, &["run"], &["--help"]));
        assert_eq!(of("run saw.bond --set a=-1 -h"), call("saw.bond", None, &["run"], &["--set", "a=-1", "-h"]));
        assert_eq!(of("saw.bond --t-end 2"), call("saw.bond", None, &["run"], &["--t-end", "2"]));
        assert_eq!(of("golden check a.bond x"), call("a.bond", None, &["golden", "check"], &["x"]));
        assert_eq!(of("graph a.bond --graph B -v"), call("a.bond", Some("B"), &["graph"], &["-v"]));
        assert_eq!(of("graph a.bond --graph=B"), call("a.bond", Some("B"), &["graph"], &[]));
        let files = vec!["a".into(), "b".into()];
        assert_eq!(of("check a b --json"), Ok(Asked::Own(Own::Check { files, json: true, most: None })));
        for line in ["watch --port 80 --no-open a.bond --set b=1", "watch a.bond --set b=1 --no-open --port 80"] {
            let (served, options) = (Served { port: 80, no_open: true }, vec!["--set".into(), "b=1".into()]);
            assert_eq!(of(line), Ok(Asked::Own(Own::Watch { served, file: "a.bond".into(), options })));
        }
        let (served, page) = (Served { port: 80, no_open: false }, Some("site".into()));
        assert_eq!(of("serve --port 80 --page site"), Ok(Asked::Own(Own::Serve { served, page })));
        assert_eq!(of("fmt -"), Ok(Asked::Own(Own::Fmt { files: vec!["-".into()], check: false })));
    }

    #[test]
    fn machine_code_can_be_done_without() {
        let Ok(Asked::Program(call)) = of("run saw.bond --t-end 2 --interpreted") else { panic!("a command") };
        assert!(call.is_interpreted);
        assert_eq!(call.options, ["--t-end", "2"]);
    }

    #[test]
    fn tables_have_files() {
        let Ok(Asked::Program(call)) = of("run saw.bond --table a=b.csv --t-end 2 --table=c=d.csv") else {
            panic!("a command")
        };
        assert_eq!(call.tables, [("a".to_owned(), "b.csv".into()), ("c".to_owned(), "d.csv".into())]);
        assert_eq!(call.options, ["--t-end", "2"]);
    }

    #[test]
    fn help_without_a_file_has_all_options() {
        let commands = COMMANDS.map(|(name, _)| name).into_iter().chain(["golden record", "golden check"]);
        for command in commands {
            let help = of(&format!("{command} --help")).expect_err(command);
            for part in [&format!("Usage: bond {command} FILE"), "--graph <NAME>", "--table <NAME=FILE.csv>", "--json"]
            {
                assert!(help.contains(part), "{command} has no {part}: {help}");
            }
        }
        let help = of("run -h").expect_err("help");
        assert!(
            ["--t-end", "--set", "--method", "--output", "--interpreted"].iter().all(|option| help.contains(option))
        );
    }

    #[test]
    fn what_is_missing_is_said() {
        for (line, said) in [
            ("run", "required arguments were not provided"),
            ("golden", "requires a subcommand but one was not provided"),
            ("golden check", "required arguments were not provided"),
            ("walk", "there is no command `walk`\n"),
            ("reprot a.bond", "there is no command `reprot`; did you mean `report`?"),
            ("check --jason a", "unexpected argument '--jason'"),
            ("run --t-end 2 a.bond", "unexpected argument '--t-end'"),
            ("run a.bond --limit-statements many", "--limit-statements many: not a number of statements"),
            ("run a.bond --graph", "--graph: give it a value"),
            ("run a.bond --table curve", "--table curve: write --table NAME=FILE.csv"),
            ("watch a.bond --set b=1 --port 1e9", "--port 1e9: not the number of a port"),
            ("run --help", "Usage: bond run FILE [OPTIONS]"),
            ("", "Usage: bond"),
            ("--version", "bond 0"),
        ] {
            let told = of(line).expect_err(line);
            assert!(told.contains(said), "{line}: {told}");
        }
    }
}
