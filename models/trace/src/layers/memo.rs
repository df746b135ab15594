//! Outlines that were fitted before, and how things lie on one another: orders and groups of faces are tried again and again, and most boundaries stay the same.

use alloc::rc::Rc;
use alloc::vec::Vec;
use core::cell::{Cell, RefCell};
use core::slice;

use dvp_core::Vec2;
use dvp_core::geometry::{LineSegment, Similarity};
use dvp_core::shape::Stroke;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::template::Seen;
use crate::outline::{Outline, fit_closed, moved};
use crate::ruler::Ruler;
use crate::sample::{RingSamples, Sample};
use crate::stroke::{StrokeFit, fit_strokes};
use crate::table::Table;

/// How many templates are held against samples in the time that an outline through these takes, about.
const QUICKER: usize = 64;

/// How an outline lies on what is seen of a thing, and by how much it misses that; none where it does not.
type Placed = Option<(Similarity<f64>, f64)>;

/// What was found of the boundaries of one picture, by their samples. Where other readings of the picture have the same boundary, it is the same.
#[derive(Default)]
pub(crate) struct Memo {
    /// The outlines through them: things that are drawn alike, pixel by pixel, as letters are, are fitted once, the first of them where it lies.
    outlines: RefCell<Table<Fitted>>,
    /// The strokes that drew them, likewise.
    strokes: RefCell<Table<(Vec2<f64>, Option<StrokeFit>)>>,
    /// What is seen of things, by samples and sides.
    seen: RefCell<Table<Rc<Templates>>>,
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
        let rings = slice::from_ref(ring);
        let corner = corner(rings);
        let mut known = self.outlines.borrow_mut();
        let fit = || Fitted { outline: fit_closed(ring, ruler), corners: Vec::new() };
        let fitted = known.get(key(rings, corner), fit);
        // How long a search goes on does not depend on what else is drawn like that.
        if !fitted.corners.contains(&corner) {
            fitted.corners.push(corner);
            self.spent.set(self.spent.get() + ring.runs.iter().map(Vec::len).sum::<usize>());
        }
        let Outline { shape, bits, misfit, covariance } = fitted.outline.as_ref()?;
        let (shape, covariance) = (shape.moved(&shift(corner - fitted.corners[0])), covariance.clone());
        Some(Outline { shape, bits: *bits, misfit: *misfit, covariance })
    }

    /// What [`fit_strokes`] gives; the ruler is always the same.
    pub(super) fn fit_strokes(&self, rings: &[RingSamples], ruler: &Ruler) -> Option<StrokeFit> {
        let corner = corner(rings);
        let mut known = self.strokes.borrow_mut();
        let (first, fit) = known.get(key(rings, corner), || (corner, fit_strokes(rings, ruler)));
        let StrokeFit { strokes, bits, misfit } = fit.as_ref()?;
        let place = |stroke: &Stroke<f64>| {
            let rings = stroke.rings.iter().map(|ring| moved(ring, &shift(corner - *first))).collect();
            Stroke { rings, ..*stroke }
        };
        Some(StrokeFit { strokes: strokes.iter().map(place).collect(), bits: *bits, misfit: *misfit })
    }

    /// What samples show of a thing; `sides`: of the outlines that were drawn through them.
    pub(super) fn seen(&self, samples: Vec<Sample>, sides: &[LineSegment<f64>]) -> Rc<Templates> {
        let mut key = Vec::new();
        add_samples(&mut key, &samples);
        add_sides(&mut key, sides);
        let mut seen = self.seen.borrow_mut();
        let templates = || Rc::new(Templates { seen: Seen::new(samples, sides), known: RefCell::default() });
        Rc::clone(seen.get(key, templates))
    }

    /// Templates are looked up, whether they were held against these samples before or not: many things, each held against each, take long by that alone.
    pub(super) fn look(&self, templates: usize) {
        self.spent.set(self.spent.get() + templates / QUICKER);
    }

    /// What [`Seen::placed`] gives.
    pub(super) fn placed(&self, templates: &Templates, edges: &[LineSegment<f64>]) -> Placed {
        let mut key = Vec::new();
        add_sides(&mut key, edges);
        *templates.known.borrow_mut().get(key, || {
            self.spent.set(self.spent.get() + templates.seen.samples.len().div_ceil(QUICKER));
            templates.seen.placed(edges)
        })
    }
}

/// The outline through samples, and the corners from which on such samples were asked for; it was fitted at the first of these.
struct Fitted {
    outline: Option<Outline>,
    corners: Vec<Vec2<f64>>,
}

/// What is seen of a thing, with the templates that were held against it.
pub(super) struct Templates {
    seen: Seen,
    /// How each of them lies on it, by its edges.
    known: RefCell<Table<Placed>>,
}

/// The corner of the pixels in which a boundary begins.
fn corner(rings: &[RingSamples]) -> Vec2<f64> {
    let points = rings.iter().flat_map(|ring| ring.runs.iter().flatten()).map(|sample| sample.point);
    let least = points.reduce(|least, point| Vec2::new(least.x.min(point.x), least.y.min(point.y)));
    least.map_or(Vec2::new(0.0, 0.0), |least| Vec2::new(least.x.floor(), least.y.floor()))
}

/// By so many pixels.
fn shift(by: Vec2<f64>) -> Similarity<f64> {
    Similarity { translation: by, ..Similarity::identity() }
}

/// Steps in a pixel that places are told apart by: what is drawn alike, some pixels further, is off by rounding, which is a ten millionth of that.
const STEPS: f64 = 1_048_576.0;

/// A boundary from a corner on as numbers that tell it from others.
fn key(rings: &[RingSamples], corner: Vec2<f64>) -> Vec<u64> {
    let count: usize = rings.iter().flat_map(|ring| &ring.runs).map(|run| 5 * run.len() + 3).sum();
    let mut key = Vec::with_capacity(count + rings.len());
    for ring in rings {
        key.push(2 * ring.runs.len() as u64 + u64::from(ring.closed));
        for run in &ring.runs {
            key.push(run.len() as u64);
            for sample in run {
                key.extend((sample.point - corner).to_array().map(|at| (at * STEPS + 0.5) as u64));
                add_doubt(&mut key, sample);
            }
        }
    }
    key
}

fn add_doubt(key: &mut Vec<u64>, sample: &Sample) {
    key.extend([sample.axis.x, sample.axis.y, sample.sigma].map(f64::to_bits));
    // No deviation is negative.
    if let Some(sigma) = key.last_mut().filter(|_| sample.is_exact) {
        *sigma |= 1 << 63;
    }
}

fn add_samples(key: &mut Vec<u64>, samples: &[Sample]) {
    key.push(samples.len() as u64);
    for sample in samples {
        key.extend([sample.point.x, sample.point.y].map(f64::to_bits));
        add_doubt(key, sample);
    }
}

fn add_sides(key: &mut Vec<u64>, sides: &[LineSegment<f64>]) {
    let numbers = sides.iter().flat_map(|side| [side.from.x, side.from.y, side.along.x, side.along.y]);
    key.extend(numbers.map(f64::to_bits));
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use proptest::prelude::*;

    use super::*;
    use crate::outline::OutlineShape;

    /// A circle of radius 5 around a point, as 48 samples.
    fn ring(middle: Vec2<f64>, sigma: f64, is_exact: bool) -> RingSamples {
        let sample = |k: u32| {
            let out = Vec2::from_angle(core::f64::consts::TAU * f64::from(k) / 48.0);
            Sample { is_exact, ..Sample::new(middle + out * 5.0, out, sigma) }
        };
        RingSamples { runs: vec![(0..48).map(sample).collect()], closed: true }
    }

    proptest! {
        #[test]
        fn what_is_alike_is_fitted_once_wherever_it_is(middle in [6.0_f64..90.0, 6.0..90.0], steps in [0_u32..900, 0_u32..900]) {
            let (memo, ruler) = (Memo::default(), Ruler { extent: 1024.0 });
            let middle = Vec2::from(middle);
            let step = Vec2::from(steps.map(f64::from));
            let [first, second] = [middle, middle + step].map(|at| memo.fit_closed(&ring(at, 0.05, false), &ruler).unwrap());
            prop_assert_eq!(memo.outlines.borrow().len(), 1);
            let (OutlineShape::Circle { center, radius }, OutlineShape::Circle { center: other, radius: other_radius }) = (&first.shape, &second.shape) else {
                panic!("{first:?} {second:?}")
            };
            prop_assert_eq!(radius.to_bits(), other_radius.to_bits());
            prop_assert!((*other - *center - step).length() < 1e-9 && (*center - middle).length() < 1e-3);
            // A search that comes to either has tried as much as if both were new.
            prop_assert_eq!(memo.spent.get(), if steps == [0, 0] { 48 } else { 96 });
        }
    }

    #[test]
    fn strokes_are_fitted_once_and_lie_where_they_are_asked_for() {
        // A pen of 4 pixels along a half circle of radius 12: its outer and its inner side, and the ends, straight.
        let (memo, ruler) = (Memo::default(), Ruler { extent: 1024.0 });
        let strip = |middle: Vec2<f64>| {
            let side = |radius: f64, k: u32| {
                let out = Vec2::from_angle(core::f64::consts::PI * f64::from(k) / 60.0);
                Sample::new(middle + out * radius, out, 0.02)
            };
            let end = |x: f64| Sample::new(middle + Vec2::new(x, 0.0), Vec2::new(0.0, 1.0), 0.02);
            let run = (0..=60).map(|k| side(14.0, k)).chain([-13.0, -12.0, -11.0].map(end));
            let run = run.chain((0..=60).rev().map(|k| side(10.0, k))).chain([11.0, 12.0, 13.0].map(end));
            [RingSamples { runs: vec![run.collect()], closed: true }]
        };
        let [middle, step] = [Vec2::new(40.25, 40.5), Vec2::new(301.0, 17.0)];
        let [first, second] = [middle, middle + step].map(|at| memo.fit_strokes(&strip(at), &ruler).unwrap());
        assert_eq!(memo.strokes.borrow().len(), 1);
        assert!((first.strokes[0].width - 4.0).abs() < 0.05, "{first:?}");
        let points = |fit: &StrokeFit| -> Vec<[f64; 2]> {
            fit.strokes.iter().flat_map(|stroke| &stroke.rings).flat_map(|ring| ring.points.clone()).collect()
        };
        let (first, second) = (points(&first), points(&second));
        assert_eq!(first.len(), second.len());
        for (from, to) in first.into_iter().zip(second) {
            let from = Vec2::from(from);
            assert!(((from - middle).length() - 12.0).abs() < 0.1, "{from:?}");
            assert!((Vec2::from(to) - from - step).length() < 1e-9, "{from:?} {to:?}");
        }
    }

    #[test]
    fn what_is_known_better_is_something_else() {
        let (memo, ruler) = (Memo::default(), Ruler { extent: 64.0 });
        for (sigma, is_exact) in [(0.05, false), (0.1, false), (0.05, true)] {
            memo.fit_closed(&ring(Vec2::new(20.3, 20.7), sigma, is_exact), &ruler);
        }
        assert_eq!(memo.outlines.borrow().len(), 3);
    }
}
