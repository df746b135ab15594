use alloc::vec;
use alloc::vec::Vec;

use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::scene::{ColorRamp, ColorStop, RampKind};
use dvp_core::shape::{AnyShape, Circle, Rectangle};
use dvp_core::{Image, ImageSize, Object, Paint, Pose, Scene};

use super::super::{Known, PictureScratch, fit_picture};
use super::better;
use crate::paint::Canvas;
use crate::{Fit, FitOptions, Fitter};

/// A ramp between two colors along a line, of points in the frame of the object that it paints.
fn ramp(ends: [[f32; 2]; 2], colors: [[f32; 3]; 2]) -> Paint<f32> {
    let stop = |offset, color| ColorStop { offset, color };
    Paint::Ramp(ColorRamp { kind: RampKind::Linear(ends), stops: vec![stop(0.0, colors[0]), stop(1.0, colors[1])] })
}

/// Objects on white as a picture of 96 x 96 pixels, rounded to 8 bits, and what is read in it.
fn read(objects: Vec<Object<f32>>, known: &Known) -> (Image<f32>, Fit<f32>) {
    let scene = Scene { objects, edge: EdgeProfile::area(), compositing: Compositing::Over, ..Scene::empty([1.0; 3]) };
    let size = ImageSize::new(96, 96).unwrap();
    let painted = Canvas::default().paint(&scene, size).unwrap().0.clone();
    let rounded = painted.data().iter().map(|value| (value * 255.0).round() / 255.0).collect();
    let image = Image::from_planar(size, rounded).unwrap();
    let fitter = Fitter::new(FitOptions::default()).unwrap();
    let fit = fit_picture(&fitter, image.view(), known, &mut PictureScratch::default()).unwrap();
    (image, fit)
}

#[test]
fn ramps_are_painted_where_they_were_seen() {
    // A disk over a sky, each in colors of its own.
    let sheet = Rectangle { size: [1.0, 1.0], corner_radius: 0.0 };
    let middle = Pose { translation: [0.5, 0.5], ..Pose::identity() };
    let sky = ramp([[0.0, -0.5], [0.0, 0.5]], [[0.5, 0.8, 1.0], [0.9, 0.95, 1.0]]);
    let sun = ramp([[-0.2, -0.2], [0.2, 0.2]], [[1.0, 0.9, 0.3], [0.9, 0.4, 0.1]]);
    let object = |shape: AnyShape<f32>, paint| Object { shape, pose: middle, paint, confidence: 1.0 };
    let truth = vec![object(sheet.into(), sky), object(Circle { radius: 0.3 }.into(), sun)];
    let (_, fit) = read(truth.clone(), &Known::default());
    let [sky, sun] = &fit.scene.objects[..] else { panic!("{:?}", fit.scene.objects) };
    assert!(sky.paint.ramp().is_some() && sun.paint.ramp().is_some());
    let AnyShape::Circle(Circle { radius }) = sun.shape else { panic!("{:?}", sun.shape) };
    assert!((96.0 * (radius * sun.pose.scale - 0.3)).abs() < 0.05, "{radius}");
    // Rounding leaves a quarter of a step.
    assert!(fit.loss < 0.6 / 255.0, "{} steps", 255.0 * fit.loss);
    assert_eq!(fit.covariance.len(), 2);
    let (_, flat) = read(truth, &Known::default().with_flat(true));
    assert!(flat.scene.objects.iter().all(|object| object.paint.ramp().is_none()));
}

/// A bar that darkens a ramp by half where that is darkest, far from the color that stands for it.
#[test]
fn what_shades_a_ramp_has_the_color_that_it_shows() {
    let sheet = Rectangle { size: [1.0, 1.0], corner_radius: 0.0 };
    let sky = ramp([[0.0, -0.5], [0.0, 0.5]], [[0.9, 0.9, 1.0], [0.1, 0.3, 0.5]]);
    let object = |shape: Rectangle<f32>, y, paint, confidence| Object {
        shape: shape.into(),
        pose: Pose { translation: [0.5, y], ..Pose::identity() },
        paint,
        confidence,
    };
    let bar = Rectangle { size: [0.5, 3.0 / 96.0], corner_radius: 0.0 };
    let truth = vec![object(sheet, 0.5, sky, 1.0), object(bar, 80.5 / 96.0, [0.0; 3].into(), 0.5)];
    let (image, fit) = read(truth, &Known::default());
    let shown = image.view().pixel(80 * 96 + 48);
    let off = |object: &Object<f32>| (0..3).map(|c| (object.color()[c] - shown[c]).abs()).fold(0.0, f32::max);
    let flat = fit.scene.objects.iter().filter(|object| object.paint.ramp().is_none());
    assert!(flat.map(off).fold(f32::INFINITY, f32::min) < 2.0 / 255.0, "{:?}", fit.scene.objects);
}

#[test]
fn of_two_that_are_as_near_the_one_with_fewer_things_is_taken() {
    let size = ImageSize::new(32, 32).unwrap();
    let dark = |i: usize| (8..24).contains(&(i % 32)) && (8..24).contains(&(i / 32));
    let pixels: Vec<f32> = (0..size.pixels()).flat_map(|i| [if dark(i) { 0.1 } else { 1.0 }; 3]).collect();
    let image = Image::from_interleaved(size, &pixels).unwrap();
    let fitter = Fitter::new(FitOptions::default()).unwrap();
    let one = fit_picture(&fitter, image.view(), &Known::default(), &mut PictureScratch::default()).unwrap();
    let mut two = one.clone();
    two.scene.objects.extend(one.scene.objects.clone());
    assert_eq!(better(one.clone(), two.clone()).scene.objects.len(), 1);
    assert_eq!(better(two.clone(), one.clone()).scene.objects.len(), 1);
    // Three steps of 256 nearer: that is seen.
    two.loss = one.loss;
    let mut far = one;
    far.loss += 3.0 / 255.0;
    assert_eq!(better(two, far).scene.objects.len(), 2);
}
