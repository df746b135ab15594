//! Flat regions of a picture with noise: denoised, partitioned, and freed from the soft pixels along their boundaries.
//!
//! In: a picture. Out: a [`FlatMap`] like that of a picture without noise, and the denoised picture to place soft pixels by.
//! `dvp_trace::regions` partitions, `strips` tells strips of soft pixels that became
//! regions of their own from thin objects; here pixels near boundaries are freed.

mod strips;
#[cfg(test)]
mod tests;

use alloc::vec::Vec;

use dvp_core::{ImageView, Real};
use dvp_trace::noise::{DenoiseScratch, denoise_twice};
use dvp_trace::regions::{Halo, merged_zones};

use super::flat::FlatMap;
use crate::colors::repeated;
use crate::tuning::{
    HALO_COLOR, HALO_PIXELS, HALO_WIDTH_PX, MIN_REGION_PIXELS, SOFT_RINGS, STRIP_WIDTH_PX, ZONE_NOISE,
};
use strips::{Zone, find_strips, measure_zones};

/// Label of pixels that belong to no region.
const SOFT: u32 = u32::MAX;

/// Settings of [`read_flat`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct RobustSettings<T> {
    /// Standard deviation of a channel that is averaged away.
    pub(crate) noise: T,
    /// Regions that differ from a neighbor by less than about this share of the contrast they stand beside are merged.
    pub(crate) halo: T,
    /// Regions up to this wide (px; twice the area over the boundary) may be strips along an edge.
    pub(crate) strip_width: T,
    /// Largest difference between denoised neighbors that are never cut apart.
    pub(crate) zone: T,
    /// What a boundary must pay, in units of the usual price.
    pub(crate) boundary: T,
}

impl<T: Real> RobustSettings<T> {
    /// For noise that is everywhere alike.
    pub(crate) fn of(noise: T) -> Self {
        let zone = T::of(ZONE_NOISE) * noise;
        Self { noise, halo: T::zero(), strip_width: T::of(STRIP_WIDTH_PX), zone, boundary: T::one() }
    }
}

/// Memory of [`read_flat`].
#[derive(Clone, Debug, Default)]
pub(crate) struct RobustScratch<T> {
    denoise: DenoiseScratch<T>,
    first: Vec<T>,
    /// The denoised picture, planar.
    pub(crate) smooth: Vec<T>,
    labels: Vec<u32>,
    eroded: Vec<u32>,
    zones: Vec<Zone<T>>,
    steps: Vec<(u32, u32)>,
}

/// Fills `map` and the denoised picture.
pub(crate) fn read_flat<T: Real>(
    image: &ImageView<'_, T>,
    settings: RobustSettings<T>,
    most_regions: usize,
    scratch: &mut RobustScratch<T>,
    map: &mut FlatMap,
) {
    let RobustSettings { noise, halo, strip_width, zone, boundary } = settings;
    denoise_twice(image, noise, &mut scratch.denoise, &mut scratch.first, &mut scratch.smooth);
    let Ok(smooth) = ImageView::new(image.size(), &scratch.smooth) else { return };
    let variance = (boundary * noise * noise).as_f64() * repeated(image);
    let halo = (halo > T::zero()).then(|| Halo {
        share: halo.as_f64(),
        pixels: HALO_PIXELS,
        width_px: HALO_WIDTH_PX,
        color: HALO_COLOR,
    });
    let count = merged_zones([image, &smooth], zone, (variance, most_regions), halo, &mut scratch.labels);
    measure_zones(&smooth, count, &scratch.labels, &mut scratch.zones, &mut scratch.steps);
    find_strips(&mut scratch.zones, &scratch.steps, strip_width, T::of(0.02) + noise);
    let deviation = T::of(0.008) + T::of(0.5) * noise;
    erode(&smooth, &scratch.zones, &mut scratch.labels, &mut scratch.eroded, deviation);
    restore_small(&mut scratch.zones, &scratch.labels, &mut scratch.eroded);
    map.set(image.size(), &scratch.eroded, SOFT);
}

/// Frees zones from strips, from pixels beside another zone, and from those near a boundary that deviate from the color of
/// their zone.
fn erode<T: Real>(
    smooth: &ImageView<'_, T>,
    zones: &[Zone<T>],
    labels: &mut [u32],
    eroded: &mut Vec<u32>,
    deviation: T,
) {
    let (width, pixels) = (smooth.size().width(), smooth.size().pixels());
    eroded.clear();
    eroded.extend_from_slice(labels);
    for (i, label) in eroded.iter_mut().enumerate() {
        let own = labels[i];
        let x = i % width;
        let other = |there: bool, j: usize| there && labels[j] != own;
        let beside = other(x > 0, i.wrapping_sub(1))
            || other(x + 1 < width, i + 1)
            || other(i >= width, i.wrapping_sub(width))
            || other(i + width < pixels, i + width);
        if beside || zones[own as usize].strip {
            *label = SOFT;
        }
    }
    let mut before = Vec::new();
    for _ in 1..SOFT_RINGS {
        before.clear();
        before.extend_from_slice(eroded);
        for (i, label) in eroded.iter_mut().enumerate() {
            if *label == SOFT {
                continue;
            }
            let x = i % width;
            let soft = |there: bool, j: usize| there && before[j] == SOFT;
            let beside = soft(x > 0, i.wrapping_sub(1))
                || soft(x + 1 < width, i + 1)
                || soft(i >= width, i.wrapping_sub(width))
                || soft(i + width < pixels, i + width);
            if beside {
                let (own, color) = (zones[*label as usize].color, smooth.pixel(i));
                if (0..3).any(|c| (own[c] - color[c]).abs() > deviation) {
                    *label = SOFT;
                }
            }
        }
    }
}

/// Zones that erosion left nothing of get their pixels back.
fn restore_small<T: Real>(zones: &mut [Zone<T>], labels: &[u32], eroded: &mut [u32]) {
    for &label in eroded.iter().filter(|&&label| label != SOFT) {
        zones[label as usize].flat += 1;
    }
    for (label, &own) in eroded.iter_mut().zip(labels) {
        let zone = &zones[own as usize];
        if zone.flat < MIN_REGION_PIXELS && !zone.strip {
            *label = if zone.pixels >= MIN_REGION_PIXELS { own } else { SOFT };
        }
    }
}
