//! Gradients of the losses with respect to the first image, to outlines and to predicted scenes.

use core::f64::consts::PI;

use dvp_core::loss::{ContourLength, ImagePair, Loss, Pyramid, RotationTerm, SceneLoss, ScenePairs, Ssim};
use dvp_core::render::PixelLoss;
use dvp_core::scene::ObjectGrad;
use dvp_core::shape::OutlineBasis;
use dvp_core::{ImageSize, ImageView, Object, Paint, Scene, SceneGrad, Shape as _};
use dvp_tests::finite_difference::compare;
use dvp_tests::strategy;
use proptest::collection::vec;
use proptest::prelude::*;

/// Two images whose values differ by at least 0.01 everywhere: MAE has a kink at equality.
fn images(sides: core::ops::Range<usize>) -> impl Strategy<Value = (ImageSize, Vec<f64>, Vec<f64>)> {
    (sides.clone(), sides).prop_flat_map(|(width, height)| {
        let size = ImageSize::new(width, height).unwrap();
        vec((0.0..1.0, 0.01..0.5, any::<bool>()), size.pixels() * 3).prop_map(move |values| {
            let target = values.iter().map(|(v, _, _)| *v).collect();
            (size, values.iter().map(|(v, d, up)| if *up { v + d } else { v - d }).collect(), target)
        })
    })
}

fn pair<'a>(size: ImageSize, image: &'a [f64], target: &'a [f64]) -> ImagePair<'a, f64> {
    ImagePair::new(ImageView::new(size, image).unwrap(), ImageView::new(size, target).unwrap()).unwrap()
}

/// The gradient against central differences, and its accumulation: `vjp` adds to what is there.
fn check_image_loss<L>(loss: &L, (size, image, target): &(ImageSize, Vec<f64>, Vec<f64>)) -> Result<(), TestCaseError>
where
    L: for<'a> Loss<f64, Input<'a> = ImagePair<'a, f64>, Grad = [f64]>,
{
    let mut scratch = L::Scratch::default();
    let mut grad = vec![0.25; image.len()];
    let value = loss.vjp(pair(*size, image, target), 3.0, &mut scratch, &mut grad).unwrap();
    prop_assert!((value - loss.value(pair(*size, image, target), &mut scratch).unwrap()).abs() < 1e-14);
    grad.iter_mut().for_each(|g| *g -= 0.25);
    compare(image, &grad, 1e-7, |x| 3.0 * loss.value(pair(*size, x, target), &mut scratch).unwrap())
        .map_err(TestCaseError::fail)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn pixel_losses(images in images(1..12)) {
        check_image_loss(&PixelLoss::Mae, &images)?;
        check_image_loss(&PixelLoss::Mse, &images)?;
    }

    #[test]
    fn pyramids_of_pixel_losses(images in images(1..12), levels in 1..6_usize) {
        // MSE: a mean of four differences may be 0, where MAE has a kink.
        check_image_loss(&Pyramid::new(PixelLoss::Mse, levels).unwrap(), &images)?;
    }

    #[test]
    fn contour_length(objects in vec(strategy::object(1..6), 0..4)) {
        let loss = ContourLength::new(OutlineBasis::new(24, 6).unwrap());
        let mut scratch = Default::default();
        let mut grads: Vec<ObjectGrad<f64>> = objects
            .iter()
            .map(|object| ObjectGrad { numbers: vec![0.5; object.shape.number_count()], ..ObjectGrad::default() })
            .collect();
        loss.vjp(&objects, -2.0, &mut scratch, &mut grads).unwrap();
        let x: Vec<f64> = objects.iter().flat_map(|o| o.efd_rows().as_flattened().to_vec()).collect();
        let grad: Vec<f64> = grads.iter().flat_map(|g| g.numbers.clone()).map(|g| g - 0.5).collect();
        if objects.is_empty() {
            prop_assert!(loss.value(&objects, &mut scratch).unwrap().abs() < 1e-15);
            return Ok(());
        }
        let mut moved = objects.clone();
        compare(&x, &grad, 1e-7, |mut x| {
            for value in moved.iter_mut().flat_map(|o| o.shape.efd_mut().unwrap().rows_mut().as_flattened_mut()) {
                *value = *x.split_off_first().unwrap();
            }
            -2.0 * loss.value(&moved, &mut scratch).unwrap()
        })
        .map_err(TestCaseError::fail)?;
    }

    #[test]
    fn scene_loss((truths, predictions) in scene_pairs()) {
        for rotation in [RotationTerm::Modulo, RotationTerm::EveryOrder, RotationTerm::Printed] {
            let mut loss = SceneLoss::reference(16, 6).unwrap();
            loss.rotation = rotation;
            let mut scratch = Default::default();
            let mut grads = vec![SceneGrad::default(); predictions.len()];
            grads.iter_mut().zip(&predictions).for_each(|(grad, scene)| grad.reset(scene));
            loss.vjp(ScenePairs::new(&predictions, &truths).unwrap(), 0.0, &mut scratch, &mut grads).unwrap();
            loss.vjp(ScenePairs::new(&predictions, &truths).unwrap(), 1.5, &mut scratch, &mut grads).unwrap();
            let grad: Vec<f64> = grads.iter().flat_map(flat_grad).collect();
            let mut moved = predictions.clone();
            let x: Vec<f64> = moved.iter_mut().flat_map(|scene| numbers(scene)).map(|v| *v).collect();
            compare(&x, &grad, 1e-6, |mut x| {
                for value in moved.iter_mut().flat_map(|scene| numbers(scene)) {
                    *value = *x.split_off_first().unwrap();
                }
                1.5 * loss.value(ScenePairs::new(&moved, &truths).unwrap(), &mut scratch).unwrap()
            })
            .map_err(TestCaseError::fail)?;
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3))]

    #[test]
    fn ssim(images in images(11..15)) {
        check_image_loss(&Ssim::default(), &images)?;
    }
}

/// Up to three pairs; some true objects are hidden; there are always as many predictions as true objects, or more.
fn scene_pairs() -> impl Strategy<Value = (Vec<Scene<f64>>, Vec<Scene<f64>>)> {
    let object = || {
        (strategy::object(1..6), 0.1..0.9, -PI..PI).prop_map(|(object, confidence, rotation)| Object {
            // Away from 0 and 1, where the cross entropy is cut.
            confidence,
            pose: dvp_core::Pose { rotation, ..object.pose },
            ..object
        })
    };
    let scene = move |count| (strategy::color(), vec(object(), count));
    let pair = (scene(0..3), scene(3..5)).prop_map(|((a, truth), (b, prediction))| {
        (Scene { objects: truth, ..Scene::empty(a) }, Scene { objects: prediction, ..Scene::empty(b) })
    });
    vec(pair, 1..4).prop_map(|pairs| pairs.into_iter().unzip())
}

/// The numbers of a scene, in the order of [`flat_grad`].
fn numbers(scene: &mut Scene<f64>) -> Vec<&mut f64> {
    let mut all: Vec<&mut f64> = scene.background.iter_mut().collect();
    for object in &mut scene.objects {
        all.extend(&mut object.pose.translation);
        all.extend([&mut object.pose.scale, &mut object.pose.rotation]);
        if let Paint::Flat(color) = &mut object.paint {
            all.extend(color);
        }
        all.push(&mut object.confidence);
        all.extend(object.shape.efd_mut().unwrap().rows_mut().as_flattened_mut());
    }
    all
}

fn flat_grad(grad: &SceneGrad<f64>) -> Vec<f64> {
    let mut all = grad.background.to_vec();
    for object in &grad.objects {
        all.extend(object.translation);
        all.extend([object.scale, object.rotation]);
        all.extend(object.color);
        all.push(object.confidence);
        all.extend(&object.numbers);
    }
    all
}
