//! Outlines that were fitted before: orders and groups of faces are tried again and again, and most boundaries stay the same.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;
use core::cell::{Cell, RefCell};

use crate::outline::{Outline, fit_closed};
use crate::ruler::Ruler;
use crate::sample::RingSamples;

/// The outlines of one picture, by the samples that they were fitted to. Where other readings of the picture have the same boundary, they are the same.
#[derive(Default)]
pub(crate) struct Memo {
    known: RefCell<BTreeMap<Vec<u64>, Known>>,
    /// Readings of the picture that were asked for before this one.
    reading: Cell<usize>,
    /// Samples that outlines of this reading were fitted to, or could have been.
    pub(super) spent: Cell<usize>,
}

/// An outline, if there is one, and the last reading that it was asked for.
struct Known {
    outline: Option<Outline>,
    reading: usize,
}

impl Memo {
    /// Another reading of the picture.
    pub(super) fn begin(&self) {
        self.reading.set(self.reading.get() + 1);
        self.spent.set(0);
    }

    /// What [`fit_closed`] gives; the ruler is always the same.
    pub(super) fn fit_closed(&self, ring: &RingSamples, ruler: &Ruler) -> Option<Outline> {
        let mut known = self.known.borrow_mut();
        let known =
            known.entry(key(ring)).or_insert_with(|| Known { outline: fit_closed(ring, ruler), reading: usize::MAX });
        // A search goes as far in every reading, whatever was known before.
        if known.reading != self.reading.get() {
            known.reading = self.reading.get();
            self.spent.set(self.spent.get() + ring.runs.iter().map(Vec::len).sum::<usize>());
        }
        known.outline.clone()
    }
}

/// The bits of all numbers of a ring, and how many samples each of its runs has.
fn key(ring: &RingSamples) -> Vec<u64> {
    let mut key = Vec::new();
    key.push(u64::from(ring.closed));
    for run in &ring.runs {
        key.push(run.len() as u64);
        for sample in run {
            let numbers = [sample.point.x, sample.point.y, sample.axis.x, sample.axis.y, sample.sigma];
            key.extend(numbers.map(f64::to_bits));
        }
    }
    key
}
