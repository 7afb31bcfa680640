//! How far runs have come, for who waits for them.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

/// Tells another thread which part of what was asked for is done, from 0 to 1. Its clones are one with it.
#[derive(Clone, Debug)]
pub struct Progress {
    /// In millionths of all.
    done: Arc<AtomicU32>,
    /// Which part of all this one tells of.
    from: f64,
    to: f64,
}

/// Of all.
const WHOLE: f64 = 1e6;

impl Progress {
    /// That of what is from `from` to `to` of this one's, 0 to 1 both: of one of several runs.
    #[must_use]
    pub fn part(&self, from: f64, to: f64) -> Self {
        let at = |part: f64| self.from + part * (self.to - self.from);
        Self { done: Arc::clone(&self.done), from: at(from), to: at(to) }
    }

    /// Says which part is done, 0 to 1.
    pub fn tell(&self, part: f64) {
        self.done.store((WHOLE * (self.from + part * (self.to - self.from))) as u32, Ordering::Relaxed);
    }

    /// Which part of all is done, 0 to 1; 0 where nothing has been told.
    #[must_use]
    pub fn done(&self) -> f64 {
        f64::from(self.done.load(Ordering::Relaxed)) / WHOLE
    }
}

impl Default for Progress {
    /// Of all.
    fn default() -> Self {
        Self { done: Arc::default(), from: 0.0, to: 1.0 }
    }
}

/// What is asked of a run does not depend on who waits for it.
impl PartialEq for Progress {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_tell_of_all() {
        let all = Progress::default();
        assert_eq!(all.done(), 0.0);
        let second = all.part(0.5, 1.0);
        second.part(0.0, 0.5).tell(0.5);
        assert_eq!(all.done(), 0.625);
        second.tell(1.0);
        assert_eq!(all.done(), 1.0);
    }
}
