//! What is known of each flat region: its color, its extent, how much of the image border it touches.

use alloc::vec::Vec;

use dvp_core::sort::median_by;
use dvp_core::{ImageView, Real};

use super::flat::FlatMap;
use crate::tuning::{CORE_PIXELS, RIM_COLOR};

/// Pixels looked at for the color of a region of a picture without noise.
const COLOR_SAMPLES: usize = 63;
/// Pixels looked at under noise: the median is as good as the mean of two thirds of them.
const NOISY_SAMPLES: usize = 4095;
/// Standard deviation of a median in units of that of a mean.
const MEDIAN_SPREAD: f64 = 1.25;

/// A connected region of flat pixels.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Region<T> {
    pub(crate) color: [T; 3],
    /// Standard deviation of each channel of the color that noise makes, or edges nearby; 0 for large regions without noise.
    pub(crate) doubt: T,
    pub(crate) pixels: usize,
    /// Sums over pixel centers: x, y, xx, xy, yy (px).
    pub(crate) sums: [T; 5],
    /// Pixels on the first or last row or column.
    pub(crate) border: usize,
    /// First column, first row, last column + 1, last row + 1.
    pub(crate) bounds: [u32; 4],
}

/// Fills `regions` from labels; region k of the map is `regions[k - 1]`.
///
/// The color is the median of pixels spread over the region: triangulation seams and near-edge pixels are outvoted.
pub(crate) fn measure<T: Real>(
    image: &ImageView<'_, T>,
    map: &FlatMap,
    noise: T,
    regions: &mut Vec<Region<T>>,
    scratch: &mut Vec<Vec<[T; 3]>>,
) {
    let (width, height) = (image.size().width(), image.size().height());
    let half = T::of(0.5);
    regions.clear();
    let nowhere = [u32::MAX, u32::MAX, 0, 0];
    regions.resize(map.region_count, Region { bounds: nowhere, ..Region::default() });
    scratch.resize_with(scratch.len().max(map.region_count), Vec::new);
    for run in &map.runs {
        let region = &mut regions[run.label as usize - 1];
        let (start, end, row) = (run.start as usize, run.end as usize, run.row as usize);
        let n = T::of_usize(end - start);
        region.pixels += end - start;
        // x runs over start + 0.5 .. end - 0.5: sums of an arithmetic series.
        let mean = half * T::of_usize(start + end);
        let y = T::of_usize(row) + half;
        let spread = n * (n * n - T::one()) / T::of(12.0);
        region.sums[0] += n * mean;
        region.sums[1] += n * y;
        region.sums[2] += n * mean * mean + spread;
        region.sums[3] += n * mean * y;
        region.sums[4] += n * y * y;
        let [left, top, right, bottom] = region.bounds;
        region.bounds = [left.min(run.start), top.min(run.row), right.max(run.end), bottom.max(run.row + 1)];
        region.border += if row == 0 || row + 1 == height {
            end - start
        } else {
            usize::from(start == 0) + usize::from(end == width)
        };
    }
    for samples in scratch.iter_mut() {
        samples.clear();
    }
    let most = if noise > T::zero() { NOISY_SAMPLES } else { COLOR_SAMPLES };
    let mut seen = [0usize; 64];
    for run in &map.runs {
        let k = run.label as usize - 1;
        let stride = 1 + regions[k].pixels / most;
        // Where in the region's own count of pixels this run starts; beyond 64 regions each run starts afresh.
        let counted = seen.get(k).copied().unwrap_or(0);
        let offset = (stride - counted % stride) % stride;
        let row = run.row as usize * width;
        let mut x = run.start as usize + offset;
        while x < run.end as usize {
            scratch[k].push(image.pixel(row + x));
            x += stride;
        }
        if let Some(count) = seen.get_mut(k) {
            *count += (run.end - run.start) as usize;
        }
    }
    for (region, samples) in regions.iter_mut().zip(scratch.iter_mut()) {
        for c in 0..3 {
            region.color[c] = median_by(samples, |color| color[c]).unwrap_or_default();
        }
        region.doubt = if noise > T::zero() || region.pixels >= CORE_PIXELS {
            noise * T::of(MEDIAN_SPREAD) / T::of_usize(samples.len().max(1)).sqrt()
        } else {
            T::of(RIM_COLOR) / T::of_usize(region.pixels.max(1))
        };
    }
}
