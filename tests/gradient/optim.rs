//! Gradients of the optimizers' own: the contour length, and scenes as flat vectors.

#![expect(clippy::unwrap_used, reason = "a failed unwrap is a failed test with a line number")]

use dvp_core::shape::OutlineBasis;
use dvp_core::{Drawing, DrawingGrad, Scene, SceneGrad};
use dvp_fit::adam::contour_length::mean_length_and_grad;
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
}
