//! Outlines that were fitted before: orders and groups of faces are tried again and again, and most boundaries stay the same.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;
use core::cell::{Cell, RefCell};

use crate::outline::{Outline, fit_closed};
use crate::ruler::Ruler;
use crate::sample::RingSamples;

/// The outlines of one picture, by the samples that they were fitted to.
#[derive(Default)]
pub(super) struct Memo {
    known: RefCell<BTreeMap<Vec<u64>, Option<Outline>>>,
    /// Samples that outlines were fitted to, those known before aside.
    pub(super) spent: Cell<usize>,
}

impl Memo {
    /// What [`fit_closed`] gives; the ruler is always the same.
    pub(super) fn fit_closed(&self, ring: &RingSamples, ruler: &Ruler) -> Option<Outline> {
        let fit = || {
            self.spent.set(self.spent.get() + ring.runs.iter().map(Vec::len).sum::<usize>());
            fit_closed(ring, ruler)
        };
        self.known.borrow_mut().entry(key(ring)).or_insert_with(fit).clone()
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
