//! Invariants of the joint second-order refinement.

use dvp::method::perturbed;
use dvp::paint::Painter;
use dvp_core::render::Compositing;
use dvp_core::shape::mdshr_bank;
use dvp_core::{Efd, Image, ImageSize, Object, Pose, Scene};
use dvp_fit::refine::{Refine, RefineScratch};
use dvp_fit::{Ambiguity, FitError};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const SIDE: usize = 128;
const HARMONICS: usize = 16;

fn paint(scene: &Scene<f32>) -> Image<f32> {
    Painter::default().paint(scene, ImageSize::new(SIDE, SIDE).unwrap()).unwrap()
}

/// Two to four objects of MDS-HR's shapes, a quarter of the image each, as many colors as objects.
fn scene(rng: &mut ChaCha8Rng) -> Scene<f32> {
    let bank = mdshr_bank::<f32>(HARMONICS);
    let count = rng.random_range(2..=4);
    let objects = (0..count).map(|k| {
        let prototype = rng.random_range(0..3);
        let center = [0.27 + 0.46 * ((k % 2) as f32), 0.27 + 0.46 * ((k / 2) as f32)];
        let pose = Pose {
            translation: center.map(|t| t + rng.random_range(-0.05..0.05)),
            scale: rng.random_range(0.12..0.24),
            rotation: rng.random_range(-3.0..3.0),
        };
        let color = core::array::from_fn(|_| rng.random_range(0.0..1.0));
        let efd = bank.prototypes()[prototype].clone();
        Object::of_efd(pose, color, 1.0, efd, Some(prototype))
    });
    Scene { objects: objects.collect(), ..Scene::empty([0.5, 0.45, 0.55]) }
}

#[test]
fn perturbed_truths_are_recovered() {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let mut scratch = RefineScratch::default();
    let mut recovered = 0;
    for _ in 0..60 {
        let truth = scene(&mut rng);
        let image = paint(&truth);
        let fit = Refine::default().fit(image.view(), &perturbed(&truth, &mut rng), &mut scratch).unwrap();
        recovered += usize::from(fit.loss < 5e-4);
        assert_eq!(fit.covariance.len(), truth.objects.len());
        assert!(fit.covariance.iter().flatten().all(|value| value.is_finite()));
    }
    assert!(recovered >= 57, "{recovered} of 60");
}

#[test]
fn the_truth_stays_and_memory_has_no_effect() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let mut used = RefineScratch::default();
    for compositing in [Compositing::Blend, Compositing::Over] {
        let truth = Scene { compositing, ..scene(&mut rng) };
        let image = paint(&truth);
        let fit = Refine::default().fit(image.view(), &truth, &mut used).unwrap();
        assert!(fit.loss < 1e-4, "{compositing:?}: {}", fit.loss);
        let start = perturbed(&truth, &mut rng);
        let again = Refine::default().fit(image.view(), &start, &mut used).unwrap();
        let fresh = Refine::default().fit(image.view(), &start, &mut RefineScratch::default()).unwrap();
        assert_eq!((&again.scene, again.loss.to_bits()), (&fresh.scene, fresh.loss.to_bits()));
        // Never worse than the start.
        let none = Refine::default().with_max_steps(0);
        let before = none.fit(image.view(), &start, &mut used).unwrap();
        assert_eq!(before.scene, start);
        assert!(again.loss <= before.loss);
    }
}

/// The picture with every pixel the mean of the 3 x 3 around it.
fn blurred(image: &Image<f32>) -> Image<f32> {
    let near = |at: usize| [at.saturating_sub(1), at, (at + 1).min(SIDE - 1)];
    let mean = |i: usize| -> [f32; 3] {
        let around = near(i / SIDE).into_iter().flat_map(|y| near(i % SIDE).map(|x| image.view().pixel(y * SIDE + x)));
        around.fold([0.0; 3], |sum, pixel| core::array::from_fn(|c| sum[c] + pixel[c] / 9.0))
    };
    let pixels: Vec<f32> = (0..SIDE * SIDE).flat_map(mean).collect();
    Image::from_interleaved(ImageSize::new(SIDE, SIDE).unwrap(), &pixels).unwrap()
}

/// What a blur does to outlines is no noise: many pixels do not average it away.
#[test]
fn deviations_grow_where_the_profile_is_wrong() {
    let mut rng = ChaCha8Rng::seed_from_u64(23);
    let mut scratch = RefineScratch::default();
    let (mut within, mut grown, mut stated) = ([0; 3], 0, 0);
    for _ in 0..30 {
        let truth = scene(&mut rng);
        let image = paint(&truth);
        let soft = (0..4).fold(image.clone(), |image, _| blurred(&image));
        let mut fit = |image: &Image<f32>| Refine::default().fit(image.view(), &truth, &mut scratch).unwrap();
        let (clear, fit) = (fit(&image), fit(&soft));
        for (k, (object, found)) in truth.objects.iter().zip(&fit.scene.objects).enumerate() {
            let [a, b] = [object, found].map(|object| object.pose);
            let off =
                [b.translation[0] - a.translation[0], b.translation[1] - a.translation[1], b.rotation - a.rotation];
            let variances = [0, 6, 18].map(|i| fit.covariance[k][i]);
            for (within, (off, variance)) in within.iter_mut().zip(off.into_iter().zip(variances)) {
                *within += usize::from(off * off <= 4.0 * variance);
            }
            // Ten times the deviation, where half as much is seen of the pixels that the profile explains worst.
            grown += usize::from(fit.covariance[k][0] > 100.0 * clear.covariance[k][0]);
            stated += 1;
        }
    }
    assert!(within.iter().all(|&within| 100 * within >= 90 * stated), "{within:?} of {stated}");
    assert_eq!(grown, stated);
}

#[test]
fn symmetry_and_crop_are_told() {
    let mut truth = scene(&mut ChaCha8Rng::seed_from_u64(2));
    truth.objects.truncate(2);
    truth.objects[0].shape = Efd::new(vec![[1.0, 0.0, 0.0, -0.5]]).into();
    truth.objects[1].shape = mdshr_bank(HARMONICS).prototypes()[0].clone().into();
    truth.objects[1].pose.translation[0] = 0.98;
    let image = paint(&truth);
    let fit = Refine::default().fit(image.view(), &truth, &mut RefineScratch::default()).unwrap();
    assert_eq!(fit.ambiguity.first(), Some(&Ambiguity::Symmetry { object: 0, order: 2 }));
    assert!(matches!(fit.ambiguity[1], Ambiguity::Cropped { object: 1, visible } if visible > 0.3 && visible < 0.9));
    assert_eq!(fit.ambiguity.len(), 2);
}

#[test]
fn bad_input_is_refused() {
    let truth = scene(&mut ChaCha8Rng::seed_from_u64(1));
    let mut image = paint(&truth);
    let mut scratch = RefineScratch::default();
    let mut refuse = |refine: Refine, start: &Scene<f32>| refine.fit(image.view(), start, &mut scratch).unwrap_err();
    let mut start = truth.clone();
    start.objects[1].pose.scale = -0.1;
    assert_eq!(refuse(Refine::default(), &start), FitError::Scale { index: 1 });
    start.objects[1] = Object { shape: Efd::zeros(3).into(), ..truth.objects[1].clone() };
    assert_eq!(refuse(Refine::default(), &start), FitError::FlatObject { index: 1 });
    start.objects[1].pose.rotation = f32::NAN;
    assert!(matches!(refuse(Refine::default(), &start), FitError::Render(_)));
    for refine in [
        Refine::default().with_factors(&[]),
        Refine::default().with_factors(&[1.0, 0.0]),
        Refine::default().with_width(f64::NAN),
    ] {
        assert!(matches!(refuse(refine, &truth), FitError::Setting { .. }));
    }
    image.data_mut()[70] = f32::INFINITY;
    let refused = Refine::default().fit(image.view(), &truth, &mut scratch).unwrap_err();
    assert_eq!(refused, FitError::NotFinite { index: 70 });
}
