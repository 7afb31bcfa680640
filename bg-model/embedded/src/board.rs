//! A Cortex-M4F: its allocator, its clock, its stack, the desktop on which QEMU runs.
//!
//! Counted are instructions in QEMU with `-icount shift=0`, where each takes a nanosecond: SysTick counts 25 million
//! ticks in a second, one for 40 instructions.

#![expect(
    unsafe_code,
    reason = "the heap is a place in memory; the stack is filled with a pattern through a pointer, and read"
)]

use core::fmt::Write;
use core::ptr;

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::register::msp;
use cortex_m_semihosting::debug::{self, EXIT_FAILURE, EXIT_SUCCESS};
use cortex_m_semihosting::hio;
use embedded_alloc::LlffHeap;
use panic_semihosting as _;

use crate::Fault;

#[global_allocator]
static HEAP: LlffHeap = LlffHeap::empty();

/// Instructions in a tick.
const INSTRUCTIONS: u32 = 40;
/// What fills the stack before anything has been there.
const PATTERN: u32 = 0xbead_bead;
/// How much of the stack below the present end is left as it is, bytes: the frame that paints.
const MARGIN: u32 = 256;

/// Runs a program with a heap of so many bytes, says what it has taken of heap and stack, and ends QEMU.
pub fn program(heap: usize, of: impl FnOnce(&mut Host) -> Result<(), Fault>) -> ! {
    let top = msp::read();
    // Statics, the heap, then what is free, up to the stack, which grows downwards.
    let start = cortex_m_rt::heap_start();
    let free = start.wrapping_byte_add(heap);
    paint(free, top - MARGIN);
    // SAFETY: it is called once, before anything is allocated; nothing else is in this memory.
    unsafe { HEAP.init(start as usize, heap) };
    let outcome = of(&mut Host);
    let (used, stack) = (HEAP.used(), top - untouched(free));
    let is_good = outcome.is_ok() && writeln!(Host, "# heap {used} bytes\n# stack {stack} bytes").is_ok();
    debug::exit(if is_good { EXIT_SUCCESS } else { EXIT_FAILURE });
    loop {
        cortex_m::asm::wfi();
    }
}

/// The desktop on which QEMU runs.
#[derive(Debug)]
pub struct Host;

impl Write for Host {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        let mut out = hio::hstdout().map_err(|()| core::fmt::Error)?;
        out.write_all(text.as_bytes()).map_err(|()| core::fmt::Error)
    }
}

/// How long something takes.
#[derive(Debug)]
pub struct Clock {
    longest: u32,
}

impl Clock {
    /// A clock that runs.
    pub fn start() -> Self {
        // SAFETY: nothing but this type has to do with SysTick.
        let mut clock = unsafe { cortex_m::Peripherals::steal() }.SYST;
        clock.set_clock_source(SystClkSource::Core);
        clock.set_reload(0x00ff_ffff);
        clock.enable_counter();
        Self { longest: 0 }
    }

    /// Calls something.
    pub fn time(&mut self, step: &mut dyn FnMut()) {
        let before = SYST::get_current();
        step();
        // It counts down, 24 bits.
        let ticks = before.wrapping_sub(SYST::get_current()) & 0x00ff_ffff;
        self.longest = self.longest.max(ticks);
    }

    /// The most that a call has taken, instructions.
    pub fn longest(&self) -> u32 {
        self.longest * INSTRUCTIONS
    }
}

/// Fills memory from one address up to another.
#[inline(never)]
fn paint(from: *mut u32, end: u32) {
    let mut word = from;
    while (word as u32) < end {
        // SAFETY: from the end of the heap up to the stack's present end no object is; nothing else runs.
        unsafe { ptr::write_volatile(word, PATTERN) };
        word = word.wrapping_add(1);
    }
}

/// The first address from this one on where something has been.
#[inline(never)]
fn untouched(from: *mut u32) -> u32 {
    let mut word = from;
    // SAFETY: memory of the controller, which was written before; the loop ends at the stack that is in use.
    while unsafe { ptr::read_volatile(word) } == PATTERN {
        word = word.wrapping_add(1);
    }
    word as u32
}
