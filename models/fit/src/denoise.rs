//! Pictures without their noise: what finds regions here, for others who look at pictures.
//!
//! In: a picture. Out: its noise level, and the picture with as much noise averaged away.

use alloc::vec::Vec;

use dvp_core::{Image, ImageView, Real};

use crate::segment::{PIXEL_NOISE, denoise_twice, noise_level};

/// The picture with its noise averaged away where its edges stay (non-local means, twice), values in the unit of the picture; none if
/// its noise is that of 8 bits or less, or it holds NaN or infinity.
///
/// Noise is independent from pixel to pixel. What compression leaves beside edges is no such noise, and stays.
#[must_use]
pub fn denoised<T: Real>(image: ImageView<'_, T>) -> Option<Image<T>> {
    if !image.data().iter().all(|value| value.is_finite()) {
        return None;
    }
    let noise = noise_level(&image, &mut Vec::new());
    if noise <= T::of(PIXEL_NOISE) {
        return None;
    }
    let (mut scratch, mut first, mut second) = (Default::default(), Vec::new(), Vec::new());
    denoise_twice(&image, noise, &mut scratch, &mut first, &mut second);
    Image::from_planar(image.size(), second).ok()
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use dvp_core::{Image, ImageSize};

    use super::denoised;

    /// Two halves, and a noise that takes three values in an order that does not repeat itself.
    fn picture(noise: f64) -> Image<f64> {
        let size = ImageSize::new(48, 48).unwrap();
        let mut state = 7_u64;
        let values: Vec<f64> = (0..3 * size.pixels())
            .map(|i| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let level = if i % 48 < 24 { 0.3 } else { 0.7 };
                level + noise * (f64::from(u32::try_from(state >> 33).unwrap() % 3) - 1.0)
            })
            .collect();
        Image::from_planar(size, values).unwrap()
    }

    #[test]
    fn noise_goes_and_edges_stay() {
        let (clean, noisy) = (picture(0.0), picture(0.05));
        let found = denoised(noisy.view()).unwrap();
        let off = |image: &Image<f64>| image.data().iter().zip(clean.data()).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        assert!(off(&found) < 0.1 * off(&noisy), "{} of {}", off(&found), off(&noisy));
    }

    #[test]
    fn pictures_without_noise_or_with_numbers_that_are_none_are_left_alone() {
        assert_eq!(denoised(picture(0.0).view()), None);
        assert_eq!(denoised(picture(0.002).view()), None);
        let mut broken = picture(0.05);
        broken.data_mut()[5] = f64::NAN;
        assert_eq!(denoised(broken.view()), None);
    }
}
