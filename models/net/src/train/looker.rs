//! Steps of a second look.

use alloc::collections::BTreeMap;

use dvp_core::optim::AdamSettings;
use dvp_core::render::EdgeProfile;
use dvp_core::shape::PrototypeBank;
use dvp_core::tensor::{Adam, Backend, Parameters, Tensor};
use dvp_core::{Image, Real, Scene};
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

use super::batch::Batch;
use super::gradients::{cut, length};
use super::schedule::Schedule;
use super::shake::shaken;
use super::weights_file::set_values;
use crate::error::NetError;
use crate::initial::initial_weights;
use crate::look::{Aim, Layout, Look, LookConfig, PLANES, Sight};
use crate::scene_steps::SceneSteps;
use crate::weights::{Weights, asked};

/// Factors of the loss on what scale and angle are off by, and on shapes; those on places are 1.
const SCALE: f64 = 1.5;
const TURN: f64 = 0.3;
const SHAPE: f64 = 0.2;

/// A second look that learns, from scenes and their images.
#[derive(Clone, Debug)]
pub struct LookTrainer<B: Backend, T: Real> {
    config: LookConfig,
    bank: PrototypeBank<T>,
    layout: Layout,
    painter: SceneSteps<T>,
    device: B::Device,
    parameters: Parameters<B>,
    pub(super) adam: Adam<B>,
    /// The learning rate.
    pub schedule: Schedule,
    /// The longest step: gradients whose length over all weights is above it are cut to it.
    pub clip_norm: Option<f64>,
    /// What is drawn at random depends on it and the step.
    pub seed: u64,
}

/// What a step of a second look came to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LookStep {
    /// Its number, from 1.
    pub number: u64,
    /// The loss before it.
    pub loss: f64,
    /// Mean absolute error of centers, in scales of the object, and of logarithms of scales.
    pub moves: f64,
    /// Cross entropy of shapes.
    pub shapes: f64,
    /// Length of the gradient over all weights, before it was cut.
    pub gradient: f64,
    /// The learning rate.
    pub rate: f64,
}

/// A loss and what it is made of.
struct Verdict<B: Backend> {
    loss: Tensor<B>,
    moves: f64,
    shapes: f64,
}

impl<B: Backend, T: Real> LookTrainer<B, T> {
    /// A look of these sizes that has learned nothing; the same for the same seed on every backend. `bank`: the shapes it tells apart;
    /// `edge`: that of the images.
    ///
    /// # Errors
    /// [`NetError::Config`]; [`NetError::Shape`] for shapes without a harmonic.
    pub fn new(
        config: LookConfig,
        bank: PrototypeBank<T>,
        edge: EdgeProfile<T>,
        schedule: Schedule,
        seed: u64,
        device: B::Device,
    ) -> Result<Self, NetError> {
        let layout = Layout::of(&bank);
        let asked = asked::<B, _>(&device, |weights| Look::load(&config, layout.prototypes(), weights))?;
        let parameters = initial_weights(&asked, seed, T::DTYPE, &device)?;
        let painter = SceneSteps::new(1, bank.harmonic_count(), edge)?;
        let adam = Adam::new(AdamSettings::default());
        Ok(Self { config, bank, layout, painter, device, parameters, adam, schedule, clip_norm: None, seed })
    }

    /// The sizes of the look.
    #[must_use]
    pub fn config(&self) -> &LookConfig {
        &self.config
    }

    /// The shapes that it tells apart.
    #[must_use]
    pub fn bank(&self) -> &PrototypeBank<T> {
        &self.bank
    }

    /// The weights as they are.
    #[must_use]
    pub fn parameters(&self) -> &Parameters<B> {
        &self.parameters
    }

    /// Takes the values of weights by name; those that are not given stay.
    ///
    /// # Errors
    /// [`ParametersError::Missing`](dvp_core::tensor::ParametersError::Missing) if the look has none of that name,
    /// [`ParametersError::Dims`](dvp_core::tensor::ParametersError::Dims). Weights named before that one are then taken.
    pub fn set_weights(&mut self, weights: &Parameters<B>) -> Result<(), NetError> {
        set_values(&mut self.parameters, weights, T::DTYPE)
    }

    /// Steps made.
    #[must_use]
    pub fn steps(&self) -> u64 {
        u64::from(self.adam.steps())
    }

    /// The loss of the next step on `batch`, and its gradient with respect to every weight.
    ///
    /// # Errors
    /// [`NetError::Batch`] if images have no scenes, or no object; as [`SceneSteps::paint`]; [`NetError::NotFinite`] if the loss or a
    /// gradient is no number.
    pub fn gradients(&self, batch: &Batch<T>) -> Result<(LookStep, BTreeMap<String, Tensor<B>>), NetError> {
        let number = self.steps() + 1;
        let chance = self.seed ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let look = Look::load(&self.config, self.layout.prototypes(), &Weights::new(&self.parameters))?;
        let Verdict { loss, moves, shapes } = self.judge(&look, batch, chance)?;
        let gradients = self.parameters.gradients(&loss.backward()?);
        let loss = loss.number()?;
        let gradient = length(&gradients, loss, number)?;
        let rate = self.schedule.rate(number);
        Ok((LookStep { number, loss, moves, shapes, gradient, rate }, gradients))
    }

    /// One step of Adam on the objects of `batch`, each of which is seen a little off.
    ///
    /// # Errors
    /// As [`Self::gradients`]. The weights are then as before.
    pub fn step(&mut self, batch: &Batch<T>) -> Result<LookStep, NetError> {
        let (step, mut gradients) = self.gradients(batch)?;
        cut(&mut gradients, step.gradient, self.clip_norm)?;
        self.adam.step(&mut self.parameters, &gradients, step.rate)?;
        Ok(step)
    }

    /// The loss of `batch`, always shaken in the same way, without a step: [`LookStep::gradient`] and [`LookStep::rate`] are 0.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn validate(&self, batch: &Batch<T>) -> Result<LookStep, NetError> {
        let verdict = self.judge(&self.look()?, batch, self.seed)?;
        let (loss, moves, shapes) = (verdict.loss.number()?, verdict.moves, verdict.shapes);
        Ok(LookStep { number: self.steps(), loss, moves, shapes, gradient: 0.0, rate: 0.0 })
    }

    /// Images of scenes that are seen a little off, and of what this look makes of them.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn corrected(&self, batch: &Batch<T>) -> Result<[Vec<Image<T>>; 2], NetError> {
        let look = self.look()?;
        let (mut before, mut after) = (Vec::new(), Vec::new());
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        for (image, truth) in batch.images.iter().zip(&batch.scenes) {
            let mut seen = shaken(truth, &self.bank, &mut rng).0;
            before.push(self.painter.paint(&seen, image.size())?);
            look.correct(&mut seen, image, &self.bank, &self.painter, &self.device)?;
            after.push(self.painter.paint(&seen, image.size())?);
        }
        Ok([before, after])
    }

    /// The look as it is, of constants.
    fn look(&self) -> Result<Look<B>, NetError> {
        Look::load(&self.config, self.layout.prototypes(), &Weights::new(&self.parameters).frozen())
    }

    fn judge(&self, look: &Look<B>, batch: &Batch<T>, chance: u64) -> Result<Verdict<B>, NetError> {
        if batch.scenes.len() != batch.images.len() {
            return Err(NetError::Batch { must: "must hold a scene for each image".into() });
        }
        let (windows, aim) = self.examples(batch, chance)?;
        let objects = aim.moves.len() / 3;
        if objects == 0 {
            return Err(NetError::Batch { must: "must hold at least one object".into() });
        }
        let share = (objects as f64).recip();
        let (side, count) = (self.config.side, self.layout.prototypes());
        let windows = Tensor::new(windows, &[objects, PLANES, side, side], &self.device)?;
        let said = look.forward(&windows)?;
        let factors = said.like(vec![1.0, 1.0, SCALE], &[1, 3])?;
        let off = said.slice(1, 0, 3)?.sub(&said.like(aim.moves, &[objects, 3])?)?.abs()?;
        let shapes = said.slice(1, 3, count)?.log_softmax(1)?.mul(&said.like(aim.shapes, &[objects, count])?)?;
        let shapes = shapes.sum_all()?.affine(-share, 0.0)?;
        let turns = said.slice(1, 3 + count, 2 * count)?.sub(&said.like(aim.turns, &[objects, 2 * count])?)?.abs()?;
        let turns = turns.mul(&said.like(aim.turned, &[objects, 2 * count])?)?.sum_all()?;
        let loss = off.mul(&factors)?.sum_all()?.affine(share, 0.0)?;
        let loss = loss.add(&turns.affine(TURN * share, 0.0)?)?.add(&shapes.affine(SHAPE, 0.0)?)?;
        Ok(Verdict { loss, moves: off.sum_all()?.number()? * share / 3.0, shapes: shapes.number()? })
    }

    /// Windows of objects that are seen a little off, and what should be said of them.
    fn examples(&self, batch: &Batch<T>, chance: u64) -> Result<(Vec<T>, Aim), NetError> {
        let mut rng = ChaCha8Rng::seed_from_u64(chance);
        let (mut windows, mut aim) = (Vec::new(), Aim::default());
        for (picture, truth) in batch.images.iter().zip(&batch.scenes) {
            let (seen, which) = shaken(truth, &self.bank, &mut rng);
            let painted = self.painter.paint(&seen, picture.size())?;
            let sight = Sight { picture, painted: &painted, background: seen.background };
            for (object, &k) in seen.objects.iter().zip(&which) {
                self.example(&sight, object, truth, k, &mut windows, &mut aim)?;
            }
        }
        Ok((windows, aim))
    }

    fn example(
        &self,
        sight: &Sight<'_, T>,
        object: &dvp_core::Object<T>,
        truth: &Scene<T>,
        k: usize,
        windows: &mut Vec<T>,
        aim: &mut Aim,
    ) -> Result<(), NetError> {
        let truth = &truth.objects[k];
        let prototype = truth
            .prototype()
            .filter(|&k| k < self.layout.prototypes())
            .ok_or_else(|| NetError::Batch { must: "must hold objects with the shapes of the bank".into() })?;
        sight.window(&self.config, object, windows);
        self.layout.aim(object, truth, prototype, aim);
        Ok(())
    }
}
