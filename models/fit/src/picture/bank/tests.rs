//! Hard-edged pictures of known shapes, with noise.

use alloc::string::ToString;
use alloc::vec::Vec;

use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::shape::mdshr_bank;
use dvp_core::{Image, ImageSize, Object, Pose, Real as _, Scene};

use super::*;
use crate::FitOptions;
use crate::picture::fit_picture;
use crate::split_mix::SplitMix;

const SIDE: usize = 64;

/// Three shapes, two of which overlap, painted without a mixed pixel.
fn scene(bank: &Bank<f32>) -> Scene<f32> {
    let placed = [
        (0, [20.0, 22.0], 11.0, 0.4, [0.9, 0.1, 0.1]),
        (1, [29.0, 27.0], 9.0, 1.0, [0.1, 0.8, 0.2]),
        (2, [47.0, 46.0], 12.0, 2.0, [0.2, 0.3, 0.9]),
    ];
    let object = |(k, at, scale, rotation, color): (usize, [f32; 2], f32, f32, [f32; 3])| {
        let side = SIDE as f32;
        let pose = Pose { translation: at.map(|v| v / side), scale: scale / side, rotation };
        Object::of_efd(pose, color, 1.0, bank.prototypes[k].1.clone(), Some(k))
    };
    Scene {
        background: [0.1, 0.2, 0.3],
        transparent: false,
        objects: placed.into_iter().map(object).collect(),
        edge: EdgeProfile::hard(64e3),
        compositing: Compositing::Over,
    }
}

/// A picture with noise of standard deviation 0.05, clipped to what a file holds.
fn noisy(picture: &Image<f32>, seed: u64) -> Image<f32> {
    let mut random = SplitMix(seed);
    let mut picture = picture.clone();
    for value in picture.data_mut() {
        // The variance of the sum of four numbers between -1/2 and 1/2 is a third.
        let sum: f64 = (0..4).map(|_| random.unit() - 0.5).sum();
        *value = (*value + f32::of(0.05 * 3.0_f64.sqrt() * sum)).clamp(0.0, 1.0);
    }
    picture
}

#[test]
fn under_noise_known_shapes_are_laid_on_the_pixels_as_they_were() {
    let names = ["heart", "square", "ellipse"].map(ToString::to_string);
    let bank = Bank { prototypes: names.into_iter().zip(mdshr_bank(31).prototypes().iter().cloned()).collect() };
    let truth = scene(&bank);
    let mut canvas = Canvas::default();
    let clean = canvas.paint(&truth, ImageSize::new(SIDE, SIDE).unwrap()).unwrap().0.clone();
    let fitter = Fitter::new(FitOptions::default().with_bank(Some(bank))).unwrap();
    let mut off = Vec::new();
    for seed in 0..4 {
        let image = noisy(&clean, seed);
        let fit = fit_picture(&fitter, image.view(), &Known::default(), &mut PictureScratch::default()).unwrap();
        let mut shapes: Vec<_> = fit.scene.objects.iter().map(|object| object.prototype().unwrap()).collect();
        shapes.sort_unstable();
        assert_eq!(shapes, [0, 1, 2], "seed {seed}");
        let painted = canvas.paint(&fit.scene, clean.size()).unwrap().0.view();
        let is_off = |&i: &usize| (0..3).any(|c| (painted.pixel(i)[c] - clean.view().pixel(i)[c]).abs() > 0.1);
        off.push((0..clean.size().pixels()).filter(is_off).count());
    }
    // Of some 160 pixels along the outlines.
    assert!(off.iter().all(|&off| off <= 8), "{off:?}");
}
