//! Sorting by a key, through one sort for all types.
//!
//! Rationale: a sort of the standard library is 5 kB of machine code for every type and every comparison, and a module for browsers
//! waits for each of them. What is sorted here is short or sorted once.

use alloc::vec::Vec;

/// Sorts by a rising key. What is equal keeps its order.
pub fn ascending<T>(items: &mut [T], key: impl FnMut(&T) -> f64) {
    let order = order(items.iter().map(key).collect());
    for place in 0..items.len() {
        // What belongs here may have been moved on by exchanges before.
        let mut from = order[place];
        while from < place {
            from = order[from];
        }
        items.swap(place, from);
    }
}

/// Sorts by a falling key. What is equal keeps its order.
pub fn descending<T>(items: &mut [T], mut key: impl FnMut(&T) -> f64) {
    ascending(items, |item| -key(item));
}

/// Which key comes at which place.
fn order(keys: Vec<f64>) -> Vec<usize> {
    let mut numbered: Vec<(f64, usize)> = keys.into_iter().zip(0..).collect();
    numbered.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    numbered.into_iter().map(|(_, index)| index).collect()
}
