//! OptZ: Adam on latents.

use dvp_core::optim::{AdamSettings, Plateau, PlateauSettings};
use dvp_core::render::PixelLoss;
use dvp_core::tensor::{Adam, Backend, Parameters, ParametersError, TensorError};
use dvp_core::{Image, Real, Scene};

use crate::error::NetError;
use crate::model::{Latents, Model};
use crate::scene_steps::SceneSteps;

/// The names of the free parameters.
const OBJECTS: &str = "objects";
const IMAGE: &str = "image";

/// Settings of OptZ and, from [`random_latents`](super::random_latents), of Rand-OptZ; the defaults are the paper's.
///
/// *Source*: the paper, TI-TP-OptZ: 100 steps of Adam at rate 0.01, halved on a plateau of 10 steps (cooldown 10); the
/// loss is that of its implementation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct OptZ {
    /// Steps of Adam.
    pub steps: usize,
    /// Learning rate at the start.
    pub learning_rate: f64,
    /// When and by how much the rate is cut.
    pub plateau: PlateauSettings,
    /// L_x.
    pub loss: PixelLoss,
}

impl Default for OptZ {
    fn default() -> Self {
        Self { steps: 100, learning_rate: 0.01, plateau: PlateauSettings::default(), loss: PixelLoss::Mae }
    }
}

impl OptZ {
    /// The same with [`Self::steps`].
    #[must_use]
    pub fn with_steps(self, steps: usize) -> Self {
        Self { steps, ..self }
    }
}

/// What a descent came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Optimum<T> {
    /// The best scene met, with every slot of the model as an object.
    pub scene: Scene<T>,
    /// Its loss: the smallest of [`Self::losses`].
    pub loss: f64,
    /// The loss at the start and after each step; shorter if a step led to no number.
    pub losses: Vec<f64>,
}

impl OptZ {
    /// The best scene that Adam meets on its way from `start`, the start and the last step included. The latents of the
    /// slots and that of the image, which the background is read off, move each for itself.
    ///
    /// *Dimensions*: `start` is the latents of one image, batch 1. `painter` must be made for as many objects and
    /// harmonics as the model predicts; `image` may have any size.
    ///
    /// # Errors
    /// [`NetError::Tensor`] if these are no latents of this model or the painter is for another one;
    /// [`NetError::NotFinite`] if the latents or the loss are no numbers at the start. If they are none later, the descent
    /// ends before it.
    pub fn run<B: Backend, T: Real>(
        &self,
        model: &Model<B>,
        painter: &SceneSteps<T>,
        image: &Image<T>,
        start: &Latents<B>,
    ) -> Result<Optimum<T>, NetError> {
        let mut free = Parameters::<B>::new();
        free.insert(OBJECTS, &start.objects.detach()?)?;
        free.insert(IMAGE, &start.image.detach()?)?;
        let mut adam = Adam::new(AdamSettings::default());
        let mut schedule = Plateau::new(self.plateau, self.learning_rate);
        let mut losses = Vec::with_capacity(self.steps + 1);
        let mut best: Option<(f64, Scene<T>)> = None;
        // Not left to the loss: what the heads clamp hides that a number went in as none.
        while is_finite(&free)? {
            let predicted = model.scenes::<T>(&latents(&free)?)?;
            let loss = painter.image_loss(&predicted, vec![image.clone()], self.loss)?;
            let value = loss.number()?;
            if !value.is_finite() {
                break;
            }
            // The rate of the first step is that of the settings: the schedule hears of a loss after each step only.
            if !losses.is_empty() {
                schedule.observe(value);
            }
            losses.push(value);
            if best.as_ref().is_none_or(|(least, _)| value < *least) {
                best = predicted.scenes(painter.edge())?.pop().map(|scene| (value, scene));
            }
            if losses.len() > self.steps {
                break;
            }
            let gradients = free.gradients(&loss.backward()?);
            adam.step(&mut free, &gradients, schedule.learning_rate())?;
        }
        match best {
            Some((loss, scene)) => Ok(Optimum { scene, loss, losses }),
            None => Err(NetError::NotFinite { step: 0, loss: f64::NAN }),
        }
    }
}

fn is_finite<B: Backend>(free: &Parameters<B>) -> Result<bool, TensorError> {
    for (_, tensor) in free.iter() {
        if !tensor.to_f64()?.iter().all(|value| value.is_finite()) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The free parameters as latents.
fn latents<B: Backend>(free: &Parameters<B>) -> Result<Latents<B>, ParametersError> {
    Ok(Latents { objects: free.get(OBJECTS)?.clone(), image: free.get(IMAGE)?.clone() })
}
