//! Sorting by numbers, through one sort for all types.
//!
//! Rationale: every type and every comparison gets a sort of its own from the compiler, about 5 kB of machine code, and a module for
//! browsers waits for each of them. Keys that are all of one type share one. It remembers the keys: not for loops over pixels. The median, which
//! outvotes what does not belong, is for those.

use core::cmp::Ordering;

use crate::Real;

/// Sorts by a rising key, as [`f64::total_cmp`] orders them. What is equal keeps its order.
pub fn ascending<T>(items: &mut [T], mut key: impl FnMut(&T) -> f64) {
    items.sort_by_cached_key(|item| Key(key(item)));
}

/// Sorts by a falling key. What is equal keeps its order.
pub fn descending<T>(items: &mut [T], mut key: impl FnMut(&T) -> f64) {
    ascending(items, |item| -key(item));
}

/// The median of a key of `values`, the higher of the two in the middle; none of nothing. Changes their order. For loops over pixels.
pub fn median_by<V, T: Real>(values: &mut [V], key: impl Fn(&V) -> T) -> Option<T> {
    let middle = values.len() / 2;
    if values.is_empty() {
        return None;
    }
    let order = |a: &V, b: &V| key(a).partial_cmp(&key(b)).unwrap_or(Ordering::Equal);
    Some(key(values.select_nth_unstable_by(middle, order).1))
}

/// The median of numbers, the higher of the two in the middle; none of nothing. Changes their order. One for all that are of a type.
#[inline(never)]
pub fn median<T: Real>(values: &mut [T]) -> Option<T> {
    median_by(values, |&value| value)
}

/// A number among numbers, NaN as well.
struct Key(f64);

impl Ord for Key {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for Key {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Key {}
