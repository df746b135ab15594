//! A model in a file: its weights, its sizes, the shapes it knows and, if it is to go on learning, its optimizer.
//!
//! One safetensors file. Tensors: `model.*`, `bank` (prototypes x harmonics x 4), `adam.mean.*`, `adam.square.*`. The rest
//! is JSON in the file's metadata, with a checksum over all numbers: a damaged file is never taken for a model.

use dvp_core::Real;
use dvp_core::shape::PrototypeBank;
use dvp_core::tensor::{Backend, Parameters};

use super::stored::Stored;
use super::trainer::Trainer;
use crate::error::NetError;
use crate::model::{Model, ModelConfig};
use crate::weights::Weights;

/// A model as it stands in a file.
#[derive(Clone, Debug)]
pub struct Checkpoint {
    stored: Stored<ModelConfig>,
}

impl Checkpoint {
    /// Takes a copy of a trainer's state; with its optimizer if `resumable`.
    ///
    /// # Errors
    /// If the framework refuses to hand out its values.
    #[inline(never)]
    pub fn of<B: Backend, T: Real>(trainer: &Trainer<B, T>, resumable: bool, about: &str) -> Result<Self, NetError> {
        let mut stored = Stored::of(trainer.config().clone(), (trainer.parameters(), &trainer.adam), resumable, about)?;
        stored.take_bank(trainer.bank())?;
        Ok(Self { stored })
    }

    /// The bytes of its file.
    ///
    /// # Errors
    /// [`NetError::Parameters`]; nothing is known to refuse.
    pub fn to_bytes(&self) -> Result<Vec<u8>, NetError> {
        self.stored.to_bytes()
    }

    /// Reads a file, given by its bytes.
    ///
    /// # Errors
    /// [`NetError::Checkpoint`] or [`NetError::Parameters`] if it is damaged, or no file of this program.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, NetError> {
        Ok(Self { stored: Stored::from_bytes(bytes)? })
    }

    /// What whoever wrote the file wants to know when it is read: the settings of the run, say.
    #[must_use]
    pub fn about(&self) -> &str {
        &self.stored.about
    }

    /// The sizes of the model.
    #[must_use]
    pub fn config(&self) -> &ModelConfig {
        &self.stored.config
    }

    /// Steps it has learned for.
    #[must_use]
    pub fn steps(&self) -> u64 {
        u64::from(self.stored.steps)
    }

    /// The shapes it knows.
    ///
    /// # Errors
    /// [`NetError::Parameters`] if the file holds none.
    pub fn bank<T: Real>(&self) -> Result<PrototypeBank<T>, NetError> {
        self.stored.bank()
    }

    /// The weights by the names of the model.
    ///
    /// # Errors
    /// If the framework refuses.
    #[inline(never)]
    pub fn weights<B: Backend>(&self, device: &B::Device) -> Result<Parameters<B>, NetError> {
        self.stored.weights(device)
    }

    /// The model, to look with: its weights are constants.
    ///
    /// # Errors
    /// As [`Model::load`].
    pub fn model<B: Backend>(&self, device: &B::Device) -> Result<Model<B>, NetError> {
        Model::load(self.config(), &self.bank::<f64>()?, &Weights::new(&self.weights(device)?).frozen())
    }

    /// Puts a trainer into the state that the file was written in.
    ///
    /// # Errors
    /// [`NetError::Checkpoint`] if the file is of a model of other sizes or holds no optimizer. The trainer is then as before.
    #[inline(never)]
    pub fn resume<B: Backend, T: Real>(&self, trainer: &mut Trainer<B, T>, device: &B::Device) -> Result<(), NetError> {
        if self.config() != trainer.config() {
            return Err(NetError::Checkpoint("it is of a model of other sizes".into()));
        }
        let adam = self.stored.adam(device)?;
        trainer.set_weights(&self.weights(device)?)?;
        trainer.adam = adam;
        Ok(())
    }
}
