//! Disjoint sets of consecutive numbers, united pair by pair (union-find with path halving).

use alloc::vec::Vec;

/// Numbers from 0, each in one set; a set is known by one of its numbers, its root.
///
/// # Examples
/// ```
/// let mut sets = dvp_core::geometry::DisjointSets::default();
/// sets.reset(4);
/// sets.unite(1, 3);
/// assert_eq!((sets.root(3), sets.root(2)), (1, 2));
/// ```
#[derive(Clone, Debug, Default)]
pub struct DisjointSets {
    parents: Vec<u32>,
}

impl DisjointSets {
    /// Starts afresh with `count` sets of one number each; keeps the memory.
    pub fn reset(&mut self, count: u32) {
        self.parents.clear();
        self.parents.extend(0..count);
    }

    /// Adds a set of one number, the next one, and returns it. There is room for 2^32 - 1 numbers: more than an image
    /// may have pixels.
    pub fn push(&mut self) -> u32 {
        let next = u32::try_from(self.parents.len()).unwrap_or(u32::MAX);
        self.parents.push(next);
        next
    }

    /// How many numbers there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.parents.len()
    }

    /// Whether there is no number.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.parents.is_empty()
    }

    /// The root of the set of number `i`.
    ///
    /// # Panics
    /// If there is no number `i`.
    #[inline]
    pub fn root(&mut self, mut i: u32) -> u32 {
        while self.parents[i as usize] != i {
            let up = self.parents[self.parents[i as usize] as usize];
            self.parents[i as usize] = up;
            i = up;
        }
        i
    }

    /// Unites the sets of two numbers and returns the root of the union, the lower of both roots: the root of a set that
    /// only this united is its lowest number.
    ///
    /// # Panics
    /// If one of the numbers does not exist.
    #[inline]
    pub fn unite(&mut self, a: u32, b: u32) -> u32 {
        let (a, b) = (self.root(a), self.root(b));
        let (low, high) = (a.min(b), a.max(b));
        self.parents[high as usize] = low;
        low
    }

    /// Puts the set of root `lost` under root `kept`.
    ///
    /// # Panics
    /// If there is no number `lost`.
    pub fn put_under(&mut self, lost: u32, kept: u32) {
        self.parents[lost as usize] = kept;
    }
}
