//! Disjoint sets of consecutive numbers, united pair by pair.

use alloc::vec::Vec;

/// Numbers from 0, each in one set; a set is known by one of its numbers, its root.
#[derive(Clone, Debug, Default)]
pub(crate) struct DisjointSets {
    parents: Vec<u32>,
}

impl DisjointSets {
    /// Starts afresh with `count` sets of one number each.
    pub(crate) fn reset(&mut self, count: u32) {
        self.parents.clear();
        self.parents.extend(0..count);
    }

    /// Adds a set of one number, the next one, and returns it.
    #[expect(clippy::cast_possible_truncation, reason = "an image has at most 2^28 pixels")]
    pub(crate) fn push(&mut self) -> u32 {
        let next = self.parents.len() as u32;
        self.parents.push(next);
        next
    }

    /// How many numbers there are.
    pub(crate) fn len(&self) -> usize {
        self.parents.len()
    }

    /// The root of the set of number `i`.
    #[inline]
    pub(crate) fn root(&mut self, mut i: u32) -> u32 {
        while self.parents[i as usize] != i {
            let up = self.parents[self.parents[i as usize] as usize];
            self.parents[i as usize] = up;
            i = up;
        }
        i
    }

    /// Unites the sets of two numbers; the lower root stays one. So the root of a set that only this united is its lowest
    /// number.
    #[inline]
    pub(crate) fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b) as usize] = a.min(b);
    }

    /// Puts the set of root `lost` under root `kept`.
    pub(crate) fn put_under(&mut self, lost: u32, kept: u32) {
        self.parents[lost as usize] = kept;
    }
}
