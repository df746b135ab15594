//! DINOv2 behind the trait of encoders.

use dvp_core::tensor::{Backend, Tensor, TensorError};
use serde::{Deserialize, Serialize};

use super::Encoder;
use crate::dinov2::{Dinov2, Dinov2Config};
use crate::error::{NetError, require};
use crate::layers::bicubic;
use crate::weights::Weights;

/// Mean of each channel of the images that the published weights were trained on, and its deviation.
///
/// *Source*: the public preprocessor of DINOv2 (ImageNet).
const CHANNEL_MEAN: [f64; 3] = [0.485, 0.456, 0.406];
const CHANNEL_DEVIATION: [f64; 3] = [0.229, 0.224, 0.225];

/// Sizes of a [`VitEncoder`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct VitConfig {
    /// Sizes of the transformer, under their published keys.
    pub model: Dinov2Config,
    /// Side in pixels to which images are resized, a multiple of the patch: the paper's 126 gives 9 x 9 patches.
    pub side: usize,
    /// Whether it keeps the weights it was given.
    pub frozen: bool,
}

/// An image, resized and standardized, as the patches of DINOv2 after its last norm.
#[derive(Clone, Debug)]
pub struct VitEncoder<B: Backend> {
    model: Dinov2<B>,
    side: usize,
    patch: usize,
    width: usize,
}

impl<B: Backend> VitEncoder<B> {
    /// Takes the weights by their public names; see [`Dinov2::load`].
    ///
    /// # Errors
    /// [`NetError::Config`]; as [`Weights::get`].
    pub fn load(config: &VitConfig, weights: &Weights<'_, B>) -> Result<Self, NetError> {
        let patch = config.model.patch_size;
        let tiled = patch > 0 && config.side > 0 && config.side.is_multiple_of(patch);
        require(tiled, "encoder.side", config.side, "must be a multiple of patch_size")?;
        let weights = if config.frozen { weights.clone().frozen() } else { weights.clone() };
        let width = config.model.hidden_size;
        Ok(Self { model: Dinov2::load(&config.model, &weights)?, side: config.side, patch, width })
    }
}

impl<B: Backend> Encoder<B> for VitEncoder<B> {
    fn channels(&self) -> usize {
        self.width
    }

    fn forward(&self, images: &Tensor<B>) -> Result<Tensor<B>, NetError> {
        let &[batch, 3, height, width] = images.dims().extents() else {
            let must = "must be batch x 3 x height x width";
            return Err(NetError::Input { input: "images", dims: *images.dims(), must });
        };
        if height == 0 || width == 0 {
            return Err(NetError::ImageSize { width, height, patch: self.patch });
        }
        let tokens = self.model.forward(&standardize(&resize(images, height, width, self.side)?)?)?;
        let side = self.side / self.patch;
        Ok(self.model.patches(&tokens)?.transpose()?.reshape(&[batch, self.width, side, side])?)
    }
}

/// .. x height x width to .. x side x side.
fn resize<B: Backend>(images: &Tensor<B>, height: usize, width: usize, side: usize) -> Result<Tensor<B>, TensorError> {
    let vertical = images.like(bicubic(height, side), &[side, height])?;
    let horizontal = images.like(bicubic(width, side), &[side, width])?;
    vertical.reshape(&[1, 1, side, height])?.matmul(&images.matmul(&horizontal.transpose()?)?)
}

fn standardize<B: Backend>(images: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
    let channel = |values: [f64; 3]| images.like(values.to_vec(), &[3, 1, 1]);
    images.sub(&channel(CHANNEL_MEAN)?)?.div(&channel(CHANNEL_DEVIATION)?)
}
