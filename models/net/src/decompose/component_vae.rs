//! The autoencoder of MONet: what is under a mask, in a few numbers.

use dvp_core::tensor::{Backend, Stride, Tensor, TensorError};

use super::broadcast::{BroadcastDecoder, Component};
use super::monet::MonetConfig;
use crate::error::NetError;
use crate::layers::{Convolution, Mlp};
use crate::weights::Weights;

/// A variational autoencoder of an image under a mask. Encoder: convolutions with steps of 2 and ReLU, a perceptron. Decoder: a
/// [`BroadcastDecoder`].
///
/// *Source*: Burgess et al.: MONet (2019), appendix B.1.
#[derive(Clone, Debug)]
pub(super) struct ComponentVae<B: Backend> {
    encoder: Vec<Convolution<B>>,
    perceptron: Mlp<B>,
    decoder: BroadcastDecoder<B>,
    latents: usize,
}

/// A normal distribution for each number of each item: means, and logarithms of variances, items x latents.
#[derive(Clone, Debug)]
pub(super) struct Latents<B: Backend> {
    pub(super) mean: Tensor<B>,
    pub(super) log_variance: Tensor<B>,
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
        let grid = [config.side / config.decoder_step, config.decoder_step];
        let decoder = BroadcastDecoder::load(weights, config.latents, &config.decoder_channels, 3, grid)?;
        Ok(Self { encoder, perceptron, decoder, latents: config.latents })
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
    /// As [`BroadcastDecoder::decode`].
    pub(super) fn decode(&self, latents: &Tensor<B>) -> Result<Component<B>, TensorError> {
        self.decoder.decode(latents)
    }
}
