//! What happens to pictures on their way: noise, compression, blur. From seeds, so that every run sees the same.

use image::RgbImage;
use jpeg_encoder::{ColorType, Encoder, SamplingFactor};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Adds independent Gaussian noise of standard deviation `sigma` (1 is full contrast) to every channel, then rounds and
/// clips to 8 bits.
pub fn add_noise(picture: &mut RgbImage, sigma: f64, seed: u64) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    for value in picture.iter_mut() {
        // Box and Muller's transform of two uniform numbers.
        let (u, v): (f64, f64) = (1.0 - rng.random::<f64>(), rng.random());
        let normal = (-2.0 * u.ln()).sqrt() * (core::f64::consts::TAU * v).cos();
        *value = to_byte(f64::from(*value) + 255.0 * sigma * normal);
    }
}

/// Convolves with a Gaussian of standard deviation `sigma_px`; beyond the border the picture goes on as at the border.
#[must_use]
pub fn blurred(picture: &RgbImage, sigma_px: f64) -> RgbImage {
    let reach = (4.0 * sigma_px).ceil();
    let offsets: Vec<f64> = (0..).map(|i| f64::from(i) - reach).take_while(|&offset| offset <= reach).collect();
    let weights: Vec<f64> = offsets.iter().map(|offset| (-0.5 * (offset / sigma_px).powi(2)).exp()).collect();
    let total: f64 = weights.iter().sum();
    let [width, height] = [picture.width(), picture.height()];
    // Both passes at once, in floating point: rounding in between would leave steps.
    let at = |x: u32, y: u32, step: [f64; 2]| {
        let place = |from: u32, step: f64, side: u32| {
            let inside = (f64::from(from) + step).clamp(0.0, f64::from(side - 1));
            (0..side).nth(to_index(inside)).unwrap_or(0)
        };
        picture.get_pixel(place(x, step[0], width), place(y, step[1], height)).0
    };
    let mut rows = vec![[0.0; 3]; to_index(f64::from(width) * f64::from(height))];
    for (sum, (x, y)) in rows.iter_mut().zip((0..height).flat_map(|y| (0..width).map(move |x| (x, y)))) {
        for (offset, weight) in offsets.iter().zip(&weights) {
            let color = at(x, y, [*offset, 0.0]);
            sum.iter_mut().zip(color).for_each(|(sum, value)| *sum += weight / total * f64::from(value));
        }
    }
    RgbImage::from_fn(width, height, |x, y| {
        let mut sum = [0.0; 3];
        for (offset, weight) in offsets.iter().zip(&weights) {
            let row = (f64::from(y) + offset).clamp(0.0, f64::from(height - 1));
            let color = rows[to_index(row * f64::from(width) + f64::from(x))];
            sum.iter_mut().zip(color).for_each(|(sum, value)| *sum += weight / total * value);
        }
        image::Rgb(sum.map(to_byte))
    })
}

/// The bytes of a JPEG file, its colors at half the resolution as programs write them by default.
///
/// # Errors
/// The encoder's reason.
pub fn jpeg(picture: &RgbImage, quality: u8) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, quality);
    encoder.set_sampling_factor(SamplingFactor::F_2_2);
    let side = |side: u32| u16::try_from(side).map_err(|error| error.to_string());
    encoder
        .encode(picture.as_raw(), side(picture.width())?, side(picture.height())?, ColorType::Rgb)
        .map_err(|error| error.to_string())?;
    Ok(bytes)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [0, 255] before")]
fn to_byte(value: f64) -> u8 {
    value.round().clamp(0.0, 255.0) as u8
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole numbers from 0 up")]
fn to_index(value: f64) -> usize {
    value as usize
}

#[cfg(test)]
mod tests {
    use image::{Rgb, RgbImage};

    use super::{add_noise, blurred, jpeg};

    #[test]
    fn noise_has_the_size_asked_for() {
        let mut picture = RgbImage::from_pixel(100, 100, Rgb([128; 3]));
        add_noise(&mut picture, 0.05, 1);
        let squares: f64 = picture.iter().map(|&value| (f64::from(value) / 255.0 - 128.0 / 255.0).powi(2)).sum();
        // 30 000 draws: the standard deviation is known to 0.4 %; rounding adds 1 / 12 step^2.
        assert!(((squares / 3e4).sqrt() - 0.05).abs() < 0.001);
    }

    #[test]
    fn blur_spreads_a_step_as_its_integral() {
        let picture = RgbImage::from_fn(40, 3, |x, _| Rgb([if x < 20 { 0 } else { 255 }; 3]));
        let soft = blurred(&picture, 1.5);
        // Half a pixel and one and a half beyond the step: the normal distribution at 1/3 and 1.
        assert!(soft.get_pixel(20, 1).0[0].abs_diff(161) <= 1, "{:?}", soft.get_pixel(20, 1));
        assert!(soft.get_pixel(21, 1).0[0].abs_diff(215) <= 1, "{:?}", soft.get_pixel(21, 1));
        assert_eq!((soft.get_pixel(0, 0).0, soft.get_pixel(39, 2).0), ([0; 3], [255; 3]));
    }

    #[test]
    fn compression_keeps_flat_colors_and_loses_edges() {
        let picture = RgbImage::from_fn(32, 32, |x, _| Rgb(if x < 12 { [200, 40, 10] } else { [20, 90, 200] }));
        let read = image::load_from_memory(&jpeg(&picture, 50).unwrap()).unwrap().to_rgb8();
        let off = |x| (0..3).map(|i| read.get_pixel(x, 16).0[i].abs_diff(picture.get_pixel(x, 16).0[i])).max().unwrap();
        assert!(off(28) < 8, "{}", off(28));
        assert!((8..16).map(off).max().unwrap() > 8);
    }
}
