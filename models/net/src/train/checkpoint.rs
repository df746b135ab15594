//! A model in a file, with the shapes it knows.

use dvp_core::Real;
use dvp_core::tensor::Backend;

use super::trainer::Trainer;
use super::weights_file::WeightsFile;
use crate::error::NetError;
use crate::model::{Model, ModelConfig};
use crate::weights::Weights;

/// A model as it stands in a file.
pub type Checkpoint = WeightsFile<ModelConfig>;

impl Checkpoint {
    /// Takes a copy of a trainer's state; with its optimizer if `resumable`. `about`: what whoever writes the file wants to know
    /// when it is read.
    ///
    /// # Errors
    /// If the framework refuses to hand out its values.
    #[inline(never)]
    pub fn of<B: Backend, T: Real>(trainer: &Trainer<B, T>, resumable: bool, about: &str) -> Result<Self, NetError> {
        let mut file = Self::new(trainer.config().clone(), (trainer.parameters(), &trainer.adam), resumable, about)?;
        file.take_bank(trainer.bank())?;
        Ok(file)
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
    /// [`NetError::Checkpoint`] if the file is of a network of other sizes or holds no optimizer. The trainer is then as before.
    #[inline(never)]
    pub fn resume<B: Backend, T: Real>(&self, trainer: &mut Trainer<B, T>, device: &B::Device) -> Result<(), NetError> {
        let (weights, adam) = self.state(trainer.config(), device)?;
        trainer.set_weights(&weights)?;
        trainer.adam = adam;
        Ok(())
    }
}
