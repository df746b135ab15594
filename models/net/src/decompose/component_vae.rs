//! The autoencoder of MONet: what is under a mask, in a few numbers.

use dvp_core::tensor::{Backend, Stride, Tensor, TensorError};

use super::monet::MonetConfig;
use crate::error::NetError;
use crate::layers::{Convolution, Mlp, places, repeated};
use crate::weights::Weights;

/// A variational autoencoder of an image under a mask. Encoder: convolutions with steps of 2 and ReLU, a perceptron. Decoder:
/// the numbers at every place of a grid, with two that tell where it is, and convolutions that keep the grid.
///
/// *Source*: Burgess et al.: MONet (2019), appendix B.1; Watters et al.: Spatial Broadcast Decoder (2019). There the grid is
/// larger than the image by what convolutions without padding take away; here they are padded with zeros.
#[derive(Clone, Debug)]
pub(super) struct ComponentVae<B: Backend> {
    encoder: Vec<Convolution<B>>,
    perceptron: Mlp<B>,
    decoder: Vec<Convolution<B>>,
    last: Convolution<B>,
    latents: usize,
    /// Places along a side of the grid, and pixels of the image for each.
    grid: [usize; 2],
}

/// A normal distribution for each number of each item: means, and logarithms of variances, items x latents.
#[derive(Clone, Debug)]
pub(super) struct Latents<B: Backend> {
    pub(super) mean: Tensor<B>,
    pub(super) log_variance: Tensor<B>,
}

/// What is decoded of latents.
#[derive(Clone, Debug)]
pub(super) struct Component<B: Backend> {
    /// items x 3 x side x side.
    pub(super) colors: Tensor<B>,
    /// Of the mask, before the softmax over parts: items x 1 x side x side.
    pub(super) logits: Tensor<B>,
}

impl<B: Backend> ComponentVae<B> {
    /// Takes `encoder.K`, `perceptron.layers.K`, `decoder.K` and `last`.
    ///
    /// # Errors
    /// As [`Weights::get`].
    pub(super) fn load(weights: &Weights<'_, B>, config: &MonetConfig) -> Result<Self, NetError> {
        let halving = Stride { step: 2, padding: 1 };
        // The colors and the logarithm of the mask.
        let (mut from, mut side) = (4, config.side);
        let mut encoder = Vec::with_capacity(config.encoder_channels.len());
        for (k, &to) in config.encoder_channels.iter().enumerate() {
            encoder.push(Convolution::load(&weights.under(&format!("encoder.{k}")), [from, to], 3, halving)?);
            (from, side) = (to, halving.windows(side, 3));
        }
        let widths = [from * side * side, config.encoder_hidden, 2 * config.latents];
        let perceptron = Mlp::load(&weights.under("perceptron"), &widths)?;
        let mut from = config.latents + 2;
        let mut decoder = Vec::with_capacity(config.decoder_channels.len());
        for (k, &to) in config.decoder_channels.iter().enumerate() {
            let keeping = Stride { step: 1, padding: 1 };
            decoder.push(Convolution::load(&weights.under(&format!("decoder.{k}")), [from, to], 3, keeping)?);
            from = to;
        }
        let last = Convolution::load(&weights.under("last"), [from, 4], 1, Stride { step: 1, padding: 0 })?;
        let grid = [config.side / config.decoder_step, config.decoder_step];
        Ok(Self { encoder, perceptron, decoder, last, latents: config.latents, grid })
    }

    /// The latents of images under masks: items x 3 x side x side, and logarithms of masks, items x 1 x side x side.
    ///
    /// # Errors
    /// As [`Tensor::conv2d`].
    pub(super) fn encode(&self, images: &Tensor<B>, log_masks: &Tensor<B>) -> Result<Latents<B>, TensorError> {
        let mut x = Tensor::concat(&[images, log_masks], 1)?;
        for convolution in &self.encoder {
            x = convolution.forward(&x)?.relu()?;
        }
        let items = x.dims().get(0).unwrap_or(1).max(1);
        let numbers = self.perceptron.forward(&x.reshape(&[items, x.dims().len() / items])?)?;
        let of = |start| numbers.slice(1, start, self.latents);
        Ok(Latents { mean: of(0)?, log_variance: of(self.latents)? })
    }

    /// What latents stand for: items x latents.
    ///
    /// # Errors
    /// As [`Tensor::conv2d`].
    pub(super) fn decode(&self, latents: &Tensor<B>) -> Result<Component<B>, TensorError> {
        let items = latents.dims().get(0).unwrap_or(1);
        let [side, step] = self.grid;
        let spread = latents.reshape(&[items, self.latents, 1, 1])?.expand(&[items, self.latents, side, side])?;
        let places = latents.like(places(side, side), &[1, 2, side, side])?.expand(&[items, 2, side, side])?;
        let mut x = Tensor::concat(&[&spread, &places], 1)?;
        for convolution in &self.decoder {
            x = convolution.forward(&x)?.relu()?;
        }
        let x = repeated(&self.last.forward(&x)?, step)?;
        Ok(Component { colors: x.slice(1, 0, 3)?.sigmoid()?, logits: x.slice(1, 3, 1)? })
    }
}
