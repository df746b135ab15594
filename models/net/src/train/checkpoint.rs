//! A model in a file: its weights, its sizes, the shapes it knows and, if it is to go on learning, its optimizer.
//!
//! One safetensors file. Tensors: `model.*`, `bank` (prototypes x harmonics x 4), `adam.mean.*`, `adam.square.*`. The rest
//! is JSON in the file's metadata, with a checksum over all numbers: a damaged file is never taken for a model.

use dvp_core::Real;
use dvp_core::dims::Dims;
use dvp_core::optim::AdamSettings;
use dvp_core::shape::{Efd, PrototypeBank};
use dvp_core::tensor::{Adam, Backend, Host, HostDevice, Parameters, Tensor, TensorError, safetensors_note};
use serde::{Deserialize, Serialize};

use super::trainer::Trainer;
use crate::error::NetError;
use crate::model::{Model, ModelConfig};
use crate::weights::Weights;

/// The version of the layout.
const VERSION: u32 = 1;

/// What a file says beside its numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Note {
    version: u32,
    config: ModelConfig,
    steps: u32,
    /// Words of who wrote it, see [`Checkpoint::about`].
    about: String,
    /// CRC-32 of the numbers as f64, tensor after tensor in the order of names, little endian.
    checksum: u32,
}

/// A model as it stands in a file.
#[derive(Clone, Debug)]
pub struct Checkpoint {
    config: ModelConfig,
    steps: u32,
    /// What whoever wrote the file wants to know when it is read: the settings of the run, say.
    pub about: String,
    tensors: Parameters<Host>,
}

impl Checkpoint {
    /// Takes a copy of a trainer's state; with its optimizer if `resumable`.
    ///
    /// # Errors
    /// If the framework refuses to hand out its values.
    #[inline(never)]
    pub fn of<B: Backend, T: Real>(trainer: &Trainer<B, T>, resumable: bool, about: &str) -> Result<Self, NetError> {
        let mut tensors = Parameters::new();
        let mut take = |prefix: &str, parameters: &Parameters<B>| -> Result<(), NetError> {
            for (name, tensor) in parameters.iter() {
                tensors.insert(format!("{prefix}.{name}"), &to_host(tensor)?)?;
            }
            Ok(())
        };
        take("model", trainer.parameters())?;
        if resumable {
            take("adam", &trainer.adam.moments()?)?;
        }
        tensors.insert("bank", &bank_tensor(trainer.bank())?)?;
        let (config, steps) = (trainer.config().clone(), trainer.adam.steps());
        Ok(Self { config, steps, about: about.to_owned(), tensors })
    }

    /// The bytes of its file.
    ///
    /// # Errors
    /// [`NetError::Parameters`]; nothing is known to refuse.
    pub fn to_bytes(&self) -> Result<Vec<u8>, NetError> {
        let Self { config, steps, about, tensors } = self;
        let (config, about, checksum) = (config.clone(), about.clone(), checksum(tensors)?);
        let note = Note { version: VERSION, config, steps: *steps, about, checksum };
        let note = serde_json::to_string(&note).map_err(|error| NetError::Checkpoint(error.to_string()))?;
        Ok(tensors.to_safetensors_with(Some(&note))?)
    }

    /// Reads a file, given by its bytes.
    ///
    /// # Errors
    /// [`NetError::Checkpoint`] or [`NetError::Parameters`] if it is damaged, or no file of this program.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, NetError> {
        let refused = |reason: String| NetError::Checkpoint(reason);
        let note = safetensors_note(bytes)?
            .ok_or_else(|| refused("weights without a note: written by another program; see --start".into()))?;
        let note: Note = serde_json::from_str(&note).map_err(|error| refused(format!("its note: {error}")))?;
        let Note { version, config, steps, about, checksum: expected } = note;
        if version != VERSION {
            return Err(refused(format!("layout {version}, this program reads {VERSION}")));
        }
        let tensors = Parameters::from_safetensors(bytes, &HostDevice)?;
        if checksum(&tensors)? != expected {
            return Err(refused("damaged: its numbers do not match its checksum".into()));
        }
        Ok(Self { config, steps, about, tensors })
    }

    /// The sizes of the model.
    #[must_use]
    pub fn config(&self) -> &ModelConfig {
        &self.config
    }

    /// Steps it has learned for.
    #[must_use]
    pub fn steps(&self) -> u64 {
        u64::from(self.steps)
    }

    /// The shapes it knows.
    ///
    /// # Errors
    /// [`NetError::Parameters`] if the file holds none.
    pub fn bank<T: Real>(&self) -> Result<PrototypeBank<T>, NetError> {
        let tensor = self.tensors.get("bank")?;
        let harmonics = tensor.dims().get(1).unwrap_or(0).max(1);
        let values: Vec<T> = tensor.to_f64()?.into_iter().map(T::of).collect();
        let rows: Vec<[T; 4]> = values.as_chunks().0.to_vec();
        Ok(PrototypeBank::new(rows.chunks_exact(harmonics).map(|rows| Efd::new(rows.to_vec())).collect()))
    }

    /// The weights by the names of the model.
    ///
    /// # Errors
    /// If the framework refuses.
    #[inline(never)]
    pub fn weights<B: Backend>(&self, device: &B::Device) -> Result<Parameters<B>, NetError> {
        self.part("model.", device)
    }

    /// The model, to look with: its weights are constants.
    ///
    /// # Errors
    /// As [`Model::load`].
    pub fn model<B: Backend>(&self, device: &B::Device) -> Result<Model<B>, NetError> {
        Model::load(&self.config, &self.bank::<f64>()?, &Weights::new(&self.weights(device)?).frozen())
    }

    /// Puts a trainer into the state that the file was written in.
    ///
    /// # Errors
    /// [`NetError::Checkpoint`] if the file is of a model of other sizes or holds no optimizer. The trainer is then as before.
    #[inline(never)]
    pub fn resume<B: Backend, T: Real>(&self, trainer: &mut Trainer<B, T>, device: &B::Device) -> Result<(), NetError> {
        if self.config != *trainer.config() {
            return Err(NetError::Checkpoint("it is of a model of other sizes".into()));
        }
        let moments = self.part::<B>("adam.", device)?;
        if moments.is_empty() && self.steps > 0 {
            return Err(NetError::Checkpoint("it holds no optimizer; give it as --start".into()));
        }
        let adam = Adam::resume(AdamSettings::default(), self.steps, &moments)?;
        trainer.set_weights(&self.weights(device)?)?;
        trainer.adam = adam;
        Ok(())
    }

    fn part<B: Backend>(&self, prefix: &str, device: &B::Device) -> Result<Parameters<B>, NetError> {
        let mut part = Parameters::new();
        for (name, tensor) in self.tensors.iter() {
            if let Some(name) = name.strip_prefix(prefix) {
                part.insert(name, &Tensor::from_values(tensor.values()?, tensor.dims(), device)?)?;
            }
        }
        Ok(part)
    }
}

fn to_host<B: Backend>(tensor: &Tensor<B>) -> Result<Tensor<Host>, TensorError> {
    Tensor::from_values(tensor.values()?, tensor.dims(), &HostDevice)
}

/// prototypes x harmonics x 4.
fn bank_tensor<T: Real>(bank: &PrototypeBank<T>) -> Result<Tensor<Host>, TensorError> {
    let harmonics = bank.harmonic_count();
    let mut values = Vec::with_capacity(bank.prototypes().len() * harmonics * 4);
    for efd in bank.prototypes() {
        let end = values.len() + 4 * harmonics;
        values.extend_from_slice(efd.rows().as_flattened());
        values.resize(end, T::zero());
    }
    let dims = Dims::new(&[bank.prototypes().len(), harmonics, 4])?;
    Tensor::from_values(T::into_values(values), &dims, &HostDevice)
}

/// CRC-32 of all numbers.
fn checksum(tensors: &Parameters<Host>) -> Result<u32, NetError> {
    let mut hasher = crc32fast::Hasher::new();
    for (_, tensor) in tensors.iter() {
        for value in tensor.to_f64()? {
            hasher.update(&value.to_le_bytes());
        }
    }
    Ok(hasher.finalize())
}
