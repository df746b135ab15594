//! Gradients of drawings with respect to scenes of every kind of shape: numbers, poses, paints, confidences.

use dvp_core::shape::{Flattening, OutlineBasis, Shape as _, ShapeError};
use dvp_core::{Drawing, DrawingGrad, Object, Paint, Pose, Scene, SceneGrad};
use dvp_tests::finite_difference::{are_steady, compare, dot, step};
use dvp_tests::inside_integral::{integral, is_resolved};
use dvp_tests::shape_strategy;
use proptest::prelude::*;

fn object() -> impl Strategy<Value = Object<f64>> {
    let pose = (prop::array::uniform2(-1.0..1.0), 0.2..3.0, -3.0..3.0)
        .prop_map(|(translation, scale, rotation)| Pose { translation, scale, rotation });
    (shape_strategy::shape(), pose, prop::array::uniform3(0.0..1.0), 0.0..1.0)
        .prop_map(|(shape, pose, color, confidence)| Object { shape, pose, paint: Paint::Flat(color), confidence })
}

/// The numbers of a scene in one row, in the order of [`flat_grad`].
fn flat(scene: &Scene<f64>) -> Vec<f64> {
    let mut x = scene.background.to_vec();
    for object in &scene.objects {
        x.extend(object.pose.translation);
        x.extend([object.pose.scale, object.pose.rotation]);
        x.extend(object.color());
        x.push(object.confidence);
        object.shape.numbers(&mut x);
    }
    x
}

fn unflat(scene: &mut Scene<f64>, mut x: &[f64]) {
    scene.background.copy_from_slice(x.split_off(..3).unwrap());
    for object in &mut scene.objects {
        object.pose.translation.copy_from_slice(x.split_off(..2).unwrap());
        object.pose.scale = x[0];
        object.pose.rotation = x[1];
        object.paint.set_color([x[2], x[3], x[4]]);
        object.confidence = x[5];
        let count = object.shape.number_count();
        object.shape.set_numbers(&x[6..6 + count]).unwrap();
        x = &x[6 + count..];
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

fn drawn(scene: &Scene<f64>, how: Flattening<'_, f64>) -> Result<Drawing<f64>, ShapeError> {
    let mut drawing = Drawing::default();
    scene.draw(how, &mut drawing).map(|()| drawing)
}

/// The scalar that a cotangent makes of a drawing. Resolved outlines may change the order of their vertices: of them it is an integral
/// over the inside.
fn pair(scene: &Scene<f64>, drawing: &Drawing<f64>, cotangent: &DrawingGrad<f64>) -> f64 {
    let mut sum = dot(&drawing.background, &cotangent.background)
        + dot(drawing.colors.as_flattened(), cotangent.colors.as_flattened())
        + dot(&drawing.confidences, &cotangent.confidences);
    for (k, object) in scene.objects.iter().enumerate() {
        let range = drawing.starts[k]..drawing.starts[k + 1];
        sum += if is_resolved(&object.shape) {
            integral(drawing.rings(k)).0
        } else {
            dot(drawing.outline(k).as_flattened(), cotangent.vertices[range].as_flattened())
        };
    }
    sum
}

/// A cotangent of random numbers, for resolved outlines that of the integral.
fn cotangent(scene: &Scene<f64>, drawing: &Drawing<f64>, numbers: &[f64]) -> DrawingGrad<f64> {
    let mut grad = DrawingGrad::default();
    grad.reset(drawing);
    let mut numbers = numbers.iter().copied().cycle();
    let mut next = || numbers.next().unwrap();
    grad.background.fill_with(&mut next);
    grad.vertices.as_flattened_mut().fill_with(&mut next);
    grad.colors.as_flattened_mut().fill_with(&mut next);
    grad.confidences.fill_with(&mut next);
    for (k, _) in scene.objects.iter().enumerate().filter(|(_, object)| is_resolved(&object.shape)) {
        grad.vertices[drawing.starts[k]..drawing.starts[k + 1]].copy_from_slice(&integral(drawing.rings(k)).1);
    }
    grad
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, max_global_rejects: 4096, ..ProptestConfig::default() })]

    #[test]
    fn scenes_of_every_kind_match_differences(
        background in prop::array::uniform3(0.0..1.0),
        objects in prop::collection::vec(object(), 0..4),
        numbers in prop::collection::vec(-1.0..1.0, 1009),
        tolerance in prop_oneof![Just(1e-1), Just(1e-2)],
    ) {
        let scene = Scene { objects, ..Scene::empty(background) };
        let basis = OutlineBasis::new(32, 8).unwrap();
        let how = Flattening::new(&basis, tolerance);
        let drawing = drawn(&scene, how).unwrap();
        let x = flat(&scene);
        // The numbers of vertices are constant, to the gradient.
        let mut moved = scene.clone();
        for lane in 0..x.len() {
            for sign in [-1.0, 1.0] {
                let mut x = x.clone();
                x[lane] += sign * step(x[lane]);
                unflat(&mut moved, &x);
                let other = drawn(&moved, how).unwrap();
                prop_assume!(other.starts == drawing.starts && other.breaks == drawing.breaks);
            }
        }
        let cotangent = cotangent(&scene, &drawing, &numbers);
        let mut grad = SceneGrad::default();
        grad.reset(&scene);
        scene.draw_vjp(how, &cotangent, &mut grad).unwrap();
        let once = flat_grad(&grad);
        let mut value = |x: &[f64]| {
            unflat(&mut moved, x);
            // Longer steps than those above may change the numbers of vertices too: such a scene is not steady.
            let same = drawn(&moved, how).ok().filter(|other| other.starts == drawing.starts && other.breaks == drawing.breaks);
            same.map_or(f64::NAN, |other| pair(&moved, &other, &cotangent))
        };
        prop_assume!(are_steady(&x, &mut value));
        compare(&x, &once, 1e-6, value).map_err(TestCaseError::fail)?;
        scene.draw_vjp(how, &cotangent, &mut grad).unwrap();
        for (twice, once) in flat_grad(&grad).iter().zip(once) {
            prop_assert!((twice - 2.0 * once).abs() <= 1e-9 * (1.0 + once.abs()), "accumulation: {twice} is not twice {once}");
        }
    }
}
