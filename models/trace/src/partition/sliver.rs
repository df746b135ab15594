//! Thin lines between two faces that may be slivers: what is seen of a third thing that both hide but for a pixel or two.
//!
//! A pen draws a line of its own color on what lies there. A sliver has the color of something that is seen elsewhere too, and one face on
//! its one side and another on its other. Which of both it is the shorter description tells.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::Vec2;
use dvp_core::contour::{Crack, Heading};
use dvp_core::image::distance;

use super::mix::{best_mixture, narrow};
use super::thin::ThinLine;
use super::{Face, OUTSIDE, Partition};
use crate::sample::Sample;
use crate::stroke::ThinSample;
use crate::tuning;

/// Share of a pixel that may be of anything.
const UNSEEN: f32 = 0.5;

/// A part of a face that is thinner than two pixels, both sides of whose boundary the same windows tell.
#[derive(Clone, Debug)]
pub(crate) struct Sliver {
    pixels: BTreeSet<usize>,
    windows: Vec<ThinSample>,
}

impl Partition {
    /// The same with lines between two faces as faces, or parts of those that they touch, where they have the color of another face; none if
    /// no line is such.
    #[must_use]
    pub fn with_slivers(&self) -> Option<Self> {
        if !self.lines.iter().any(|line| self.color_of_sliver(line).is_some()) {
            return None;
        }
        let mut cut = self.clone();
        cut.lines.clear();
        for line in &self.lines {
            if !cut.insert(line) {
                cut.lines.push(line.clone());
            }
        }
        // Beside the ends of a sliver lies what hides it.
        cut.guessed.iter().for_each(|&i| cut.shares[i] = cut.shares[i].min(UNSEEN));
        (!cut.slivers.is_empty()).then_some(cut)
    }

    /// Whether a face is a sliver, at least in part.
    #[must_use]
    pub fn has_sliver(&self, face: u32) -> bool {
        self.slivers.iter().any(|sliver| sliver.pixels.first().is_some_and(|&i| self.labels[i] == face))
    }

    /// The boundary at a crack beside a sliver, as the windows across it tell, which may be nothing; none if there is no sliver.
    pub(crate) fn sliver_sample(&self, crack: Crack) -> Option<Option<Sample>> {
        let sides = crack.sides().map(|[x, y]| y * self.size[0] + x);
        let sliver = self.slivers.iter().find(|sliver| sides.iter().any(|i| sliver.pixels.contains(i)))?;
        Some(sliver.sample(crack))
    }

    /// The color, of the palette, of a line between two faces that has the color of another face.
    fn color_of_sliver(&self, line: &ThinLine) -> Option<usize> {
        let windows = &line.chain.samples;
        let between = windows.iter().filter(|window| self.is_between(window)).count();
        if line.chain.is_closed || (between as f64) < tuning::SLIVER_MOSTLY * windows.len() as f64 {
            return None;
        }
        let color = (0..self.palette.len()).find(|&k| distance(self.palette[k], line.color) <= self.mix_noise)?;
        self.faces.iter().any(|face| face.color == color && face.flat > 0).then_some(color)
    }

    /// Whether a line shows a mixture of what lies on its sides and of the ground, all along: then two things lie so near one another that no pixel
    /// between them is of the ground alone.
    #[inline(never)]
    pub(crate) fn is_gap(&self, line: &ThinLine) -> bool {
        let is_mixed = |window: &ThinSample| {
            let sides = self.sides(window);
            let is_face = sides.iter().all(|&side| side != OUTSIDE);
            let color = |face: u32| narrow(self.faces[face as usize].color);
            is_face && {
                let colors = [0, color(sides[0]), color(sides[1])];
                sides[0] != sides[1]
                    && best_mixture(line.color, &colors, &self.palette)
                        .is_some_and(|best| best.misfit <= self.mix_noise && best.share < f64::from(tuning::PURE_SHARE))
            }
        };
        line.chain.samples.iter().all(is_mixed)
    }

    /// Makes a face of a line; whether it may be a sliver.
    fn insert(&mut self, line: &ThinLine) -> bool {
        let Some(color) = self.color_of_sliver(line) else { return false };
        let covered = self.covered(line);
        if covered.is_empty() {
            return false;
        }
        let [left, top, right, bottom] = self.face_of(color, covered.keys()).bounds;
        let around = [
            left.saturating_sub(1),
            top.saturating_sub(1),
            (right + 1).min(self.size[0]),
            (bottom + 1).min(self.size[1]),
        ];
        // A line that cuts a face in two is none that separates two faces.
        let mut touched: Vec<u32> = covered.keys().map(|&i| self.labels[i]).collect();
        touched.sort_unstable();
        touched.dedup();
        let is_cut = |&face: &u32| {
            let is_own = |i: usize| self.labels[i] == face;
            self.pieces(around, |i| is_own(i) && !covered.contains_key(&i)).len() > self.pieces(around, is_own).len()
        };
        if touched.iter().any(is_cut) {
            return false;
        }
        for pixels in self.pieces(around, |i| covered.contains_key(&i)) {
            let sliver = self.face_of(color, &pixels);
            let face = self.faces.len() as u32;
            for &i in &pixels {
                self.faces[self.labels[i] as usize].area -= 1;
                (self.labels[i], self.shares[i]) = (face, covered[&i]);
            }
            self.faces.push(sliver);
            while let Some(other) = self.alike_beside(&pixels) {
                let keep = pixels.first().map_or(face, |&i| self.labels[i]);
                self.unite(keep, other);
            }
            self.slivers.push(Sliver { pixels: pixels.into_iter().collect(), windows: line.chain.samples.clone() });
        }
        true
    }

    /// A face of some pixels, none of them flat.
    fn face_of<'p>(&self, color: usize, pixels: impl IntoIterator<Item = &'p usize>) -> Face {
        let mut face = Face { color, area: 0, flat: 0, bounds: [usize::MAX, usize::MAX, 0, 0] };
        pixels.into_iter().for_each(|&i| face.take(1, 0, self.at(i).map(|at| [at, at + 1])));
        face
    }

    /// Column and row of a pixel.
    fn at(&self, i: usize) -> [usize; 2] {
        [i % self.size[0], i / self.size[0]]
    }

    /// Another face of the same color that touches the side of a pixel.
    fn alike_beside(&self, pixels: &[usize]) -> Option<u32> {
        let color = |face: u32| self.faces[face as usize].color;
        pixels.iter().find_map(|&i| {
            let (own, [x, y]) = (self.labels[i], self.at(i));
            let beside = [[x + 1, y], [x.wrapping_sub(1), y], [x, y + 1], [x, y.wrapping_sub(1)]];
            beside
                .into_iter()
                .map(|at| self.face_at(at))
                .find(|&face| face != OUTSIDE && face != own && color(face) == color(own))
        })
    }

    /// Makes one face of two; the last one takes the number of that which is gone.
    fn unite(&mut self, keep: u32, gone: u32) {
        let [low, high] = [keep.min(gone), keep.max(gone)];
        let last = (self.faces.len() - 1) as u32;
        let Face { area, flat, bounds: [left, top, right, bottom], .. } = self.faces[high as usize];
        self.faces[low as usize].take(area, flat, [[left, right], [top, bottom]]);
        self.faces.swap_remove(high as usize);
        for label in &mut self.labels {
            if *label == high {
                *label = low;
            } else if *label == last {
                *label = high;
            }
        }
    }

    /// Whether a window has two faces on its sides.
    fn is_between(&self, window: &ThinSample) -> bool {
        let [before, behind] = self.sides(window);
        before != behind && before != OUTSIDE && behind != OUTSIDE
    }

    /// The faces on the sides of a window.
    fn sides(&self, window: &ThinSample) -> [u32; 2] {
        let reach = window.axis * (0.5 * window.width + 1.0);
        [window.point - reach, window.point + reach].map(|at| self.face_at(pixel(at)))
    }

    /// The pixels that a line covers, those in which most of it lies where it covers no center, with its share.
    fn covered(&self, line: &ThinLine) -> BTreeMap<usize, f32> {
        let windows = &line.chain.samples;
        // Windows, and how much of each the line covers.
        let mut all = Vec::new();
        for pair in windows.windows(2) {
            all.push((pair[0], 1.0));
            let steps = (pair[1].point - pair[0].point).length().round();
            if pair[0].axis == pair[1].axis && steps > 1.0 && steps <= tuning::SLIVER_GAP {
                let between = |k: usize| pair[0].point.lerp(pair[1].point, k as f64 / steps);
                all.extend((1..steps as usize).map(|k| (ThinSample { point: between(k), ..pair[0] }, 1.0)));
            }
        }
        all.extend(windows.last().map(|last| (*last, 1.0)));
        // Windows at its ends, the last of which it may cover in part.
        for (k, tip) in [windows.first(), windows.last()].into_iter().enumerate() {
            let inner = if k == 0 { windows.get(1) } else { windows.get(windows.len().wrapping_sub(2)) };
            let (Some(tip), Some(inner)) = (tip, inner) else { continue };
            let out = (tip.point - inner.point).normalized().unwrap_or_default();
            let longer = line.chain.ends[k];
            let beyond = |n: usize| {
                (ThinSample { point: tip.point + out * n as f64, ..*tip }, (longer + 1.0 - n as f64).min(1.0))
            };
            all.extend((1..=longer.ceil() as usize).map(beyond));
        }
        let mut pixels = BTreeMap::new();
        for (window, covered) in all {
            let along = window.axis.perp();
            let middle = window.point.dot(window.axis);
            let [low, high] = [middle - 0.5 * window.width, middle + 0.5 * window.width];
            let [first, last] = [(low + 0.5).floor(), (high - 0.5).floor()];
            let [first, last] = if last < first { [middle.floor(); 2] } else { [first, last] };
            let mut at = first;
            while at <= last {
                let [x, y] = pixel(along * window.point.dot(along) + window.axis * (at + 0.5));
                if x < self.size[0] && y < self.size[1] {
                    let share = (high.min(at + 1.0) - low.max(at)).clamp(0.0, 1.0);
                    pixels.insert(y * self.size[0] + x, (covered * share) as f32);
                }
                at += 1.0;
            }
        }
        pixels
    }

    /// Pieces that some pixels between the first column and row and those after the last make, where touching at corners is touching.
    fn pieces(&self, [left, top, right, bottom]: [usize; 4], is_own: impl Fn(usize) -> bool) -> Vec<Vec<usize>> {
        let columns = right - left;
        let mut is_seen = alloc::vec![false; columns * (bottom - top)];
        let mut open: Vec<[usize; 2]> = Vec::new();
        let mut pieces = Vec::new();
        for (x, y) in (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y))) {
            open.push([x, y]);
            let mut piece = Vec::new();
            while let Some([x, y]) = open.pop() {
                let is_within = (left..right).contains(&x) && (top..bottom).contains(&y);
                if !is_within || !is_own(y * self.size[0] + x) {
                    continue;
                }
                if core::mem::replace(&mut is_seen[(y - top) * columns + x - left], true) {
                    continue;
                }
                piece.push(y * self.size[0] + x);
                open.extend((0..9).map(|k| [(x + k % 3).wrapping_sub(1), (y + k / 3).wrapping_sub(1)]));
            }
            if !piece.is_empty() {
                pieces.push(piece);
            }
        }
        pieces
    }
}

impl Sliver {
    fn sample(&self, crack: Crack) -> Option<Sample> {
        let axis = match crack.heading {
            Heading::PlusX | Heading::MinusX => Vec2::new(0.0, 1.0),
            Heading::PlusY | Heading::MinusY => Vec2::new(1.0, 0.0),
        };
        let [from, to] = [crack.start, crack.end()].map(|[x, y]| Vec2::new(x as f64, y as f64));
        let middle = from.lerp(to, 0.5);
        let along = axis.perp();
        let is_here = |window: &&ThinSample| window.axis == axis && (window.point - middle).dot(along).abs() < 0.5;
        let off = |window: &ThinSample| (window.point - middle).dot(axis);
        let window = self.windows.iter().filter(is_here).min_by(|a, b| off(a).abs().total_cmp(&off(b).abs()))?;
        let side = if off(window) > 0.0 { -0.5 } else { 0.5 };
        let point = window.point + axis * (side * window.width);
        ((point - middle).dot(axis).abs() < tuning::SLIVER_NEAR).then_some(Sample::new(point, axis, window.sigma))
    }
}

/// The pixel that a place lies in; beyond the picture to the left and above it is no pixel.
fn pixel(at: Vec2<f64>) -> [usize; 2] {
    [at.x, at.y].map(|value| if value < 0.0 { usize::MAX } else { value as usize })
}
