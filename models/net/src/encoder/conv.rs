//! Strided convolutions: small, and trained from nothing.

use dvp_core::tensor::{Backend, Stride, Tensor};
use serde::{Deserialize, Serialize};

use super::Encoder;
use crate::error::{NetError, require};
use crate::layers::{Convolution, places};
use crate::weights::Weights;

/// Sizes of a [`ConvEncoder`].
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct ConvConfig {
    /// Side in pixels of the patches that the first layer takes, without overlap.
    pub patch: usize,
    /// Channels of each stage; every stage but the first halves the grid.
    pub channels: Vec<usize>,
    /// Convolutions of each stage that keep the grid, each added to what it was made from.
    pub residual: usize,
}

impl ConvConfig {
    fn validate(&self) -> Result<(), NetError> {
        require(self.patch > 0, "encoder.patch", self.patch, "must be at least 1")?;
        let channels = format!("{:?}", self.channels);
        let some = !self.channels.is_empty() && !self.channels.contains(&0);
        require(some, "encoder.channels", channels, "must be at least one number, none of them 0")
    }
}

/// Patches to channels, then stages of 3 x 3 convolutions with ReLU. Two channels tell every place of the first grid
/// where it is, -1 to 1: positions can then be read off features, not only compared.
///
/// *Source*: the two channels: Liu et al.: An Intriguing Failing of Convolutional Neural Networks and the CoordConv
/// Solution (2018).
#[derive(Clone, Debug)]
pub struct ConvEncoder<B: Backend> {
    patch: usize,
    patches: Convolution<B>,
    stages: Vec<Stage<B>>,
    channels: usize,
}

#[derive(Clone, Debug)]
struct Stage<B: Backend> {
    enter: Convolution<B>,
    residual: Vec<Convolution<B>>,
}

impl<B: Backend> ConvEncoder<B> {
    /// Takes `patches` and `stages.K.enter`, `stages.K.residual.J`, each a `weight` and a `bias`.
    ///
    /// # Errors
    /// [`NetError::Config`]; as [`Weights::get`].
    pub fn load(config: &ConvConfig, weights: &Weights<'_, B>) -> Result<Self, NetError> {
        config.validate()?;
        let ConvConfig { patch, ref channels, residual } = *config;
        let first = channels[0];
        let tiles = Stride { step: patch, padding: 0 };
        let patches = Convolution::load(&weights.under("patches"), [3, first], patch, tiles)?;
        let mut stages = Vec::with_capacity(channels.len());
        let mut from = first + 2;
        for (k, &to) in channels.iter().enumerate() {
            let weights = weights.under(&format!("stages.{k}"));
            let step = if k == 0 { 1 } else { 2 };
            let enter = Convolution::load(&weights.under("enter"), [from, to], 3, Stride { step, padding: 1 })?;
            let keep = |j| {
                let weights = weights.under(&format!("residual.{j}"));
                Convolution::load(&weights, [to, to], 3, Stride { step: 1, padding: 1 })
            };
            stages.push(Stage { enter, residual: (0..residual).map(keep).collect::<Result<_, _>>()? });
            from = to;
        }
        Ok(Self { patch, patches, stages, channels: from })
    }
}

impl<B: Backend> Encoder<B> for ConvEncoder<B> {
    fn channels(&self) -> usize {
        self.channels
    }

    fn forward(&self, images: &Tensor<B>) -> Result<Tensor<B>, NetError> {
        let &[batch, 3, height, width] = images.dims().extents() else {
            let must = "must be batch x 3 x height x width";
            return Err(NetError::Input { input: "images", dims: *images.dims(), must });
        };
        let (rows, columns) = (height / self.patch, width / self.patch);
        if rows == 0 || columns == 0 {
            return Err(NetError::ImageSize { width, height, patch: self.patch });
        }
        let centered = images.affine(2.0, -1.0)?;
        let patches = self.patches.forward(&centered)?.relu()?;
        let places = patches.like(places(rows, columns), &[1, 2, rows, columns])?;
        let mut x = Tensor::concat(&[&patches, &places.expand(&[batch, 2, rows, columns])?], 1)?;
        for stage in &self.stages {
            x = stage.enter.forward(&x)?.relu()?;
            for conv in &stage.residual {
                x = x.add(&conv.forward(&x)?.relu()?)?;
            }
        }
        Ok(x)
    }
}
