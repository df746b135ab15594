//! Gradients of LIVE: the price on crossings, and what a layer makes small, by every number that moves.

use dvp_core::geometry::Px;
use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::shape::{Path, PathRing, Segment, Shape as _};
use dvp_core::{Image, ImageSize, Object, Paint, Pose, Scene, SceneGrad};
use dvp_fit::live::crossing::crossing_and_grad;
use dvp_fit::live::descent::{PathDescent, PathLoss, PathStage};
use dvp_tests::finite_difference::{are_steady, compare};
use dvp_tests::strategy::color;
use proptest::prelude::*;

const SIDE: usize = 20;

/// A closed path of two to five cubics around a place, its points on distinct rays so that some legs cross and some do not.
fn path() -> impl Strategy<Value = Path<f64>> {
    let point = || (0.1..0.35, -0.3..0.3);
    let segment = (point(), point(), point());
    (prop::array::uniform2(0.3..0.7), prop::collection::vec(segment, 2..6)).prop_map(|(center, segments)| {
        let step = core::f64::consts::TAU / segments.len() as f64;
        let place = |turns: f64, (radius, off): (f64, f64)| {
            let angle = step * (turns + off);
            [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()]
        };
        let (points, segments) = segments
            .iter()
            .enumerate()
            .map(|(k, &(from, first, second))| {
                let k = k as f64;
                let controls = [place(k + 1.0 / 3.0, first), place(k + 2.0 / 3.0, second)];
                (place(k, from), Segment::Cubic { controls })
            })
            .unzip();
        Path::new(vec![PathRing { points, segments }]).unwrap()
    })
}

fn scene() -> impl Strategy<Value = Scene<f64>> {
    let object = (path(), color(), 0.1..0.9).prop_map(|(path, color, confidence)| Object {
        shape: path.into(),
        pose: Pose::identity(),
        paint: Paint::Flat(color),
        confidence,
    });
    (color(), prop::collection::vec(object, 1..4)).prop_map(|(background, objects)| Scene {
        objects,
        edge: EdgeProfile::distance(0.05),
        compositing: Compositing::Over,
        ..Scene::empty(background)
    })
}

/// Every number of a scene of paths that moves.
fn numbers(scene: &Scene<f64>) -> Vec<f64> {
    let mut numbers = scene.background.to_vec();
    for object in &scene.objects {
        object.shape.numbers(&mut numbers);
        numbers.extend(object.color());
        numbers.push(object.confidence);
    }
    numbers
}

fn gradient(grad: &SceneGrad<f64>) -> Vec<f64> {
    let objects = grad.objects.iter();
    let objects = objects.flat_map(|object| {
        object.numbers.iter().copied().chain(object.color).chain(core::iter::once(object.confidence))
    });
    grad.background.into_iter().chain(objects).collect()
}

fn with_numbers(scene: &Scene<f64>, numbers: &[f64]) -> Scene<f64> {
    let mut scene = scene.clone();
    let (background, mut rest) = numbers.split_at(3);
    scene.background.copy_from_slice(background);
    for object in &mut scene.objects {
        let (shape, others) = rest.split_at(object.shape.number_count());
        let (paint, others) = others.split_at(4);
        object.shape.set_numbers(shape).unwrap();
        object.paint.set_color([paint[0], paint[1], paint[2]]);
        object.confidence = paint[3];
        rest = others;
    }
    scene
}

proptest! {
    #[test]
    fn crossing_matches_differences(scene in scene(), weight in 0.1..2.0) {
        let mut grad = SceneGrad::default();
        grad.reset(&scene);
        let price = crossing_and_grad(&scene.objects, weight, &mut grad);
        prop_assert!((0.0..=weight).contains(&price), "{price}");
        let mut unused = SceneGrad::default();
        let mut price = |x: &[f64]| {
            let moved = with_numbers(&scene, x);
            unused.reset(&moved);
            crossing_and_grad(&moved.objects, weight, &mut unused)
        };
        let x = numbers(&scene);
        // Where a leg has next to no length the sine bends faster than differences can follow.
        prop_assume!(are_steady(&x, &mut price));
        compare(&x, &gradient(&grad), 1e-6, price).map_err(TestCaseError::fail)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, max_global_rejects: 4096, ..ProptestConfig::default() })]

    #[test]
    fn a_layer_matches_differences(
        scene in scene(),
        pixels in prop::collection::vec(0.0..1.0, 3 * SIDE * SIDE),
        reach in 2.0..12.0,
    ) {
        let image = Image::from_planar(ImageSize::new(SIDE, SIDE).unwrap(), pixels).unwrap();
        let stage = PathStage {
            steps: 0,
            point_rate: Px(1.0),
            color_rate: 0.01,
            last_rate: 1.0,
            loss: PathLoss::Focused { reach: Px(reach), every: 1 },
            crossing: 0.3,
            background: true,
            opacity: true,
        };
        let mut descent = PathDescent::new(image.view(), scene.edge, scene.compositing).unwrap();
        descent.focus_on(&scene, Px(reach)).unwrap();
        descent.objective(&scene, &stage).unwrap();
        let grad = gradient(descent.gradient());
        let layout = descent.drawing().starts.clone();
        let mut same_layout = true;
        let mut loss = |x: &[f64]| {
            let loss = descent.objective(&with_numbers(&scene, x), &stage).unwrap();
            same_layout &= descent.drawing().starts == layout;
            loss
        };
        let x = numbers(&scene);
        // A pixel as near to one part of an outline as to another is at a kink of its distance.
        prop_assume!(are_steady(&x, &mut loss));
        let compared = compare(&x, &grad, 2e-5, loss);
        // A polygon that gets a vertex more is another function.
        prop_assume!(same_layout);
        compared.map_err(TestCaseError::fail)?;
    }
}
