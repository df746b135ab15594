//! The edges of a blur.

use alloc::vec::Vec;

use dvp_core::render::EdgeLaw;
use dvp_core::shape::{AnyShape, Circle, Ellipse};
use dvp_core::{Image, ImageSize, Object, Pose, Scene};

use super::*;
use crate::picture::{Known, PictureScratch, fit_picture};
use crate::{FitOptions, Fitter};

/// A scene of a disk with edges of some softness, scene units.
fn disk(softness: f32) -> Scene<f32> {
    let pose = Pose { translation: [0.5, 0.5], scale: 1.0, rotation: 0.0 };
    let shape = AnyShape::Circle(Circle { radius: 0.3 });
    let object = Object { shape, pose, paint: [0.1, 0.3, 0.6].into(), confidence: 1.0 };
    Scene { objects: Vec::from([object]), edge: EdgeProfile::distance(softness), ..Scene::empty([1.0; 3]) }
}

#[test]
fn the_softness_is_that_at_which_the_picture_is_missed_least() {
    let size = ImageSize::new(64, 64).unwrap();
    let mut canvas = Canvas::default();
    for factor in [0.85, 1.0, 1.18] {
        let made = disk(0.02 * factor);
        let image: Image<f32> = canvas.paint(&made, size).unwrap().0.clone();
        let found = nearest(disk(0.02), image.view(), &mut canvas).unwrap();
        assert!((found.edge.sigma / made.edge.sigma - 1.0).abs() < 0.03, "{factor} {:?}", found.edge);
        assert_eq!(found.objects, made.objects);
    }
}

#[test]
fn a_blur_makes_edges_as_soft_as_it_is_with_the_pixel() {
    let edge = blurred(&disk(0.1), 1.5, 64).edge;
    assert_eq!(edge.law, EdgeLaw::Distance);
    // Half of the integral of F (1 - F): that of the curve of Gauss is its deviation over the root of pi.
    let expected = 2.0 * (1.5_f64.powi(2) + 1.0 / 12.0).sqrt() / core::f64::consts::PI.sqrt() / 64.0;
    let expected = EdgeProfile::distance(f32::of(expected)).sigma;
    assert!((expected / edge.sigma - 1.0).abs() < 1e-5);
}

#[test]
fn blurred_things_that_have_run_together_are_where_all_pixels_say() {
    let ellipse = |translation, rotation| {
        let shape = AnyShape::Ellipse(Ellipse { radii: [0.11, 0.07] });
        let pose = Pose { translation, scale: 1.0, rotation };
        Object { shape, pose, paint: [0.2, 0.2, 0.2].into(), confidence: 1.0 }
    };
    let objects = Vec::from([ellipse([0.36, 0.41], 0.3), ellipse([0.51, 0.47], 1.4), ellipse([0.55, 0.62], 0.7)]);
    let size = ImageSize::new(96, 96).unwrap();
    let made = blurred(&Scene { objects, ..Scene::empty([0.9; 3]) }, 0.8, 96);
    let image: Image<f32> = Canvas::default().paint(&made, size).unwrap().0.clone();
    let fitter = Fitter::new(FitOptions::default()).unwrap();
    let fit = fit_picture(&fitter, image.view(), &Known::default(), &mut PictureScratch::default()).unwrap();
    assert_eq!(fit.scene.objects.len(), 3);
    for object in &made.objects {
        let off = |found: &Object<f32>| {
            let [a, b] = [object, found].map(|object| object.pose.translation.map(f64::from));
            96.0 * (a[0] - b[0]).hypot(a[1] - b[1])
        };
        let off = fit.scene.objects.iter().map(off).fold(f64::INFINITY, f64::min);
        assert!(off < 0.05, "{off} pixels");
    }
}
