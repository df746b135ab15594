//! What was found before, by the numbers that it was found for.
//!
//! Rationale: one map for all that is found. Every type in a map gets a map of its own from the compiler, and a module for browsers waits for each.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

/// What was found, in the order in which it was asked for.
pub(crate) struct Table<T> {
    places: BTreeMap<Vec<u64>, usize>,
    found: Vec<T>,
}

impl<T> Default for Table<T> {
    fn default() -> Self {
        Self { places: BTreeMap::new(), found: Vec::new() }
    }
}

impl<T> Table<T> {
    /// What was found for `key`; the first time it is what `find` finds.
    pub(crate) fn get(&mut self, key: Vec<u64>, find: impl FnOnce() -> T) -> &mut T {
        let place = place(&mut self.places, key);
        if place == self.found.len() {
            self.found.push(find());
        }
        &mut self.found[place]
    }

    /// For how many keys something was found.
    #[cfg(test)]
    pub(crate) fn len(&self) -> usize {
        self.found.len()
    }
}

/// The place of a key; a new one comes last.
#[inline(never)]
fn place(places: &mut BTreeMap<Vec<u64>, usize>, key: Vec<u64>) -> usize {
    let next = places.len();
    *places.entry(key).or_insert(next)
}
