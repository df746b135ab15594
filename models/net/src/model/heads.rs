//! Latents to the parameters of scenes.

use dvp_core::real::Real;
use dvp_core::shape::PrototypeBank;
use dvp_core::tensor::{Backend, Tensor};

use super::Latents;
use super::config::{ModelConfig, Slots};
use super::prediction::Prediction;
use super::rotation_head::RotationReader;
use super::shape_head::ShapeReader;
use super::slots::centers;
use crate::error::NetError;
use crate::layers::Mlp;
use crate::weights::Weights;

/// Seven heads, perceptrons of three layers: sigmoid on translation, scale, color, confidence and background, tanh on the
/// sine and cosine of the rotation, attention or descriptors for the shape. The background is read off the mean latent.
/// Translations of cells are told from their centers, inside the sigmoid, as boxes are in Conditional DETR.
#[derive(Clone, Debug)]
pub struct Heads<B: Backend> {
    translation: Mlp<B>,
    scale: Mlp<B>,
    rotation: RotationReader<B>,
    color: Mlp<B>,
    confidence: Mlp<B>,
    background: Mlp<B>,
    shape: ShapeReader<B>,
    /// Logits of the places that translations are told from, 1 x objects x 2; none: of the middle.
    anchors: Option<Tensor<B>>,
}

impl<B: Backend> Heads<B> {
    /// Takes `translation`, `scale`, `rotation`, `color`, `confidence`, `background` and `shape`.
    ///
    /// # Errors
    /// [`NetError::Config`]; as [`Weights::get`].
    pub fn load<T: Real>(
        config: &ModelConfig,
        bank: &PrototypeBank<T>,
        weights: &Weights<'_, B>,
    ) -> Result<Self, NetError> {
        let (width, wide) = (config.transformer.d_model, config.head_width);
        let head = |name, outputs| Mlp::load(&weights.under(name), &[width, wide, wide, outputs]);
        let translation = head("translation", 2)?;
        let anchors = match config.slots {
            Slots::Queries => None,
            Slots::Cells { rows, columns } => {
                let logits = centers(rows, columns).into_iter().map(|x| (x / (1.0 - x)).ln()).collect();
                Some(translation.like(logits, &[1, rows * columns, 2])?)
            }
        };
        Ok(Self {
            translation,
            anchors,
            scale: head("scale", 1)?,
            rotation: RotationReader::load(config, bank, &weights.under("rotation"))?,
            color: head("color", 3)?,
            confidence: head("confidence", 1)?,
            background: head("background", 3)?,
            shape: ShapeReader::load(config, bank, &weights.under("shape"))?,
        })
    }

    /// Those of some of the slots.
    ///
    /// # Errors
    /// [`NetError::Tensor`] if there is no such slot.
    pub(super) fn of_slots(&self, slots: &[usize]) -> Result<Self, NetError> {
        let anchors = self.anchors.as_ref().map(|anchors| anchors.select(1, slots)).transpose()?;
        Ok(Self { anchors, ..self.clone() })
    }

    /// Scenes of latents; `T` is the number type of the latents.
    ///
    /// # Errors
    /// [`NetError::Tensor`] if the latents are of another width, number type or device than the weights.
    pub fn forward<T: Real>(&self, latents: &Latents<B>) -> Result<Prediction<B>, NetError> {
        let x = &latents.objects;
        let &[batch, objects, _] = x.dims().extents() else {
            let must = "must be batch x objects x width";
            return Err(NetError::Input { input: "latents", dims: *x.dims(), must });
        };
        let (descriptors, prototypes) = self.shape.forward(x)?;
        let mut places = self.translation.forward(x)?;
        if let Some(anchors) = &self.anchors {
            places = places.add(anchors)?;
        }
        Ok(Prediction {
            translations: places.sigmoid()?,
            scales: self.scale.forward(x)?.sigmoid()?.reshape(&[batch, objects])?,
            rotations: self.rotation.forward::<T>(x, prototypes.as_ref())?,
            colors: self.color.forward(x)?.sigmoid()?,
            confidences: self.confidence.forward(x)?.sigmoid()?.reshape(&[batch, objects])?,
            background: self.background.forward(&latents.image)?.sigmoid()?,
            descriptors,
            prototypes,
        })
    }
}
