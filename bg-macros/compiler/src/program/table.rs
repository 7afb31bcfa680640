//! Hash tables that hash the same way in every run.
//!
//! In: keys of small integers. Out: lookups; nothing ever iterates over such a table.
//! Method: one multiplication and rotation per word, as in the Firefox hash of rustc (crate rustc-hash 1.1, `FxHasher`).

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// A hash table without a random seed.
pub(crate) type Table<K, V> = HashMap<K, V, BuildHasherDefault<Mixer>>;

/// The state of one hash.
#[derive(Clone, Copy, Default)]
pub(crate) struct Mixer(u64);

/// 2^64 over pi, the multiplier of `FxHasher`.
const MULTIPLIER: u64 = 0x517c_c1b7_2722_0a95;

impl Hasher for Mixer {
    fn finish(&self) -> u64 {
        // The table takes its bucket from the low bits, the multiplication mixes best into the high ones.
        self.0.rotate_left(26)
    }

    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_u64(u64::from(byte));
        }
    }

    fn write_u8(&mut self, word: u8) {
        self.write_u64(u64::from(word));
    }

    fn write_u32(&mut self, word: u32) {
        self.write_u64(u64::from(word));
    }

    fn write_i32(&mut self, word: i32) {
        self.write_u64(u64::from(word.cast_unsigned()));
    }

    fn write_u64(&mut self, word: u64) {
        self.0 = (self.0.rotate_left(5) ^ word).wrapping_mul(MULTIPLIER);
    }

    fn write_usize(&mut self, word: usize) {
        self.write_u64(word as u64);
    }

    fn write_isize(&mut self, word: isize) {
        self.write_u64(word.cast_unsigned() as u64);
    }
}
