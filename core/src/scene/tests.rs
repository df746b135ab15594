#![expect(clippy::float_cmp, reason = "numbers exact by construction")]

use alloc::vec;

use super::*;
use crate::shape::{OutlineBasis, ShapeError};

fn scene() -> Scene<f64> {
    let pose = Pose { translation: [0.25, 0.5], scale: 0.5, rotation: core::f64::consts::FRAC_PI_2 };
    let ellipse = |harmonics| Efd::new(vec![[1.0, 0.0, 0.0, -1.0]]).resized(harmonics);
    let object = |harmonics| Object::of_efd(pose, [0.1, 0.2, 0.3], 0.75, ellipse(harmonics), None);
    Scene { objects: vec![object(1), object(3)], ..Scene::empty([1.0, 0.5, 0.0]) }
}

#[test]
fn a_quarter_turn_takes_x_to_y() {
    // (1, 0) turns to (0, 1), halves to (0, 0.5), moves to (0.25, 1).
    let pose = scene().objects[0].pose;
    let [x, y] = f64::xy(pose.transform_point(f64::vec2(1.0, 0.0)));
    assert!((x - 0.25).abs() < 1e-15 && (y - 1.0).abs() < 1e-15, "({x}, {y})");
    let back = pose.inverse().unwrap();
    let [x, y] = f64::xy(back.transform_point(f64::vec2(0.25, 1.0)));
    assert!((x - 1.0).abs() < 1e-15 && y.abs() < 1e-15, "({x}, {y})");
    assert_eq!(Pose { scale: 0.0, ..pose }.inverse(), None);
    assert_eq!(Pose::<f64>::identity().inverse(), Some(Pose::identity()));
}

#[test]
fn the_pair_of_the_reference_is_sine_then_cosine() {
    assert_eq!(rotation_from_pair([0.0, 2.0]), 0.0);
    assert_eq!(rotation_from_pair([3.0, 0.0]), core::f64::consts::FRAC_PI_2);
    let mut grad = [7.0; 2];
    rotation_from_pair_vjp([0.0, 0.0], 1.0, &mut grad);
    assert_eq!(grad, [7.0; 2]);
}

#[test]
fn harmonics_may_differ_between_objects() {
    let basis = OutlineBasis::new(16, 3).unwrap();
    let mut drawing = Drawing::default();
    scene().draw(&basis, &mut drawing).unwrap();
    assert_eq!(drawing.object_count(), 2);
    assert_eq!(drawing.starts, [0, 16, 32]);
    assert_eq!(drawing.outline(0), drawing.outline(1));
    assert_eq!(drawing.background, [1.0, 0.5, 0.0]);
    assert_eq!(drawing.confidences, [0.75; 2]);
    let small = OutlineBasis::new(16, 2).unwrap();
    let refused = scene().draw(&small, &mut drawing);
    assert_eq!(refused, Err(ShapeError::TooManyHarmonics { harmonic_count: 3, limit: 2 }));
}

#[test]
fn a_second_drawing_reuses_the_memory() {
    let basis = OutlineBasis::new(16, 3).unwrap();
    let (mut drawing, mut grad) = (Drawing::default(), SceneGrad::default());
    scene().draw(&basis, &mut drawing).unwrap();
    grad.reset(&scene());
    let before = (drawing.vertices.as_ptr(), drawing.starts.as_ptr(), grad.objects[1].numbers.as_ptr());
    scene().draw(&basis, &mut drawing).unwrap();
    grad.reset(&scene());
    assert_eq!(before, (drawing.vertices.as_ptr(), drawing.starts.as_ptr(), grad.objects[1].numbers.as_ptr()));
}

#[test]
fn a_gradient_of_another_layout_is_refused() {
    let (basis, scene) = (OutlineBasis::new(16, 3).unwrap(), scene());
    let (mut drawing, mut grad_drawing, mut grad) = (Drawing::default(), DrawingGrad::default(), SceneGrad::default());
    scene.draw(&basis, &mut drawing).unwrap();
    grad_drawing.reset(&drawing);
    let refused = scene.draw_vjp(&basis, &grad_drawing, &mut grad);
    assert_eq!(refused, Err(ShapeError::Length { what: "gradient of the objects", expected: 2, len: 0 }));
    grad.reset(&scene);
    grad.objects[1].numbers.pop();
    let refused = scene.draw_vjp(&basis, &grad_drawing, &mut grad);
    assert_eq!(refused, Err(ShapeError::Length { what: "gradient of the numbers", expected: 12, len: 11 }));
}

#[test]
fn shares_of_two_objects() {
    // Coverages 1 and 1/2, confidences 1/2 and 1. Over: 1/2 x 1/2 of the first shows, 1/2 of the second, 1/4 of the background.
    let layers = [Layer::new([0.0; 3], 1.0, 0.5), Layer::new([1.0; 3], 0.5, 1.0)];
    let mut shares = [0.0; 2];
    assert_eq!(Compositing::Over.shares(&layers, &mut shares), 0.25);
    assert_eq!(shares, [0.25, 0.5]);
    // Blend: weights exp(-5) and 1/2 share what is not background.
    assert_eq!(Compositing::Blend.shares(&layers, &mut shares), 0.25);
    let total = (-5.0_f64).exp() + 0.5;
    assert!(
        (shares[0] - 0.75 * (-5.0_f64).exp() / total).abs() < 1e-15 && (shares[0] + shares[1] - 0.75).abs() < 1e-15
    );
    assert_eq!(Compositing::Blend.shares::<f64>(&[], &mut []), 1.0);
}

#[test]
fn regions_share_join_and_cut() {
    use crate::shape::Rectangle;
    // Squares of side 2 around (0, 0) and (1, 0): 2 x 2 shared, 3 x 2 together, 1 x 2 of the first alone.
    let square = |x: f64| {
        let shape = Rectangle { size: [2.0, 2.0], corner_radius: 0.0 }.into();
        Region::of(&(shape, Pose { translation: [x, 0.0], ..Pose::identity() }), 1e-3).unwrap()
    };
    let (first, second) = (square(0.0), square(1.0));
    let bounds = |region: &Region| region.bounds().map(|b| [b.min.to_array(), b.max.to_array()]);
    assert_eq!(bounds(&first.intersection(&second).unwrap()), Some([[0.0, -1.0], [1.0, 1.0]]));
    assert_eq!(bounds(&first.union(&second).unwrap()), Some([[-1.0, -1.0], [2.0, 1.0]]));
    let left = first.difference(&second).unwrap();
    assert_eq!(bounds(&left), Some([[-1.0, -1.0], [0.0, 1.0]]));
    // Its area is 2.
    assert!(left.to_placed(1.9).unwrap().is_some() && left.to_placed(2.1).unwrap().is_none());
    assert_eq!(bounds(&first.difference(&first).unwrap()), None);
    let boxed = |x: f64| square(x).bounds().unwrap();
    assert!(first.union(&second).unwrap().contains(boxed(0.0)) && !first.contains(boxed(1.0)));
}

#[test]
fn casting_there_and_back_rounds_to_the_nearest() {
    let mut scene = scene();
    scene.objects[0].pose.translation = [0.1, 0.5];
    let back = scene.cast::<f32>().cast::<f64>();
    assert_eq!(back.objects[0].pose.translation, [f64::from(0.1_f32), 0.5]);
    assert_eq!(scene.cast::<f64>(), scene);
}
