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
    known: RefCell<BTreeMap<Vec<u64>, Option<Outline>>>,
    /// Samples that outlines were fitted to, of all that is bounded as one: the searches for an order of all readings, or what else is asked for.
    pub(super) spent: Cell<usize>,
    /// Those of the searches so far, while something else is asked for.
    searched: Cell<usize>,
    /// How many searches there were.
    pub(super) searches: Cell<usize>,
}

impl Memo {
    /// A search for an order begins, or goes on in another reading of the picture: all of them have one budget.
    pub(super) fn search(&self) {
        self.spent.set(self.searched.get());
        self.searches.set(self.searches.get() + 1);
    }

    /// It ends.
    pub(super) fn found(&self) {
        self.searched.set(self.spent.replace(0));
    }

    /// What [`fit_closed`] gives; the ruler is always the same.
    pub(super) fn fit_closed(&self, ring: &RingSamples, ruler: &Ruler) -> Option<Outline> {
        let mut known = self.known.borrow_mut();
        let outline = known.entry(key(ring)).or_insert_with(|| {
            self.spent.set(self.spent.get() + ring.runs.iter().map(Vec::len).sum::<usize>());
            fit_closed(ring, ruler)
        });
        outline.clone()
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
