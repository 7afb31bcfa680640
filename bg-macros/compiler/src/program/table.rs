//! Hash tables that hash the same way in every run, and stores in which equal items are stored once.
//!
//! In: keys of small integers. Out: lookups; nothing ever iterates over such a table.
//! Method: one multiplication and rotation per word, as in the Firefox hash of rustc (crate rustc-hash 1.1, `FxHasher`).

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hash, Hasher};
use std::ops::{Index, IndexMut};

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

/// Items by index; hash-consing (Ershov 1958) stores equal items once.
#[derive(Debug)]
pub(super) struct Store<T> {
    /// The items.
    pub(super) items: Vec<T>,
    index: Table<T, u32>,
}

impl<T> Default for Store<T> {
    fn default() -> Self {
        Self { items: Vec::new(), index: Table::default() }
    }
}

impl<T: Clone + Eq + Hash> Store<T> {
    /// The index of this item.
    pub(super) fn intern(&mut self, item: T) -> u32 {
        self.intern_as(item.clone(), item)
    }

    /// The index of this item, which is equal to others of the same key.
    pub(super) fn intern_as(&mut self, key: T, item: T) -> u32 {
        let next = number(self.items.len());
        let index = *self.index.entry(key).or_insert(next);
        if index == next {
            self.items.push(item);
        }
        index
    }
}

impl<T> Store<T> {
    /// The number of items.
    pub(super) fn len(&self) -> usize {
        self.items.len()
    }

    /// All items under the roots, children first, in depth-first order from the roots in order. `children` hands each child
    /// of an item to its last argument, in order.
    pub(super) fn post_order(
        &self,
        roots: impl DoubleEndedIterator<Item = u32>,
        children: impl Fn(&T, &mut dyn FnMut(u32)),
    ) -> Vec<u32> {
        let mut seen = vec![false; self.items.len()];
        let mut order = Vec::new();
        let mut pending: Vec<(u32, bool)> = roots.rev().map(|root| (root, false)).collect();
        while let Some((item, is_finished)) = pending.pop() {
            if is_finished {
                order.push(item);
            } else if !std::mem::replace(&mut seen[item as usize], true) {
                pending.push((item, true));
                let first = pending.len();
                children(&self[item], &mut |child| pending.push((child, false)));
                pending[first..].reverse();
            }
        }
        order
    }
}

impl<T> Index<u32> for Store<T> {
    type Output = T;

    fn index(&self, index: u32) -> &T {
        &self.items[index as usize]
    }
}

impl<T> IndexMut<u32> for Store<T> {
    fn index_mut(&mut self, index: u32) -> &mut T {
        &mut self.items[index as usize]
    }
}

/// An index as stored.
pub(super) fn number(index: usize) -> u32 {
    u32::try_from(index).expect("a routine has fewer than 2^32 nodes")
}
