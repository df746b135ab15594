//! Straight things of the picture that are there again, in a heap.
//!
//! Of things without a corner inward, a corner outward of what they cover together is a corner of one of them: it tells where that is.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::geometry::{Bounds, LineSegment, Similarity};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::heap::{Heap, INSIDE};
use super::model::Model;
use super::share::Part;
use super::stretch::{Corner, Stretches};
use crate::elimination::solve;
use crate::outline::Outline;
use crate::ruler::Ruler;
use crate::sample::Sample;
use crate::tuning;

/// Sine of the angle between sides that may be the same.
const ALONG: f64 = 0.1;
/// What of a boundary lies nearer to a thing (pixels) is its outline: a corner of an outline is off by tenths where its sides are short.
const NEAR: f64 = 0.4;
/// Fewest windows that only one thing explains: as many as tell of one side that it is there.
const LEAST_TOLD: usize = 3;
/// Shares of each side at which pixels just inside of it are of the heap.
const PROBES: [f64; 4] = [0.125, 0.375, 0.625, 0.875];
/// Things are side by side that are closer (pixels), or overlap by less, but for what they may be longer.
const BESIDE: f64 = 0.1;
/// Steps in which a model comes to lie.
const STEPS: usize = 3;

/// The things of one kind that have corners of the outlines of a heap, and lie in it; what is left of the stretches of its boundary stays. Each kind is
/// given as the models that may be of it: things of several kinds that lie on one another are a figure. So are things that lie side by side: then none.
pub(super) fn take(kinds: &[Vec<Model>], stretches: &mut Stretches, heap: &Heap<'_>) -> Option<Vec<Part>> {
    let samples: Vec<Sample> = stretches.samples.iter().flatten().copied().collect();
    let taken = kinds.iter().map(|kind| Taken::of(kind, stretches, &samples, heap));
    let Some(taken) = taken.max_by_key(Taken::told) else { return Some(Vec::new()) };
    if taken.is_figure() {
        return None;
    }
    let mut is_told = taken.is_told.iter();
    let mut left = |stretch: &Vec<Sample>| {
        let is_left = |sample: &Sample| is_told.next().is_some_and(|is_told| !is_told).then_some(*sample);
        let left: Vec<Option<Sample>> = stretch.iter().map(is_left).collect();
        left.split(Option::is_none).map(|run| run.iter().copied().flatten().collect()).collect::<Vec<_>>()
    };
    stretches.samples = stretches.samples.iter().flat_map(&mut left).collect();
    let choice = (kinds.len() as f64).log2() + tuning::OUTLINE_PIECE_BITS;
    let parts = taken.places.iter().enumerate().map(|(k, (place, on))| {
        let first = if k == 0 { choice + place.model.bits(heap.ruler) } else { 0.0 };
        Part::again(place.outline(on, first, heap.ruler), on.len())
    });
    Some(parts.collect())
}

/// Things of one kind in a heap.
struct Taken<'a> {
    /// Where they are, and what of the boundary said so.
    places: Vec<(Place<'a>, Vec<Sample>)>,
    /// Which samples of the boundary are of their outlines.
    is_told: Vec<bool>,
}

impl<'a> Taken<'a> {
    /// Those of which a corner is seen; if these explain most of the boundary, then those of which two sides are.
    fn of(kind: &'a [Model], of: &Stretches, samples: &[Sample], heap: &Heap<'_>) -> Self {
        let mut taken = Self { places: Vec::new(), is_told: vec![false; samples.len()] };
        taken.take(kind.iter().flat_map(|model| at_corners(model, &of.corners)), samples, heap);
        let told = taken.told();
        if told < samples.len() && 2 * told > samples.len() {
            taken.take(kind.iter().flat_map(|model| at_sides(model, &of.sides)), samples, heap);
        }
        taken
    }

    /// How many samples are of their outlines.
    fn told(&self) -> usize {
        self.is_told.iter().filter(|&&is_told| is_told).count()
    }

    /// Takes the place that explains most of what is left of a boundary, again and again.
    fn take(&mut self, places: impl Iterator<Item = Place<'a>>, samples: &[Sample], heap: &Heap<'_>) {
        let left = places.filter(|place| place.is_in(heap));
        let mut left: Vec<(Place<'_>, Vec<usize>)> = left.map(|place| place.told(samples)).collect();
        loop {
            left.iter_mut().for_each(|(_, told)| told.retain(|&k| !self.is_told[k]));
            left.retain(|(_, told)| told.len() >= LEAST_TOLD);
            let Some(k) = (0..left.len()).max_by_key(|&k| left[k].1.len()) else { return };
            let (place, told) = left.remove(k);
            let on: Vec<Sample> = told.iter().map(|&k| samples[k]).collect();
            let (place, told) = place.fitted(&on).told(samples);
            told.iter().for_each(|&k| self.is_told[k] = true);
            self.places.push((place, on));
        }
    }

    /// Whether each thing lies beside another one: such make another thing together, as the squares of codes and of letters do. Those that lie on one another
    /// by chance hardly do.
    fn is_figure(&self) -> bool {
        let place = |k: usize| &self.places[k].0;
        let count = self.places.len();
        let has_other = |k: usize| (0..count).any(|other| other != k && place(k).is_beside(place(other)));
        count > 1 && (0..count).all(has_other)
    }
}

/// The places of a model in which it has a corner that an outline has.
fn at_corners<'a>(model: &'a Model, corners: &[Corner]) -> Vec<Place<'a>> {
    let next = model.sides.iter().cycle().skip(1);
    let places = |(before, after): (&LineSegment<f64>, &LineSegment<f64>)| {
        let is_here = |corner: &&Corner| {
            let [first, second] = corner.sides;
            is_along(before, first) && is_along(after, second)
        };
        let shift = |corner: &Corner| Place { model, shift: corner.at - after.from };
        corners.iter().filter(is_here).map(shift).collect::<Vec<_>>()
    };
    model.sides.iter().zip(next).flat_map(places).collect()
}

/// The places of a model in which two of its sides lie on sides of an outline.
fn at_sides<'a>(model: &'a Model, sides: &[LineSegment<f64>]) -> Vec<Place<'a>> {
    let mut places = Vec::new();
    for (k, one) in model.sides.iter().enumerate() {
        for other in &model.sides[..k] {
            let of = |side: &LineSegment<f64>| {
                let along = side.along.normalized().unwrap_or_default();
                let here = sides.iter().filter(|there| is_along(there, along));
                here.map(|there| there.from - side.from).collect::<Vec<_>>()
            };
            let cross = one.along.cross(other.along);
            for off in of(one) {
                for there in of(other) {
                    // Where the lines of both sides meet.
                    let shift = off + one.along * ((there - off).cross(other.along) / cross);
                    if shift.x.is_finite() && shift.y.is_finite() {
                        places.push(Place { model, shift });
                    }
                }
            }
        }
    }
    places
}

/// Whether a side points about along a unit vector.
fn is_along(side: &LineSegment<f64>, along: Vec2<f64>) -> bool {
    let here = side.along.normalized().unwrap_or_default();
    here.dot(along) > 0.0 && here.cross(along).abs() < ALONG
}

/// A model in a place.
struct Place<'a> {
    model: &'a Model,
    shift: Vec2<f64>,
}

impl<'a> Place<'a> {
    /// The side of the model nearest to a sample, and how far that is (pixels).
    fn off(&self, sample: &Sample) -> (&'a LineSegment<f64>, f64) {
        let off = |side: &'a LineSegment<f64>| (side, side.nearest(sample.point - self.shift).offset.length());
        let sides = self.model.sides[1..].iter().map(off);
        sides.fold(off(&self.model.sides[0]), |best, side| if side.1 < best.1 { side } else { best })
    }

    /// The place, and which samples are of its outline.
    fn told(self, samples: &[Sample]) -> (Self, Vec<usize>) {
        let is_around = |point: Vec2<f64>| {
            let point = point - self.shift;
            Bounds { min: point, max: point }.meets(&self.model.bounds, NEAR)
        };
        let is_told = |&k: &usize| is_around(samples[k].point) && self.off(&samples[k]).1 < NEAR;
        let told = (0..samples.len()).filter(is_told).collect();
        (self, told)
    }

    /// Whether it covers nothing but pixels of the heap.
    fn is_in(&self, heap: &Heap<'_>) -> bool {
        self.model.sides.iter().all(|side| {
            let inward = side.along.normalized().unwrap_or_default().perp() * INSIDE;
            PROBES.iter().all(|&share| (heap.may_be)(side.from + side.along * share + inward + self.shift))
        })
    }

    /// Whether a side of one is about where one of the other begins, or two of its sides lie on the lines of two, and they are not apart: then both make
    /// a longer thing.
    fn is_beside(&self, other: &Self) -> bool {
        let there = &other.model.bounds;
        let near = BESIDE + self.model.longer + other.model.longer;
        let apart = other.shift - self.shift;
        if !self.model.bounds.meets(&Bounds { min: there.min + apart, max: there.max + apart }, near) {
            return false;
        }
        let mut in_row = 0;
        for here in &self.model.sides {
            let along = here.along.normalized().unwrap_or_default();
            let is_parallel = |there: &&LineSegment<f64>| is_along(there, along) || is_along(there, -along);
            for there in other.model.sides.iter().filter(is_parallel) {
                let off = along.cross(there.from + apart - here.from).abs();
                let is_same_way = along.dot(there.along) > 0.0;
                if !is_same_way && off < near {
                    return true;
                }
                in_row += usize::from(is_same_way && off < BESIDE);
            }
        }
        in_row > 1
    }

    /// The place nearest to samples.
    fn fitted(mut self, on: &[Sample]) -> Self {
        for _ in 0..STEPS {
            let on: Vec<(&Sample, &LineSegment<f64>)> = on.iter().map(|sample| (sample, self.off(sample).0)).collect();
            self.shift = moved(&on, self.shift).unwrap_or(self.shift);
        }
        self
    }

    /// The outline there, at so many bits beside those of its place, and how well it fits samples.
    fn outline(&self, on: &[Sample], bits: f64, ruler: &Ruler) -> Outline {
        let chi2 = |sample: &Sample| {
            let (side, off) = self.off(sample);
            let off = off / sigma(sample, side);
            // What the end of a stretch shows of something else is off by as much as it likes.
            off * off.min(tuning::OUTLINE_HUBER)
        };
        let misfit = ruler.misfit(on.iter().map(chi2).sum());
        let map = Similarity { translation: self.shift, ..Similarity::identity() };
        let bits = bits + 2.0 * ruler.number(tuning::RENDERER_SIGMA);
        Outline { shape: self.model.shape.moved(&map), bits, misfit, covariance: Vec::new() }
    }
}

/// Deviation (pixels) of the distance of a sample from a side.
fn sigma(sample: &Sample, side: &LineSegment<f64>) -> f64 {
    let normal = side.along.normalized().unwrap_or_default().perp();
    (sample.sigma * normal.dot(sample.axis).abs()).hypot(tuning::RENDERER_SIGMA)
}

/// The shift that brings sides nearer to samples, from one that is near; none if the sides are about parallel.
fn moved(on: &[(&Sample, &LineSegment<f64>)], shift: Vec2<f64>) -> Option<Vec2<f64>> {
    let (mut matrix, mut right) = ([[0.0; 2]; 2], [0.0; 2]);
    for (sample, side) in on {
        let normal = side.along.normalized()?.perp();
        let sigma = sigma(sample, side);
        let off = normal.dot(sample.point - side.from - shift);
        let weight = tuning::OUTLINE_HUBER / (off.abs() / sigma).max(tuning::OUTLINE_HUBER) / (sigma * sigma);
        let normal = normal.to_array();
        for i in 0..2 {
            right[i] += weight * normal[i] * off;
            for j in 0..2 {
                matrix[i][j] += weight * normal[i] * normal[j];
            }
        }
    }
    solve(matrix, right).map(|step| shift + Vec2::from(step))
}
