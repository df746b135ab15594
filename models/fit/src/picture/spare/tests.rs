//! Which thin things go, and which stay.

use dvp_core::render::EdgeProfile;
use dvp_core::shape::{AnyShape, Rectangle};
use dvp_core::{ImageSize, Object, Pose, Scene};
use dvp_trace::{Known, ObjectDoubt, trace};

use super::*;

const SIDE: usize = 64;
const BLUE: [f32; 3] = [0.1, 0.2, 0.6];

/// A rectangle of some size around a place, in pixels.
fn rectangle(size: [f32; 2], [x, y]: [f32; 2], color: [f32; 3]) -> Object<f32> {
    let unit = SIDE as f32;
    let pose = Pose { translation: [x / unit, y / unit], scale: 1.0 / unit, rotation: 0.0 };
    Object {
        shape: AnyShape::Rectangle(Rectangle { size, corner_radius: 0.0 }),
        pose,
        paint: color.into(),
        confidence: 1.0,
    }
}

/// How many things are left of the drawing of a picture of some objects with others in it.
fn left(objects: &[Object<f32>], more: &[Object<f32>]) -> usize {
    let mut canvas = Canvas::default();
    let size = ImageSize::new(SIDE, SIDE).unwrap();
    let scene = Scene { objects: objects.to_vec(), ..Scene::empty([1.0; 3]) };
    let mut image = canvas.paint(&scene, size).unwrap().0.clone();
    image.data_mut().iter_mut().for_each(|value| *value = (*value * 255.0 + 0.5).floor() / 255.0);
    let mut traced = trace(&image.view(), &Known::default()).unwrap();
    assert_eq!(traced.scene.objects.len(), objects.len(), "{:?}", traced.scene);
    traced.scene.objects.extend(more.iter().cloned());
    traced.doubts.extend(more.iter().map(|_| ObjectDoubt::default()));
    let (painted, drawing) = canvas.paint(&traced.scene, size).unwrap();
    if let Some(spare) = Spare::of(&drawing, &painted.clone()) {
        spare.leave_out(&mut traced, &drawing, &image.view(), &mut canvas).unwrap();
    }
    assert_eq!(traced.scene.objects.len(), traced.doubts.len());
    traced.scene.objects.len()
}

#[test]
fn what_changes_nothing_is_not_needed() {
    let square = rectangle([20.0, 20.0], [20.0, 20.0], BLUE);
    let line = rectangle([1.5, 30.0], [50.25, 32.0], BLUE);
    // A line on what has its color, and one of a fiftieth of a pixel along its edge.
    let within = rectangle([1.0, 12.0], [20.0, 20.0], BLUE);
    let beside = rectangle([0.02, 12.0], [30.01, 20.0], BLUE);
    assert_eq!(left(&[square.clone(), line.clone()], &[within, beside]), 2);
}

#[test]
fn what_is_seen_is_needed() {
    let square = rectangle([20.0, 20.0], [20.0, 20.0], BLUE);
    // A line, a dot, and a line that is hardly another color.
    let line = rectangle([1.0, 30.0], [50.5, 32.0], BLUE);
    let dot = rectangle([3.0, 2.0], [40.5, 60.0], BLUE);
    let faint = rectangle([20.0, 3.0], [20.0, 50.5], [0.85, 0.9, 0.95]);
    assert_eq!(left(&[square, line, dot, faint], &[]), 4);
}

#[test]
fn what_lies_on_the_sides_of_pixels_is_seen() {
    // Beyond the corner of the picture, but for two by two pixels: its outline goes along their sides, and the pixels on that are those outside.
    let objects = [rectangle([20.0, 20.0], [30.0, 30.0], BLUE), rectangle([3.0, 3.0], [0.5, 0.5], BLUE)];
    let mut canvas = Canvas::default();
    let scene = Scene { objects: objects.to_vec(), edge: EdgeProfile::area(), ..Scene::empty([1.0; 3]) };
    let (image, drawing) = canvas.paint(&scene, ImageSize::new(SIDE, SIDE).unwrap()).unwrap();
    let image = image.clone();
    let spare = Spare::of(&drawing, &image).expect("the small one is thin");
    let mut traced = trace(&image.view(), &Known::default()).unwrap();
    (traced.scene, traced.doubts) = (scene, vec![ObjectDoubt::default(); 2]);
    spare.leave_out(&mut traced, &drawing, &image.view(), &mut canvas).unwrap();
    assert_eq!(traced.scene.objects.len(), 2);
}
