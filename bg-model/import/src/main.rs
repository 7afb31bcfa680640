//! `bg-import urdf FILE`, `bg-import mjcf FILE`: a robot's description to text of `bond_graph!`.

use std::path::PathBuf;
use std::process::ExitCode;

use bg_import::{Format, Options, import_file, shown};
use clap::{Args, Parser, Subcommand};

/// Makes a `bond_graph!` of a robot's description. The text goes to the output, notes go to the error output.
#[derive(Parser)]
#[command(name = "bg-import", version)]
struct Arguments {
    #[command(subcommand)]
    format: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Reads a URDF, the description of ROS.
    Urdf {
        /// The root link moves freely; else it is the ground.
        #[arg(long)]
        free_base: bool,
        #[command(flatten)]
        file: File,
    },
    /// Reads MJCF, MuJoCo's XML.
    Mjcf {
        #[command(flatten)]
        file: File,
    },
}

#[derive(Args)]
struct File {
    /// The file to read.
    file: PathBuf,
    /// The file to write.
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// Fixed joints stay joints; else what they join is one body.
    #[arg(long)]
    keep_fixed: bool,
    /// Joints give way, with parameters for how much, and a scene has them rigid; else all are rigid.
    #[arg(long)]
    compliant: bool,
    /// No input drives a joint.
    #[arg(long)]
    no_drives: bool,
    /// Limits of joints do not become stops.
    #[arg(long)]
    no_limits: bool,
    /// That shapes touch nothing is known, and no note.
    #[arg(long)]
    no_contacts: bool,
    /// The inputs that drive joints give no more effort than the file says.
    #[arg(long)]
    actuators: bool,
    /// Where something is not as in the file nothing is written, and the exit code is 1.
    #[arg(long)]
    strict: bool,
}

fn main() -> ExitCode {
    match run(Arguments::parse().format) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {}", message.lines().map(shown).collect::<Vec<_>>().join("\n"));
            ExitCode::FAILURE
        }
    }
}

fn run(command: Command) -> Result<(), String> {
    let (format, free_base, file) = match command {
        Command::Urdf { free_base, file } => (Format::Urdf, free_base, file),
        Command::Mjcf { file } => (Format::Mjcf, false, file),
    };
    let path = file.file.display();
    let options = Options {
        free_base,
        keep_fixed: file.keep_fixed,
        compliant: file.compliant,
        drives: !file.no_drives,
        limits: !file.no_limits,
        contacts: !file.no_contacts,
        actuators: file.actuators,
        strict: file.strict,
    };
    let imported = import_file(format, &file.file, options).map_err(|fault| format!("{path}: {fault}"))?;
    for note in &imported.notes {
        eprintln!("note: {}", shown(note));
    }
    for remark in &imported.remarks {
        eprintln!("remark: {}", shown(remark));
    }
    match &file.output {
        Some(output) => std::fs::write(output, imported.text)
            .map_err(|source| format!("cannot write {}: {source}", output.display())),
        None => {
            print!("{}", imported.text);
            Ok(())
        }
    }
}
