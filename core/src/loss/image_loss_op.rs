//! Losses of images as differentiable steps of a batch.

use alloc::vec::Vec;
use core::fmt;

use super::{ImagePair, Loss, LossError};
use crate::diff_op::{DiffOp, OpInput, Signature};
use crate::dims::{Dims, DimsError, ImageSize};
use crate::image::{CHANNELS, Image, ImageView};
use crate::real::Real;

/// Images (3 x height x width) to their loss against a target each: a number per item. For
/// [`PixelLoss`](crate::render::PixelLoss), [`Ssim`](super::Ssim) and [`Pyramid`](super::Pyramid).
///
/// *Derivative*: that of the loss.
#[derive(Clone, Debug)]
pub struct ImageLossOp<T, L> {
    loss: L,
    size: ImageSize,
    targets: Vec<Image<T>>,
    signature: Signature,
}

impl<T: Real, L> ImageLossOp<T, L> {
    /// Losses of images of `size` against `targets`, one per item.
    ///
    /// # Errors
    /// As [`Dims::new`].
    pub fn new(loss: L, size: ImageSize, targets: Vec<Image<T>>) -> Result<Self, DimsError> {
        let images = OpInput::new("images", &[CHANNELS, size.height(), size.width()])?;
        let signature = Signature::new("image loss", [images], Dims::SCALAR).for_batch(targets.len());
        Ok(Self { loss, size, targets, signature })
    }

    fn pair<'a>(&'a self, item: usize, image: &'a [T]) -> Result<ImagePair<'a, T>, LossError> {
        ImagePair::new(ImageView::new(self.size, image)?, self.targets[item].view())
    }
}

impl<T, L> DiffOp<T> for ImageLossOp<T, L>
where
    T: Real,
    L: for<'a> Loss<T, Input<'a> = ImagePair<'a, T>, Grad = [T]> + fmt::Debug + Send + Sync,
{
    type Scratch = L::Scratch;
    type Error = LossError;

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn forward(
        &self,
        item: usize,
        input: &[T],
        output: &mut [T],
        _: &mut [T],
        scratch: &mut L::Scratch,
    ) -> Result<(), LossError> {
        output[0] = self.loss.value(self.pair(item, input)?, scratch)?;
        Ok(())
    }

    fn vjp(
        &self,
        item: usize,
        input: &[T],
        _: &[T],
        grad_output: &[T],
        grad_input: &mut [T],
        scratch: &mut L::Scratch,
    ) -> Result<(), LossError> {
        self.loss.vjp(self.pair(item, input)?, grad_output[0], scratch, grad_input).map(|_| ())
    }
}
