//! Weights in a file: tensors, sizes and words of who wrote it.
//!
//! One safetensors file. Tensors: `model.*`, `adam.mean.*`, `adam.square.*` and, of networks that know shapes, `bank` (prototypes x
//! harmonics x 4). The rest is JSON in the file's metadata, with a checksum over all numbers: a damaged file is never taken for a network.

use dvp_core::dims::Dims;
use dvp_core::optim::AdamSettings;
use dvp_core::real::{DType, Real};
use dvp_core::shape::{Efd, PrototypeBank};
use dvp_core::tensor::{Adam, Backend, Host, HostDevice, Parameters, Tensor, TensorError, safetensors_note};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::error::NetError;

/// The version of the layout.
const VERSION: u32 = 1;

/// What a file says beside its numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Note<C> {
    version: u32,
    config: C,
    steps: u32,
    about: String,
    /// CRC-32 of the numbers as f64, tensor after tensor in the order of names, little endian.
    checksum: u32,
}

/// A network as it stands in a file: its weights, its sizes `C` and, if it is to go on learning, its optimizer.
#[derive(Clone, Debug)]
pub struct WeightsFile<C> {
    config: C,
    steps: u32,
    about: String,
    tensors: Parameters<Host>,
}

impl<C: Clone + PartialEq + Serialize + DeserializeOwned> WeightsFile<C> {
    /// A copy of a trainer's weights; with its optimizer if `resumable`.
    pub(super) fn new<B: Backend>(
        config: C,
        (parameters, adam): (&Parameters<B>, &Adam<B>),
        resumable: bool,
        about: &str,
    ) -> Result<Self, NetError> {
        let mut stored = Self { config, steps: adam.steps(), about: about.to_owned(), tensors: Parameters::new() };
        stored.take("model", parameters)?;
        if resumable {
            stored.take("adam", &adam.moments()?)?;
        }
        Ok(stored)
    }

    /// Takes a copy of tensors, under a path.
    fn take<B: Backend>(&mut self, path: &str, parameters: &Parameters<B>) -> Result<(), NetError> {
        for (name, tensor) in parameters.iter() {
            self.tensors.insert(format!("{path}.{name}"), &to_host(tensor)?)?;
        }
        Ok(())
    }

    /// Takes the shapes that a network knows, prototypes x harmonics x 4.
    pub(super) fn take_bank<T: Real>(&mut self, bank: &PrototypeBank<T>) -> Result<(), NetError> {
        let harmonics = bank.harmonic_count();
        let mut values = Vec::with_capacity(bank.prototypes().len() * harmonics * 4);
        for efd in bank.prototypes() {
            let end = values.len() + 4 * harmonics;
            values.extend_from_slice(efd.rows().as_flattened());
            values.resize(end, T::zero());
        }
        let dims = Dims::new(&[bank.prototypes().len(), harmonics, 4]).map_err(TensorError::from)?;
        let tensor = Tensor::from_values(T::into_values(values), &dims, &HostDevice)?;
        Ok(self.tensors.insert("bank", &tensor)?)
    }

    /// The shapes that the network knows.
    ///
    /// # Errors
    /// [`NetError::Parameters`] if the file holds none: it is of a network without shapes.
    pub fn bank<T: Real>(&self) -> Result<PrototypeBank<T>, NetError> {
        let tensor = self.tensors.get("bank")?;
        let harmonics = tensor.dims().get(1).unwrap_or(0).max(1);
        let values: Vec<T> = tensor.to_f64()?.into_iter().map(T::of).collect();
        let rows: Vec<[T; 4]> = values.as_chunks().0.to_vec();
        Ok(PrototypeBank::new(rows.chunks_exact(harmonics).map(|rows| Efd::new(rows.to_vec())).collect()))
    }

    /// The sizes of the network.
    #[must_use]
    pub fn config(&self) -> &C {
        &self.config
    }

    /// Steps it has learned for.
    #[must_use]
    pub fn steps(&self) -> u64 {
        u64::from(self.steps)
    }

    /// What whoever wrote the file wants to know when it is read: the settings of the run, say.
    #[must_use]
    pub fn about(&self) -> &str {
        &self.about
    }

    /// The bytes of its file.
    ///
    /// # Errors
    /// [`NetError::Parameters`]; nothing is known to refuse.
    pub fn to_bytes(&self) -> Result<Vec<u8>, NetError> {
        Ok(self.tensors.to_safetensors_with(Some(&self.note(&self.tensors)?))?)
    }

    /// The bytes of a file of half the size, to look with: matrices and kernels of the weights as F16, without the optimizer.
    /// Biases, factors of norms and shapes are few and stay as they are.
    ///
    /// # Errors
    /// [`NetError::Parameters`] for a weight beyond 65504.
    pub fn to_half_bytes(&self) -> Result<Vec<u8>, NetError> {
        let mut kept = Parameters::new();
        for (name, tensor) in self.tensors.iter().filter(|(name, _)| !name.starts_with("adam.")) {
            kept.insert(name, tensor)?;
        }
        let half = |name: &str, dims: &Dims| name.starts_with("model.") && dims.rank() > 1;
        // The checksum is that of the numbers as they will be read.
        let rounded = Parameters::from_safetensors(&kept.to_safetensors_half(None, half)?, &HostDevice)?;
        Ok(kept.to_safetensors_half(Some(&self.note(&rounded)?), half)?)
    }

    /// What the file says beside these numbers.
    fn note(&self, tensors: &Parameters<Host>) -> Result<String, NetError> {
        let Self { config, steps, about, .. } = self;
        let (config, about, checksum) = (config.clone(), about.clone(), checksum(tensors)?);
        let note = Note { version: VERSION, config, steps: *steps, about, checksum };
        serde_json::to_string(&note).map_err(|error| NetError::Checkpoint(error.to_string()))
    }

    /// Reads a file, given by its bytes.
    ///
    /// # Errors
    /// [`NetError::Checkpoint`] or [`NetError::Parameters`] if it is damaged, of another kind of network, or no file of this program.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, NetError> {
        let refused = |reason: String| NetError::Checkpoint(reason);
        let note = safetensors_note(bytes)?
            .ok_or_else(|| refused("weights without a note: written by another program; see --start".into()))?;
        let note: Note<C> = serde_json::from_str(&note).map_err(|error| refused(format!("its note: {error}")))?;
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

    /// The weights by the names of the network.
    ///
    /// # Errors
    /// If the framework refuses.
    #[inline(never)]
    pub fn weights<B: Backend>(&self, device: &B::Device) -> Result<Parameters<B>, NetError> {
        self.part("model.", device)
    }

    /// The weights and the optimizer as they were, for a trainer of a network of sizes `config`.
    pub(super) fn state<B: Backend>(
        &self,
        config: &C,
        device: &B::Device,
    ) -> Result<(Parameters<B>, Adam<B>), NetError> {
        if *config != self.config {
            return Err(NetError::Checkpoint("it is of a network of other sizes".into()));
        }
        let moments = self.part::<B>("adam.", device)?;
        if moments.is_empty() && self.steps > 0 {
            return Err(NetError::Checkpoint("it holds no optimizer; give it as --start".into()));
        }
        Ok((self.weights(device)?, Adam::resume(AdamSettings::default(), self.steps, &moments)?))
    }

    /// The tensors under a path, which ends with a dot, by the rest of their names.
    fn part<B: Backend>(&self, path: &str, device: &B::Device) -> Result<Parameters<B>, NetError> {
        let mut part = Parameters::new();
        for (name, tensor) in self.tensors.iter() {
            if let Some(name) = name.strip_prefix(path) {
                part.insert(name, &Tensor::from_values(tensor.values()?, tensor.dims(), device)?)?;
            }
        }
        Ok(part)
    }
}

/// Gives parameters the values of those of the same name; the others stay.
pub(super) fn set_values<B: Backend>(
    parameters: &mut Parameters<B>,
    values: &Parameters<B>,
    dtype: DType,
) -> Result<(), NetError> {
    for (name, tensor) in values.iter() {
        parameters.set(name, &tensor.cast(dtype)?)?;
    }
    Ok(())
}

fn to_host<B: Backend>(tensor: &Tensor<B>) -> Result<Tensor<Host>, TensorError> {
    Tensor::from_values(tensor.values()?, tensor.dims(), &HostDevice)
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
