//! Parameters as the bytes of a safetensors file, and back, bit for bit.

use alloc::borrow::Cow;
use alloc::boxed::Box;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use safetensors::tensor::{Dtype, SafeTensors, View, serialize};

use super::backend::Backend;
use super::handle::Tensor;
use super::parameters::{Parameters, ParametersError};
use crate::dims::Dims;
use crate::real::Values;

/// The key of notes among a file's metadata.
const NOTE: &str = "dvp";

/// Values on their way to a file.
struct Stored {
    values: Values,
    dims: Dims,
}

impl View for Stored {
    fn dtype(&self) -> Dtype {
        match self.values {
            Values::F32(_) => Dtype::F32,
            Values::F64(_) => Dtype::F64,
        }
    }

    fn shape(&self) -> &[usize] {
        self.dims.extents()
    }

    fn data(&self) -> Cow<'_, [u8]> {
        Cow::Owned(match &self.values {
            Values::F32(values) => values.iter().flat_map(|value| value.to_le_bytes()).collect(),
            Values::F64(values) => values.iter().flat_map(|value| value.to_le_bytes()).collect(),
        })
    }

    fn data_len(&self) -> usize {
        match &self.values {
            Values::F32(values) => size_of_val(&values[..]),
            Values::F64(values) => size_of_val(&values[..]),
        }
    }
}

impl<B: Backend> Parameters<B> {
    /// The bytes of a safetensors file with all parameters, in their number types.
    ///
    /// # Errors
    /// If the framework refuses to hand out its values.
    pub fn to_safetensors(&self) -> Result<Vec<u8>, ParametersError> {
        self.to_safetensors_with(None)
    }

    /// As [`Self::to_safetensors`], with a note among the file's metadata that [`safetensors_note`] finds again.
    ///
    /// # Errors
    /// As [`Self::to_safetensors`].
    pub fn to_safetensors_with(&self, note: Option<&str>) -> Result<Vec<u8>, ParametersError> {
        let mut stored = Vec::with_capacity(self.len());
        for (name, tensor) in self.iter() {
            stored.push((name, Stored { values: tensor.values()?, dims: *tensor.dims() }));
        }
        let metadata = note.map(|note| [(NOTE.to_string(), note.to_string())].into_iter().collect());
        serialize(stored, metadata).map_err(|error| ParametersError::Format(error.to_string()))
    }

    /// All parameters of a safetensors file, given by its bytes.
    ///
    /// # Errors
    /// [`ParametersError::Format`] if it is damaged or another format, [`ParametersError::DType`].
    pub fn from_safetensors(bytes: &[u8], device: &B::Device) -> Result<Self, ParametersError> {
        let mut parameters = Self::new();
        for (name, values, dims) in read(bytes)? {
            parameters.insert(name, &Tensor::from_values(values, &dims, device)?)?;
        }
        Ok(parameters)
    }

    /// Takes the values of every parameter from a safetensors file, given by its bytes. Number types are kept as in this
    /// store. Nothing changes if there is an error.
    ///
    /// # Errors
    /// As [`Self::from_safetensors`]; [`ParametersError::Missing`], [`ParametersError::Unexpected`] and
    /// [`ParametersError::Dims`] if the file belongs to another model.
    pub fn load_safetensors(&mut self, bytes: &[u8]) -> Result<(), ParametersError> {
        let mut loaded = Self::new();
        for (name, values, dims) in read(bytes)? {
            let Ok(own) = self.get(&name) else { return Err(ParametersError::Unexpected { name }) };
            if *own.dims() != dims {
                return Err(ParametersError::Dims { name, extents: Box::new([*own.dims(), dims]) });
            }
            loaded.insert(name, &Tensor::from_values(values.cast(own.dtype()), &dims, &own.device())?)?;
        }
        if let Some((name, _)) = self.iter().find(|(name, _)| loaded.get(name).is_err()) {
            return Err(ParametersError::Missing { name: name.into() });
        }
        *self = loaded;
        Ok(())
    }
}

/// The note of a safetensors file, given by its bytes; none if it was written without one, or by another program.
///
/// # Errors
/// [`ParametersError::Format`] if it is damaged or another format.
pub fn safetensors_note(bytes: &[u8]) -> Result<Option<String>, ParametersError> {
    let (_, metadata) =
        SafeTensors::read_metadata(bytes).map_err(|error| ParametersError::Format(error.to_string()))?;
    Ok(metadata.metadata().as_ref().and_then(|all| all.get(NOTE).cloned()))
}

/// Names, values and extents of a file.
fn read(bytes: &[u8]) -> Result<Vec<(String, Values, Dims)>, ParametersError> {
    let file = SafeTensors::deserialize(bytes).map_err(|error| ParametersError::Format(error.to_string()))?;
    let mut found = Vec::with_capacity(file.len());
    for (name, view) in file.iter() {
        let values = match view.dtype() {
            Dtype::F32 => Values::F32(view.data().as_chunks().0.iter().map(|&b| f32::from_le_bytes(b)).collect()),
            Dtype::F64 => Values::F64(view.data().as_chunks().0.iter().map(|&b| f64::from_le_bytes(b)).collect()),
            other => return Err(ParametersError::DType { name: name.into(), found: format!("{other:?}") }),
        };
        let dims = Dims::new(view.shape()).map_err(|error| ParametersError::Format(format!("{name}: {error}")))?;
        found.push((name.into(), values, dims));
    }
    Ok(found)
}
