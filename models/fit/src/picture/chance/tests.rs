use alloc::vec;

use dvp_core::shape::Rectangle;
use dvp_core::{ImageSize, Object, Pose, Real as _};
use dvp_trace::{Known, ObjectDoubt};

use super::*;
use crate::split_mix::SplitMix;

const SIDE: usize = 64;

/// A rectangle, numbers in pixels.
fn rectangle(middle: [f32; 2], size: [f32; 2], color: [f32; 3]) -> Object<f32> {
    let px = |value: f32| value / SIDE as f32;
    Object {
        shape: Rectangle { size: size.map(px), corner_radius: 0.0 }.into(),
        pose: Pose { translation: middle.map(px), ..Pose::identity() },
        paint: color.into(),
        confidence: 1.0,
    }
}

/// A drawing under noise of a standard deviation of .05: a large square, and a spot of 7 pixels in a color that noise makes of those there, `more` standard
/// deviations brighter; whether the spot is in the picture.
fn read(more: f32, is_there: bool, is_gray: bool) -> usize {
    left(rectangle([50.5, 48.5], [7.0, 1.0], [0.2 + 0.05 * more; 3]), is_there, is_gray)
}

/// How many are left of a square and a spot.
fn left(spot: Object<f32>, is_there: bool, is_gray: bool) -> usize {
    let square = rectangle([24.0, 24.0], [20.0, 20.0], [0.8, 0.8, 0.8]);
    let mut scene = Scene { objects: vec![square, spot], ..Scene::empty([0.2; 3]) };
    let mut canvas = Canvas::default();
    let size = ImageSize::new(SIDE, SIDE).unwrap();
    let shown = Scene { objects: scene.objects[..1 + usize::from(is_there)].to_vec(), ..scene.clone() };
    let mut image: Image<f32> = canvas.paint(&shown, size).unwrap().0.clone();
    let mut random = SplitMix(7);
    let pixels = size.pixels();
    for i in 0..3 * pixels {
        let normal = (0..12).map(|_| random.unit()).sum::<f64>() - 6.0;
        image.data_mut()[i] =
            if is_gray && i >= pixels { image.data()[i - pixels] } else { image.data()[i] + 0.05 * f32::of(normal) };
    }
    let mut traced = dvp_trace::trace(&image.view(), &Known::default().with_spoiled(true)).unwrap();
    scene.edge = traced.scene.edge;
    scene.compositing = traced.scene.compositing;
    traced.scene = scene.clone();
    traced.doubts = vec![ObjectDoubt::default(); 2];
    traced.noise = 0.05;
    leave_out(&mut traced, &scene, &image.view(), &mut canvas).unwrap();
    assert_eq!(traced.scene.objects.len(), traced.doubts.len());
    traced.scene.objects.len()
}

#[test]
fn what_noise_makes_is_left_out_and_what_is_there_stays() {
    assert_eq!(read(4.0, false, false), 1);
    assert_eq!(read(4.0, true, false), 2);
    // Noise that all channels share says it once: 7 pixels of 4 standard deviations are 81 bits, of 3 they are 45.
    assert_eq!(read(3.0, true, true), 1);
    assert_eq!(read(6.0, true, true), 2);
}

#[test]
fn single_pixels_are_no_things() {
    assert_eq!(left(rectangle([50.5, 48.5], [1.0, 1.0], [1.0; 3]), true, true), 1);
    assert_eq!(left(rectangle([50.5, 48.5], [3.0, 3.0], [1.0; 3]), true, true), 2);
}
