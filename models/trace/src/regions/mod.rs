//! Pictures that are not flat, such as photographs, as regions of one color each.
//!
//! *Source*: the functional of Mumford and Shah (1989) with constant colors, by merging regions (Koepfler, Lopez and Morel, 1994): of two neighbors those
//! become one first that miss the picture least more by it, per pixel of the boundary that they lose. Neighbors that are each other's best are merged at
//! once, all over the picture, so that a picture of a million pixels takes as many rounds as one of a thousand.

mod merge;
#[cfg(test)]
mod tests;

use alloc::vec::Vec;

use dvp_core::contour::{Connectivity, label_by};
use dvp_core::{Image, ImageView, Real};

use merge::Merging;

/// Squared error that a pixel of a boundary must save, in units of the variance of noise and of what is not seen: two natural logarithms for every bit, of
/// which the next step of a boundary takes one and more. Half and twice as much are in `tests/report/sensitivity.md`.
const BOUNDARY_PRICE: f64 = 3.0;
/// Standard deviation of what is not seen, of 1.
const UNSEEN: f64 = 0.03;

/// A picture as regions of one color.
#[derive(Clone, Debug)]
pub struct Regions {
    /// The picture in the colors of its regions.
    pub image: Image<f32>,
    /// The region of every pixel, row by row.
    pub labels: Vec<u32>,
    /// How many regions there are.
    pub count: usize,
}

/// At most `most` regions (one at least) of a picture whose noise has the standard deviation `noise`; fewer where more would say what is not seen.
#[must_use]
#[inline(never)]
pub fn regions(image: &ImageView<'_, f32>, most: usize, noise: f64) -> Regions {
    let mut labels = Vec::new();
    let count = zones(image, 0.0, &mut labels);
    let mut merging = Merging::of(image, &labels, count);
    merging.run(BOUNDARY_PRICE * (noise * noise + UNSEEN * UNSEEN), most.max(1));
    let colors = merging.finish(&mut labels);
    let mut flat = Image::zeros(image.size());
    for (c, channel) in flat.data_mut().chunks_exact_mut(labels.len()).enumerate() {
        channel.iter_mut().zip(&labels).for_each(|(value, &label)| *value = colors[label as usize][c] as f32);
    }
    Regions { image: flat, labels, count: colors.len() }
}

/// What coders leave beside edges.
#[derive(Clone, Copy, Debug)]
pub struct Halo {
    /// It costs up to this share, squared, of the largest contrast (squared) that the smaller of two regions stands beside.
    pub share: f64,
    /// Larger regions (pixels) are none,
    pub pixels: f64,
    /// if they are wider than this (px; twice the area over the boundary)
    pub width_px: f64,
    /// and differ by more than this (of 1).
    pub color: f64,
}

impl Halo {
    /// Whether a region of so many pixels and so long a boundary may be something of its own.
    fn is_own(&self, pixels: f64, boundary: f64) -> bool {
        pixels > self.pixels && 2.0 * pixels > self.width_px * boundary
    }
}

/// Zones of pixels that differ by at most `tolerance` (per channel) from a direct neighbor in `smooth`, merged by the colors of `image` where a pixel of
/// boundary saves too little beside noise of this `variance`, and on until there are no more than `most`. `labels` gets the region of every
/// pixel, numbered from 0 in the order of their first ones; returns how many there are.
#[inline(never)]
pub fn merged_zones<T: Real>(
    [image, smooth]: [&ImageView<'_, T>; 2],
    tolerance: T,
    (variance, most): (f64, usize),
    halo: Option<Halo>,
    labels: &mut Vec<u32>,
) -> usize {
    let count = zones(smooth, tolerance, labels);
    let mut merging = Merging::of(image, labels, count);
    let worth = BOUNDARY_PRICE * variance;
    merging.run(worth, most);
    if let Some(halo) = halo {
        merging.clear_halos(worth, halo);
    }
    merging.finish(labels).len()
}

/// Zones of pixels that differ by at most `tolerance` (per channel) from a direct neighbor; returns how many there are.
fn zones<T: Real>(image: &ImageView<'_, T>, tolerance: T, labels: &mut Vec<u32>) -> usize {
    let [r, g, b] = [0, 1, 2].map(|c| image.channel(c));
    let alike = |i: usize, j: usize| (r[i] - r[j]).abs().max((g[i] - g[j]).abs()).max((b[i] - b[j]).abs()) <= tolerance;
    let zones = label_by(image.size(), Connectivity::Four, |_| true, alike);
    labels.clear();
    labels.extend(zones.labels.into_iter().map(|label| label - 1));
    zones.sizes.len()
}
