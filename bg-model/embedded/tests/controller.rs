//! The program on a Cortex-M4F in QEMU: the bits of this desktop, the memory and the instructions that it takes.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use object::{Object, ObjectSegment};

const TARGET: &str = "thumbv7em-none-eabihf";
const QEMU: &str = "qemu-system-arm";

/// Where the controller's memory begins; flash is below.
const MEMORY: u64 = 0x2000_0000;
/// The most that the program may take: bytes of flash, of statics, of stack; instructions of a sample in `f64` and
/// `f32`.
const FLASH: u64 = 40 * 1024;
const STATICS: u64 = 2 * 1024;
const STACK: u64 = 1024;
const INSTRUCTIONS: [u64; 2] = [40_000, 1_600];

/// A program for the controller; none where the compiler has not the target.
fn program(name: &str) -> Option<PathBuf> {
    let libraries =
        Command::new("rustc").args(["--print", "target-libdir", "--target", TARGET]).output().expect("rustc");
    let libraries = String::from_utf8(libraries.stdout).expect("a path");
    if !Path::new(libraries.trim()).exists() {
        println!("skipped: no libraries for {TARGET}; `rustup target add {TARGET}`");
        return None;
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("the target folder");
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--quiet", "--locked", "--release", "--bin", name, "--target", TARGET, "--target-dir"]);
    assert!(cargo.arg(folder).current_dir(env!("CARGO_MANIFEST_DIR")).status().expect("cargo").success());
    Some(folder.join(TARGET).join("release").join(name))
}

/// What the program prints; none where there is no QEMU.
fn printed(program: &Path) -> Option<String> {
    let machine = ["-M", "mps2-an386", "-cpu", "cortex-m4", "-icount", "shift=0"];
    let surroundings = ["-nographic", "-monitor", "none", "-serial", "none", "-semihosting-config"];
    let mut qemu = Command::new(QEMU);
    qemu.args(machine).args(surroundings).args(["enable=on,target=native", "-kernel"]).arg(program);
    let Ok(output) = qemu.output() else {
        println!("skipped: there is no {QEMU}");
        return None;
    };
    assert!(output.status.success(), "{output:?}");
    Some(String::from_utf8(output.stdout).expect("a text"))
}

/// The numbers of a line.
fn numbers(line: &str) -> Vec<u64> {
    line.split(' ').filter_map(|word| word.parse().ok()).collect()
}

/// Asserts that a program prints on the controller what it prints on this desktop, so many lines; gives what it says
/// besides, or none where it cannot be run.
fn compared(name: &str, desktop: &str, lines: usize) -> Option<Vec<String>> {
    let text = printed(&program(name)?)?;
    let (costs, bits): (Vec<&str>, Vec<&str>) = text.lines().partition(|line| line.starts_with('#'));
    let desktop = String::from_utf8(Command::new(desktop).output().expect("a program").stdout).expect("a text");
    assert_eq!(bits, desktop.lines().collect::<Vec<_>>());
    assert_eq!(bits.len(), lines);
    println!("{}", costs.join("\n"));
    Some(costs.into_iter().map(str::to_owned).collect())
}

#[test]
fn the_observer_has_the_bits_of_a_desktop_on_a_controller() {
    let Some(costs) = compared("motor-observer", env!("CARGO_BIN_EXE_motor-observer"), 20) else { return };
    let [longest, heap, stack] = &costs[..] else { panic!("{costs:?}") };
    let [longest, heap, stack] = [longest, heap, stack].map(|line| numbers(line));
    assert!(longest.iter().zip(INSTRUCTIONS).all(|(&found, most)| found > 0 && found <= most), "{longest:?}");
    assert!(heap == [0] && stack[0] <= STACK, "{heap:?} {stack:?}");
}

#[test]
fn every_method_has_the_bits_of_a_desktop_on_a_controller() {
    compared("methods", env!("CARGO_BIN_EXE_methods"), 13);
}

#[test]
fn flash_and_statics_are_small() {
    let Some(program) = program("motor-observer") else { return };
    let bytes = std::fs::read(program).expect("the program");
    let file = object::File::parse(&*bytes).expect("an ELF file");
    // What is loaded is in flash, the values that statics begin with too.
    let flash: u64 = file.segments().map(|segment| segment.file_range().1).sum();
    let in_memory = file.segments().filter(|segment| segment.address() >= MEMORY);
    let statics: u64 = in_memory.map(|segment| segment.size()).sum();
    println!("{flash} bytes of flash, {statics} of statics");
    assert!(flash > 0 && flash <= FLASH && statics <= STATICS, "{flash} {statics}");
}
