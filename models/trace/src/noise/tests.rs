use alloc::vec::Vec;

use dvp_core::{Image, ImageSize, Real};

use super::means::{DenoiseScratch, DenoiseSettings, denoise};
use super::{denoised, evened, noise_level};

const SIDE: usize = 64;

fn paint(color: impl Fn(usize, usize) -> [f64; 3]) -> Image<f64> {
    let pixels: Vec<f64> = (0..SIDE * SIDE).flat_map(|i| color(i % SIDE, i / SIDE)).collect();
    Image::from_interleaved(ImageSize::new(SIDE, SIDE).unwrap(), &pixels).unwrap()
}

/// Adds normal noise: Box-Muller on a 64-bit linear congruential generator (Knuth's constants).
pub(crate) fn add_noise<T: Real>(image: &mut Image<T>, sigma: f64) {
    let mut state = 1_u64;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(state >> 32).unwrap()) / f64::from(u32::MAX)
    };
    for value in image.data_mut() {
        let (radius, turn) = (uniform().max(1e-12), uniform());
        *value += T::of(sigma * (-2.0 * radius.ln()).sqrt() * (core::f64::consts::TAU * turn).cos());
    }
}

/// The picture in single precision.
fn single(image: &Image<f64>) -> Image<f32> {
    Image::from_planar(image.size(), image.data().iter().map(|&value| value as f32).collect()).unwrap()
}

/// Adds the noise of a camera: its variance is `read` squared and the value over `photons`.
fn add_shot_noise(image: &mut Image<f32>, read: f64, photons: f64) {
    let mut noise = Image::<f64>::zeros(image.size());
    add_noise(&mut noise, 1.0);
    for (value, noise) in image.data_mut().iter_mut().zip(noise.data()) {
        let deviation = (read * read + f64::from(*value) / photons).sqrt();
        *value = (f64::from(*value) + deviation * noise).clamp(0.0, 1.0) as f32;
    }
}

/// A disk of radius 20 with an edge 4 px soft, on another color.
fn soft_disk() -> Image<f64> {
    paint(|x, y| {
        let off = [x, y].map(|v| f64::from(u32::try_from(v).unwrap()) - 31.5);
        let share = ((22.0 - off[0].hypot(off[1])) / 4.0).clamp(0.0, 1.0);
        [0.2 + 0.6 * share, 0.7 - 0.4 * share, 0.5]
    })
}

#[test]
fn the_noise_level_is_found() {
    for sigma in [0.005, 0.01, 0.02, 0.05, 0.1] {
        let mut image = soft_disk();
        add_noise(&mut image, sigma);
        let found = noise_level(&image.view(), &mut Vec::new());
        assert!((found / sigma - 1.0).abs() < 0.1, "{found} is not {sigma}");
        image.data_mut().iter_mut().for_each(|value| *value = (*value * 255.0).round() / 255.0);
        let found = noise_level(&image.view(), &mut Vec::new());
        assert!((found / sigma - 1.0).abs() < 0.1, "{found} of 8 bits is not {sigma}");
    }
}

#[test]
fn noise_cut_off_at_black_is_found() {
    let mut image = paint(|x, y| if x.abs_diff(32).max(y.abs_diff(32)) < 16 { [0.5, 0.4, 0.6] } else { [0.0; 3] });
    add_noise(&mut image, 0.03);
    image.data_mut().iter_mut().for_each(|value| *value = value.clamp(0.0, 1.0));
    let found = noise_level(&image.view(), &mut Vec::new());
    // One black block in 16 happens to lie above 0, and spreads less. Over all blocks it would be 0.017.
    assert!((found / 0.03 - 1.0).abs() < 0.15, "{found}");
}

#[test]
fn pictures_without_noise_have_none() {
    assert!(noise_level(&soft_disk().view(), &mut Vec::new()) < 1e-12);
    let slope = paint(|x, y| [x, y, x + y].map(|v| f64::from(u32::try_from(v).unwrap()) / 128.0));
    assert!(noise_level(&slope.view(), &mut Vec::new()) < 1e-12);
    let one = Image::<f64>::zeros(ImageSize::new(1, 1).unwrap());
    assert!(noise_level(&one.view(), &mut Vec::new()).abs() < 1e-12);
}

fn mean_square(a: &[f64], b: &[f64]) -> f64 {
    let count = f64::from(u32::try_from(a.len()).unwrap());
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>() / count
}

#[test]
fn denoising_keeps_edges() {
    let clean = soft_disk();
    let mut image = clean.clone();
    let sigma: f64 = 0.05;
    add_noise(&mut image, sigma);
    let mut out = Vec::new();
    let settings = DenoiseSettings { reach: 5, expected: 2.0 * sigma * sigma, limit: 2.0 * sigma * sigma };
    denoise(&image.view(), &image.view(), settings, &mut DenoiseScratch::default(), &mut out);
    // A 3 x 3 mean would leave a ninth of the noise and blur the edge.
    let left = mean_square(&out, clean.data()) / (sigma * sigma);
    assert!(left < 0.1, "{left} of the noise is left");
    // A picture without noise stays as it is.
    let nothing = DenoiseSettings { reach: 5, expected: 0.0, limit: 1e-9 };
    denoise(&clean.view(), &clean.view(), nothing, &mut DenoiseScratch::default(), &mut out);
    assert!(mean_square(&out, clean.data()) < 1e-12);
}

#[test]
fn denoising_averages_pairs_once() {
    // 3 x 1 pixels 0, 1, 0.5 of equal neighborhoods at this limit: all pairs have a share near 1, so all become the mean.
    let pixels: Vec<f64> = [0.0, 1.0, 0.5].into_iter().flat_map(|v| [v; 3]).collect();
    let image = Image::from_interleaved(ImageSize::new(3, 1).unwrap(), &pixels).unwrap();
    let mut out = Vec::new();
    let settings = DenoiseSettings { reach: 2, expected: 0.0, limit: 1e9 };
    denoise(&image.view(), &image.view(), settings, &mut DenoiseScratch::default(), &mut out);
    assert!(out.iter().all(|v| (v - 0.5).abs() < 1e-6), "{out:?}");
}

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
    let (found, _) = denoised(noisy.view()).unwrap();
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

/// A bright disk on dark ground.
fn lamp(x: usize, y: usize) -> [f64; 3] {
    let off = [x, y].map(|v| f64::from(u32::try_from(v).unwrap()) - 31.5);
    [0.1 + 0.6 * (20.5 - off[0].hypot(off[1])).clamp(0.0, 1.0); 3]
}

#[test]
fn noise_that_grows_with_the_light_is_found_and_made_even() {
    let clean = single(&paint(lamp));
    for (read, photons) in [(0.005, 100.0), (0.01, 300.0), (0.02, 500.0)] {
        let mut image = clean.clone();
        add_shot_noise(&mut image, read, photons);
        let even = evened(&image.view()).expect("the noise grows");
        for value in [0.1, 0.7] {
            let (found, is) = (even.law.variance(value).sqrt(), (read * read + value / photons).sqrt());
            assert!((found / is - 1.0).abs() < 0.25, "{found} for {is} at {value}");
        }
        // What is left of it, bright and dark, away from the edge.
        let deviation = |is_in: &dyn Fn(f64) -> bool| {
            let [mut sum, mut count] = [0.0; 2];
            for i in 0..SIDE * SIDE {
                let radius = [i % SIDE, i / SIDE].map(|v| f64::from(u32::try_from(v).unwrap()) - 31.5);
                if is_in(radius[0].hypot(radius[1])) {
                    sum += f64::from(even.image.view().pixel(i)[0] - clean.view().pixel(i)[0]).powi(2);
                    count += 1.0;
                }
            }
            (sum / count).sqrt() / even.level
        };
        let (bright, dark) = (deviation(&|radius| radius < 16.0), deviation(&|radius| radius > 25.0));
        assert!(bright / dark < 1.35 && dark / bright < 1.35, "{bright} and {dark} of {photons}");
    }
}

#[test]
fn noise_that_is_even_stays() {
    let mut image = single(&paint(lamp));
    assert!(evened(&image.view()).is_none(), "there is none");
    add_noise(&mut image, 0.03);
    assert!(evened(&image.view()).is_none(), "it is even");
}

#[test]
fn few_colors_are_no_noise_that_grows() {
    let mut image = single(&paint(lamp));
    add_shot_noise(&mut image, 0.005, 100.0);
    assert!(evened(&image.view()).is_some());
    image.data_mut().iter_mut().for_each(|value| *value = (*value * 8.0).round() / 8.0);
    assert!(evened(&image.view()).is_none());
}

#[test]
fn single_pixels_of_few_colors_are_no_noise_that_grows() {
    // The brightest channel of one color is cut off, so that most groups of alike blocks tell nothing.
    let colors: [[u8; 3]; 8] = [
        [42, 6, 69],
        [58, 176, 255],
        [74, 184, 222],
        [79, 74, 182],
        [151, 208, 77],
        [165, 132, 124],
        [218, 192, 40],
        [243, 181, 34],
    ];
    for seed in 1..20 {
        let mut state: u64 = seed;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            colors[(state >> 61) as usize].map(|value| f32::from(value) / 255.0)
        };
        let pixels: Vec<[f32; 3]> = (0..SIDE * SIDE).map(|_| next()).collect();
        let image = Image::from_interleaved(ImageSize::new(SIDE, SIDE).unwrap(), pixels.as_flattened()).unwrap();
        assert!(evened(&image.view()).is_none(), "{seed}");
    }
}

#[test]
fn textures_are_no_noise_that_grows() {
    // Waves on the upper half, of all values: more of them where it is brighter in some places, less in others.
    let mut image = single(&paint(|x, y| {
        let [x, y] = [x, y].map(|v| f64::from(u32::try_from(v).unwrap()));
        [0.5 + 0.3 * (0.1 * x).sin() + 0.1 * (0.05 * y).sin().powi(3) * (2.5 * x).cos() * (2.1 * y).cos(); 3]
    }));
    add_noise(&mut image, 0.004);
    assert!(evened(&image.view()).is_none());
}
