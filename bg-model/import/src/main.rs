//! `bg-import urdf FILE`, `bg-import mjcf FILE`: a robot's description to text of `bond_graph!`.

use std::path::PathBuf;
use std::process::ExitCode;

use bg_import::{Format, Options, import};
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
}

fn main() -> ExitCode {
    match run(Arguments::parse().format) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
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
    let text = std::fs::read_to_string(&file.file).map_err(|source| format!("cannot read {path}: {source}"))?;
    let name = file.file.file_name().map_or_else(|| path.to_string(), |name| name.to_string_lossy().into_owned());
    let options = Options {
        free_base,
        keep_fixed: file.keep_fixed,
        compliant: file.compliant,
        drives: !file.no_drives,
        limits: !file.no_limits,
    };
    let imported = import(format, &name, &text, options).map_err(|fault| format!("{path}: {fault}"))?;
    for note in &imported.notes {
        eprintln!("note: {note}");
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
