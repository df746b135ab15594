//! Gradients of the optimizers' own: the contour length, and scenes as flat vectors.

use dvp_core::shape::OutlineBasis;
use dvp_core::{Drawing, DrawingGrad, Scene, SceneGrad};
use dvp_fit::adam::contour_length::mean_length_and_grad;
use dvp_fit::adam::fixed_shapes::FixedShapes;
use dvp_fit::parameters::{Free, Parameters};
use dvp_tests::finite_difference::compare;
use dvp_tests::strategy;
use proptest::prelude::*;

const WEIGHT: f64 = 0.7;

/// The weighted mean length of `scene`; leaves its gradient.
fn length(scene: &Scene<f64>, basis: &OutlineBasis<f64>, grad: &mut SceneGrad<f64>) -> f64 {
    let mut drawing = Drawing::default();
    scene.draw(basis, &mut drawing).unwrap();
    let mut grad_drawing = DrawingGrad::default();
    grad_drawing.reset(&drawing);
    grad.reset(scene);
    let length = mean_length_and_grad(scene, &drawing, WEIGHT, &mut grad_drawing, grad);
    scene.draw_vjp(basis, &grad_drawing, grad).unwrap();
    length
}

proptest! {
    #[test]
    fn contour_length_through_the_flat_vector(scene in strategy::scene(1..4, 1..6), vertex_count in 8_usize..70) {
        let basis = OutlineBasis::new(vertex_count, 6).unwrap();
        let mut grad = SceneGrad::default();
        length(&scene, &basis, &mut grad);
        let mut parameters = Parameters::new();
        parameters.load(&scene, Free::PoseColorAndShape);
        parameters.pull_back(&grad);
        let (x, gradient) = (parameters.values().to_vec(), parameters.gradient().to_vec());
        let mut moved = scene.clone();
        compare(&x, &gradient, 1e-7, |x| {
            parameters.values_and_gradient().0.copy_from_slice(x);
            parameters.store(&mut moved);
            length(&moved, &basis, &mut SceneGrad::default())
        }).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn the_pose_does_not_change_a_unit_length(scene in strategy::scene(1..4, 1..6), pose in strategy::pose()) {
        let basis = OutlineBasis::new(64, 6).unwrap();
        let mut grad = SceneGrad::default();
        let before = length(&scene, &basis, &mut grad);
        for object in &grad.objects {
            prop_assert!(object.translation.iter().all(|g| g.abs() < 1e-10), "{object:?}");
            prop_assert!(object.scale.abs() < 1e-10 && object.rotation.abs() < 1e-10, "{object:?}");
        }
        let mut moved = scene;
        moved.objects[0].pose = pose;
        prop_assert!((length(&moved, &basis, &mut grad) - before).abs() < 1e-12);
    }

    #[test]
    fn fixed_shapes_draw_and_pull_back_as_the_scene(
        scene in strategy::scene(0..4, 1..6),
        cotangent in prop::collection::vec(-1.0..1.0, 97),
        vertex_count in 4_usize..70,
    ) {
        let basis = OutlineBasis::new(vertex_count, 6).unwrap();
        let (mut drawing, mut posed) = (Drawing::default(), Drawing::default());
        scene.draw(&basis, &mut drawing).unwrap();
        let mut shapes = FixedShapes::default();
        shapes.sample(&scene, &basis).unwrap();
        shapes.draw(&scene, &mut posed);
        prop_assert_eq!(&posed, &drawing);

        let mut grad_drawing = DrawingGrad::default();
        grad_drawing.reset(&drawing);
        let mut numbers = cotangent.iter().copied().cycle();
        let mut next = || numbers.next().unwrap_or(f64::NAN);
        grad_drawing.background.fill_with(&mut next);
        grad_drawing.vertices.as_flattened_mut().fill_with(&mut next);
        grad_drawing.colors.as_flattened_mut().fill_with(&mut next);
        grad_drawing.confidences.fill_with(&mut next);
        let (mut grad, mut expected) = (SceneGrad::default(), SceneGrad::default());
        grad.reset(&scene);
        expected.reset(&scene);
        // Twice: gradients are added.
        for _ in 0..2 {
            shapes.draw_vjp(&scene, &grad_drawing, &mut grad);
            scene.draw_vjp(&basis, &grad_drawing, &mut expected).unwrap();
        }
        let mut parameters = [Parameters::new(), Parameters::new()];
        for (parameters, grad) in parameters.iter_mut().zip([&grad, &expected]) {
            parameters.load(&scene, Free::PoseAndColor);
            parameters.pull_back(grad);
        }
        for (a, b) in parameters[0].gradient().iter().zip(parameters[1].gradient()) {
            prop_assert!((a - b).abs() < 1e-11, "{a} {b}");
        }
        for (a, b) in grad.objects.iter().zip(&expected.objects) {
            prop_assert!((a.confidence - b.confidence).abs() < 1e-12, "{a:?} {b:?}");
        }
    }
}
