//! A trained model as something to look with: a picture of any size to its scene, on the host, without a framework.
//!
//! ```text
//! picture -> square of the side that models train on -> model -> scene -> what is there -> second looks -> units of the picture
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `mod` | [`Proposer`] |
//! | `built_in` | [`BUILT_IN`], [`BUILT_IN_LOOK`]: weights that come with the program |
//! | `second` | second looks, where the proposer has them |

mod built_in;
mod second;
#[cfg(test)]
mod tests;

use dvp_core::render::EdgeProfile;
use dvp_core::shape::PrototypeBank;
use dvp_core::tensor::{Host, HostDevice, Parameters};
use dvp_core::{AnyShape, Image, ImageView, Object, Real, Scene};
use dvp_fit::noise::denoised;

pub use built_in::{BUILT_IN, BUILT_IN_LOOK};
use second::Second;

use crate::error::NetError;
use crate::layers::Phase;
use crate::model::{Latents, Model, ModelConfig};
use crate::optimize::{OptZ, Optimum, random_latents};
use crate::scene_steps::{SceneSteps, image_tensor};
use crate::square::Square;
use crate::there::{candidates, keep_there, there};
use crate::train::{Checkpoint, LookFile};
use crate::weights::Weights;

/// Side in pixels of the squares that models train on: that of MDS-HR.
pub const TRAINED_SIDE: usize = 128;

/// Second looks that the program takes.
///
/// Rationale: see `tests/report/training.md`.
pub const LOOKS: usize = 3;

/// A model that proposes the scene of a picture.
///
/// Models are trained on squares of [`TRAINED_SIDE`] pixels. A picture of another size is put on a square as large as its
/// longer side, in the middle, on the median color of its border, and resampled (bicubic, averaged where it shrinks):
/// proportions stay. Objects of a picture twice as wide as high therefore look half as large to the model. Noise is taken off before it
/// looks ([`cleared`]).
///
/// Scenes come back in the units of the picture (shorter side 1), with the reference's edges and overlaps blended,
/// as models know them. Computed in f32.
#[derive(Clone, Debug)]
pub struct Proposer {
    config: ModelConfig,
    model: Model<Host>,
    bank: PrototypeBank<f32>,
    painter: SceneSteps<f32>,
    /// Looks again at what was found.
    second: Option<Second>,
}

impl Proposer {
    /// The model of a checkpoint.
    ///
    /// # Errors
    /// As [`Checkpoint::model`].
    pub fn new(checkpoint: &Checkpoint) -> Result<Self, NetError> {
        let (config, bank) = (checkpoint.config().clone(), checkpoint.bank::<f32>()?);
        let mut weights = Parameters::<Host>::new();
        for (name, tensor) in checkpoint.weights::<Host>(&HostDevice)?.iter() {
            weights.insert(name, &tensor.cast(f32::DTYPE)?)?;
        }
        let model = Model::load(&config, &bank, &Weights::new(&weights).frozen())?;
        let painter = SceneSteps::new(config.objects(), config.harmonics(&bank), EdgeProfile::reference())?;
        Ok(Self { config, model, bank, painter, second: None })
    }

    /// What comes with the program: a model, and a second look.
    ///
    /// # Errors
    /// None is known: both are read in tests.
    pub fn built_in() -> Result<Self, NetError> {
        Self::from_bytes(BUILT_IN)?.with_look(&LookFile::from_bytes(BUILT_IN_LOOK)?, LOOKS)
    }

    /// The same, looking so many times again at every object that it finds; at least once. The places, sizes, angles and shapes of
    /// [`Self::objects`] are then those of the last look.
    ///
    /// # Errors
    /// [`NetError::Checkpoint`] if the look tells other shapes apart than the model knows; as [`Look::load`](crate::look::Look::load).
    pub fn with_look(self, file: &LookFile, looks: usize) -> Result<Self, NetError> {
        if file.bank::<f32>()? != self.bank {
            return Err(NetError::Checkpoint(
                "the second look tells other shapes apart than the network knows: train one with the same --bank and --harmonics, or \
                 take none"
                    .into(),
            ));
        }
        Ok(Self { second: Some(Second::new(file, looks.max(1))?), ..self })
    }

    /// The model of a file of weights, given by its bytes.
    ///
    /// # Errors
    /// As [`Checkpoint::from_bytes`] and [`Self::new`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, NetError> {
        Self::new(&Checkpoint::from_bytes(bytes)?)
    }

    /// The sizes of the model.
    #[must_use]
    pub fn config(&self) -> &ModelConfig {
        &self.config
    }

    /// The shapes that it knows.
    #[must_use]
    pub fn bank(&self) -> &PrototypeBank<f32> {
        &self.bank
    }

    /// The scene of a picture as the model sees it: every slot an object with its confidence.
    ///
    /// # Errors
    /// [`NetError::Image`] for a picture with NaN or infinity.
    pub fn propose(&self, image: ImageView<'_, f32>) -> Result<Scene<f32>, NetError> {
        let (square, target) = Square::of(image, TRAINED_SIDE)?;
        Ok(square.to_picture(self.scene(&self.latents(&cleared(target))?)?))
    }

    /// The objects of a picture: the slots that the model is sure of, and of the doubtful ones those that the picture is
    /// painted better with, with confidence 1; of two that stand for one thing (overlapping, of one color) the
    /// more confident; each with the shape of the prototype that weighs most in it, if shapes are mixed of prototypes. Where there are
    /// second looks, they put candidates right before the picture decides, and the last one what is there.
    ///
    /// # Errors
    /// As [`Self::propose`].
    pub fn objects(&self, image: ImageView<'_, f32>) -> Result<Scene<f32>, NetError> {
        let (square, target) = Square::of(image, TRAINED_SIDE)?;
        let target = cleared(target);
        let mut scene = self.scene(&self.latents(&target)?)?;
        let whole = |objects: &[Object<f32>]| objects.iter().map(|slot| self.with_prototype(slot)).collect();
        if let Some(second) = &self.second {
            let slots = candidates(&scene.objects);
            scene.objects = slots.into_iter().map(|slot| scene.objects[slot].clone()).collect();
            scene.objects = whole(&scene.objects);
            second.settle(&mut scene, &target, &self.bank, &self.painter)?;
        } else {
            keep_there(&mut scene, &target, &self.painter)?;
            scene.objects = whole(&scene.objects);
        }
        Ok(square.to_picture(scene))
    }

    /// OptZ from the slots that are objects (see [`Self::objects`]), at least the most confident one. The paper's moves all
    /// slots: it takes as many times as long, and several come to share an object. Losses are those on the square.
    ///
    /// # Errors
    /// As [`Self::propose`] and [`OptZ::run`].
    pub fn opt_z(&self, image: ImageView<'_, f32>, settings: &OptZ) -> Result<Optimum<f32>, NetError> {
        let (square, target) = Square::of(image, TRAINED_SIDE)?;
        let seen = cleared(target.clone());
        let latents = self.latents(&seen)?;
        let scene = self.scene(&latents)?;
        let mut slots = there(&scene, &seen, &self.painter)?;
        if slots.is_empty() {
            let confidence = |&slot: &usize| scene.objects[slot].confidence;
            slots.extend((0..scene.objects.len()).max_by(|a, b| confidence(a).total_cmp(&confidence(b))));
        }
        let painter = SceneSteps::new(slots.len(), self.config.harmonics(&self.bank), self.painter.edge())?;
        let found = settings.run(&self.model.of_slots(&slots)?, &painter, &target, &latents.of_slots(&slots)?)?;
        Ok(Optimum { scene: square.to_picture(found.scene), ..found })
    }

    /// Rand-OptZ: OptZ from latents drawn at random, which asks nothing of the encoder.
    ///
    /// # Errors
    /// As [`Self::opt_z`].
    pub fn rand_opt_z(&self, image: ImageView<'_, f32>, settings: &OptZ, seed: u64) -> Result<Optimum<f32>, NetError> {
        let (square, target) = Square::of(image, TRAINED_SIDE)?;
        let start = random_latents(&self.config, seed, f32::DTYPE, &HostDevice)?;
        let found = settings.run(&self.model, &self.painter, &target, &start)?;
        Ok(Optimum { scene: square.to_picture(found.scene), ..found })
    }

    /// Every slot, in units of the square.
    fn scene(&self, latents: &Latents<Host>) -> Result<Scene<f32>, NetError> {
        one(self.model.scenes::<f32>(latents)?.scenes(self.painter.edge())?)
    }

    /// A slot with the shape of the prototype that weighs most in it.
    fn with_prototype(&self, slot: &Object<f32>) -> Object<f32> {
        let prototype = slot.prototype().and_then(|index| self.bank.prototypes().get(index));
        let shape = prototype.map_or_else(|| slot.shape.clone(), |efd| AnyShape::of_efd(efd.clone(), slot.prototype()));
        Object { shape, ..slot.clone() }
    }

    fn latents(&self, target: &Image<f32>) -> Result<Latents<Host>, NetError> {
        let images = image_tensor(core::slice::from_ref(target), &HostDevice)?;
        Ok(self.model.latents(&self.model.features(&images)?, Phase::Inference)?.0)
    }
}

/// A picture as networks are shown it: without its noise.
///
/// Rationale: a network that learned from clean pictures takes noise for edges, and asks of an object that it explains a share of an error
/// that is mostly noise (`tests/report/stability.md`).
#[must_use]
pub fn cleared(picture: Image<f32>) -> Image<f32> {
    denoised(picture.view()).map_or(picture, |(clear, _)| clear)
}

/// The scene of a batch of one.
fn one(mut scenes: Vec<Scene<f32>>) -> Result<Scene<f32>, NetError> {
    scenes.pop().ok_or_else(|| NetError::Batch { must: "must hold at least one image".into() })
}
