//! Random inputs for the macro's compiler and the hacksaw's parameter reading, in any number.
//!
//! `cargo run --release -p bond-graph-tests --example fuzz -- --inputs 1000000 --seed 1`. The same numbers give the
//! same inputs. A panic, a hang or a broken promise is printed with its input, kept in `--keep`, and the exit code is
//! 1.

use std::collections::BTreeSet;
use std::error::Error;
use std::fs;
use std::panic;
use std::path::{Path, PathBuf};
use std::process::exit;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use bond_graph_tests::fuzz::{Input, Kind, Outcome, Tally, Violation, examine, seeds, shrink};
use clap::Parser;

/// Hands random inputs to the macro's compiler and to the hacksaw's parameter reading.
#[derive(Clone, Debug, Parser)]
struct Arguments {
    /// How many inputs
    #[arg(long, value_name = "COUNT", default_value_t = 100_000)]
    inputs: u64,
    /// The number of the first input, to repeat a part of a run
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    from: u64,
    /// What the random numbers start with
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,
    /// The longest that one input may take, s; then it counts as a hang
    #[arg(long, value_name = "SECONDS", default_value_t = 60)]
    limit: u64,
    /// Write what broke a promise, and a shortest input for each new code, into this folder
    #[arg(long, value_name = "FOLDER")]
    keep: Option<PathBuf>,
}

/// What the working thread tells.
enum Message {
    /// It begins with this input.
    Begin(u64),
    /// It is through with an input that took so long.
    End(Duration),
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let seeds = seeds(&workspace)?;
    if let Some(folder) = &arguments.keep {
        fs::create_dir_all(folder)?;
    }
    // Panics are caught and counted; their own messages would hide the rest.
    panic::set_hook(Box::new(|_| {}));
    let (sender, receiver) = channel();
    let begin = Instant::now();
    let worker = thread::spawn({
        let (arguments, seeds) = (arguments.clone(), seeds.clone());
        move || work(&arguments, &seeds, &sender)
    });
    let slowest = watch(&arguments, &seeds, &receiver);
    let Ok(tally) = worker.join() else { return Err("the working thread ended early".into()) };
    println!("{} inputs, seed {}, {:.0} s", arguments.inputs, arguments.seed, begin.elapsed().as_secs_f64());
    print!("{tally}");
    println!("slowest: input {} ({}), {:.2} s", slowest.0, Kind::of(slowest.0).name(), slowest.1.as_secs_f64());
    exit(i32::from(tally.violations() > 0));
}

/// Examines all inputs.
fn work(arguments: &Arguments, seeds: &[String], sender: &Sender<Message>) -> Tally {
    let mut tally = Tally::default();
    for number in arguments.from..arguments.from + arguments.inputs {
        // The watching thread lives as long as this one.
        let _ = sender.send(Message::Begin(number));
        let (kind, begin) = (Kind::of(number), Instant::now());
        let input = kind.input(seeds, arguments.seed, number);
        let result = examine(&input);
        let _ = sender.send(Message::End(begin.elapsed()));
        let new = tally.count(kind, &result);
        if let Err(Violation(what)) = &result {
            println!("input {number} ({}): {what}\n{}", kind.name(), input.text());
            keep(arguments, &format!("violation_{number}"), &input);
        }
        for code in new.iter().filter(|_| arguments.keep.is_some()) {
            keep(arguments, code, &shortest(&input, code, &|| drop(sender.send(Message::Begin(number)))));
        }
        if (number + 1).is_multiple_of(10_000) {
            eprintln!("{} inputs, {} violations", number + 1 - arguments.from, tally.violations());
        }
    }
    tally
}

/// A short input that is refused with this code alone, or at least with it. `alive` is called before each trial.
fn shortest(input: &Input, code: &str, alive: &dyn Fn()) -> Input {
    let only = Outcome::Refused(BTreeSet::from([code.to_owned()]));
    let tried = |input: &Input| {
        alive();
        examine(input)
    };
    let short = shrink(input, &mut |input| matches!(tried(input), Ok(Outcome::Refused(codes)) if codes.contains(code)));
    shrink(&short, &mut |input| tried(input).as_ref() == Ok(&only))
}

/// Writes an input into the folder of kept ones.
fn keep(arguments: &Arguments, name: &str, input: &Input) {
    let Some(folder) = &arguments.keep else { return };
    let name = name.replace(' ', "_");
    let written = match input {
        Input::Call(text) => fs::write(folder.join(name + ".bond"), text),
        Input::Settings { file, set } if set.is_empty() => fs::write(folder.join(name + ".toml"), file),
        Input::Settings { set, .. } => fs::write(folder.join(name + ".set"), set.join("\n")),
    };
    if let Err(error) = written {
        eprintln!("not kept: {error}");
    }
}

/// Waits for the working thread; an input that takes too long ends the program. Gives the slowest input.
fn watch(arguments: &Arguments, seeds: &[String], receiver: &Receiver<Message>) -> (u64, Duration) {
    let (mut number, mut slowest) = (arguments.from, (arguments.from, Duration::ZERO));
    loop {
        match receiver.recv_timeout(Duration::from_secs(arguments.limit)) {
            Ok(Message::Begin(next)) => number = next,
            Ok(Message::End(time)) if time > slowest.1 => slowest = (number, time),
            Ok(Message::End(_)) => {}
            Err(RecvTimeoutError::Disconnected) => return slowest,
            Err(RecvTimeoutError::Timeout) => {
                let input = Kind::of(number).input(seeds, arguments.seed, number);
                println!("input {number} takes more than {} s:\n{}", arguments.limit, input.text());
                keep(arguments, &format!("hang_{number}"), &input);
                exit(1);
            }
        }
    }
}
