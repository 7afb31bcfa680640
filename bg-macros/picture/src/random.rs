//! Numbers that look random and are the same in every run.
//!
//! In: a seed. Out: numbers. Method: linear congruential generator (Knuth, TAOCP 2, sec. 3.3.4, MMIX).

/// The generator.
#[derive(Clone, Debug)]
pub(crate) struct Random(u64);

impl Random {
    /// One sequence for each seed.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15))
    }

    /// A whole number below `end`.
    pub fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % end
    }

    /// A whole number from -`reach` to `reach`.
    pub fn offset(&mut self, reach: i32) -> i32 {
        i32::try_from(self.below(2 * reach.unsigned_abs() as usize + 1)).unwrap_or_default() - reach
    }
}
