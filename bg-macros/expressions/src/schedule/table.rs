//! Stores in which equal items are stored once.
//!
//! In: items. Out: their indices.

use std::hash::Hash;
use std::ops::{Index, IndexMut};

use rustc_hash::FxHashMap;

/// Items by index; hash-consing (Ershov 1958) stores equal items once.
#[derive(Debug)]
pub(super) struct Store<T> {
    /// The items.
    pub(super) items: Vec<T>,
    index: FxHashMap<T, u32>,
}

impl<T> Default for Store<T> {
    fn default() -> Self {
        Self { items: Vec::new(), index: FxHashMap::default() }
    }
}

impl<T: Clone + Eq + Hash> Store<T> {
    /// The index of this item.
    pub(super) fn intern(&mut self, item: T) -> u32 {
        match self.index.get(&item) {
            Some(&known) => known,
            None => self.intern_as(item.clone(), item),
        }
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

    /// All items under the roots, children first, in depth-first order from the roots in order. `children` hands each
    /// child of an item to its last argument, in order.
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
