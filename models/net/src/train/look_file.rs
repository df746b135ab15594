//! A second look in a file, with the shapes it tells apart.

use dvp_core::Real;
use dvp_core::tensor::Backend;

use super::looker::LookTrainer;
use super::weights_file::WeightsFile;
use crate::error::NetError;
use crate::look::LookConfig;

/// A second look as it stands in a file.
pub type LookFile = WeightsFile<LookConfig>;

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
        let mut file = Self::new(trainer.config().clone(), (trainer.parameters(), &trainer.adam), resumable, about)?;
        file.take_bank(trainer.bank())?;
        Ok(file)
    }

    /// Puts a trainer into the state that the file was written in.
    ///
    /// # Errors
    /// [`NetError::Checkpoint`] if the file is of a network of other sizes or holds no optimizer. The trainer is then as before.
    pub fn resume<B: Backend, T: Real>(
        &self,
        trainer: &mut LookTrainer<B, T>,
        device: &B::Device,
    ) -> Result<(), NetError> {
        let (weights, adam) = self.state(trainer.config(), device)?;
        trainer.set_weights(&weights)?;
        trainer.adam = adam;
        Ok(())
    }
}
