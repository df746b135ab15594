//! Encoders: an image to features on a grid.
//!
//! In: images, batch x 3 x height x width, colors in \[0, 1\]. Out: batch x channels x rows x columns.
//!
//! | file | holds |
//! |---|---|
//! | `mod` | [`Encoder`], [`EncoderConfig`] |
//! | `conv` | [`ConvEncoder`]: strided convolutions, trains from nothing on a processor |
//! | `vit` | [`VitEncoder`]: the published DINOv2 behind the same trait |

mod conv;
#[cfg(test)]
mod tests;
mod vit;

use alloc::sync::Arc;
use core::fmt::Debug;

use dvp_core::tensor::{Backend, Tensor};
use serde::{Deserialize, Serialize};

pub use conv::{ConvConfig, ConvEncoder};
pub use vit::{VitConfig, VitEncoder};

use crate::error::NetError;
use crate::weights::Weights;

/// From images to features on a grid.
pub trait Encoder<B: Backend>: Debug + Send + Sync {
    /// Numbers per place of the grid.
    fn channels(&self) -> usize;

    /// batch x 3 x height x width, colors in \[0, 1\], to batch x [`Self::channels`] x rows x columns.
    ///
    /// # Errors
    /// [`NetError::Input`] or [`NetError::ImageSize`] for extents that the encoder does not take.
    fn forward(&self, images: &Tensor<B>) -> Result<Tensor<B>, NetError>;
}

/// Which encoder, and its sizes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum EncoderConfig {
    /// Strided convolutions.
    Conv(ConvConfig),
    /// DINOv2 with registers.
    Vit(VitConfig),
}

impl EncoderConfig {
    /// The encoder of these sizes with its weights.
    ///
    /// # Errors
    /// [`NetError::Config`]; as [`Weights::get`].
    pub fn load<B: Backend>(&self, weights: &Weights<'_, B>) -> Result<Arc<dyn Encoder<B>>, NetError> {
        Ok(match self {
            Self::Conv(config) => Arc::new(ConvEncoder::load(config, weights)?),
            Self::Vit(config) => Arc::new(VitEncoder::load(config, weights)?),
        })
    }
}
