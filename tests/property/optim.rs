//! Invariants of the paper's optimizers.

use dvp_core::render::contour::ContourRenderer;
use dvp_core::render::{Compositing, EdgeProfile, Renderer};
use dvp_core::shape::OutlineBasis;
use dvp_core::{Drawing, Efd, Image, ImageSize, Object, Pose, Scene};
use dvp_fit::StopReason;
use dvp_fit::adam::descent::{Descent, DescentError};
use dvp_fit::opt_iter::OptIter;
use dvp_fit::opt_p::OptP;
use dvp_fit::parameters::renormalize;
use dvp_fit::rand_opt_p::{RandOptP, random_scene};
use dvp_tests::strategy;
use proptest::prelude::*;

const VERTICES: usize = 64;

fn renderer() -> ContourRenderer<f32> {
    ContourRenderer::new(EdgeProfile::reference(), Compositing::Blend)
}

fn paint(scene: &Scene<f32>, side: usize) -> Image<f32> {
    let mut drawing = Drawing::default();
    scene.draw(&OutlineBasis::new(VERTICES, 16).unwrap(), &mut drawing).unwrap();
    let mut image = Image::zeros(ImageSize::new(side, side).unwrap());
    renderer().render(&drawing, image.size(), &mut Default::default(), image.data_mut()).unwrap();
    image
}

fn ellipse(translation: [f32; 2], color: [f32; 3]) -> Object<f32> {
    let pose = Pose { translation, scale: 0.2, rotation: 0.4 };
    Object::of_efd(pose, color, 1.0, Efd::new(vec![[1.0, 0.0, 0.0, -0.5]]), None)
}

fn two_ellipses() -> Scene<f32> {
    let objects = vec![ellipse([0.3, 0.35], [0.9, 0.1, 0.2]), ellipse([0.7, 0.65], [0.1, 0.3, 0.9])];
    Scene { objects, ..Scene::empty([0.8, 0.9, 0.7]) }
}

/// The truth, each object a little off.
fn perturbed() -> Scene<f32> {
    let mut scene = two_ellipses();
    for (object, sign) in scene.objects.iter_mut().zip([1.0, -1.0]) {
        object.pose.translation[0] += 0.02 * sign;
        object.pose.translation[1] -= 0.015;
        object.pose.scale *= 1.0 + 0.1 * sign;
        object.pose.rotation += 0.2 * sign;
        object.paint.colors_mut().for_each(|color| color[1] += 0.05);
    }
    scene.background[2] -= 0.05;
    scene
}

fn bits(scene: &Scene<f32>) -> Vec<u32> {
    let objects = scene.objects.iter().flat_map(|object| {
        let Pose { translation: [x, y], scale, rotation } = object.pose;
        [x, y, scale, rotation].into_iter().chain(object.color()).chain(object.efd_rows().iter().flatten().copied())
    });
    scene.background.into_iter().chain(objects).map(f32::to_bits).collect()
}

proptest! {
    #[test]
    fn renormalizing_keeps_the_outline(object in strategy::object(1..9), size in 0.2..5.0_f64, turn in -3.0..3.0_f64) {
        let basis = OutlineBasis::new(VERTICES, 9).unwrap();
        let mut efd = object.shape.efd().unwrap().clone();
        efd.rotate_scale(turn, size);
        let mut before = vec![[0.0; 2]; VERTICES];
        basis.outline(efd.rows(), &mut before).unwrap();
        object.pose.transform(&mut before);

        let mut pose = object.pose;
        pose.rotation += renormalize(efd.rows_mut(), &mut pose.scale);
        let [a, _, c, _] = efd.rows()[0];
        prop_assert!((a - 1.0).abs() < 1e-12 && c.abs() < 1e-12, "{:?}", efd.rows()[0]);
        let mut after = vec![[0.0; 2]; VERTICES];
        basis.outline(efd.rows(), &mut after).unwrap();
        pose.transform(&mut after);
        for (a, b) in before.as_flattened().iter().zip(after.as_flattened()) {
            prop_assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
        // Normal once is normal for good.
        let mut scale = 1.0;
        prop_assert!(renormalize(efd.rows_mut(), &mut scale).abs() < 1e-12 && (scale - 1.0).abs() < 1e-12);
    }

    #[test]
    fn random_scenes_keep_to_their_ranges(count in 0_usize..6, seed in any::<u64>()) {
        let shapes = [Efd::new(vec![[1.0, 0.0, 0.0, -0.5]]), Efd::new(vec![[1.0, 0.0, 0.0, -1.0]])];
        let scene: Scene<f64> = random_scene(count, &shapes, seed);
        prop_assert_eq!(scene.objects.len(), count);
        prop_assert_eq!(&scene, &random_scene(count, &shapes, seed));
        for object in &scene.objects {
            prop_assert!(object.pose.translation.iter().all(|t| (0.05..0.95).contains(t)));
            prop_assert!((0.1..0.3).contains(&object.pose.scale));
            prop_assert!(object.color().iter().all(|c| (0.0..1.0).contains(c)));
        }
    }
}

#[test]
fn opt_p_recovers_a_small_perturbation() {
    let (truth, renderer) = (two_ellipses(), renderer());
    let image = paint(&truth, 64);
    let mut descent = Descent::new(&renderer, VERTICES, 1).unwrap();
    let start = OptP::default().with_steps(0).fit(&mut descent, image.view(), &perturbed()).unwrap();
    let fit = OptP::default().fit(&mut descent, image.view(), &perturbed()).unwrap();
    assert!(start.loss > 0.02, "{}", start.loss);
    assert!(fit.loss < start.loss / 20.0, "{} from {}", fit.loss, start.loss);
    assert_eq!((fit.steps, fit.stop), (100, StopReason::StepLimit));
    for (found, object) in fit.scene.objects.iter().zip(&truth.objects) {
        for (a, b) in found.pose.translation.iter().zip(object.pose.translation) {
            assert!((a - b).abs() < 2e-3, "{:?}", found.pose);
        }
        assert!((found.pose.scale - 0.2).abs() < 2e-3 && (found.pose.rotation - 0.4).abs() < 0.02, "{:?}", found.pose);
    }
    // A descent with a history gives the same bits as a new one.
    let mut fresh = Descent::new(&renderer, VERTICES, 1).unwrap();
    let again = OptP::default().fit(&mut fresh, image.view(), &perturbed()).unwrap();
    assert_eq!((bits(&again.scene), again.loss.to_bits()), (bits(&fit.scene), fit.loss.to_bits()));
}

#[test]
fn opt_iter_finds_both_objects() {
    let (truth, renderer) = (two_ellipses(), renderer());
    let image = paint(&truth, 64);
    let mut descent = Descent::new(&renderer, VERTICES, 4).unwrap();
    let mut settings = OptIter::default();
    (settings.object_count, settings.harmonic_count) = (2, 4);
    (settings.shape, settings.finish) = ((60, 5e-3), (20, 5e-3));
    let fit = settings.fit(&mut descent, image.view()).unwrap();
    assert_eq!((fit.scene.objects.len(), fit.steps), (2, 2 * 160 + 20));
    assert!(fit.loss < 5e-3, "{}", fit.loss);
    for object in &truth.objects {
        let distance = |found: &Object<f32>| {
            let [dx, dy] = [0, 1].map(|i| found.pose.translation[i] - object.pose.translation[i]);
            dx.hypot(dy)
        };
        assert!(fit.scene.objects.iter().any(|found| distance(found) < 0.01), "{:?}", fit.scene.objects);
    }
}

#[test]
fn rand_opt_p_never_ends_above_its_start() {
    let renderer = renderer();
    let image = paint(&two_ellipses(), 32);
    let shapes = [Efd::new(vec![[1.0, 0.0, 0.0, -0.5], [0.0; 4]])];
    let mut descent = Descent::new(&renderer, VERTICES, 2).unwrap();
    let mut settings = RandOptP::default();
    (settings.pose, settings.shape, settings.contour_length) = ((20, 0.01), (20, 1e-3), 0.0);
    for seed in 0..4 {
        let start = random_scene(2, &shapes, seed);
        let before = OptP::default().with_steps(0).fit(&mut descent, image.view(), &start).unwrap();
        let fit = settings.fit(&mut descent, image.view(), &start).unwrap();
        assert!(fit.loss < before.loss, "{} from {}", fit.loss, before.loss);
    }
}

#[test]
fn nothing_to_find() {
    let renderer = renderer();
    let flat = paint(&Scene::empty([0.25, 0.5, 0.75]), 16);
    let mut descent = Descent::new(&renderer, VERTICES, 16).unwrap();
    let fit = OptIter::default().fit(&mut descent, flat.view()).unwrap();
    assert_eq!((fit.scene.objects.len(), fit.stop), (0, StopReason::Empty));
    assert!(fit.loss < 1e-6, "{}", fit.loss);
    // Without objects the background moves alone.
    let fit = OptP::default().fit(&mut descent, flat.view(), &Scene::empty([0.3, 0.4, 0.7])).unwrap();
    assert!(fit.loss < 2e-3, "{}", fit.loss);
}

#[test]
fn numbers_that_are_none_are_refused() {
    let renderer = renderer();
    let mut descent = Descent::new(&renderer, VERTICES, 1).unwrap();
    let mut image = paint(&two_ellipses(), 16);
    let mut start = perturbed();
    start.objects[1].pose.scale = f32::NAN;
    let refused = OptP::default().fit(&mut descent, image.view(), &start).unwrap_err();
    assert!(matches!(refused, DescentError::Render(_)), "{refused}");
    let mut many = perturbed();
    many.objects[0].shape = Efd::zeros(2).into();
    let refused = OptP::default().fit(&mut descent, image.view(), &many).unwrap_err();
    assert!(matches!(refused, DescentError::Shape(_)), "{refused}");
    image.data_mut()[7] = f32::NAN;
    assert!(OptP::default().fit(&mut descent, image.view(), &perturbed()).is_err());
    assert!(OptIter::default().fit(&mut descent, image.view()).is_err());
}
