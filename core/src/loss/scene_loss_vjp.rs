//! The way back of L_p, for the matches that the forward pass left in the scratch memory.

use super::scene_match::SceneLossScratch;
use super::{LossError, SceneLoss, ScenePairs, check_length};
use crate::real::Real;
use crate::scene::SceneGrad;

/// Least p (1 - p) that the slope of the cross entropy is divided by, as in the reference's framework.
const LEAST_VARIANCE: f64 = 1e-12;

/// Adds `cotangent` times the gradient with respect to the predictions.
pub(super) fn scene_loss_vjp<T: Real>(
    loss: &SceneLoss<T>,
    pairs: ScenePairs<'_, T>,
    cotangent: T,
    scratch: &mut SceneLossScratch<T>,
    grads: &mut [SceneGrad<T>],
) -> Result<(), LossError> {
    let scenes = pairs.predictions().iter().zip(pairs.truths()).zip(grads);
    for (pair, ((prediction, truth), grad)) in scenes.enumerate() {
        check_length("object gradients", &grad.objects, prediction.objects.len())?;
        let range = scratch.of_pair(pair);
        let objects = range.len();
        let scene = cotangent * loss.pair_weight(objects, pairs);
        let each = scene / T::of_usize(objects.max(1));
        let weights = &loss.weights;
        mean_square_vjp(scene * weights.background, prediction.background, truth.background, &mut grad.background);
        let slots = T::of_usize(prediction.objects.len());
        for (slot, (object, grad)) in prediction.objects.iter().zip(&mut grad.objects).enumerate() {
            let there = scratch.matches()[range.clone()].iter().any(|found| found.prediction == slot);
            grad.confidence += scene * weights.confidence / slots * cross_entropy_slope(object.confidence, there);
        }
        for index in range {
            let found = scratch.matches()[index];
            let (object, other) = (&prediction.objects[found.prediction], &truth.objects[found.truth]);
            let grad = &mut grad.objects[found.prediction];
            let translation = each * weights.translation;
            mean_square_vjp(translation, object.pose.translation, other.pose.translation, &mut grad.translation);
            mean_square_vjp(each * weights.color, object.color(), other.color(), &mut grad.color);
            grad.scale += each * weights.scale * T::of(2.0) * (object.pose.scale - other.pose.scale);
            // The turn is the true angle minus the predicted one.
            grad.rotation -= each * weights.rotation * loss.rotation.price(&found, objects, &scratch.orders)[1];
            let descriptors = object.shape.descriptors()?;
            check_length("gradient of the descriptors", grad.efd_rows(), descriptors.harmonic_count())?;
            loss.outline_difference(descriptors, other.shape.descriptors()?, scratch)?;
            let factor = each * weights.shape / T::of_usize(scratch.vertices.len());
            scratch.vertices.iter_mut().flatten().for_each(|value| *value *= factor);
            loss.basis.outline_vjp(&scratch.vertices, grad.efd_rows_mut())?;
        }
    }
    Ok(())
}

fn mean_square_vjp<T: Real, const N: usize>(cotangent: T, a: [T; N], b: [T; N], grad: &mut [T; N]) {
    let factor = cotangent * T::of(2.0) / T::of_usize(N);
    for ((grad, a), b) in grad.iter_mut().zip(a).zip(b) {
        *grad += factor * (a - b);
    }
}

fn cross_entropy_slope<T: Real>(confidence: T, there: bool) -> T {
    let truth = if there { T::one() } else { T::zero() };
    (confidence - truth) / (confidence * (T::one() - confidence)).max(T::of(LEAST_VARIANCE))
}
