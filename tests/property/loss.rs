//! Losses: 0 at equality, at least 0 elsewhere, unchanged by what must not matter.

use core::f64::consts::TAU;

use dvp_core::loss::{ImagePair, Loss, Pyramid, RotationTerm, SceneLoss, ScenePairs, SceneTerms, Ssim};
use dvp_core::render::PixelLoss;
use dvp_core::shape::{REFERENCE_SYMMETRY_HARMONICS, REFERENCE_SYMMETRY_THRESHOLD};
use dvp_core::{ImageSize, ImageView, Scene};
use dvp_tests::strategy;
use proptest::collection::vec;
use proptest::prelude::*;

fn images() -> impl Strategy<Value = (ImageSize, Vec<f64>, Vec<f64>)> {
    (11..40_usize, 11..24_usize).prop_flat_map(|(width, height)| {
        let size = ImageSize::new(width, height).unwrap();
        let values = || vec(0.0..1.0, size.pixels() * 3);
        (Just(size), values(), values())
    })
}

fn value<L>(loss: &L, size: ImageSize, a: &[f64], b: &[f64]) -> f64
where
    L: for<'a> Loss<f64, Input<'a> = ImagePair<'a, f64>, Grad = [f64]>,
{
    let pair = ImagePair::new(ImageView::new(size, a).unwrap(), ImageView::new(size, b).unwrap()).unwrap();
    loss.value(pair, &mut L::Scratch::default()).unwrap()
}

/// Position `at + step` of a line continued by reflection.
fn mirrored(at: usize, step: i32, len: usize) -> usize {
    let at = (i32::try_from(at).unwrap() + step).unsigned_abs() as usize;
    if at < len { at } else { 2 * (len - 1) - at }
}

/// SSIM by its definition: a two-dimensional window, weighted means, variances around those means.
fn direct_ssim(size: ImageSize, a: &[f64], b: &[f64]) -> f64 {
    let weight = |i: i32| (-f64::from(i * i) / (2.0 * 1.5 * 1.5)).exp();
    let total: f64 = (-5..=5).map(weight).sum();
    let (mut sum, mut count) = (0.0, 0.0);
    for plane in 0..3 {
        for row in 0..size.height() {
            for column in 0..size.width() {
                let at = |dy: i32, dx: i32| {
                    let row = mirrored(row, dy, size.height());
                    let column = mirrored(column, dx, size.width());
                    let index = plane * size.pixels() + row * size.width() + column;
                    (weight(dy) * weight(dx) / (total * total), a[index], b[index])
                };
                let window = || (-5..=5).flat_map(|dy| (-5..=5).map(move |dx| at(dy, dx)));
                let m_a: f64 = window().map(|(w, a, _)| w * a).sum();
                let m_b: f64 = window().map(|(w, _, b)| w * b).sum();
                let v_a: f64 = window().map(|(w, a, _)| w * (a - m_a).powi(2)).sum();
                let v_b: f64 = window().map(|(w, _, b)| w * (b - m_b).powi(2)).sum();
                let cov: f64 = window().map(|(w, a, b)| w * (a - m_a) * (b - m_b)).sum();
                sum += (2.0 * m_a * m_b + 1e-4) * (2.0 * cov + 9e-4)
                    / ((m_a * m_a + m_b * m_b + 1e-4) * (v_a + v_b + 9e-4));
                count += 1.0;
            }
        }
    }
    sum / count
}

/// A scene whose objects all count, and an order to put them in.
fn ordered_scene() -> impl Strategy<Value = (Scene<f64>, Vec<usize>)> {
    strategy::scene(1..6, 1..6).prop_flat_map(|mut scene| {
        scene.objects.iter_mut().for_each(|object| object.confidence = 1.0);
        let order: Vec<usize> = (0..scene.objects.len()).collect();
        (Just(scene), Just(order).prop_shuffle())
    })
}

fn scene_terms(loss: &SceneLoss<f64>, prediction: &Scene<f64>, truth: &Scene<f64>) -> SceneTerms<f64> {
    let pairs = ScenePairs::new(core::slice::from_ref(prediction), core::slice::from_ref(truth)).unwrap();
    loss.terms(pairs, &mut Default::default()).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn image_losses_are_zero_at_equality_and_symmetric((size, a, b) in images()) {
        fn check<L>(loss: &L, size: ImageSize, a: &[f64], b: &[f64]) -> Result<(), TestCaseError>
        where
            L: for<'a> Loss<f64, Input<'a> = ImagePair<'a, f64>, Grad = [f64]>,
        {
            prop_assert!(value(loss, size, a, a).abs() < 1e-12);
            let (there, back) = (value(loss, size, a, b), value(loss, size, b, a));
            prop_assert!(there > 0.0 && (there - back).abs() < 1e-12, "{} {}", there, back);
            Ok(())
        }
        check(&PixelLoss::Mae, size, &a, &b)?;
        check(&PixelLoss::Mse, size, &a, &b)?;
        check(&Ssim::default(), size, &a, &b)?;
        check(&Pyramid::new(PixelLoss::Mse, 4).unwrap(), size, &a, &b)?;
    }

    #[test]
    fn ssim_follows_its_definition((size, a, b) in images()) {
        let fast = 1.0 - value(&Ssim::default(), size, &a, &b);
        let direct = direct_ssim(size, &a, &b);
        prop_assert!((fast - direct).abs() < 1e-12, "{} {}", fast, direct);
    }

    /// Halving keeps the mean color of images with even sides, so the levels of a constant difference are equal.
    #[test]
    fn a_constant_difference_has_the_same_loss_on_all_levels((size, a, _) in images(), shift in 0.01..0.5) {
        let shift: f64 = shift;
        let b: Vec<f64> = a.iter().map(|v| v + shift).collect();
        let loss: f64 = value(&Pyramid::new(PixelLoss::Mae, 6).unwrap(), size, &a, &b);
        prop_assert!((loss - shift).abs() < 1e-12);
    }

    #[test]
    fn scene_loss_is_zero_at_equality_and_blind_to_order((scene, order) in ordered_scene()) {
        let mut shuffled = scene.clone();
        shuffled.objects = order.iter().map(|&k| scene.objects[k].clone()).collect();
        for rotation in [RotationTerm::Modulo, RotationTerm::EveryOrder] {
            let mut loss = SceneLoss::reference(32, 6).unwrap();
            loss.rotation = rotation;
            prop_assert!(scene_terms(&loss, &shuffled, &scene).sum().abs() < 1e-12);
        }
    }

    #[test]
    fn order_of_slots_and_true_objects_does_not_matter(
        (truth, order) in ordered_scene(),
        mut prediction in strategy::scene(6..8, 1..6),
    ) {
        let loss = SceneLoss::reference(32, 6).unwrap();
        let before = scene_terms(&loss, &prediction, &truth).sum();
        let mut shuffled = truth.clone();
        shuffled.objects = order.iter().map(|&k| truth.objects[k].clone()).collect();
        prediction.objects.reverse();
        prop_assert!((scene_terms(&loss, &prediction, &shuffled).sum() - before).abs() < 1e-12);
    }

    #[test]
    fn a_symmetric_turn_is_free((truth, _) in ordered_scene(), turns in vec(-3..4_i32, 6)) {
        let loss = SceneLoss::reference(32, 6).unwrap();
        let mut turned = truth.clone();
        for (object, turn) in turned.objects.iter_mut().zip(turns) {
            let efd = object.shape.efd().unwrap();
            let order = efd.reference_symmetry_order(REFERENCE_SYMMETRY_HARMONICS, REFERENCE_SYMMETRY_THRESHOLD);
            object.pose.rotation += f64::from(turn) * TAU / f64::from(u32::try_from(order).unwrap());
        }
        prop_assert!(scene_terms(&loss, &turned, &truth).rotation.abs() < 1e-12);
    }

    #[test]
    fn hidden_true_objects_do_not_count((truth, _) in ordered_scene(), extra in strategy::object(1..6)) {
        let loss = SceneLoss::reference(32, 6).unwrap();
        let mut with_hidden = truth.clone();
        with_hidden.objects.insert(0, dvp_core::Object { confidence: 0.4, ..extra });
        prop_assert!(scene_terms(&loss, &truth, &with_hidden).sum().abs() < 1e-12);
    }
}
