//! Which stretches of a boundary are of one thing.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::contour::perimeter;
use dvp_core::geometry::{Bounds, LineSegment};

use super::super::raster;
use super::again::INSIDE;
use super::stretch::Stretches;
use crate::outline::{Outline, fit_round};
use crate::ruler::Ruler;
use crate::sample::{RingSamples, Sample};
use crate::tuning;

/// Fewest windows of a stretch that is looked at: as many as a circle has numbers.
const SHORTEST: usize = 3;
/// Standard deviation (pixels) of the polygon through stretches that are of nothing round.
const POLYGON_SIGMA: f64 = 0.1;
/// Bits of a stretch below which two cannot be fewer: those of two circles.
const WORTH_CUTTING: f64 = 70.0;
/// Windows from one place where a stretch may be cut to the next, at first.
const STEP: usize = 3;
/// Windows of a stretch among which such a place is looked for.
const FIRST_LOOKS: usize = 48;
/// Standard deviation (pixels) of a place that an outline reaches to, or not beyond: it is told by whole pixels.
pub(super) const HELD_SIGMA: f64 = 0.5;
/// Most places that an outline is held to.
pub(super) const MOST_HELD: usize = 8;
/// How far outlines are followed beyond a heap, in steps of [`INSIDE`].
const MOST_DEPTH: usize = 16;
/// Most stretches of one boundary: more are the edge of something that is uneven.
const MOST_STRETCHES: usize = 64;

/// Things, and where the boundary was cut between them.
pub(super) struct Shared {
    pub(super) parts: Vec<Part>,
    pub(super) cuts: Vec<Vec2<f64>>,
    pub(super) stretches: Vec<Vec<Sample>>,
}

/// What things of a heap are held against.
pub(super) struct Heap<'a> {
    /// Whether a place is of the heap, or may be.
    pub(super) may_be: &'a dyn Fn(Vec2<f64>) -> bool,
    pub(super) ruler: &'a Ruler,
}

impl Heap<'_> {
    /// The cheapest round outline around stretches, and through some places, that costs less than `most` bits and covers nothing but pixels of the heap; and
    /// whether the stretches alone tell it.
    fn round(&self, runs: &[Vec<Sample>], held: &[Sample], most: f64) -> Option<(Outline, bool)> {
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

/// Stretches of one thing.
#[derive(Clone)]
pub(super) struct Part {
    pub(super) stretches: Vec<usize>,
    /// Places that it reaches to, as pixels that nothing else covers tell.
    pub(super) held: Vec<Sample>,
    /// Windows of them.
    count: usize,
    /// The outline through them, if there is one.
    pub(super) outline: Option<Outline>,
    /// Bits of that, or of the polygon through them.
    pub(super) bits: f64,
    /// Whether windows alone tell of it.
    pub(super) is_told: bool,
}

impl Part {
    pub(super) fn new(stretches: Vec<usize>, held: Vec<Sample>, of: &[Vec<Sample>], heap: &Heap<'_>) -> Self {
        let runs: Vec<Vec<Sample>> = stretches.iter().map(|&k| of[k].clone()).collect();
        let count: usize = runs.iter().map(Vec::len).sum();
        let polygon = polygon(count, heap.ruler);
        let price = |outline: &Outline| outline.bits + outline.misfit;
        let most = if count == 0 { f64::INFINITY } else { polygon };
        let (outline, is_told) =
            heap.round(&runs, &held, most).map_or((None, false), |(outline, is_told)| (Some(outline), is_told));
        let bits = outline.as_ref().map_or(polygon, price);
        Self { stretches, held, count, outline, bits, is_told }
    }

    /// A thing of which so many windows are seen.
    pub(super) fn again(outline: Outline, count: usize) -> Self {
        let bits = outline.bits + outline.misfit;
        Self { stretches: Vec::new(), held: Vec::new(), count, outline: Some(outline), bits, is_told: true }
    }

    /// Whether it may be of the same thing as another one: their outlines lie on one another, if they have such.
    fn may_join(&self, other: &Self) -> bool {
        let (Some(one), Some(other)) = (&self.outline, &other.outline) else { return true };
        let [(here, one, _), (there, other, _)] = [one, other].map(extent);
        (here - there).length() < one.max(other)
    }

    /// Bits of its outline, if it has one.
    fn known(&self) -> f64 {
        self.outline.as_ref().map_or(0.0, |_| self.bits)
    }

    /// Share of its outline that is seen; 0 without one.
    pub(super) fn seen(&self) -> f64 {
        self.outline.as_ref().map_or(0.0, |outline| self.count as f64 / extent(outline).2)
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
fn extent(outline: &Outline) -> (Vec2<f64>, f64, f64) {
    let polygon = raster::polygon(outline).unwrap_or_default();
    let bounds = Bounds::of_vertices(&polygon);
    let (center, size) = bounds.map_or_else(Default::default, |bounds| (bounds.center(), bounds.size()));
    (center, 0.25 * (size.x + size.y), perimeter(&polygon))
}

/// The things that stretches are of: again and again those two parts become one that cost least more by it. None if what is of none is more than a
/// few windows.
pub(super) fn share(mut left: Stretches, most: f64, heap: &Heap<'_>) -> Option<Shared> {
    let (mut parts, mut stretches) = (Vec::new(), Vec::new());
    // What nothing explains is most often long.
    left.samples.sort_by_key(Vec::len);
    while let Some(stretch) = left.samples.pop() {
        // Short ones, and what only cracks tell, say nothing: pixels do.
        let is_told = |sample: &Sample| sample.sigma < tuning::CRACK_SIGMA;
        if stretch.len() < SHORTEST || !stretch.iter().any(is_told) {
            continue;
        }
        if let Some((cut, halves)) = cut(&stretch, &left, heap) {
            left.samples.extend(halves);
            left.cuts.push(cut);
            continue;
        }
        stretches.push(stretch);
        let part = Part::new(vec![parts.len()], Vec::new(), &stretches, heap);
        if part.outline.is_none() && part.bits > 2.0 * most {
            return None;
        }
        parts.push(part);
        if stretches.len() > MOST_STRETCHES {
            return None;
        }
    }
    join(&mut parts, &stretches, heap);
    Some(Shared { parts, cuts: left.cuts, stretches })
}

/// Bits of so many windows as a polygon.
fn polygon(count: usize, ruler: &Ruler) -> f64 {
    2.0 * count as f64 * ruler.number(POLYGON_SIGMA)
}

/// Where a stretch is two that cost less, and these.
fn cut(stretch: &[Sample], left: &Stretches, heap: &Heap<'_>) -> Option<(Vec2<f64>, Vec<Vec<Sample>>)> {
    let price = |stretch: &Vec<Sample>| Part::new(vec![0], Vec::new(), core::slice::from_ref(stretch), heap).bits;
    let whole = price(&stretch.to_vec());
    if whole < WORTH_CUTTING {
        return None;
    }
    let halves = |stretch: &[Sample], k: usize| {
        let halves = left.halves(stretch, stretch[k].point);
        // What nobody explains then costs what it does as a polygon.
        let left_out = stretch.len() - halves.iter().map(Vec::len).sum::<usize>();
        (halves.iter().map(price).sum::<f64>() + polygon(left_out, heap.ruler), k, halves)
    };
    // Few windows tell where.
    let every = stretch.len().div_ceil(FIRST_LOOKS);
    let few: Vec<Sample> = stretch.iter().step_by(every).copied().collect();
    let best = |places: &mut dyn Iterator<Item = usize>| {
        places.map(|k| halves(&few, k)).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, k, _)| k)
    };
    let near = best(&mut (0..few.len()).step_by(STEP))?;
    let near = best(&mut (near.saturating_sub(STEP - 1)..(near + STEP).min(few.len())))?;
    let (bits, k, halves) = halves(stretch, every * near);
    (bits < whole).then(|| (stretch[k].point, halves))
}

/// Joins parts as long as that makes the description shorter.
fn join(parts: &mut Vec<Part>, stretches: &[Vec<Sample>], heap: &Heap<'_>) {
    // The first stretches of two parts, the bits that joining them costs more, and the part that they make.
    let mut pairs: Vec<([usize; 2], f64, Part)> = Vec::new();
    loop {
        for (k, a) in parts.iter().enumerate() {
            for b in parts[..k].iter().filter(|b| a.may_join(b)) {
                let key = [a.stretches[0], b.stretches[0]];
                if pairs.iter().any(|pair| pair.0 == key) {
                    continue;
                }
                let both = a.stretches.iter().chain(&b.stretches).copied().collect();
                let joined = Part::new(both, Vec::new(), stretches, heap);
                let is_shorter = joined.bits < a.bits + b.bits && joined.outline.is_some();
                // What is of no outline by itself goes where it costs least, whatever it cost before.
                let more = if is_shorter { joined.bits - a.known() - b.known() } else { f64::INFINITY };
                pairs.push((key, more, joined));
            }
        }
        let best = (0..pairs.len()).min_by(|&a, &b| pairs[a].1.total_cmp(&pairs[b].1));
        let Some(best) = best.filter(|&best| pairs[best].1 < f64::INFINITY) else { return };
        let (key, _, joined) = pairs.swap_remove(best);
        let is_part = |stretch: usize| key.contains(&stretch);
        pairs.retain(|pair| !pair.0.iter().any(|&stretch| is_part(stretch)));
        parts.retain(|part| !is_part(part.stretches[0]));
        parts.push(joined);
    }
}
