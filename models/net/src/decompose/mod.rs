//! Decomposers: networks that divide an image into parts, each a mask and what the mask shows; they know no shapes.
//!
//! In: images, batch x 3 x side x side, colors in \[0, 1\]. Out: [`Parts`], and for training a [`Verdict`]. Learned from images
//! alone.
//!
//! | file | holds |
//! |---|---|
//! | `config` | [`DecomposerConfig`]: which, and its sizes |
//! | `monet` | [`monet::Monet`]: attention takes a part at a time, an autoencoder describes it |
//! | `attention_net` | its attention, a U-Net |
//! | `component_vae` | its autoencoder |
//! | `terms` | the terms of its loss |
//! | `slots` | [`slots::Slots`]: Slot Attention, parts compete for the places of an image |
//! | `slot_attention` | the competition |
//! | `broadcast` | the decoder of both: numbers to colors and a mask |
//! | `inputs` | what both take: images of a side, chance; checks of sizes |
//! | `parts` | [`Parts`], and [`PartsOf`] an image: labels, reconstruction |
//! | `divider` | [`Divider`]: a trained decomposer that reads pictures of any size, on the host |

mod attention_net;
mod broadcast;
mod component_vae;
mod config;
mod divider;
mod inputs;
pub mod monet;
mod parts;
mod slot_attention;
pub mod slots;
#[cfg(test)]
mod slots_tests;
mod terms;
#[cfg(test)]
mod tests;

use dvp_core::tensor::{Backend, Tensor};

pub use config::DecomposerConfig;
pub use divider::{Divider, on_square};
pub use parts::{Parts, PartsOf};
pub use terms::Terms;

use self::monet::Monet;
use self::slots::Slots;
use crate::error::NetError;

/// A network that divides images into parts.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Decomposer<B: Backend> {
    /// Masks by recurrent attention, appearances by a variational autoencoder.
    Monet(Box<Monet<B>>),
    /// Slots that compete for the places of an image.
    Slots(Box<Slots<B>>),
}

/// A batch, judged.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Verdict<B: Backend> {
    /// A number, for the way back.
    pub loss: Tensor<B>,
    /// What it is made of.
    pub terms: Terms,
    /// The parts that were judged.
    pub parts: Parts<B>,
}

impl<B: Backend> Decomposer<B> {
    /// The loss of images, batch x 3 x side x side; `chance` numbers what is drawn at random.
    ///
    /// # Errors
    /// [`NetError::Input`] for other extents; if the framework refuses.
    pub fn judge(&self, images: &Tensor<B>, chance: u64) -> Result<Verdict<B>, NetError> {
        match self {
            Self::Monet(monet) => monet.judge(images, chance),
            Self::Slots(slots) => slots.judge(images, chance),
        }
    }

    /// The parts of images, batch x 3 x side x side; nothing is drawn anew: the same images have the same parts.
    ///
    /// # Errors
    /// As [`Self::judge`].
    pub fn parts(&self, images: &Tensor<B>) -> Result<Parts<B>, NetError> {
        match self {
            Self::Monet(monet) => monet.parts(images),
            Self::Slots(slots) => slots.parts(images),
        }
    }
}
