//! What the soft pixels between the background and one object say about the edges of a picture.
//!
//! *Softness*: sum p (1 - p) / sum |grad p| over the soft pixels. By the coarea formula the denominator is the length of the
//! edges, whatever their direction, so that this is the integral of p (1 - p) across an edge, px: 0 for hard pixels, 1/6 on
//! average for area coverage, s for a logistic of scale s, and std / sqrt(pi) for a Gaussian blur.
//!
//! *Lopsidedness*: the reference's coverage lingers near 1 and drops off fast. Its soft pixels divide into low : middle :
//! high as 0.16 : 0.48 : 0.36, those of area coverage as 0.13 : 0.74 : 0.13, of blur as 0.21 : 0.58 : 0.21, at random
//! distances; edges along the pixel grid stray from that.

use dvp_core::render::EdgeProfile;
use dvp_core::{ImageView, Real};

use super::EdgeKind;
use crate::tuning::{
    AREA_SOFTNESS_PX, EDGE_LINE, EDGE_LINE_NOISES, EDGE_PIXELS, HARD_SOFTNESS_PX, LOPSIDED_LEAST, LOPSIDED_SURELY,
};

/// Sigma of the nearest logistic over the softness of a Gaussian: sqrt(pi) / 1.702.
const LOGISTIC: f64 = 1.041;
/// Softness of the reference renderer per pixel of the shorter image side.
const REFERENCE_SOFTNESS: f64 = 1.157e-3;
/// Softness found over the reference's may lie between these: coarse pixels sample a steep edge badly.
const REFERENCE_RANGE: [f64; 2] = [0.55, 1.65];
/// (high - low) / soft of the reference, and its standard deviation times the root of the number of soft pixels.
const LOPSIDED: f64 = 0.2;
const LOPSIDED_NOISE: f64 = 0.7;

/// Counts and sums over soft pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct EdgeEvidence<T> {
    /// Noise per channel; 0 where there is none but rounding.
    pub(crate) noise: T,
    /// Coverage below 0.015 or above 0.985.
    pub(crate) settled: usize,
    /// 0.015 to 0.1.
    pub(crate) low: usize,
    /// 0.1 to 0.9.
    pub(crate) middle: usize,
    /// 0.9 to 0.985.
    pub(crate) high: usize,
    /// Sum of p (1 - p) over the pixels that were measured.
    pub(crate) spread: T,
    /// Sum of |grad p| over the same pixels: by the coarea formula the length of the edges in them, px.
    pub(crate) length: T,
}

impl<T: Real> EdgeEvidence<T> {
    /// Counts a pixel.
    pub(crate) fn count(&mut self, coverage: T) {
        if coverage < T::of(0.015) || coverage > T::of(0.985) {
            self.settled += 1;
        } else if coverage < T::of(0.1) {
            self.low += 1;
        } else if coverage <= T::of(0.9) {
            self.middle += 1;
        } else {
            self.high += 1;
        }
    }

    /// Softness of the edges, px; none if too little was measured.
    pub(crate) fn softness(&self) -> Option<T> {
        (self.length > T::of(4.0)).then(|| self.spread / self.length)
    }

    /// Whether edges are about as wide as the reference's, at `unit_px` pixels per scene unit.
    pub(crate) fn may_be_reference(&self, unit_px: T) -> bool {
        let ratio = |softness: T| (softness / (unit_px * T::of(REFERENCE_SOFTNESS))).as_f64();
        let in_range = |softness| (REFERENCE_RANGE[0]..REFERENCE_RANGE[1]).contains(&ratio(softness));
        self.low + self.middle + self.high >= EDGE_PIXELS && self.softness().is_some_and(in_range)
    }

    /// The kind that the pixels speak for, and another one to try where they leave a doubt, at `unit_px` pixels per scene
    /// unit.
    pub(crate) fn kinds(&self, unit_px: T) -> (EdgeKind<T>, Option<EdgeKind<T>>) {
        let reference = EdgeKind::Profile(EdgeProfile::reference());
        let soft = self.low + self.middle + self.high;
        let Some(softness) = self.softness().filter(|_| soft + self.settled >= EDGE_PIXELS) else {
            return (reference, None);
        };
        let other = if softness < T::of(HARD_SOFTNESS_PX) {
            EdgeKind::Hard
        } else if softness < T::of(AREA_SOFTNESS_PX) {
            EdgeKind::Area
        } else {
            let sigma_px = softness * T::of(LOGISTIC);
            EdgeKind::Profile(EdgeProfile::distance(sigma_px * T::of(2.0) / unit_px))
        };
        if !self.may_be_reference(unit_px) {
            return (other, None);
        }
        let count = T::of_usize(soft).as_f64();
        let lopsided = (T::of_usize(self.high) - T::of_usize(self.low)).as_f64() / count;
        let least = (LOPSIDED - 3.0 * LOPSIDED_NOISE / num_traits::Float::sqrt(count)).min(LOPSIDED_LEAST);
        // Edges along the grid show few coverages; where there are many, areas have far fewer high ones.
        let many = 20 * self.low > soft && 4 * self.middle > soft && 2 * self.high > self.middle;
        let surely = many && (other == EdgeKind::Area || lopsided > LOPSIDED_SURELY);
        if surely {
            (reference, None)
        } else if self.noise > T::zero() || (lopsided > least && 10 * self.high > self.middle) {
            // Noise, and what takes it off, make coverages even.
            (reference, Some(other))
        } else {
            (other, None)
        }
    }

    /// Measures a pixel between regions of the two colors; one at the border of the image, or beside something else, tells
    /// nothing.
    pub(crate) fn measure(&mut self, image: &ImageView<'_, T>, [x, y]: [u32; 2], [from, to]: [[T; 3]; 2]) {
        let (width, height) = (image.size().width(), image.size().height());
        let (x, y) = (x as usize, y as usize);
        if x == 0 || y == 0 || x + 1 >= width || y + 1 >= height {
            return;
        }
        let line: [T; 3] = core::array::from_fn(|c| to[c] - from[c]);
        let per_length = line.iter().map(|&d| d * d).sum::<T>().recip();
        let at = y * width + x;
        let tolerance = (self.noise * T::of(EDGE_LINE_NOISES)).max(T::of(EDGE_LINE)).powi(2);
        let share = |index: usize| {
            let color = image.pixel(index);
            let from_start: [T; 3] = core::array::from_fn(|c| color[c] - from[c]);
            let dot = from_start.iter().zip(&line).map(|(&a, &b)| a * b).sum::<T>();
            let off = from_start.iter().map(|&a| a * a).sum::<T>() - dot * dot * per_length;
            (off <= tolerance).then_some(dot * per_length)
        };
        if let [Some(p), Some(left), Some(right), Some(up), Some(down)] =
            [at, at - 1, at + 1, at - width, at + width].map(share)
        {
            let [gx, gy] = [right - left, down - up];
            // What noise adds to squares on average is taken off.
            let variance = self.noise * self.noise * per_length;
            self.spread += p * (T::one() - p) + variance;
            self.length += T::of(0.5) * (gx * gx + gy * gy - T::of(4.0) * variance).max(T::zero()).sqrt();
        }
    }
}
