use alloc::vec::Vec;

use dvp_core::{Image, ImageSize, Scene};
use proptest::prelude::*;

use super::super::{Known, PictureScratch, fit_picture};
use super::*;
use crate::{FitOptions, Fitter};

const SIDE: usize = 48;

/// A bright and a dark square on gray, whose values are `low` plus `times` what they usually are, in steps of `step`.
fn squares(low: f32, times: f32, step: f32) -> Image<f32> {
    let is_in = |i: usize, least: usize| {
        let most = least + 12;
        (least..most).contains(&(i % SIDE)) && (least..most).contains(&(i / SIDE))
    };
    let value = |i: usize| {
        if is_in(i, 8) {
            0.8
        } else if is_in(i, 26) {
            0.1
        } else {
            0.4
        }
    };
    let values = (0..3 * SIDE * SIDE).map(|i| ((low + times * value(i % (SIDE * SIDE))) / step).round() * step);
    Image::from_planar(ImageSize::new(SIDE, SIDE).unwrap(), values.collect()).unwrap()
}

fn read(image: &Image<f32>) -> Fit<f32> {
    let fitter = Fitter::new(FitOptions::default()).unwrap();
    fit_picture(&fitter, image.view(), &Known::default(), &mut PictureScratch::default()).unwrap()
}

#[test]
fn twelve_bits_in_a_file_of_sixteen_are_a_picture() {
    let step = 1.0 / 65535.0;
    let usual = read(&squares(0.0, 1.0, step));
    for (low, times) in [(0.0, 4095.0 / 65535.0), (0.45, 0.02), (0.9, 0.1)] {
        let fit = read(&squares(low, times, step));
        assert_eq!(fit.scene.objects.len(), 2, "{low}, {times}");
        for (object, usual) in fit.scene.objects.iter().zip(&usual.scene.objects) {
            let off = (0..2).map(|c| object.pose.translation[c] - usual.pose.translation[c]);
            assert!(off.into_iter().all(|off| (SIDE as f32 * off).abs() < 0.05), "{low}, {times}");
            let is = low + times * usual.color()[0];
            assert!((object.color()[0] - is).abs() < 0.01 * times, "{} for {is}", object.color()[0]);
        }
        assert!(fit.loss < 0.01 * times && fit.noise < 0.01 * times, "{} and {} of {times}", fit.loss, fit.noise);
    }
}

#[test]
fn what_has_contrast_or_steps_of_eight_bits_is_read_as_it_is() {
    let step = 1.0 / 65535.0;
    assert!(stretched(&squares(0.0, 1.0, step).view()).is_none());
    assert!(stretched(&squares(0.0, 0.2, 1.0 / 255.0).view()).is_none());
    assert!(stretched(&squares(0.5, 0.0, step).view()).is_none(), "one color");
    // A pixel that is dead.
    let mut image = squares(0.0, 0.1, step);
    image.data_mut()[100] = 1.0;
    assert!(stretched(&image.view()).is_some());
}

/// Darkest value.
fn low_of(image: &Image<f32>) -> f32 {
    image.data().iter().copied().fold(f32::INFINITY, f32::min)
}

proptest! {
    #[test]
    fn colors_come_back(low in 0.0_f32..0.7, times in 0.005_f32..0.28, color in 0.0_f32..1.0) {
        let image = squares(low, times, 1e-7);
        let Some(other) = stretched(&image.view()) else { return Ok(()) };
        let values: Vec<f32> = other.image.data().to_vec();
        prop_assert!(values.iter().all(|value| (0.04..0.96).contains(value)));
        let is = low + times * color;
        let seen = ENDS[0] + other.gain * (is - low_of(&image));
        let mut fit = read(&image);
        fit.scene = Scene::empty([seen; 3]);
        let restored = restored(&other, fit);
        prop_assert!((restored.scene.background[0] - is.clamp(0.0, 1.0)).abs() < 1e-4);
    }
}
