//! The decoder of parts: a few numbers to colors and a mask.

use dvp_core::tensor::{Backend, Stride, Tensor, TensorError};

use crate::error::NetError;
use crate::layers::{Convolution, places, repeated};
use crate::weights::Weights;

/// The numbers at every place of a grid, with two that tell where it is, and convolutions that keep the grid.
///
/// *Source*: Watters et al.: Spatial Broadcast Decoder (2019). There the grid is larger than the image by what convolutions without
/// padding take away; here they are padded with zeros.
#[derive(Clone, Debug)]
pub(super) struct BroadcastDecoder<B: Backend> {
    convolutions: Vec<Convolution<B>>,
    last: Convolution<B>,
    numbers: usize,
    /// Places along a side of the grid, and pixels of the image for each.
    grid: [usize; 2],
}

/// What is decoded.
#[derive(Clone, Debug)]
pub(super) struct Component<B: Backend> {
    /// items x 3 x side x side.
    pub(super) colors: Tensor<B>,
    /// Of the mask, before the softmax over parts: items x 1 x side x side.
    pub(super) logits: Tensor<B>,
}

impl<B: Backend> BroadcastDecoder<B> {
    /// Takes `decoder.K`, with kernels of an odd `side`, and `last`. `grid`: places along a side of the grid, and pixels of the image
    /// for each.
    ///
    /// # Errors
    /// As [`Weights::get`].
    pub(super) fn load(
        weights: &Weights<'_, B>,
        numbers: usize,
        channels: &[usize],
        side: usize,
        grid: [usize; 2],
    ) -> Result<Self, NetError> {
        let keeping = Stride { step: 1, padding: side / 2 };
        let mut from = numbers + 2;
        let mut convolutions = Vec::with_capacity(channels.len());
        for (k, &to) in channels.iter().enumerate() {
            convolutions.push(Convolution::load(&weights.under(&format!("decoder.{k}")), [from, to], side, keeping)?);
            from = to;
        }
        let last = Convolution::load(&weights.under("last"), [from, 4], 1, Stride { step: 1, padding: 0 })?;
        Ok(Self { convolutions, last, numbers, grid })
    }

    /// What numbers stand for: items x numbers.
    ///
    /// # Errors
    /// As [`Tensor::conv2d`].
    pub(super) fn decode(&self, numbers: &Tensor<B>) -> Result<Component<B>, TensorError> {
        let items = numbers.dims().get(0).unwrap_or(1);
        let [side, step] = self.grid;
        let spread = numbers.reshape(&[items, self.numbers, 1, 1])?.expand(&[items, self.numbers, side, side])?;
        let places = numbers.like(places(side, side), &[1, 2, side, side])?.expand(&[items, 2, side, side])?;
        let mut x = Tensor::concat(&[&spread, &places], 1)?;
        for convolution in &self.convolutions {
            x = convolution.forward(&x)?.relu()?;
        }
        let x = repeated(&self.last.forward(&x)?, step)?;
        Ok(Component { colors: x.slice(1, 0, 3)?.sigmoid()?, logits: x.slice(1, 3, 1)? })
    }
}
