//! A second look in a file: its weights, its sizes, the shapes it tells apart and, if it is to go on learning, its optimizer.
//!
//! Tensors: `model.*`, `bank`, `adam.mean.*`, `adam.square.*`; the rest as [`Checkpoint`](super::Checkpoint) has it.

use dvp_core::Real;
use dvp_core::shape::PrototypeBank;
use dvp_core::tensor::{Backend, Parameters};

use super::looker::LookTrainer;
use super::stored::Stored;
use crate::error::NetError;
use crate::look::LookConfig;

/// A second look as it stands in a file.
#[derive(Clone, Debug)]
pub struct LookFile {
    stored: Stored<LookConfig>,
}

impl LookFile {
    /// Takes a copy of a trainer's state; with its optimizer if `resumable`. `about`: what whoever writes the file wants to know
    /// when it is read.
    ///
    /// # Errors
    /// If the framework refuses to hand out its values.
    pub fn of<B: Backend, T: Real>(
        trainer: &LookTrainer<B, T>,
        resumable: bool,
        about: &str,
    ) -> Result<Self, NetError> {
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
    /// [`NetError::Checkpoint`] or [`NetError::Parameters`] if it is damaged, or holds no second look.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, NetError> {
        Ok(Self { stored: Stored::from_bytes(bytes)? })
    }

    /// The sizes of the look.
    #[must_use]
    pub fn config(&self) -> &LookConfig {
        &self.stored.config
    }

    /// Steps it has learned for.
    #[must_use]
    pub fn steps(&self) -> u64 {
        u64::from(self.stored.steps)
    }

    /// What whoever wrote the file wants to know when it is read.
    #[must_use]
    pub fn about(&self) -> &str {
        &self.stored.about
    }

    /// The shapes it tells apart.
    ///
    /// # Errors
    /// [`NetError::Parameters`] if the file holds none.
    pub fn bank<T: Real>(&self) -> Result<PrototypeBank<T>, NetError> {
        self.stored.bank()
    }

    /// The weights by the names of the look.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn weights<B: Backend>(&self, device: &B::Device) -> Result<Parameters<B>, NetError> {
        self.stored.weights(device)
    }

    /// Puts a trainer into the state that the file was written in.
    ///
    /// # Errors
    /// [`NetError::Checkpoint`] if the file is of a look of other sizes or holds no optimizer. The trainer is then as before.
    pub fn resume<B: Backend, T: Real>(
        &self,
        trainer: &mut LookTrainer<B, T>,
        device: &B::Device,
    ) -> Result<(), NetError> {
        if self.config() != trainer.config() {
            return Err(NetError::Checkpoint("it is of a second look of other sizes".into()));
        }
        let adam = self.stored.adam(device)?;
        trainer.set_weights(&self.weights(device)?)?;
        trainer.adam = adam;
        Ok(())
    }
}
