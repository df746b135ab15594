//! A heap, and round outlines in it.

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::contour::perimeter;
use dvp_core::geometry::{Bounds, LineSegment};

use super::super::raster;
use crate::outline::{Outline, fit_round};
use crate::ruler::Ruler;
use crate::sample::{RingSamples, Sample};

/// So far inside (pixels) of an outline pixels are of the heap: where it goes along the side of a pixel, half of that is.
pub(super) const INSIDE: f64 = 0.75;
/// Standard deviation (pixels) of a place that an outline reaches to, or not beyond: it is told by whole pixels.
pub(super) const HELD_SIGMA: f64 = 0.5;
/// Most places that an outline is held to.
pub(super) const MOST_HELD: usize = 8;
/// How far outlines are followed beyond a heap, in steps of [`INSIDE`].
const MOST_DEPTH: usize = 16;

/// What things of a heap are held against.
pub(super) struct Heap<'a> {
    /// Whether a place is of the heap, or may be.
    pub(super) may_be: &'a dyn Fn(Vec2<f64>) -> bool,
    pub(super) ruler: &'a Ruler,
}

impl Heap<'_> {
    /// The cheapest round outline around stretches, and through some places, that costs less than `most` bits and covers nothing but pixels of the heap; and
    /// whether the stretches alone tell it.
    #[inline(never)]
    pub(super) fn round(&self, runs: &[Vec<Sample>], held: &[Sample], most: f64) -> Option<(Outline, bool)> {
        let fit = |held: &[Sample], may_be: &dyn Fn(&Outline) -> bool| {
            let mut runs = runs.to_vec();
            match runs.last_mut() {
                Some(last) => last.extend(held),
                None => runs.push(held.to_vec()),
            }
            fit_round(&RingSamples { runs, closed: false }, most, self.ruler, may_be)
        };
        if let Some(found) = fit(held, &|outline| is_around(outline, runs) && self.spilled(outline).is_none()) {
            return Some((found, held.is_empty()));
        }
        // What one of few numbers covers beyond the heap holds another one.
        let mut held = held.to_vec();
        for _ in 0..MOST_HELD {
            let outline = fit(&held, &|outline| is_around(outline, runs))?;
            let Some(edge) = self.spilled(&outline) else { return Some((outline, false)) };
            held.push(edge);
        }
        None
    }

    /// Where an outline goes farthest beyond the heap: the place that it should go through.
    #[inline(never)]
    fn spilled(&self, outline: &Outline) -> Option<Sample> {
        let polygon = raster::polygon(outline).unwrap_or_default();
        let depths = LineSegment::closed(&polygon).filter_map(|side| {
            let inward = side.along.normalized()?.perp();
            let at = |depth: usize| side.from + side.along * 0.5 + inward * (INSIDE * depth as f64);
            let depth = (1..=MOST_DEPTH).find(|&depth| (self.may_be)(at(depth))).unwrap_or(MOST_DEPTH);
            (depth > 1).then(|| (depth, Sample::new(at(depth - 1), inward, HELD_SIGMA)))
        });
        depths.max_by_key(|&(depth, _)| depth).map(|(_, edge)| edge)
    }
}

/// Whether stretches lead around what a round outline covers: around an opening they lead the other way.
fn is_around(outline: &Outline, runs: &[Vec<Sample>]) -> bool {
    let (center, ..) = extent(outline);
    let steps = runs.iter().flat_map(|run| run.windows(2));
    runs.is_empty()
        || steps.map(|pair| (pair[0].point - center).cross(pair[1].point - pair[0].point)).sum::<f64>() > 0.0
}

/// The middle of an outline, half of its mean width and height, and its length.
#[inline(never)]
pub(super) fn extent(outline: &Outline) -> (Vec2<f64>, f64, f64) {
    let polygon = raster::polygon(outline).unwrap_or_default();
    let bounds = Bounds::of_vertices(&polygon);
    let (center, size) = bounds.map_or_else(Default::default, |bounds| (bounds.center(), bounds.size()));
    (center, 0.25 * (size.x + size.y), perimeter(&polygon))
}
