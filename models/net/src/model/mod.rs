//! The paper's model: an image to a scene of as many objects as it has slots.
//!
//! ```text
//! images -> encoder -> (batch norm) -> 1 x 1 convolution -> slots -> latents -> seven heads -> scene
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `mod` | [`Model`] |
//! | `config` | [`ModelConfig`]: the paper's sizes, small ones, and what a file says |
//! | `slots` | Conditional DETR, or the places of the grid |
//! | `heads` | [`Heads`]: latents to the parameters of scenes |
//! | `shape_head` | attention to the prototypes, or descriptors themselves |
//! | `rotation_head` | the angle, or one per prototype that knows its symmetry |
//! | `prediction` | [`Prediction`]: scenes of a batch as tensors, and as scenes |
//!
//! *Source*: the paper, section on the architecture; sizes and activations as its implementation has them.

mod config;
mod heads;
mod prediction;
mod rotation_head;
mod shape_head;
mod slots;
#[cfg(test)]
mod tests;

use alloc::sync::Arc;

use dvp_core::real::Real;
use dvp_core::shape::PrototypeBank;
use dvp_core::tensor::{Backend, Stride, Tensor, TensorError};

pub use config::{ModelConfig, RotationHead, ShapeHead, Slots};
pub use heads::Heads;
pub use prediction::Prediction;
use slots::SlotReader;

use crate::encoder::Encoder;
use crate::error::NetError;
use crate::layers::{BatchNorm, Phase};
use crate::weights::Weights;

/// What the heads look at.
#[derive(Clone, Debug)]
pub struct Latents<B: Backend> {
    /// One vector per slot, batch x objects x width.
    pub objects: Tensor<B>,
    /// One of the whole image, batch x width: the mean of the slots'.
    pub image: Tensor<B>,
}

impl<B: Backend> Latents<B> {
    /// Those of slots, batch x objects x width, with their mean as that of the image.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn of_objects(objects: Tensor<B>) -> Result<Self, TensorError> {
        Ok(Self { image: image_latent(&objects)?, objects })
    }

    /// Those of some of the slots, by their indices; that of the image stays.
    ///
    /// # Errors
    /// [`TensorError`] if there is no such slot.
    pub fn of_slots(&self, slots: &[usize]) -> Result<Self, TensorError> {
        Ok(Self { objects: self.objects.select(1, slots)?, image: self.image.clone() })
    }
}

/// The network, from images to scenes.
#[derive(Clone, Debug)]
pub struct Model<B: Backend> {
    encoder: Arc<dyn Encoder<B>>,
    norm: Option<BatchNorm<B>>,
    kernels: Tensor<B>,
    bias: Tensor<B>,
    slots: SlotReader<B>,
    heads: Heads<B>,
}

/// Weights that a step of training changes without a gradient: names and new values.
pub type Running<B> = Vec<(String, Tensor<B>)>;

impl<B: Backend> Model<B> {
    /// Takes `encoder`, `norm`, `projection`, `transformer` and `heads`. `bank`: the prototypes that shapes are mixed of;
    /// not looked at by [`ShapeHead::Direct`].
    ///
    /// # Errors
    /// [`NetError::Config`], also for an empty bank; as [`Weights::get`].
    #[inline(never)]
    pub fn load<T: Real>(
        config: &ModelConfig,
        bank: &PrototypeBank<T>,
        weights: &Weights<'_, B>,
    ) -> Result<Self, NetError> {
        config.validate()?;
        let encoder = config.encoder.load(&weights.under("encoder"))?;
        let (from, width) = (encoder.channels(), config.transformer.d_model);
        let norm = if config.batch_norm { Some(BatchNorm::load(&weights.under("norm"), from)?) } else { None };
        let projection = weights.under("projection");
        Ok(Self {
            encoder,
            norm,
            kernels: projection.get("weight", &[width, from, 1, 1])?,
            bias: projection.get("bias", &[width])?.reshape(&[width, 1, 1])?,
            slots: SlotReader::load(config, &weights.under("transformer"))?,
            heads: Heads::load(config, bank, &weights.under("heads"))?,
        })
    }

    /// Features of images: what a frozen encoder makes once and for all.
    ///
    /// *Dimensions*: batch x 3 x height x width, colors in \[0, 1\], to batch x channels x rows x columns.
    ///
    /// # Errors
    /// As [`Encoder::forward`].
    #[inline(never)]
    pub fn features(&self, images: &Tensor<B>) -> Result<Tensor<B>, NetError> {
        self.encoder.forward(images)
    }

    /// Latents of features; in training also the weights that follow the batch.
    ///
    /// # Errors
    /// [`NetError::Tensor`] or [`NetError::Input`] if these are no features of this model.
    #[inline(never)]
    pub fn latents(&self, features: &Tensor<B>, phase: Phase) -> Result<(Latents<B>, Running<B>), NetError> {
        let mut running = Vec::new();
        let features = match &self.norm {
            None => features.clone(),
            Some(norm) => {
                let (normal, statistics) = norm.forward(features, phase)?;
                let names = BatchNorm::<B>::RUNNING.map(|name| format!("norm.{name}"));
                running.extend(names.into_iter().zip(statistics.into_iter().flatten()));
                normal
            }
        };
        let width = features.conv2d(&self.kernels, Stride { step: 1, padding: 0 })?.add(&self.bias)?;
        Ok((Latents::of_objects(self.slots.forward(&width)?)?, running))
    }

    /// Scenes of latents.
    ///
    /// # Errors
    /// [`NetError::Tensor`] if these are no latents of this model.
    #[inline(never)]
    pub fn scenes<T: Real>(&self, latents: &Latents<B>) -> Result<Prediction<B>, NetError> {
        self.heads.forward::<T>(latents)
    }

    /// The model that makes scenes of the latents of some of the slots ([`Latents::of_slots`]).
    ///
    /// # Errors
    /// [`NetError::Tensor`] if there is no such slot.
    pub fn of_slots(&self, slots: &[usize]) -> Result<Self, NetError> {
        Ok(Self { heads: self.heads.of_slots(slots)?, ..self.clone() })
    }

    /// Scenes of images, by what was learned: [`Self::features`], [`Self::latents`], [`Self::scenes`].
    ///
    /// # Errors
    /// As the three.
    pub fn predict<T: Real>(&self, images: &Tensor<B>) -> Result<Prediction<B>, NetError> {
        let (latents, _) = self.latents(&self.features(images)?, Phase::Inference)?;
        self.scenes::<T>(&latents)
    }
}

/// The mean over the slots: batch x width.
fn image_latent<B: Backend>(objects: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
    match *objects.dims().extents() {
        [batch, _, width] => objects.mean(1)?.reshape(&[batch, width]),
        _ => objects.mean(1),
    }
}
