//! Noise that is independent from pixel to pixel: how much of it a picture has, and the picture without.
//!
//! In: a picture. Out: its noise level (`level`), the picture with as much noise averaged away (`means`), and with noise of one level where it
//! grows with the light (`shot`).

mod level;
mod means;
mod shot;
#[cfg(test)]
pub(crate) mod tests;

use alloc::vec::Vec;

use dvp_core::{Image, ImageView, Real};

use crate::tuning;

pub use level::noise_level;
pub use means::DenoiseScratch;
pub use shot::{Evened, NoiseLaw, evened};

/// Noise of rounding to 8 bits, and as much again: below it there is nothing to average away.
pub const ROUNDED: f64 = 0.003;

/// Fills `smooth` (planar) with the picture, of which noise of standard deviation `noise` is averaged away; `first` becomes what
/// neighborhoods are judged by.
#[inline(never)]
pub fn denoise_twice<T: Real>(
    image: &ImageView<'_, T>,
    noise: T,
    scratch: &mut DenoiseScratch<T>,
    first: &mut Vec<T>,
    smooth: &mut Vec<T>,
) {
    let two_variances = T::of(2.0) * noise * noise;
    let settings =
        means::DenoiseSettings { reach: tuning::DENOISE_REACH, expected: two_variances, limit: two_variances };
    means::denoise(image, image, settings, scratch, first);
    let Ok(guide) = ImageView::new(image.size(), first) else { return };
    let left = two_variances * T::of(tuning::DENOISE_LEFT * tuning::DENOISE_LEFT);
    let settings = means::DenoiseSettings { expected: left, limit: T::of(2.0) * left, ..settings };
    means::denoise(image, &guide, settings, scratch, smooth);
}

/// The picture with its noise averaged away, and the standard deviation of that noise, in the unit of the picture; none if its noise is that of
/// 8 bits or less, or it holds NaN or infinity.
///
/// Noise is independent from pixel to pixel. What compression leaves beside edges is no such noise, and stays.
#[must_use]
#[inline(never)]
pub fn denoised<T: Real>(image: ImageView<'_, T>) -> Option<(Image<T>, T)> {
    let noise = level_above_rounding(&image)?;
    Some((averaged(&image, noise)?, noise))
}

/// The noise level of a picture; none if it is that of 8 bits or less, or the picture holds NaN or infinity.
pub(crate) fn level_above_rounding<T: Real>(image: &ImageView<'_, T>) -> Option<T> {
    if !image.data().iter().all(|value| value.is_finite()) {
        return None;
    }
    Some(noise_level(image, &mut Vec::new())).filter(|&noise| noise > T::of(ROUNDED))
}

/// The picture with noise of standard deviation `noise` averaged away where its edges stay (non-local means, twice).
#[inline(never)]
pub(crate) fn averaged<T: Real>(image: &ImageView<'_, T>, noise: T) -> Option<Image<T>> {
    let (mut scratch, mut first, mut second) = (Default::default(), Vec::new(), Vec::new());
    denoise_twice(image, noise, &mut scratch, &mut first, &mut second);
    Image::from_planar(image.size(), second).ok()
}
