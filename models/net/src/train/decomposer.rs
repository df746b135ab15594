//! Steps of a decomposer.

use core::marker::PhantomData;

use dvp_core::optim::AdamSettings;
use dvp_core::tensor::{Adam, Backend, Parameters};
use dvp_core::{Image, Real};

use super::gradients::{cut, length};
use super::schedule::Schedule;
use super::weights_file::set_values;
use crate::decompose::{Decomposer, DecomposerConfig, PartsOf, Terms};
use crate::error::NetError;
use crate::initial::initial_weights;
use crate::scene_steps::image_tensor;
use crate::weights::{Weights, asked};

/// Images that are judged at the same time, without a step.
const AT_ONCE: usize = 16;

/// A decomposer that learns, from images alone.
#[derive(Clone, Debug)]
pub struct DecomposerTrainer<B: Backend, T: Real> {
    config: DecomposerConfig,
    device: B::Device,
    parameters: Parameters<B>,
    pub(super) adam: Adam<B>,
    /// The learning rate.
    pub schedule: Schedule,
    /// The longest step: gradients whose length over all weights is above it are cut to it.
    pub clip_norm: Option<f64>,
    /// What is drawn at random depends on it and the step.
    pub seed: u64,
    numbers: PhantomData<T>,
}

/// What a step of a decomposer came to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct DecomposerStep {
    /// Its number, from 1.
    pub number: u64,
    /// The loss before it.
    pub loss: f64,
    /// What the loss is made of.
    pub terms: Terms,
    /// Length of the gradient over all weights, before it was cut.
    pub gradient: f64,
    /// The learning rate.
    pub rate: f64,
}

impl<B: Backend, T: Real> DecomposerTrainer<B, T> {
    /// A decomposer of these sizes that has learned nothing; the same for the same seed on every backend.
    ///
    /// # Errors
    /// [`NetError::Config`].
    pub fn new(config: DecomposerConfig, schedule: Schedule, seed: u64, device: B::Device) -> Result<Self, NetError> {
        let asked = asked::<B, _>(&device, |weights| config.load(weights))?;
        let parameters = initial_weights(&asked, seed, T::DTYPE, &device)?;
        let adam = Adam::new(AdamSettings::default());
        Ok(Self { config, device, parameters, adam, schedule, clip_norm: None, seed, numbers: PhantomData })
    }

    /// The sizes of the decomposer.
    #[must_use]
    pub fn config(&self) -> &DecomposerConfig {
        &self.config
    }

    /// The weights as they are.
    #[must_use]
    pub fn parameters(&self) -> &Parameters<B> {
        &self.parameters
    }

    /// Takes the values of weights by name; those that are not given stay.
    ///
    /// # Errors
    /// [`ParametersError::Missing`](dvp_core::tensor::ParametersError::Missing) if the decomposer has none of that name,
    /// [`ParametersError::Dims`](dvp_core::tensor::ParametersError::Dims). Weights named before that one are then taken.
    pub fn set_weights(&mut self, weights: &Parameters<B>) -> Result<(), NetError> {
        set_values(&mut self.parameters, weights, T::DTYPE)
    }

    /// Steps made.
    #[must_use]
    pub fn steps(&self) -> u64 {
        u64::from(self.adam.steps())
    }

    /// One step of Adam on images of the side of the decomposer.
    ///
    /// # Errors
    /// As [`Decomposer::judge`]; [`NetError::NotFinite`] if the loss or a gradient is no number. The weights are then as before.
    pub fn step(&mut self, images: &[Image<T>]) -> Result<DecomposerStep, NetError> {
        let number = self.steps() + 1;
        let chance = self.seed ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let decomposer = self.config.load(&Weights::new(&self.parameters))?;
        let verdict = decomposer.judge(&image_tensor(images, &self.device)?, chance)?;
        let loss = verdict.loss.number()?;
        let mut gradients = self.parameters.gradients(&verdict.loss.backward()?);
        let gradient = length(&gradients, loss, number)?;
        cut(&mut gradients, gradient, self.clip_norm)?;
        let rate = self.schedule.rate(number);
        self.adam.step(&mut self.parameters, &gradients, rate)?;
        Ok(DecomposerStep { number, loss, terms: verdict.terms, gradient, rate })
    }

    /// The parts of images as they are now.
    ///
    /// # Errors
    /// As [`Decomposer::parts`].
    pub fn parts(&self, images: &[Image<T>]) -> Result<Vec<PartsOf>, NetError> {
        let decomposer: Decomposer<B> = self.config.load(&Weights::new(&self.parameters).frozen())?;
        let mut all = Vec::with_capacity(images.len());
        for images in images.chunks(AT_ONCE) {
            all.extend(decomposer.parts(&image_tensor(images, &self.device)?)?.of_images()?);
        }
        Ok(all)
    }
}
