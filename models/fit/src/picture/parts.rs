//! What changes in a picture where a drawing does, part by part, and what the things in it cost.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::contour::{contains, perimeter, signed_area};
use dvp_core::geometry::DisjointSets;
use dvp_core::{Drawing, ImageSize, Object, Real as _, Scene};
use dvp_trace::missed::{differing, touching};

use crate::scene_bits;
use crate::tuning::PIECE_WIDTH_PX;

/// Difference of a channel from which on a pixel is painted anew: less than a step of 8 bits.
const CHANGED: f32 = 1e-3;
/// How far (pixels) beside an outline its pixels are looked for: what goes along pixels' sides has one on either side.
const BESIDE: f64 = 1e-3;

/// Bits that an object costs by the law of scenes.
pub(super) fn price(object: &Object<f32>) -> f64 {
    let [of_one, of_none] =
        [vec![object.clone()], Vec::new()].map(|objects| Scene { objects, ..Scene::empty([0.0; 3]) });
    scene_bits(&of_one, 0) - scene_bits(&of_none, 0)
}

/// Whether object `k` is thin.
pub(super) fn is_thin(drawing: &Drawing<f32>, k: usize, size: ImageSize) -> bool {
    let unit = size.unit_px() as f64;
    let rings: Vec<&[[f32; 2]]> = drawing.rings(k).iter().collect();
    // A ring within another is the edge of an opening, whichever way it goes around.
    let area = |(j, ring): (usize, &&[[f32; 2]])| {
        let others = rings.iter().enumerate().filter(|&(other, _)| other != j);
        let around = others.filter(|(_, other)| ring.first().is_some_and(|&point| contains(other, point)));
        let area = f64::from(signed_area(ring).abs()) * unit * unit;
        if around.count() % 2 == 0 { area } else { -area }
    };
    let length = rings.iter().map(|ring| f64::from(perimeter(ring))).sum::<f64>() * unit;
    2.0 * rings.iter().enumerate().map(area).sum::<f64>() <= PIECE_WIDTH_PX * length
}

/// Walks along the outline of object `k`, on both sides of it: pixels on the way, as indices, and how far the way is through each, about half a pixel at
/// a time.
#[inline(never)]
pub(super) fn walk(drawing: &Drawing<f32>, k: usize, size: ImageSize, at: &mut dyn FnMut(usize, f64)) {
    let unit = size.unit_px() as f64;
    for ring in drawing.rings(k).iter() {
        let ends = ring.iter().skip(1).chain(ring.first());
        for (from, to) in ring.iter().zip(ends) {
            let [from, to] = [from, to].map(|point| point.map(|value| f64::from(value) * unit));
            // What of the way lies in the picture: outlines may lead far out of it.
            let [mut start, mut end] = [0.0_f64, 1.0_f64];
            for (c, side) in [size.width(), size.height()].into_iter().enumerate() {
                let step = to[c] - from[c];
                let [low, high] = [-from[c] / step, (f64::of_usize(side) - from[c]) / step];
                if step != 0.0 {
                    (start, end) = (start.max(low.min(high)), end.min(low.max(high)));
                }
            }
            let side = (to[0] - from[0]).hypot(to[1] - from[1]);
            let aside = [(from[1] - to[1]) / side * BESIDE, (to[0] - from[0]) / side * BESIDE];
            let length = (end - start) * side;
            let count = length.ceil().max(1.0);
            for j in 0..if length > 0.0 { count.to_count() } else { 0 } {
                let share = start + (end - start) * (j as f64 + 0.5) / count;
                let [x, y] = [0, 1].map(|c| from[c] + share * (to[c] - from[c]));
                for [x, y] in [[x - aside[0], y - aside[1]], [x + aside[0], y + aside[1]]] {
                    if x >= 0.0 && y >= 0.0 && x < size.width() as f64 && y < size.height() as f64 {
                        at(y.to_count() * size.width() + x.to_count(), 0.5 * length / count);
                    }
                }
            }
        }
    }
}

/// The pixels of the rows around some: `margin` rows more to either side.
pub(super) fn rows(pixels: &Range<usize>, margin: usize, size: ImageSize) -> Range<usize> {
    let width = size.width();
    let rows = (pixels.start / width).saturating_sub(margin)..(pixels.end / width + margin + 1).min(size.height());
    rows.start * width..rows.end * width
}

/// Parts of a picture that change: pixels that touch, and all parts that one object lies in are one.
pub(super) struct Parts {
    /// The pixels that change, ascending, and the part of each.
    pixels: Vec<usize>,
    part: Vec<u32>,
    /// The first of the pixels that are compared.
    first: usize,
    sets: DisjointSets,
    size: ImageSize,
}

impl Parts {
    /// What changes from one image to the other, both from pixel `first` on.
    pub(super) fn of([before, after]: [[&[f32]; 3]; 2], first: usize, size: ImageSize) -> Self {
        let pixels = differing(before, after, CHANGED, first);
        let part = touching(&pixels, size.width());
        let mut sets = DisjointSets::default();
        sets.reset(part.iter().map(|part| part + 1).max().unwrap_or(0));
        Self { pixels, part, first, sets, size }
    }

    /// The part that an object lies in; none if nothing changes along its outline.
    pub(super) fn part_of(&mut self, drawing: &Drawing<f32>, k: usize) -> Option<u32> {
        let mut first = None;
        walk(drawing, k, self.size, &mut |i, _| {
            if let Ok(at) = self.pixels.binary_search(&i) {
                let part = self.part[at];
                first = Some(first.map_or(part, |first| self.sets.unite(first, part)));
            }
        });
        first
    }

    /// How many parts there are, those that are one with others too.
    pub(super) fn count(&self) -> usize {
        self.sets.len()
    }

    /// Where what is counted of a part stands.
    pub(super) fn root(&mut self, part: u32) -> usize {
        self.sets.root(part) as usize
    }

    /// The pixels that change, counted from the first of those that are compared, and where what is counted of the part of each stands.
    pub(super) fn pixels(&mut self) -> Vec<(usize, usize)> {
        let pixels = self.pixels.iter().zip(&self.part);
        pixels.map(|(&i, &part)| (i - self.first, self.sets.root(part) as usize)).collect()
    }
}

/// By how much the farthest channel of pixel `i` is off.
pub(super) fn off(image: [&[f32]; 3], painted: [&[f32]; 3], i: usize) -> f64 {
    f64::from((0..3).map(|c| (image[c][i] - painted[c][i]).abs()).fold(0.0, f32::max))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paint::Canvas;
    use dvp_core::Pose;
    use dvp_core::render::EdgeProfile;
    use dvp_core::shape::{AnyShape, FillRule, Path, PathRing};

    /// Whether squares of some sizes around one another are thin, as one thing, some of them gone around the other way.
    fn is_thin_of(sides: &[(f32, bool)]) -> bool {
        let ring = |&(side, is_reversed): &(f32, bool)| {
            let half = 0.5 * side;
            let mut points = vec![[-half, -half], [half, -half], [half, half], [-half, half]];
            if is_reversed {
                points.reverse();
            }
            PathRing::polygon(points)
        };
        let shape = AnyShape::Path(Path { rings: sides.iter().map(ring).collect(), fill: FillRule::EvenOdd });
        let pose = Pose { translation: [0.5, 0.5], scale: 1.0 / 32.0, rotation: 0.0 };
        let object = Object { shape, pose, paint: [0.0; 3].into(), confidence: 1.0 };
        let scene = Scene { edge: EdgeProfile::area(), objects: vec![object], ..Scene::empty([1.0; 3]) };
        let size = ImageSize::new(32, 32).unwrap();
        let mut canvas = Canvas::default();
        is_thin(&canvas.paint(&scene, size).unwrap().1, 0, size)
    }

    #[test]
    fn a_frame_is_thin_whichever_way_its_opening_goes_around() {
        assert!(!is_thin_of(&[(20.0, false)]));
        for is_reversed in [false, true] {
            assert!(is_thin_of(&[(20.0, false), (17.0, is_reversed)]), "{is_reversed}");
            // With a square of its own in the opening.
            assert!(!is_thin_of(&[(20.0, false), (17.0, is_reversed), (15.0, false)]), "{is_reversed}");
        }
    }
}
