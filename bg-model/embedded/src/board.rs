//! The program of a Cortex-M4F: what `main` prints on a desktop, and then in lines that begin with `#` what it took.
//!
//! Counted are instructions in QEMU with `-icount shift=0`, where each takes a nanosecond: SysTick counts 25 million ticks in a
//! second, one for 40 instructions.

#![expect(unsafe_code, reason = "the stack is filled with a pattern through a pointer, and read")]

use core::fmt::Write;
use core::ptr;

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::register::msp;
use cortex_m_semihosting::debug::{self, EXIT_FAILURE, EXIT_SUCCESS};
use cortex_m_semihosting::hio;
use embedded_alloc::LlffHeap;
use motor_observer::Fault;
use panic_semihosting as _;

#[global_allocator]
static HEAP: LlffHeap = LlffHeap::empty();

/// Room for what is made at the start, bytes.
const HEAP_SIZE: usize = 1024;
/// Samples of a run.
const SAMPLES: u32 = 2000;
/// Instructions in a tick.
const INSTRUCTIONS: u32 = 40;
/// What fills the stack before anything has been there.
const PATTERN: u32 = 0xbead_bead;
/// How much of the stack below the present end is left as it is, bytes: the frame that paints.
const MARGIN: u32 = 256;

#[cortex_m_rt::entry]
fn main() -> ! {
    let top = msp::read();
    paint(top - MARGIN);
    // SAFETY: it is called once, before anything is allocated.
    unsafe {
        embedded_alloc::init!(HEAP, HEAP_SIZE);
    }
    let outcome = run();
    if outcome.is_ok() {
        let stack = top - untouched();
        let _ = writeln!(Host, "# stack {stack} bytes");
    }
    debug::exit(if outcome.is_ok() { EXIT_SUCCESS } else { EXIT_FAILURE });
    loop {
        cortex_m::asm::wfi();
    }
}

/// The desktop on which QEMU runs.
struct Host;

impl Write for Host {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        let mut out = hio::hstdout().map_err(|()| core::fmt::Error)?;
        out.write_all(text.as_bytes()).map_err(|()| core::fmt::Error)
    }
}

fn run() -> Result<(), Fault> {
    let mut clock = cortex_m::Peripherals::take().ok_or(Fault::Taken)?.SYST;
    clock.set_clock_source(SystClkSource::Core);
    clock.set_reload(0x00ff_ffff);
    clock.clear_current();
    clock.enable_counter();
    let (mut double, mut single) = (0, 0);
    motor_observer::report::<f64>(&mut Host, SAMPLES, |step| double = double.max(ticks(step)))?;
    motor_observer::report::<f32>(&mut Host, SAMPLES, |step| single = single.max(ticks(step)))?;
    writeln!(Host, "# longest step {} instructions in f64, {} in f32", double * INSTRUCTIONS, single * INSTRUCTIONS)?;
    writeln!(Host, "# heap {} bytes", HEAP.used())?;
    Ok(())
}

/// The ticks that something takes.
fn ticks(step: &mut dyn FnMut()) -> u32 {
    let before = SYST::get_current();
    step();
    // It counts down, 24 bits.
    before.wrapping_sub(SYST::get_current()) & 0x00ff_ffff
}

/// Fills the stack up to an address.
#[inline(never)]
fn paint(end: u32) {
    let mut word = cortex_m_rt::heap_start();
    while (word as u32) < end {
        // SAFETY: from the end of all statics up to the stack's present end no object is; nothing else runs.
        unsafe { ptr::write_volatile(word, PATTERN) };
        word = word.wrapping_add(1);
    }
}

/// The first address above which something has been on the stack.
#[inline(never)]
fn untouched() -> u32 {
    let mut word = cortex_m_rt::heap_start();
    // SAFETY: memory of the controller, which was written before; the loop ends at the stack that is in use.
    while unsafe { ptr::read_volatile(word) } == PATTERN {
        word = word.wrapping_add(1);
    }
    word as u32
}
