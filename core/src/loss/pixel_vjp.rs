//! The way back of MAE and MSE.

use super::ImagePair;
use crate::real::Real;
use crate::render::PixelLoss;

/// Adds `cotangent` times the gradient with respect to the first image; the derivative of |d| at 0 is 0.
pub(super) fn pixel_vjp<T: Real>(loss: PixelLoss, pair: ImagePair<'_, T>, cotangent: T, grad: &mut [T]) {
    let (zero, each) = (T::zero(), cotangent / T::of_usize(grad.len()));
    let triples = grad.iter_mut().zip(pair.image().data()).zip(pair.target().data());
    match loss {
        PixelLoss::Mae => triples.for_each(|((grad, &a), &b)| {
            *grad += if a > b { each } else { zero } - if a < b { each } else { zero };
        }),
        PixelLoss::Mse => triples.for_each(|((grad, &a), &b)| *grad += (each + each) * (a - b)),
    }
}
