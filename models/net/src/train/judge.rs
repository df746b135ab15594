//! The loss of a batch in each mode.

use core::f64::consts::TAU;

use dvp_core::render::PixelLoss;
use dvp_core::shape::PrototypeBank;
use dvp_core::tensor::{Backend, Tensor};
use dvp_core::{AnyShape, Image, Real, Scene};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use super::batch::{Batch, Features};
use super::mode::{Mode, Source};
use crate::error::NetError;
use crate::layers::Phase;
use crate::model::{Model, Prediction, Running};
use crate::scene_steps::{SceneSteps, image_tensor};
use crate::there::there;

/// How a model is judged.
#[derive(Clone, Debug)]
pub struct Judge<T: Real> {
    /// The regime.
    pub mode: Mode,
    /// L_x.
    pub image_loss: PixelLoss,
    /// Factor on L_x where L_p is there too; 1 in the paper.
    pub image_weight: f64,
    /// Steps on the scenes of the model.
    pub steps: SceneSteps<T>,
    /// Shapes that TI-TP gives to the objects it paints again; if there are none they keep theirs.
    pub bank: PrototypeBank<T>,
}

/// A batch, judged.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Judged<B: Backend> {
    /// A number.
    pub loss: Tensor<B>,
    /// L_x, where the mode has it.
    pub image: Option<f64>,
    /// L_p, where the mode has it.
    pub parameters: Option<f64>,
    /// Weights that follow the batch without a gradient.
    pub running: Running<B>,
}

impl<T: Real> Judge<T> {
    /// The loss of `batch`; `chance` numbers what TI-TP draws at random.
    ///
    /// # Errors
    /// [`NetError::Batch`] if the batch is empty, or scenes are missing that the mode needs, or clean images; as the model and the steps.
    pub fn judge<B: Backend>(
        &self,
        model: &Model<B>,
        batch: &Batch<T>,
        phase: Phase,
        device: &B::Device,
        chance: u64,
    ) -> Result<Judged<B>, NetError> {
        if batch.images.is_empty() {
            return Err(NetError::Batch { must: "must hold at least one image".into() });
        }
        if self.mode.source() == Source::Scenes && batch.scenes.len() != batch.images.len() {
            return Err(NetError::Batch { must: format!("must hold a scene for each image in mode {}", self.mode) });
        }
        if batch.targets().len() != batch.images.len() {
            return Err(NetError::Batch { must: "must hold a clean image for each image, or none".into() });
        }
        let features = if batch.features.is_empty() {
            model.features(&image_tensor(&batch.images, device)?)?
        } else {
            Features::stack(&batch.features, device)?
        };
        let (first, running) = see::<B, T>(model, &features, phase)?;
        let image_loss =
            |scenes: &Prediction<B>| self.steps.image_loss(scenes, batch.targets().to_vec(), self.image_loss);
        let (image, parameters) = match self.mode {
            Mode::Ti | Mode::Gi | Mode::TiPlus => (Some(image_loss(&first)?), None),
            Mode::Gp => (None, Some(self.steps.parameter_loss(&first, batch.scenes.clone())?)),
            Mode::GpGi => (Some(image_loss(&first)?), Some(self.steps.parameter_loss(&first, batch.scenes.clone())?)),
            Mode::Tp => (None, Some(self.again(model, &first, batch, phase)?)),
            Mode::TiTp => {
                // What is there and which shape it has is learned from scenes alone.
                let image = image_loss(&first.detach([false, false, false, false, true, true, false])?)?;
                (Some(image), Some(self.dreamed(model, &first, batch, phase, device, chance)?))
            }
        };
        let loss = match (&image, &parameters) {
            (Some(image), Some(parameters)) => image.affine(self.image_weight, 0.0)?.add(parameters)?,
            (Some(loss), None) | (None, Some(loss)) => loss.clone(),
            (None, None) => return Err(NetError::Batch { must: "must be judged by something".into() }),
        };
        let number = |loss: &Option<Tensor<B>>| loss.as_ref().map(Tensor::number).transpose();
        Ok(Judged { image: number(&image)?, parameters: number(&parameters)?, loss, running })
    }

    /// TP: what is read off the repainted image, against what was painted; the gradient flows through the painting, what
    /// was painted is taken for the truth.
    fn again<B: Backend>(
        &self,
        model: &Model<B>,
        first: &Prediction<B>,
        batch: &Batch<T>,
        phase: Phase,
    ) -> Result<Tensor<B>, NetError> {
        let truths = first.scenes(self.steps.edge())?;
        let painted = self.steps.render(first, batch.images[0].size())?;
        self.steps.parameter_loss(&look::<B, T>(model, &painted, phase)?.0, truths)
    }

    /// TI-TP: scenes dreamed of what was seen, painted and read.
    fn dreamed<B: Backend>(
        &self,
        model: &Model<B>,
        first: &Prediction<B>,
        batch: &Batch<T>,
        phase: Phase,
        device: &B::Device,
        chance: u64,
    ) -> Result<Tensor<B>, NetError> {
        let mut rng = ChaCha8Rng::seed_from_u64(chance);
        let mut scenes = first.scenes(self.steps.edge())?;
        let mut images = Vec::with_capacity(scenes.len());
        for (scene, target) in scenes.iter_mut().zip(batch.targets()) {
            self.dream(scene, target, &mut rng)?;
            images.push(self.steps.paint(scene, target.size())?);
        }
        self.steps.parameter_loss(&look::<B, T>(model, &image_tensor(&images, device)?, phase)?.0, scenes)
    }

    /// Keeps of a scene that was seen in `target` the objects that are there, turned at random and with the shapes of
    /// prototypes at random.
    ///
    /// Rationale: an object that is seen twice must not be dreamed twice. The model would learn from its own dreams that
    /// what it sees twice is there twice, L_x pulls both on the object, and from step to step more are doubled (100 steps
    /// from good weights: exact count .88 to .80, all of it objects too many). So the picture decides what is there.
    pub(super) fn dream(&self, scene: &mut Scene<T>, target: &Image<T>, rng: &mut ChaCha8Rng) -> Result<(), NetError> {
        let prototypes = self.bank.prototypes();
        let slots = there(scene, target, &self.steps)?;
        scene.objects = slots.into_iter().map(|slot| scene.objects[slot].clone()).collect();
        for object in &mut scene.objects {
            object.confidence = T::one();
            object.pose.rotation = T::of(rng.random_range(0.0..TAU));
            if !prototypes.is_empty() {
                let k = rng.random_range(0..prototypes.len());
                object.shape = AnyShape::of_efd(prototypes[k].clone(), Some(k));
            }
        }
        Ok(())
    }
}

/// Scenes of images, and what follows the batch.
fn look<B: Backend, T: Real>(
    model: &Model<B>,
    images: &Tensor<B>,
    phase: Phase,
) -> Result<(Prediction<B>, Running<B>), NetError> {
    see::<B, T>(model, &model.features(images)?, phase)
}

/// The same, from features.
fn see<B: Backend, T: Real>(
    model: &Model<B>,
    features: &Tensor<B>,
    phase: Phase,
) -> Result<(Prediction<B>, Running<B>), NetError> {
    let (latents, running) = model.latents(features, phase)?;
    Ok((model.scenes::<T>(&latents)?, running))
}
