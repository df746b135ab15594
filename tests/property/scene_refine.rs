//! Drawings whose numbers were shaken, brought back by the joint refinement through the renderer.

#![expect(clippy::float_cmp, reason = "what does not move stays the same bit for bit")]

use dvp_core::image::{CHANNELS, ImageView};
use dvp_core::render::{Compositing, ContourRenderer, EdgeProfile, Renderer};
use dvp_core::shape::{
    AnyShape, Circle, Ellipse, Flattening, OutlineBasis, Path, PathRing, Polygon, Rectangle, Segment, Shape as _,
};
use dvp_core::{Drawing, ImageSize, Object, Paint, Pose, Scene};
use dvp_fit::scene_refine::{RefineStep, SceneRefine};
use proptest::prelude::*;

const SIDE: usize = 64;

fn object(shape: impl Into<AnyShape<f64>>, translation: [f64; 2], rotation: f64, color: [f64; 3]) -> Object<f64> {
    let pose = Pose { translation, scale: 1.0, rotation };
    Object { shape: shape.into(), pose, paint: Paint::Flat(color), confidence: 1.0 }
}

/// A disk, a turned ellipse, a rectangle with a hole in it, and a leaf of two cubics, far enough apart.
fn drawing(edge: EdgeProfile<f64>) -> Scene<f64> {
    let still = [0.0; 2];
    let frame = Polygon {
        rings: vec![
            vec![[0.55, 0.1], [0.9, 0.1], [0.9, 0.42], [0.55, 0.42]],
            vec![[0.65, 0.18], [0.65, 0.34], [0.8, 0.34], [0.8, 0.18]],
        ],
    };
    let leaf = PathRing {
        points: vec![[0.6, 0.85], [0.9, 0.6]],
        segments: vec![
            Segment::Cubic { controls: [[0.55, 0.7], [0.7, 0.55]] },
            Segment::Cubic { controls: [[0.95, 0.75], [0.8, 0.95]] },
        ],
    };
    let objects = vec![
        object(Circle { radius: 0.14 }, [0.25, 0.25], 0.0, [0.8, 0.1, 0.1]),
        object(Ellipse { radii: [0.2, 0.1] }, [0.28, 0.7], 0.5, [0.1, 0.3, 0.7]),
        object(frame, still, 0.0, [0.2, 0.6, 0.2]),
        object(Path::new(vec![leaf]).unwrap(), still, 0.0, [0.9, 0.7, 0.1]),
    ];
    Scene { objects, edge, compositing: Compositing::Over, ..Scene::empty([0.95, 0.95, 0.9]) }
}

fn paint<const N: usize>(scene: &Scene<f64>) -> Vec<f64> {
    let size = ImageSize::new(SIDE, SIDE).unwrap();
    let basis = OutlineBasis::new(64, 1).unwrap();
    let mut drawing = Drawing::default();
    scene.draw(Flattening::new(&basis, 1e-4), &mut drawing).unwrap();
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    let mut pixels = vec![0.0; N * size.pixels()];
    let mut scratch = Default::default();
    if N == CHANNELS {
        renderer.render(&drawing, size, &mut scratch, &mut pixels).unwrap();
    } else {
        renderer.render_rgba(&drawing, size, &mut scratch, &mut pixels).unwrap();
    }
    pixels
}

/// The scene with every number of every shape, pose and color moved by `shakes` times a pixel, a twentieth in colors.
fn shaken(scene: &Scene<f64>, shakes: &[f64]) -> Scene<f64> {
    let px = 1.0 / SIDE as f64;
    let mut shakes = shakes.iter().copied().cycle();
    let mut shake = |value: &mut f64, size: f64| *value += size * shakes.next().unwrap();
    let mut scene = scene.clone();
    for object in &mut scene.objects {
        let free = object.shape.pose_freedom();
        if free.translation {
            object.pose.translation.iter_mut().for_each(|value| shake(value, px));
        }
        if free.rotation {
            shake(&mut object.pose.rotation, 5.0 * px);
        }
        let mut numbers = Vec::new();
        object.shape.numbers(&mut numbers);
        numbers.iter_mut().for_each(|value| shake(value, px));
        object.shape.set_numbers(&numbers).unwrap();
        object.paint.colors_mut().flatten().for_each(|value| shake(value, 0.05));
    }
    scene
}

fn numbers(scene: &Scene<f64>) -> Vec<f64> {
    let mut numbers = Vec::new();
    for object in &scene.objects {
        numbers.extend(object.pose.translation);
        numbers.push(object.pose.rotation);
        object.shape.numbers(&mut numbers);
        numbers.extend(object.color());
    }
    numbers
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn shaken_numbers_come_back(
        shakes in prop::collection::vec(-1.0..1.0_f64, 61),
        blurred in any::<bool>(),
        transparent in any::<bool>(),
    ) {
        let edge = if blurred { EdgeProfile::distance(0.02) } else { EdgeProfile::area() };
        let truth = Scene { transparent, ..drawing(edge) };
        let start = shaken(&truth, &shakes);
        let size = ImageSize::new(SIDE, SIDE).unwrap();
        let refine = SceneRefine::default();
        let refined = if transparent {
            let pixels = paint::<4>(&truth);
            refine.fit(ImageView::premultiplied(size, &pixels).unwrap(), &start).unwrap()
        } else {
            let pixels = paint::<3>(&truth);
            refine.fit(ImageView::new(size, &pixels).unwrap(), &start).unwrap()
        };
        prop_assert!(refined.loss <= refined.start_loss * 1e-3, "{} from {}", refined.loss, refined.start_loss);
        prop_assert_eq!(refined.scene.objects.len(), truth.objects.len());
        for (object, before) in refined.scene.objects.iter().zip(&start.objects) {
            prop_assert_eq!(object.shape.kind(), before.shape.kind());
            prop_assert!(object.confidence == before.confidence);
        }
        // Numbers of the first three objects are unique; control points of the leaf may slide along it.
        let (found, expected) = (numbers(&refined.scene), numbers(&truth));
        let unique = found.len() - 15 - 3;
        for (i, (found, expected)) in found.iter().zip(&expected).enumerate().take(unique) {
            prop_assert!((found - expected).abs() < 0.02 / SIDE as f64 * 5.0, "number {i}: {found}, not {expected}");
        }
    }
}

#[test]
fn what_is_right_stays() {
    let truth = drawing(EdgeProfile::area());
    let pixels = paint::<3>(&truth);
    let size = ImageSize::new(SIDE, SIDE).unwrap();
    let refined = SceneRefine::default().fit(ImageView::<_, 3>::new(size, &pixels).unwrap(), &truth).unwrap();
    assert!(refined.loss <= refined.start_loss);
    for (found, expected) in numbers(&refined.scene).iter().zip(numbers(&truth)) {
        assert!((found - expected).abs() < 1e-3, "{found}, not {expected}");
    }
}

#[test]
fn what_is_out_of_sight_stays_where_it_is() {
    let mut truth = drawing(EdgeProfile::area());
    let rectangle = Rectangle { size: [0.1, 0.1], corner_radius: 0.02 };
    truth.objects.push(object(rectangle, [4.0, 4.0], 0.3, [0.5; 3]));
    let pixels = paint::<3>(&truth);
    let start = shaken(&truth, &[0.5, -0.7, 0.9]);
    let size = ImageSize::new(SIDE, SIDE).unwrap();
    let refined = SceneRefine::default().fit(ImageView::<_, 3>::new(size, &pixels).unwrap(), &start).unwrap();
    assert_eq!(refined.scene.objects.last(), start.objects.last());
    assert!(refined.loss < 1e-3 * refined.start_loss);
}

#[test]
fn scenes_of_nothing_and_of_nonsense_are_answered() {
    let size = ImageSize::new(8, 8).unwrap();
    let pixels = vec![0.5; 3 * size.pixels()];
    let image = ImageView::<f64, 3>::new(size, &pixels).unwrap();
    let empty = Scene::empty([0.1; 3]);
    let refined = SceneRefine::default().fit(image, &empty).unwrap();
    assert!(refined.scene.background.iter().all(|value| (value - 0.5).abs() < 1e-6), "the background moves alone");
    let mut nonsense = empty.clone();
    nonsense.objects.push(object(Circle { radius: f64::NAN }, [0.5; 2], 0.0, [0.5; 3]));
    assert!(SceneRefine::default().fit(image, &nonsense).is_err());
}

#[test]
fn opacities_may_end_at_their_bounds() {
    let mut truth = drawing(EdgeProfile::area());
    let mut start = shaken(&truth, &[0.4, -0.6, 0.3]);
    // One is not there, one is opaque; both begin half there, and others come after them.
    (truth.objects[0].confidence, truth.objects[1].confidence) = (0.0, 1.0);
    (start.objects[0].confidence, start.objects[1].confidence) = (0.3, 0.7);
    let pixels = paint::<3>(&truth);
    let size = ImageSize::new(SIDE, SIDE).unwrap();
    let refined = SceneRefine::default().fit(ImageView::<_, 3>::new(size, &pixels).unwrap(), &start).unwrap();
    assert!(refined.loss < 1e-3 * refined.start_loss, "{} from {}", refined.loss, refined.start_loss);
    // What is half opaque looks like what is opaque in a paler color: there is no one answer for the second.
    let absent = refined.scene.objects[0].confidence;
    assert!((0.0..0.05).contains(&absent), "{absent}");
    assert_eq!(refined.scene.objects[2].shape.kind(), "polygon");
}

#[test]
fn an_image_with_alpha_needs_a_transparent_scene() {
    let size = ImageSize::new(8, 8).unwrap();
    let pixels = vec![0.0; 4 * size.pixels()];
    let image = ImageView::premultiplied(size, &pixels).unwrap();
    assert!(SceneRefine::default().fit(image, &Scene::<f64>::empty([0.5; 3])).is_err());
}

#[test]
fn who_watches_sees_the_start_and_every_step_to_the_end() {
    let truth = drawing(EdgeProfile::area());
    let start = shaken(&truth, &[0.4, -0.6, 0.3]);
    let pixels = paint::<3>(&truth);
    let image = ImageView::<_, 3>::new(ImageSize::new(SIDE, SIDE).unwrap(), &pixels).unwrap();
    let mut seen = Vec::new();
    let watch = &mut |step: RefineStep<'_, f64>| seen.push((step.step, step.loss, step.scene.clone()));
    let refined = SceneRefine::default().fit_watched(image, &start, watch).unwrap();
    assert_eq!((seen[0].1, &seen[0].2), (refined.start_loss, &start));
    assert!(seen.len() > 5 && seen.iter().enumerate().all(|(k, step)| step.0 == k));
    assert!(seen.is_sorted_by(|a, b| a.1 >= b.1 * (1.0 - 1e-12)), "the loss never rises");
    assert_eq!(seen.last().unwrap().2, refined.scene, "the last step is the result");
    assert_eq!(SceneRefine::default().fit(image, &start).unwrap().scene, refined.scene, "watching changes nothing");
}
