//! Steps of training.

use std::thread;

use dvp_core::optim::AdamSettings;
use dvp_core::shape::PrototypeBank;
use dvp_core::tensor::{Adam, Backend, Parameters};
use dvp_core::{Image, Real, Scene};

use super::batch::{Batch, Features};
use super::gradients::{Gradients, cut, length};
use super::judge::Judge;
use super::mode::Mode;
use super::schedule::Schedule;
use super::weights_file::set_values;
use crate::error::NetError;
use crate::initial::initial_weights;
use crate::layers::Phase;
use crate::model::{Model, ModelConfig, Running};
use crate::scene_steps::image_tensor;
use crate::weights::{Weights, asked};

/// Images that are judged at the same time, without a step.
const AT_ONCE: usize = 32;

/// A model that learns.
#[derive(Clone, Debug)]
pub struct Trainer<B: Backend, T: Real> {
    pub(super) config: ModelConfig,
    bank: PrototypeBank<T>,
    device: B::Device,
    pub(super) parameters: Parameters<B>,
    pub(super) adam: Adam<B>,
    /// How it is judged.
    pub judge: Judge<T>,
    /// The learning rate.
    pub schedule: Schedule,
    /// The longest step: gradients whose length over all weights is above it are cut to it.
    pub clip_norm: Option<f64>,
    /// Parts of a batch that are worked on at the same time.
    pub threads: usize,
    /// What is drawn at random depends on it and the step.
    pub seed: u64,
}

/// What a step came to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Step {
    /// Its number, from 1.
    pub number: u64,
    /// The loss before it.
    pub loss: f64,
    /// L_x, where the mode has it.
    pub image: Option<f64>,
    /// L_p, where the mode has it.
    pub parameters: Option<f64>,
    /// Length of the gradient over all weights, before it was cut.
    pub gradient: f64,
    /// The learning rate.
    pub rate: f64,
}

/// What a part of a batch came to.
struct Part<B: Backend> {
    share: f64,
    /// Loss, L_x, L_p.
    losses: [Option<f64>; 3],
    gradients: Gradients<B>,
    running: Running<B>,
}

impl<B: Backend, T: Real> Trainer<B, T> {
    /// A model of these sizes that has learned nothing; the same for the same seed. `bank`: see [`Model::load`].
    ///
    /// # Errors
    /// [`NetError::Config`].
    #[inline(never)]
    pub fn new(
        config: ModelConfig,
        bank: PrototypeBank<T>,
        judge: Judge<T>,
        schedule: Schedule,
        seed: u64,
        device: B::Device,
    ) -> Result<Self, NetError> {
        let asked = asked::<B, _>(&device, |weights| Model::load(&config, &bank, weights))?;
        let parameters = initial_weights(&asked, seed, T::DTYPE, &device)?;
        let adam = Adam::new(AdamSettings::default());
        Ok(Self { config, bank, device, parameters, adam, judge, schedule, clip_norm: None, threads: 1, seed })
    }

    /// The sizes of the model.
    #[must_use]
    pub fn config(&self) -> &ModelConfig {
        &self.config
    }

    /// The shapes that the model knows.
    #[must_use]
    pub fn bank(&self) -> &PrototypeBank<T> {
        &self.bank
    }

    /// The weights as they are.
    #[must_use]
    pub fn parameters(&self) -> &Parameters<B> {
        &self.parameters
    }

    /// Takes the values of weights by name; those that are not given stay. For pretrained encoders and for modes that
    /// go on from another.
    ///
    /// # Errors
    /// [`ParametersError::Missing`](dvp_core::tensor::ParametersError::Missing) if the model has none of that name,
    /// [`ParametersError::Dims`](dvp_core::tensor::ParametersError::Dims).
    #[inline(never)]
    pub fn set_weights(&mut self, weights: &Parameters<B>) -> Result<(), NetError> {
        set_values(&mut self.parameters, weights, T::DTYPE)
    }

    /// Steps made.
    #[must_use]
    pub fn steps(&self) -> u64 {
        u64::from(self.adam.steps())
    }

    /// The model as it is.
    ///
    /// # Errors
    /// As [`Model::load`].
    pub fn model(&self) -> Result<Model<B>, NetError> {
        Model::load(&self.config, &self.bank, &Weights::new(&self.parameters))
    }

    /// One step of Adam on `batch`, which may be cut into parts for several threads: then norms over batches are over
    /// parts, and the scenes of TI-TP are drawn for each.
    ///
    /// # Errors
    /// As [`Judge::judge`]; [`NetError::NotFinite`] if the loss or a gradient is no number. The weights are then as before.
    #[inline(never)]
    pub fn step(&mut self, batch: &Batch<T>) -> Result<Step, NetError> {
        let number = self.steps() + 1;
        let parts = self.parts(batch, number)?;
        let mut gradients = Gradients::<B>::new();
        for part in &parts {
            for (name, gradient) in &part.gradients {
                let own = if parts.len() == 1 { gradient.clone() } else { gradient.affine(part.share, 0.0)? };
                let sum = gradients.get(name).map_or_else(|| Ok(own.clone()), |sum| sum.add(&own))?;
                gradients.insert(name.clone(), sum);
            }
        }
        let mean = |k: usize| parts.iter().map(|part| Some(part.share * part.losses[k]?)).sum::<Option<f64>>();
        let loss = mean(0).unwrap_or(f64::NAN);
        let norm = length(&gradients, loss, number)?;
        cut(&mut gradients, norm, self.clip_norm)?;
        let rate = self.schedule.rate(number);
        self.adam.step(&mut self.parameters, &gradients, rate)?;
        for (name, tensor) in running_mean(&parts)? {
            self.parameters.set(&name, &tensor)?;
        }
        Ok(Step { number, loss, image: mean(1), parameters: mean(2), gradient: norm, rate })
    }

    /// The loss of `batch` in `mode`, without a step: [`Step::gradient`] and [`Step::rate`] are 0. Norms go by what was
    /// learned.
    ///
    /// # Errors
    /// As [`Judge::judge`].
    #[inline(never)]
    pub fn validate(&self, mode: Mode, batch: &Batch<T>) -> Result<Step, NetError> {
        let judge = Judge { mode, ..self.judge.clone() };
        let (mut losses, mut total) = ([0.0; 3], 0.0);
        let model = self.frozen()?;
        for start in (0..batch.images.len()).step_by(AT_ONCE) {
            let part = batch.part(start, AT_ONCE);
            let judged = judge.judge(&model, &part, Phase::Inference, &self.device, self.seed)?;
            let own = [judged.loss.number()?, judged.image.unwrap_or(0.0), judged.parameters.unwrap_or(0.0)];
            let share = part.images.len() as f64;
            losses.iter_mut().zip(own).for_each(|(sum, own)| *sum += share * own);
            total += share;
        }
        let [loss, image, parameters] = losses.map(|sum| sum / total);
        let (image, parameters) =
            (judge.mode.has_image_loss().then_some(image), judge.mode.has_parameter_loss().then_some(parameters));
        Ok(Step { number: self.steps(), loss, image, parameters, gradient: 0.0, rate: 0.0 })
    }

    /// Images as the model sees them: its scenes, with the objects that are more likely there than not, painted.
    ///
    /// # Errors
    /// As [`Model::predict`].
    #[inline(never)]
    pub fn reconstruct(&self, images: &[Image<T>]) -> Result<Vec<Image<T>>, NetError> {
        let scenes = self.frozen()?.predict::<T>(&image_tensor(images, &self.device)?)?;
        let paint = |(mut scene, image): (Scene<T>, &Image<T>)| {
            scene.keep_visible();
            self.judge.steps.paint(&scene, image.size())
        };
        scenes.scenes(self.judge.steps.edge())?.into_iter().zip(images).map(paint).collect()
    }

    /// What the encoder makes of images: where it is frozen, once and for all.
    ///
    /// # Errors
    /// As [`Model::features`].
    #[inline(never)]
    pub fn features(&self, images: &[Image<T>]) -> Result<Vec<Features<T>>, NetError> {
        let model = self.frozen()?;
        let mut all = Vec::with_capacity(images.len());
        for images in images.chunks(AT_ONCE) {
            all.extend(Features::of_batch(&model.features(&image_tensor(images, &self.device)?)?)?);
        }
        Ok(all)
    }

    /// The model as it is, of constants.
    fn frozen(&self) -> Result<Model<B>, NetError> {
        Model::load(&self.config, &self.bank, &Weights::new(&self.parameters).frozen())
    }

    fn parts(&self, batch: &Batch<T>, step: u64) -> Result<Vec<Part<B>>, NetError> {
        let count = self.threads.clamp(1, batch.images.len().max(1));
        let len = batch.images.len().div_ceil(count);
        let chance = |k: usize| self.seed ^ step.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(k as u64);
        if count == 1 {
            return Ok(vec![self.part(batch, 1.0, chance(0))?]);
        }
        let batches: Vec<Batch<T>> = (0..batch.images.len()).step_by(len).map(|start| batch.part(start, len)).collect();
        thread::scope(|scope| {
            let run = |(k, part): (usize, Batch<T>)| {
                let share = part.images.len() as f64 / batch.images.len() as f64;
                scope.spawn(move || self.part(&part, share, chance(k)))
            };
            let threads: Vec<_> = batches.into_iter().enumerate().map(run).collect();
            let join = |thread: thread::ScopedJoinHandle<'_, _>| match thread.join() {
                Ok(result) => result,
                Err(panic) => std::panic::resume_unwind(panic),
            };
            threads.into_iter().map(join).collect()
        })
    }

    /// Gradients of a part of a batch, on handles of its own.
    fn part(&self, batch: &Batch<T>, share: f64, chance: u64) -> Result<Part<B>, NetError> {
        let mut replica = Parameters::new();
        for (name, weight) in self.parameters.iter() {
            replica.insert(name, &weight.detach()?)?;
        }
        let model = Model::load(&self.config, &self.bank, &Weights::new(&replica))?;
        let judged = self.judge.judge(&model, batch, Phase::Training, &self.device, chance)?;
        let losses = [Some(judged.loss.number()?), judged.image, judged.parameters];
        let gradients = replica.gradients(&judged.loss.backward()?);
        Ok(Part { share, losses, gradients, running: judged.running })
    }
}

/// Means over parts of what follows a batch without a gradient.
fn running_mean<B: Backend>(parts: &[Part<B>]) -> Result<Running<B>, NetError> {
    let mut means = Running::<B>::new();
    for part in parts {
        for (k, (name, tensor)) in part.running.iter().enumerate() {
            let own = tensor.affine(part.share, 0.0)?;
            match means.get_mut(k) {
                Some((_, mean)) => *mean = mean.add(&own)?,
                None => means.push((name.clone(), own)),
            }
        }
    }
    Ok(means)
}
