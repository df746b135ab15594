//! Gradients of drawings with respect to scenes.

use dvp_core::scene::{PoseGrad, rotation_from_pair, rotation_from_pair_vjp};
use dvp_core::shape::OutlineBasis;
use dvp_core::{Drawing, DrawingGrad, Pose, Scene, SceneGrad};
use dvp_tests::finite_difference::{compare, dot};
use dvp_tests::strategy;
use proptest::prelude::*;

/// The numbers of a scene in one row, in the order of [`flat_grad`].
fn flat(scene: &Scene<f64>) -> Vec<f64> {
    let mut x = scene.background.to_vec();
    for object in &scene.objects {
        x.extend(object.pose.translation);
        x.extend([object.pose.scale, object.pose.rotation]);
        x.extend(object.color());
        x.push(object.confidence);
        x.extend(object.efd_rows().as_flattened());
    }
    x
}

fn unflat(scene: &mut Scene<f64>, mut x: &[f64]) {
    // A NaN fails the comparison.
    let mut next = || x.split_off_first().copied().unwrap_or(f64::NAN);
    scene.background.fill_with(&mut next);
    for object in &mut scene.objects {
        object.pose.translation.fill_with(&mut next);
        object.pose.scale = next();
        object.pose.rotation = next();
        object.paint.set_color([next(), next(), next()]);
        object.confidence = next();
        if let Some(efd) = object.shape.efd_mut() {
            efd.rows_mut().as_flattened_mut().fill_with(&mut next);
        }
    }
}

fn flat_grad(grad: &SceneGrad<f64>) -> Vec<f64> {
    let mut x = grad.background.to_vec();
    for object in &grad.objects {
        x.extend(object.translation);
        x.extend([object.scale, object.rotation]);
        x.extend(object.color);
        x.push(object.confidence);
        x.extend(&object.numbers);
    }
    x
}

/// The scalar that a cotangent makes of a drawing.
fn pair(drawing: &Drawing<f64>, cotangent: &DrawingGrad<f64>) -> f64 {
    dot(&drawing.background, &cotangent.background)
        + dot(drawing.vertices.as_flattened(), cotangent.vertices.as_flattened())
        + dot(drawing.colors.as_flattened(), cotangent.colors.as_flattened())
        + dot(&drawing.confidences, &cotangent.confidences)
}

/// A cotangent of random numbers for `drawing`.
fn cotangent(drawing: &Drawing<f64>, numbers: &[f64]) -> DrawingGrad<f64> {
    let mut grad = DrawingGrad::default();
    grad.reset(drawing);
    let mut numbers = numbers.iter().copied().cycle();
    let mut next = || numbers.next().unwrap_or(f64::NAN);
    grad.background.fill_with(&mut next);
    grad.vertices.as_flattened_mut().fill_with(&mut next);
    grad.colors.as_flattened_mut().fill_with(&mut next);
    grad.confidences.fill_with(&mut next);
    grad
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn draw_vjp_matches_differences(
        scene in strategy::scene(0..4, 1..40),
        numbers in prop::collection::vec(-1.0..1.0, 97),
        vertex_count in 4_usize..70,
    ) {
        let basis = OutlineBasis::new(vertex_count, 40).unwrap();
        let mut drawing = Drawing::default();
        scene.draw(&basis, &mut drawing).unwrap();
        let cotangent = cotangent(&drawing, &numbers);
        let mut grad = SceneGrad::default();
        grad.reset(&scene);
        scene.draw_vjp(&basis, &cotangent, &mut grad).unwrap();
        let once = flat_grad(&grad);
        let mut moved = scene.clone();
        compare(&flat(&scene), &once, 1e-7, |x| {
            unflat(&mut moved, x);
            moved.draw(&basis, &mut drawing).unwrap();
            pair(&drawing, &cotangent)
        }).map_err(TestCaseError::fail)?;
        scene.draw_vjp(&basis, &cotangent, &mut grad).unwrap();
        for (twice, once) in flat_grad(&grad).iter().zip(once) {
            prop_assert!((twice - 2.0 * once).abs() < 1e-9, "accumulation: {twice} is not twice {once}");
        }
    }

    #[test]
    fn transform_vjp_matches_differences(
        pose in strategy::pose(),
        unit in prop::collection::vec(-1.0..1.0, 14),
        cotangent in prop::collection::vec(-1.0..1.0, 14),
    ) {
        let mut grad = PoseGrad::default();
        let mut grad_unit = [[0.0; 2]; 7];
        pose.transform_vjp(unit.as_chunks().0, cotangent.as_chunks().0, &mut grad, &mut grad_unit);
        let mut x = vec![pose.translation[0], pose.translation[1], pose.scale, pose.rotation];
        x.extend(&unit);
        let mut analytic = vec![grad.translation[0], grad.translation[1], grad.scale, grad.rotation];
        analytic.extend(grad_unit.as_flattened());
        compare(&x, &analytic, 1e-8, |x| {
            let moved = Pose { translation: [x[0], x[1]], scale: x[2], rotation: x[3] };
            let mut outline = x[4..].to_vec();
            moved.transform(outline.as_chunks_mut().0);
            dot(&outline, &cotangent)
        }).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn rotation_from_pair_vjp_matches_differences(angle in -3.1..3.1_f64, length in 0.1..3.0) {
        let pair: [f64; 2] = [length * angle.sin(), length * angle.cos()];
        prop_assert!((rotation_from_pair(pair) - angle).abs() < 1e-12);
        let mut grad = [0.0; 2];
        rotation_from_pair_vjp(pair, 1.5, &mut grad);
        compare(&pair, &grad, 1e-7, |x| 1.5 * rotation_from_pair([x[0], x[1]])).map_err(TestCaseError::fail)?;
    }
}
