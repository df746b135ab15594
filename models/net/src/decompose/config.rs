//! Sizes of decomposers, as files hold them.

use dvp_core::tensor::Backend;
use serde::{Deserialize, Serialize};

use super::Decomposer;
use super::monet::{Monet, MonetConfig};
use super::slots::{Slots, SlotsConfig};
use crate::error::NetError;
use crate::weights::Weights;

/// Which decomposer, and its sizes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum DecomposerConfig {
    /// Masks by recurrent attention, appearances by a variational autoencoder.
    Monet(MonetConfig),
    /// Slots that compete for the places of an image.
    Slots(SlotsConfig),
}

impl DecomposerConfig {
    /// The name of its kind, as files and options have it.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Monet(_) => "monet",
            Self::Slots(_) => "slots",
        }
    }

    /// Pixels along a side of the images it takes.
    #[must_use]
    pub fn side(&self) -> usize {
        match self {
            Self::Monet(config) => config.side,
            Self::Slots(config) => config.side,
        }
    }

    /// The most parts it divides an image into, the background counted.
    #[must_use]
    pub fn slots(&self) -> usize {
        match self {
            Self::Monet(config) => config.slots,
            Self::Slots(config) => config.slots,
        }
    }

    /// Refuses sizes of which no decomposer can be made.
    ///
    /// # Errors
    /// [`NetError::Config`], which names the key.
    pub fn validate(&self) -> Result<(), NetError> {
        match self {
            Self::Monet(config) => config.validate(),
            Self::Slots(config) => config.validate(),
        }
    }

    /// The decomposer of these sizes with its weights.
    ///
    /// # Errors
    /// [`NetError::Config`]; as [`Weights::get`].
    pub fn load<B: Backend>(&self, weights: &Weights<'_, B>) -> Result<Decomposer<B>, NetError> {
        Ok(match self {
            Self::Monet(config) => Decomposer::Monet(Box::new(Monet::load(config, weights)?)),
            Self::Slots(config) => Decomposer::Slots(Box::new(Slots::load(config, weights)?)),
        })
    }
}
