//! Pictures that are not clean: noise and compression on MDS-HR with default options, and pictures that are not flat.

use dvp::format::mdshr_bank;
use dvp::generate::{SceneSettings, sample_scene};
use dvp::paint::Painter;
use dvp::spoil::{add_noise, jpeg};
use dvp_core::metric::visible_object_count;
use dvp_core::{Image, ImageSize, Real};
use dvp_fit::picture::{Known, PictureScratch, fit_picture};
use dvp_fit::{Fit, FitOptions, FitScratch, Fitter, StopReason, fit_image};
use image::RgbImage;

const SIDE: u32 = 128;
const PICTURES: u64 = 24;

/// A picture of our own generator, and how many objects it shows.
fn picture(index: u64) -> (RgbImage, usize) {
    let size = ImageSize::new(SIDE as usize, SIDE as usize).unwrap();
    let scene = sample_scene(&SceneSettings::mds_hr(), &mdshr_bank(), size, 11, index);
    (to_picture(&Painter::default().paint(&scene, size).unwrap()), visible_object_count(&scene))
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "colors are in [0, 1], sides short")]
fn to_picture(image: &Image<f32>) -> RgbImage {
    let bytes = image.to_interleaved().into_iter().map(|v| (v * 255.0).round() as u8).collect();
    RgbImage::from_raw(image.size().width() as u32, image.size().height() as u32, bytes).unwrap()
}

fn to_image(picture: &RgbImage) -> Image<f32> {
    let size = ImageSize::new(picture.width() as usize, picture.height() as usize).unwrap();
    let values: Vec<f32> = picture.as_raw().iter().map(|&byte| f32::from(byte) / 255.0).collect();
    Image::from_interleaved(size, &values).unwrap()
}

fn with_bank() -> FitOptions<f32> {
    FitOptions::default().with_bank(Some(mdshr_bank()))
}

/// Pictures of which the right number of objects is found after `spoil`, and the noise levels found.
fn exact_counts(options: FitOptions<f32>, spoil: impl Fn(RgbImage, u64) -> RgbImage) -> (usize, Vec<f32>) {
    let fitter = Fitter::new(options).unwrap();
    let (mut scratch, mut exact, mut noise) = (FitScratch::default(), 0, Vec::new());
    for index in 0..PICTURES {
        let (picture, visible) = picture(index);
        let fit = fitter.fit(to_image(&spoil(picture, index)).view(), &mut scratch).unwrap();
        exact += usize::from(fit.scene.objects.len() == visible);
        noise.push(fit.noise);
    }
    eprintln!("{exact} of {PICTURES} counts exact");
    (exact, noise)
}

/// One picture of 24 may be missed at each level.
#[test]
fn objects_are_counted_through_noise() {
    for options in [FitOptions::default(), with_bank()] {
        // The first is a step of 8 bits: boundaries cost little, and the faint tails of edges must not become objects.
        for sigma in [0.004, 0.01, 0.03, 0.05] {
            let (exact, noise) = exact_counts(options.clone(), |mut picture, index| {
                add_noise(&mut picture, sigma, index);
                picture
            });
            assert!(exact >= 23, "{exact} at {sigma}");
            // Clipping at black and white takes from the noise of dark and light pictures.
            let near = noise.iter().filter(|&&found| (f64::from(found) / sigma - 1.0).abs() < 0.1).count();
            assert!(near >= 18, "{near} levels near {sigma}: {noise:?}");
        }
    }
}

/// Without shapes to know, three of 24 may be missed where noise is as strong as most contrasts. A denoised boundary between colors that
/// differ by less than the noise is still one.
#[test]
fn objects_are_counted_through_strong_noise() {
    for (sigma, least) in [(0.1, 23), (0.2, 22), (0.3, 21)] {
        let (exact, _) = exact_counts(FitOptions::default(), |mut picture, index| {
            add_noise(&mut picture, sigma, index);
            picture
        });
        assert!(exact >= least, "{exact} at {sigma}");
    }
}

/// Every sample of the outline is off by more than the width within which samples count in a clean picture.
#[test]
fn a_square_in_strong_noise_is_no_ellipse() {
    let side = 256;
    let inside = |x: f64, y: f64| (x - 0.5).abs() < 0.25 && (y - 0.45).abs() < 0.25;
    let clean = paint(side, |x, y| if inside(x, y) { [0.3, 0.35, 0.7] } else { [0.6, 0.55, 0.3] });
    let mut noisy = to_picture(&clean);
    add_noise(&mut noisy, 0.2, 5);
    let fit = fit(&to_image(&noisy), 8);
    let painted = Painter::default().paint(&fit.scene, clean.size()).unwrap();
    let off = painted.data().iter().zip(clean.data()).filter(|(a, b)| (*a - *b).abs() > 0.1).count();
    // A row of pixels around it has 512, of three values each; an ellipse missed 9,399 values.
    assert!(off < 3 * 512, "{off} values");
}

/// JPEG of quality 50, colors at half the resolution; one miss of 24 is above .95.
#[test]
fn objects_are_counted_through_compression() {
    for (options, least) in [(FitOptions::default(), 23), (with_bank(), 23)] {
        let spoil = |picture: RgbImage, _| image::load_from_memory(&jpeg(&picture, 50).unwrap()).unwrap().to_rgb8();
        let (exact, _) = exact_counts(options, spoil);
        assert!(exact >= least, "{exact}");
    }
}

fn paint(side: usize, color: impl Fn(f64, f64) -> [f64; 3]) -> Image<f32> {
    let extent = f64::of_usize(side);
    let at = |i: usize| (f64::of_usize(i % side) / extent, f64::of_usize(i / side) / extent);
    let pixels: Vec<f32> = (0..side * side)
        .flat_map(|i| {
            let (x, y) = at(i);
            color(x, y).map(|v| f64::as_f32((v * 255.0).round() / 255.0))
        })
        .collect();
    Image::from_interleaved(ImageSize::new(side, side).unwrap(), &pixels).unwrap()
}

fn fit(image: &Image<f32>, max_objects: usize) -> Fit<f32> {
    let fit = fit_image(image.view(), &FitOptions::default().with_max_objects(max_objects)).unwrap();
    eprintln!("{} objects, {} unexplained, {:?}", fit.scene.objects.len(), fit.unexplained, fit.stop);
    fit
}

/// `fit_picture` reads it as a ramp of colors.
#[test]
fn a_gradient_is_not_flat() {
    for side in [64, 256] {
        let image = paint(side, |x, _| [x, 0.3, 1.0 - x]);
        for most in [3, 12] {
            let bands = fit(&image, most);
            assert!(bands.scene.objects.len() <= most);
            assert!(matches!(bands.stop, StopReason::NotFlat | StopReason::NoBetterThanFlat), "{:?}", bands.stop);
            assert!((0.05..=1.0).contains(&bands.unexplained), "{}", bands.unexplained);
        }
    }
}

/// The error of every pixel is passed on to those that come after it, as programs do that save a drawing with few colors (Floyd and Steinberg).
fn dithered(picture: &Image<f32>, levels: f32) -> Image<f32> {
    let (width, mut dithered) = (picture.size().width(), picture.clone());
    for channel in dithered.data_mut().chunks_exact_mut(picture.size().pixels()) {
        for i in 0..channel.len() {
            let near = (channel[i] * levels).round().clamp(0.0, levels) / levels;
            let error = channel[i] - near;
            channel[i] = near;
            let column = i % width;
            let after = [(column + 1 < width, 1, 7.0), (column > 0, width - 1, 3.0), (true, width, 5.0)];
            for (is_there, step, share) in after.into_iter().chain([(column + 1 < width, width + 1, 1.0)]) {
                if let Some(value) = channel.get_mut(i + step).filter(|_| is_there) {
                    *value += error * share / 16.0;
                }
            }
        }
    }
    dithered
}

/// Its dots are hundreds of faces, and no things.
#[test]
fn a_dithered_drawing_is_what_was_drawn() {
    const SIDES: usize = 96;
    let drawn = paint(SIDES, |x, y| {
        if x > 0.5 && x < 0.95 && y > 0.5 && y < 0.9 {
            [0.08, 0.24, 0.78]
        } else if (x - 0.5).hypot(y - 0.5) < 0.3 {
            [0.78, 0.12, 0.16]
        } else {
            [1.0; 3]
        }
    });
    let fitter = Fitter::new(FitOptions::default()).unwrap();
    let mut scratch = PictureScratch::default();
    let found = fit_picture(&fitter, dithered(&drawn, 5.0).view(), &Known::default(), &mut scratch).unwrap();
    assert_eq!(found.scene.objects.len(), 2);
    let painted = scratch.canvas.paint(&found.scene, drawn.size()).unwrap().0.view();
    let drawn = drawn.view();
    let is_off = |i: usize| (0..3).any(|c| (painted.pixel(i)[c] - drawn.pixel(i)[c]).abs() > 0.05);
    let wrong = (0..SIDES * SIDES).filter(|&i| is_off(i)).count();
    // Where an edge passes between dots is known to a pixel or so, and edges are 3 in 100 of the pixels.
    assert!(50 * wrong < SIDES * SIDES, "{wrong}");
}

#[test]
fn flat_pictures_leave_nothing_unexplained() {
    let (clean, visible) = picture(0);
    let found = fit(&to_image(&clean), 256);
    assert_eq!(found.scene.objects.len(), visible);
    assert!(found.unexplained < 2e-3, "{}", found.unexplained);
}
