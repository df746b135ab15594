//! Outlines that were fitted before, and how things lie on one another: orders and groups of faces are tried again and again, and most boundaries stay the same.

use alloc::collections::BTreeMap;
use alloc::rc::Rc;
use alloc::vec::Vec;
use core::cell::{Cell, RefCell};

use dvp_core::geometry::{LineSegment, Similarity};

use super::template::Seen;
use crate::outline::{Outline, fit_closed};
use crate::ruler::Ruler;
use crate::sample::{RingSamples, Sample};

/// How many templates are held against samples in the time that an outline through these takes, about.
const QUICKER: usize = 64;

/// How an outline lies on what is seen of a thing, and by how much it misses that; none where it does not.
type Placed = Option<(Similarity<f64>, f64)>;

/// What was found of the boundaries of one picture, by their samples. Where other readings of the picture have the same boundary, it is the same.
#[derive(Default)]
pub(crate) struct Memo {
    /// The outlines through them.
    known: RefCell<BTreeMap<Vec<u64>, Option<Outline>>>,
    /// What is seen of things, by samples and sides.
    seen: RefCell<BTreeMap<Vec<u64>, Rc<Templates>>>,
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

    /// What samples show of a thing; `sides`: of the outlines that were drawn through them.
    pub(super) fn seen(&self, samples: Vec<Sample>, sides: &[LineSegment<f64>]) -> Rc<Templates> {
        let mut key = Vec::new();
        add_samples(&mut key, &samples);
        add_sides(&mut key, sides);
        let mut seen = self.seen.borrow_mut();
        let templates = || Rc::new(Templates { seen: Seen::new(samples, sides), known: RefCell::default() });
        Rc::clone(seen.entry(key).or_insert_with(templates))
    }

    /// Templates are looked up, whether they were held against these samples before or not: many things, each held against each, take long by that alone.
    pub(super) fn look(&self, templates: usize) {
        self.spent.set(self.spent.get() + templates / QUICKER);
    }

    /// What [`Seen::placed`] gives.
    pub(super) fn placed(&self, templates: &Templates, edges: &[LineSegment<f64>]) -> Placed {
        let mut key = Vec::new();
        add_sides(&mut key, edges);
        *templates.known.borrow_mut().entry(key).or_insert_with(|| {
            self.spent.set(self.spent.get() + templates.seen.samples.len().div_ceil(QUICKER));
            templates.seen.placed(edges)
        })
    }
}

/// What is seen of a thing, with the templates that were held against it.
pub(super) struct Templates {
    seen: Seen,
    /// How each of them lies on it, by its edges.
    known: RefCell<BTreeMap<Vec<u64>, Placed>>,
}

/// The bits of all numbers of a ring, and how many samples each of its runs has.
fn key(ring: &RingSamples) -> Vec<u64> {
    let mut key = Vec::new();
    key.push(u64::from(ring.closed));
    ring.runs.iter().for_each(|run| add_samples(&mut key, run));
    key
}

fn add_samples(key: &mut Vec<u64>, samples: &[Sample]) {
    key.push(samples.len() as u64);
    for sample in samples {
        let numbers = [sample.point.x, sample.point.y, sample.axis.x, sample.axis.y, sample.sigma];
        key.extend(numbers.map(f64::to_bits));
    }
}

fn add_sides(key: &mut Vec<u64>, sides: &[LineSegment<f64>]) {
    let numbers = sides.iter().flat_map(|side| [side.from.x, side.from.y, side.along.x, side.along.y]);
    key.extend(numbers.map(f64::to_bits));
}
