//! The program on a Cortex-M4F in QEMU: the bits of this desktop, the memory and the instructions that it takes.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use object::{Object, ObjectSegment};

const TARGET: &str = "thumbv7em-none-eabihf";
const QEMU: &str = "qemu-system-arm";

/// Where the controller's memory begins; flash is below.
const MEMORY: u64 = 0x2000_0000;
/// The most that the program may take: bytes of flash, of statics, of stack; instructions of a sample in `f64` and `f32`.
const FLASH: u64 = 40 * 1024;
const STATICS: u64 = 2 * 1024;
const STACK: u64 = 1024;
const INSTRUCTIONS: [u64; 2] = [40_000, 1_600];

/// The program for the controller; none where the compiler has not the target.
fn program() -> Option<PathBuf> {
    let libraries =
        Command::new("rustc").args(["--print", "target-libdir", "--target", TARGET]).output().expect("rustc");
    let libraries = String::from_utf8(libraries.stdout).expect("a path");
    if !Path::new(libraries.trim()).exists() {
        println!("skipped: no libraries for {TARGET}; `rustup target add {TARGET}`");
        return None;
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("the target folder");
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--quiet", "--locked", "--release", "--target", TARGET, "--target-dir"]).arg(folder);
    assert!(cargo.current_dir(env!("CARGO_MANIFEST_DIR")).status().expect("cargo").success());
    Some(folder.join(TARGET).join("release/motor-observer"))
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

#[test]
fn a_controller_has_the_bits_of_a_desktop() {
    let Some(program) = program() else { return };
    let Some(text) = printed(&program) else { return };
    let (costs, bits): (Vec<&str>, Vec<&str>) = text.lines().partition(|line| line.starts_with('#'));
    let desktop = Command::new(env!("CARGO_BIN_EXE_motor-observer")).output().expect("the desktop's program").stdout;
    let desktop = String::from_utf8(desktop).expect("a text");
    assert_eq!(bits, desktop.lines().collect::<Vec<_>>());
    assert_eq!(bits.len(), 20);

    println!("{}", costs.join("\n"));
    let [longest, heap, stack] = costs[..] else { panic!("{costs:?}") };
    assert!(numbers(longest).iter().zip(INSTRUCTIONS).all(|(&found, most)| found > 0 && found <= most), "{longest}");
    assert_eq!(numbers(heap), [0]);
    assert!(numbers(stack)[0] <= STACK, "{stack}");
}

#[test]
fn flash_and_statics_are_small() {
    let Some(program) = program() else { return };
    let bytes = std::fs::read(program).expect("the program");
    let file = object::File::parse(&*bytes).expect("an ELF file");
    // What is loaded is in flash, the values that statics begin with too.
    let flash: u64 = file.segments().map(|segment| segment.file_range().1).sum();
    let in_memory = file.segments().filter(|segment| segment.address() >= MEMORY);
    let statics: u64 = in_memory.map(|segment| segment.size()).sum();
    println!("{flash} bytes of flash, {statics} of statics");
    assert!(flash > 0 && flash <= FLASH && statics <= STATICS, "{flash} {statics}");
}
