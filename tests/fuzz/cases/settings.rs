//! Random parameter files and `--set` texts.
//!
//! In: randomness. Out: bytes of a file that mostly are TOML of the hacksaw's parameters, and texts `NAME=VALUE`.

use bg_model::parameters::Parameters;
use bg_workbench::parameters::{Values, to_toml};
use fastrand::Rng;
use hacksaw::mechanism::HacksawParameters;

use super::Input;
use super::draw::{EXTREMES, number, one, rarely};

/// Values of every type of TOML, and some of none.
const VALUES: [&str; 40] = [
    "nan",
    "-nan",
    "inf",
    "-inf",
    "NaN",
    "infinity",
    "-0",
    "-0.0",
    "+1",
    "1.",
    ".5",
    "1e400",
    "-1e400",
    "1e-400",
    "0x10",
    "0b11",
    "0o7",
    "1_0",
    "1__0",
    "true",
    "'ten'",
    "\"1\"",
    "\"\"\"\n1\"\"\"",
    "''",
    "[1, 2]",
    "[]",
    "{}",
    "{ x = 1 }",
    "1979-05-27",
    "07:32:00",
    "9223372036854775807",
    "9223372036854775808",
    "-9223372036854775808",
    "",
    "=",
    "1 2",
    "ten",
    "1,5",
    "٣",
    "1e",
];

/// Names that are no parameter, or written as none usually is.
const NAMES: [&str; 20] = [
    "",
    " ",
    "torqe",
    "TORQUE",
    "torque.x",
    "\"torque\"",
    "'torque'",
    "\"a\\nb\"",
    "\"\"",
    "a b",
    "k_",
    "中",
    "a\u{301}",
    "[torque]",
    "[[torque]]",
    "[",
    "#",
    "torque\u{0}",
    "\u{feff}torque",
    "r\u{202e}_cut",
];

/// A file and texts; each may be empty.
pub(super) fn settings(rng: &mut Rng) -> Input {
    let (with_file, count) = (rng.bool(), rng.usize(..4));
    let file = if with_file { file(rng) } else { Vec::new() };
    let set = (0..if with_file { count.saturating_sub(1) } else { count.max(1) }).map(|_| setting(rng)).collect();
    Input::Settings { file, set }
}

fn file(rng: &mut Rng) -> Vec<u8> {
    let mut bytes = match rng.u32(..4) {
        0 => to_toml(&Values::new(HacksawParameters::table())).into_bytes(),
        _ => (0..rng.usize(..6)).map(|_| format!("{} = {}\n", name(rng), value(rng))).collect::<String>().into_bytes(),
    };
    for _ in 0..rng.usize(..6).saturating_sub(3) {
        damage(rng, &mut bytes);
    }
    if rarely(rng, 500) {
        bytes.extend(format!("a = {}1{}\n", "[".repeat(5000), "]".repeat(5000)).into_bytes());
    }
    bytes
}

fn setting(rng: &mut Rng) -> String {
    let (name, value) = (name(rng), value(rng));
    match rng.u32(..20) {
        0 => name,
        1 => format!("{name}=={value}"),
        2 => format!(" {name} = {value}\n"),
        3 => format!("--{name}={value}"),
        4 => {
            let mut bytes = format!("{name}={value}").into_bytes();
            damage(rng, &mut bytes);
            String::from_utf8_lossy(&bytes).into_owned()
        }
        _ => format!("{name}={value}"),
    }
}

/// Mostly a parameter's name, sometimes misspelt.
fn name(rng: &mut Rng) -> String {
    let table = HacksawParameters::table();
    let name = table[rng.usize(..table.len())].name.to_owned();
    match rng.u32(..12) {
        0 => one(rng, &NAMES).to_owned(),
        1 => {
            let mut bytes = name.into_bytes();
            damage(rng, &mut bytes);
            String::from_utf8_lossy(&bytes).into_owned()
        }
        _ => name,
    }
}

fn value(rng: &mut Rng) -> String {
    match rng.u32(..8) {
        0 => one(rng, &VALUES).to_owned(),
        1 => one(rng, &EXTREMES).to_owned(),
        2 => format!("{:e}", f64::from_bits(rng.u64(..))),
        3 => format!("-{}", number(rng)),
        _ => number(rng),
    }
}

/// A byte more, less, or another one.
fn damage(rng: &mut Rng, bytes: &mut Vec<u8>) {
    let at = rng.usize(..=bytes.len());
    let byte = if rarely(rng, 4) {
        rng.u8(..)
    } else {
        one(rng, &["=", "\n", "[", "]", "\"", "'", ".", "e", "-", "#", "{"]).as_bytes()[0]
    };
    match rng.u32(..3) {
        0 => bytes.insert(at, byte),
        1 if at < bytes.len() => drop(bytes.remove(at)),
        _ if at < bytes.len() => bytes[at] = byte,
        _ => {}
    }
}
