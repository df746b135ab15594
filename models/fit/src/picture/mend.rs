//! Drawings with what they paint wrongly taken away, and what they miss painted on them.
//!
//! What is thin and drawn in pieces is taken away first, so that all of it is missed; then what is missed is painted, round by round, since things lie on
//! one another. Every part of the picture that changes on its own says whether it is shorter so, with what the drawing still misses there; where it is
//! not, all stays as it was.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::contour::{perimeter, signed_area};
use dvp_core::geometry::DisjointSets;
use dvp_core::{Drawing, Image, ImageSize, ImageView, Object, Real as _, Scene};
use dvp_trace::Traced;
use dvp_trace::missed::{Missed, Painted, differing, touching};
use dvp_trace::tuning::{CODED_CONTRAST, LEAST_CONTRAST, PIXEL_BITS};

use crate::FitError;
use crate::paint::Canvas;
use crate::scene_bits;
use crate::tuning::{PIECE_WIDTH_PX, PIECE_WRONG};

/// Most rounds of things on one another.
const MOST_ROUNDS: usize = 4;
/// Difference of a channel from which on a pixel is painted anew: less than a step of 8 bits.
const CHANGED: f32 = 1e-3;

/// What is wrong with a drawing, before it is mended.
pub(super) struct Wrong {
    /// The drawing, painted.
    pub(super) before: Image<f32>,
    /// Which of its objects are thin, and not what the picture shows.
    is_piece: Vec<bool>,
    /// Differences of a channel up to this are none.
    step: f64,
    /// The pixels that differ, ascending.
    off: Vec<usize>,
}

impl Wrong {
    /// What is wrong with a drawing that is painted; none if nothing is.
    #[inline(never)]
    pub(super) fn of(
        traced: &Traced,
        drawing: &Drawing<f32>,
        painted: &Image<f32>,
        image: &ImageView<'_, f32>,
    ) -> Option<Self> {
        let step = if traced.coded { CODED_CONTRAST } else { LEAST_CONTRAST };
        let pair = Painted { scene: &traced.scene, image: *image, painted: painted.view(), step };
        let off = pair.off();
        let is_piece = |k: usize| self::is_piece(drawing, k, &off, image.size());
        let is_piece: Vec<bool> = (0..drawing.object_count()).map(is_piece).collect();
        (is_piece.contains(&true) || pair.may_miss(&off)).then(|| Self { before: painted.clone(), is_piece, step, off })
    }

    /// Mends the drawing where that makes it shorter. Its polygons, as they are painted on the canvas then; none if nothing changes.
    #[inline(never)]
    pub(super) fn mend(
        &self,
        traced: &mut Traced,
        drawing: &Drawing<f32>,
        image: ImageView<'_, f32>,
        canvas: &mut Canvas<f32>,
    ) -> Result<Option<Drawing<f32>>, FitError> {
        let Self { before, is_piece, step, .. } = self;
        let size = image.size();
        let mut scene = Scene { objects: Vec::new(), ..traced.scene.clone() };
        let kept = traced.scene.objects.iter().zip(is_piece).filter(|&(_, is_piece)| !is_piece);
        scene.objects.extend(kept.map(|(object, _)| object.clone()));
        let first = scene.objects.len();
        let mut bits = Vec::new();
        let mut rounds = 0;
        let (painted, again) = loop {
            let (painted, again) = canvas.paint(&scene, size)?;
            let pair = Painted { scene: &scene, image, painted: painted.view(), step: *step };
            let off = || if rounds == 0 { self.off_without(&pair, drawing) } else { pair.off() };
            let missed = if rounds < MOST_ROUNDS { pair.missed(&off()) } else { Vec::new() };
            if missed.is_empty() {
                break (painted, again);
            }
            rounds += 1;
            for Missed { object, bits: of_outline, .. } in missed {
                bits.push(of_outline);
                scene.objects.push(object);
            }
        };
        let pieces: Vec<usize> = (0..is_piece.len()).filter(|&k| is_piece[k]).collect();
        let rows = pieces.iter().map(|&k| rows(drawing, k, size));
        let rows = rows.chain((first..scene.objects.len()).map(|k| self::rows(&again, k, size)));
        let mut parts = Parts::of([before, painted], &all_of(rows));
        let of_pieces: Vec<Option<u32>> = pieces.iter().map(|&k| parts.part_of(drawing, k)).collect();
        let of_added: Vec<Option<u32>> = (first..scene.objects.len()).map(|k| parts.part_of(&again, k)).collect();
        let nearer = parts.nearer(&image, [before, painted], *step);
        let mut shorter = nearer.clone();
        let price =
            |object: &Object<f32>| scene_bits(&Scene { objects: vec![object.clone()], ..Scene::empty([0.0; 3]) }, 0);
        for (&k, part) in pieces.iter().zip(&of_pieces) {
            part.iter().for_each(|&part| shorter[parts.root(part)] += price(&traced.scene.objects[k]));
        }
        for (object, part) in scene.objects[first..].iter().zip(&of_added) {
            part.iter().for_each(|&part| shorter[parts.root(part)] -= price(object));
        }
        let mut is_better = |part: Option<u32>| {
            part.map(|part| parts.root(part)).is_some_and(|root| nearer[root] > 0.0 && shorter[root] > 0.0)
        };
        let mut is_left = vec![true; is_piece.len()];
        pieces.iter().zip(&of_pieces).for_each(|(&k, &part)| is_left[k] = !is_better(part));
        let mut is_changed = is_left.contains(&false);
        let mut left = is_left.iter();
        traced.scene.objects.retain(|_| left.next() != Some(&false));
        let mut left = is_left.iter();
        traced.covariances.retain(|_| left.next() != Some(&false));
        let count = scene.objects.len();
        for ((object, part), bits) in scene.objects.drain(first..).zip(of_added).zip(bits) {
            if is_better(part) {
                is_changed = true;
                traced.scene.objects.push(object);
                traced.covariances.push(None);
                traced.bits += bits;
            }
        }
        if !is_changed {
            return Ok(None);
        }
        let is_all = pieces.iter().all(|&k| !is_left[k]) && traced.scene.objects.len() == count;
        Ok(Some(if is_all { again } else { canvas.paint(&traced.scene, size)?.1 }))
    }

    /// The pixels that differ without the pieces: others only where these are.
    fn off_without(&self, pair: &Painted<'_>, drawing: &Drawing<f32>) -> Vec<usize> {
        let width = pair.image.size().width();
        let pieces = (0..self.is_piece.len()).filter(|&k| self.is_piece[k]);
        let rows = all_of(pieces.map(|k| rows(drawing, k, pair.image.size())));
        let within = rows.start * width..rows.end * width;
        let [before, after] = [within.start, within.end].map(|at| self.off.partition_point(|&i| i < at));
        let again = differing(&pair.image, &pair.painted, f32::of(self.step), within);
        self.off[..before].iter().copied().chain(again).chain(self.off[after..].iter().copied()).collect()
    }
}

/// The rows of pixels that an object may be seen in: from the first to that after the last.
fn rows(drawing: &Drawing<f32>, k: usize, size: ImageSize) -> Range<usize> {
    let unit = size.unit_px() as f32;
    let places = || drawing.outline(k).iter().map(|point| point[1] * unit);
    let [low, high] = [places().fold(f32::INFINITY, f32::min) - 2.0, places().fold(0.0, f32::max) + 3.0];
    low.max(0.0).to_count().min(size.height())..high.to_count().min(size.height())
}

/// The rows from the first to the last of all.
fn all_of(rows: impl Iterator<Item = Range<usize>>) -> Range<usize> {
    rows.reduce(|a, b| a.start.min(b.start)..a.end.max(b.end)).unwrap_or_default()
}

/// Whether object `k` is thin, and pixels along much of its outline are `off`.
fn is_piece(drawing: &Drawing<f32>, k: usize, off: &[usize], size: ImageSize) -> bool {
    let unit = size.unit_px() as f64;
    let rings = drawing.rings(k);
    let area = rings.iter().map(|ring| f64::from(signed_area(ring))).sum::<f64>().abs() * unit * unit;
    let length = rings.iter().map(|ring| f64::from(perimeter(ring))).sum::<f64>() * unit;
    if 2.0 * area > PIECE_WIDTH_PX * length {
        return false;
    }
    let [mut wrong, mut all] = [0.0; 2];
    walk(drawing, k, size, &mut |i, length| {
        all += length;
        wrong += if off.binary_search(&i).is_ok() { length } else { 0.0 };
    });
    wrong > PIECE_WRONG * all
}

/// Walks along the outline of object `k`: pixels on the way, as indices, and how far the way is through each, about a pixel at a time.
#[inline(never)]
fn walk(drawing: &Drawing<f32>, k: usize, size: ImageSize, at: &mut dyn FnMut(usize, f64)) {
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
            let length = (end - start) * (to[0] - from[0]).hypot(to[1] - from[1]);
            let count = length.ceil().max(1.0);
            for j in 0..if length > 0.0 { count.to_count() } else { 0 } {
                let share = start + (end - start) * (j as f64 + 0.5) / count;
                let [x, y] = [0, 1].map(|c| from[c] + share * (to[c] - from[c]));
                if x >= 0.0 && y >= 0.0 && x < size.width() as f64 && y < size.height() as f64 {
                    at(y.to_count() * size.width() + x.to_count(), length / count);
                }
            }
        }
    }
}

/// Parts of a picture that change: pixels that touch, and all parts that one object lies in are one.
struct Parts {
    /// The pixels that change, ascending, and the part of each.
    pixels: Vec<usize>,
    part: Vec<u32>,
    sets: DisjointSets,
    size: ImageSize,
}

impl Parts {
    /// What changes from one image to the other in some rows.
    fn of([before, after]: [&Image<f32>; 2], rows: &Range<usize>) -> Self {
        let size = before.size();
        let pixels =
            differing(&before.view(), &after.view(), CHANGED, rows.start * size.width()..rows.end * size.width());
        let part = touching(&pixels, size.width());
        let mut sets = DisjointSets::default();
        sets.reset(part.iter().map(|part| part + 1).max().unwrap_or(0));
        Self { pixels, part, sets, size }
    }

    /// The part that an object lies in; none if nothing changes along its outline.
    fn part_of(&mut self, drawing: &Drawing<f32>, k: usize) -> Option<u32> {
        let mut first = None;
        walk(drawing, k, self.size, &mut |i, _| {
            if let Ok(at) = self.pixels.binary_search(&i) {
                let part = self.part[at];
                first = Some(first.map_or(part, |first| self.sets.unite(first, part)));
            }
        });
        first
    }

    /// Where what is counted of a part stands.
    fn root(&mut self, part: u32) -> usize {
        self.sets.root(part) as usize
    }

    /// By how many bits less the second image misses the picture, part by part. A pixel that is off by `step` is off by one sigma.
    fn nearer(&mut self, image: &ImageView<'_, f32>, [before, after]: [&Image<f32>; 2], step: f64) -> Vec<f64> {
        let mut nearer = vec![0.0; self.sets.len()];
        let bits = |painted: &Image<f32>, i: usize| {
            let [seen, painted] = [image.pixel(i), painted.view().pixel(i)];
            let off = (0..3).map(|c| (seen[c] - painted[c]).abs()).fold(0.0, f32::max);
            (0.5 * core::f64::consts::LOG2_E * (f64::from(off) / step).powi(2)).min(PIXEL_BITS)
        };
        for (&i, &part) in self.pixels.iter().zip(&self.part) {
            nearer[self.sets.root(part) as usize] += bits(before, i) - bits(after, i);
        }
        nearer
    }
}
