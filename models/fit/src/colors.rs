//! Colors finer than 8 bits, from soft pixels.
//!
//! Rounding hides up to half a step of every flat color, but each soft pixel mixes two of them in its own proportion
//! before it is rounded: hundreds of differently rounded sums together tell the colors to a small part of a step. Poses
//! must stand, so that the proportions are known; the image is linear in the colors then.

use alloc::vec::Vec;

use dvp_core::render::Compositing;
use dvp_core::scene::Layer;
use dvp_core::{ImageView, Real};

use crate::cholesky::{factor, packed, solve};
use crate::tuning::{MIXTURE_OUTLIER, SOFT_PIXEL_NOISE};

/// Steps of an 8-bit channel.
const STEPS: f64 = 255.0;
/// How far from a multiple of 1/255 a value may be to count as rounded.
const ROUNDED: f64 = 1e-5;
/// Coverage planes of at most this many values are taken: beyond it, colors stay as they are.
pub(crate) const MAX_COVERAGE_VALUES: usize = 1 << 22;

/// Memory of [`refine_colors`].
#[derive(Clone, Debug, Default)]
pub(crate) struct ColorScratch<T> {
    pub(crate) coverage: Vec<T>,
    matrix: Vec<T>,
    sides: [Vec<T>; 3],
    layers: Vec<Layer<T>>,
    /// Of the objects, then of the background.
    shares: Vec<T>,
}

/// Whether every value is a multiple of 1/255.
pub(crate) fn is_rounded<T: Real>(values: impl IntoIterator<Item = T>) -> bool {
    values.into_iter().all(|value| {
        let steps = value * T::of(STEPS);
        (steps - steps.round()).abs() <= T::of(ROUNDED * STEPS)
    })
}

/// How often a picture says what it says: noise that is the same in all channels is no evidence three times over.
pub(crate) fn repeated<T: Real>(image: &ImageView<'_, T>) -> f64 {
    let [red, green, blue] = [0, 1, 2].map(|c| image.channel(c));
    if red == green && red == blue { 3.0 } else { 1.0 }
}

/// The nearest color of whole steps.
pub(crate) fn round_color<T: Real>(color: &mut [T; 3]) {
    for value in color {
        *value = (*value * T::of(STEPS)).round() / T::of(STEPS);
    }
}

/// Moves background (last) and object colors by at most half a step, so that the soft `pixels` are explained best.
///
/// `coverage` of the scratch holds a plane per object; objects are fully confident and `blend` into each other.
pub(crate) fn refine_colors<T: Real>(
    image: &ImageView<'_, T>,
    pixels: impl Iterator<Item = usize>,
    colors: &mut [[T; 3]],
    scratch: &mut ColorScratch<T>,
) {
    let n = colors.len();
    let objects = n - 1;
    let plane = image.size().pixels();
    let step = T::one() / T::of(STEPS);
    // The rounded color is within a uniform half step: standard deviation step / sqrt(12).
    let prior = T::of(12.0) / (step * step);
    let data = T::one() / T::of(SOFT_PIXEL_NOISE * SOFT_PIXEL_NOISE);
    scratch.matrix.clear();
    scratch.matrix.resize(packed(n, 0), T::zero());
    for side in &mut scratch.sides {
        side.clear();
        side.resize(n, T::zero());
    }
    for i in 0..n {
        scratch.matrix[packed(i, i)] = prior;
    }
    scratch.layers.clear();
    scratch.layers.extend(colors[..objects].iter().map(|&color| Layer::new(color, T::zero(), T::one())));
    scratch.shares.clear();
    scratch.shares.resize(n, T::zero());
    for index in pixels {
        let coverage = &scratch.coverage;
        for (k, layer) in scratch.layers.iter_mut().enumerate() {
            layer.coverage = coverage[k * plane + index];
        }
        scratch.shares[objects] = Compositing::Blend.shares(&scratch.layers, &mut scratch.shares[..objects]);
        let target = image.pixel(index);
        let mut residual = target;
        for (color, &share) in colors.iter().zip(&scratch.shares) {
            for c in 0..3 {
                residual[c] -= share * color[c];
            }
        }
        if residual.iter().any(|r| r.abs() > T::of(MIXTURE_OUTLIER)) {
            continue;
        }
        for i in 0..n {
            let share = scratch.shares[i];
            if share <= T::zero() {
                continue;
            }
            let weighted = data * share;
            for (side, r) in scratch.sides.iter_mut().zip(residual) {
                side[i] += weighted * r;
            }
            let row = &mut scratch.matrix[packed(i, 0)..=packed(i, i)];
            for (value, &other) in row.iter_mut().zip(&scratch.shares) {
                *value += weighted * other;
            }
        }
    }
    if !factor(&mut scratch.matrix, n) {
        return;
    }
    let half = T::of(0.5) * step;
    for (c, side) in scratch.sides.iter_mut().enumerate() {
        solve(&scratch.matrix, n, side);
        for (color, &change) in colors.iter_mut().zip(side.iter()) {
            color[c] = (color[c] + change.max(-half).min(half)).max(T::zero()).min(T::one());
        }
    }
}
