//! A decomposer in a file.

use dvp_core::Real;
use dvp_core::tensor::Backend;

use super::decomposer::DecomposerTrainer;
use super::weights_file::WeightsFile;
use crate::decompose::{Decomposer, DecomposerConfig};
use crate::error::NetError;
use crate::weights::Weights;

/// A decomposer as it stands in a file.
pub type DecomposerFile = WeightsFile<DecomposerConfig>;

impl DecomposerFile {
    /// Takes a copy of a trainer's state; with its optimizer if `resumable`. `about`: what whoever writes the file wants to know
    /// when it is read.
    ///
    /// # Errors
    /// If the framework refuses to hand out its values.
    pub fn of<B: Backend, T: Real>(
        trainer: &DecomposerTrainer<B, T>,
        resumable: bool,
        about: &str,
    ) -> Result<Self, NetError> {
        Self::new(trainer.config().clone(), (trainer.parameters(), &trainer.adam), resumable, about)
    }

    /// The decomposer, to look with: its weights are constants.
    ///
    /// # Errors
    /// As [`DecomposerConfig::load`].
    pub fn decomposer<B: Backend>(&self, device: &B::Device) -> Result<Decomposer<B>, NetError> {
        self.config().load(&Weights::new(&self.weights(device)?).frozen())
    }

    /// Puts a trainer into the state that the file was written in.
    ///
    /// # Errors
    /// [`NetError::Checkpoint`] if the file is of a network of other sizes or holds no optimizer. The trainer is then as before.
    pub fn resume<B: Backend, T: Real>(
        &self,
        trainer: &mut DecomposerTrainer<B, T>,
        device: &B::Device,
    ) -> Result<(), NetError> {
        let (weights, adam) = self.state(trainer.config(), device)?;
        trainer.set_weights(&weights)?;
        trainer.adam = adam;
        Ok(())
    }
}
