//! A large picture whose scene is known.

use dvp_core::render::EdgeProfile;
use dvp_core::shape::{AnyShape, Circle};
use dvp_core::{ImageSize, Object, Pose, Scene};

use super::*;
use crate::FitOptions;
use crate::paint::Canvas;

const SIDE: usize = 2048;

/// Twenty disks in 2048 x 2048 pixels with edges of ten: more things than the paper's scenes have.
fn disks() -> Scene<f32> {
    let disk = |k: usize| Object {
        shape: AnyShape::Circle(Circle { radius: 0.05 + 0.001 * k as f32 }),
        pose: Pose {
            translation: [0.15 + 0.17 * (k % 5) as f32, 0.2 + 0.2 * (k / 5) as f32],
            scale: 1.0,
            rotation: 0.0,
        },
        paint: [0.1, 0.05 * k as f32, 0.6].into(),
        confidence: 1.0,
    };
    let objects = (0..20).map(disk).collect();
    Scene { objects, edge: EdgeProfile::distance(1.0 / SIDE as f32), ..Scene::empty([0.9; 3]) }
}

/// The fit of a scene of 8 bits with some pixels (column, row) black, if every other pixel tells it.
fn fit_of(scene: &Scene<f32>, black: impl Iterator<Item = [usize; 2]>) -> Option<Fit<f32>> {
    let size = ImageSize::new(SIDE, SIDE).unwrap();
    let mut canvas = Canvas::default();
    let mut image = canvas.paint(scene, size).unwrap().0.clone();
    image.data_mut().iter_mut().for_each(|value| *value = (*value * 255.0 + 0.5).floor() / 255.0);
    for [column, row] in black {
        (0..3).for_each(|channel| image.data_mut()[channel * size.pixels() + row * SIDE + column] = 0.0);
    }
    let fitter = Fitter::new(FitOptions::default()).unwrap();
    fit(&fitter, image.view(), &Known::default(), &mut PictureScratch::default()).unwrap()
}

#[test]
fn large_pictures_with_wide_edges_are_read_by_every_other_pixel() {
    let scene = disks();
    let fit = fit_of(&scene, core::iter::empty()).unwrap();
    assert_eq!(fit.scene.objects.len(), 20);
    for object in &scene.objects {
        let off = |other: &Object<f32>| {
            let [x, y] = [0, 1].map(|k| other.pose.translation[k] - object.pose.translation[k]);
            x.hypot(y)
        };
        // A fiftieth of a pixel.
        assert!(fit.scene.objects.iter().any(|other| off(other) < 1e-5), "{object:?} in {:?}", fit.scene.objects);
    }
    assert!(fit.loss < 3e-4, "{}", fit.loss);
}

#[test]
fn what_lies_between_the_pixels_that_are_read_asks_for_all_of_them() {
    // Every other column has the pixels that are not read.
    let lines = (100..200).flat_map(|row| (40..90).map(move |column| [2 * column, row]));
    assert!(fit_of(&disks(), lines).is_none());
}
