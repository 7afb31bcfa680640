//! Time on the wall clock; zero where there is none.

use std::time::Duration;

/// When a run began.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    #[cfg(not(all(target_arch = "wasm32", target_os = "unknown")))]
    start: std::time::Instant,
}

#[cfg(not(all(target_arch = "wasm32", target_os = "unknown")))]
impl Stopwatch {
    /// Now.
    pub fn started() -> Self {
        Self { start: std::time::Instant::now() }
    }

    /// The time since then.
    pub fn elapsed(self) -> Duration {
        self.start.elapsed()
    }
}

/// WebAssembly by itself has no clock: `Instant::now` would panic.
#[cfg(all(target_arch = "wasm32", target_os = "unknown"))]
impl Stopwatch {
    /// Now.
    pub const fn started() -> Self {
        Self {}
    }

    /// Zero.
    pub const fn elapsed(self) -> Duration {
        Duration::ZERO
    }
}
