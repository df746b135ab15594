//! Parameters as the bytes of a safetensors file, and back, bit for bit; where asked for in half precision.
//!
//! Numbers of half precision, F16 and BF16, become the f32 that they are.

use alloc::borrow::Cow;
use alloc::boxed::Box;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use half::{bf16, f16};
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
    bytes: Vec<u8>,
    dtype: Dtype,
    dims: Dims,
}

impl Stored {
    /// Values as they are.
    fn of(values: &Values, dims: Dims) -> Self {
        let (bytes, dtype) = match values {
            Values::F32(values) => (values.iter().flat_map(|value| value.to_le_bytes()).collect(), Dtype::F32),
            Values::F64(values) => (values.iter().flat_map(|value| value.to_le_bytes()).collect(), Dtype::F64),
        };
        Self { bytes, dtype, dims }
    }

    /// Values rounded to half precision; the first number that is beyond it is an error. Those of f64 become f32 on the way.
    fn half(values: &Values, dims: Dims) -> Result<Self, f64> {
        let mut bytes = Vec::with_capacity(2 * values.len());
        for value in values.to_f64() {
            #[expect(clippy::cast_possible_truncation, reason = "rounding is what is asked for")]
            let rounded = f16::from_f32(value as f32);
            if value.is_finite() && !rounded.is_finite() {
                return Err(value);
            }
            bytes.extend(rounded.to_le_bytes());
        }
        Ok(Self { bytes, dtype: Dtype::F16, dims })
    }
}

impl View for Stored {
    fn dtype(&self) -> Dtype {
        self.dtype
    }

    fn shape(&self) -> &[usize] {
        self.dims.extents()
    }

    fn data(&self) -> Cow<'_, [u8]> {
        Cow::Borrowed(&self.bytes)
    }

    fn data_len(&self) -> usize {
        self.bytes.len()
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
        self.to_safetensors_half(note, |_, _| false)
    }

    /// As [`Self::to_safetensors_with`], the parameters for whose name and extents `half` holds as F16: rounded to the nearest,
    /// to even between two. They are read as f32.
    ///
    /// # Errors
    /// As [`Self::to_safetensors`]; [`ParametersError::Half`] for a number beyond 65504, the largest of F16. What is no number
    /// or infinite stays so.
    pub fn to_safetensors_half(
        &self,
        note: Option<&str>,
        half: impl Fn(&str, &Dims) -> bool,
    ) -> Result<Vec<u8>, ParametersError> {
        let mut all = Vec::with_capacity(self.len());
        for (name, tensor) in self.iter() {
            let (values, dims) = (tensor.values()?, *tensor.dims());
            let stored = if half(name, &dims) {
                Stored::half(&values, dims).map_err(|value| ParametersError::Half { name: name.into(), value })?
            } else {
                Stored::of(&values, dims)
            };
            all.push((name, stored));
        }
        let metadata = note.map(|note| [(NOTE.to_string(), note.to_string())].into_iter().collect());
        serialize(all, metadata).map_err(|error| ParametersError::Format(error.to_string()))
    }

    /// All parameters of a safetensors file, given by its bytes; those of half precision as f32.
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
            Dtype::F16 => half_values(view.data(), |bytes| f16::from_le_bytes(bytes).to_f32()),
            Dtype::BF16 => half_values(view.data(), |bytes| bf16::from_le_bytes(bytes).to_f32()),
            Dtype::F32 => Values::F32(view.data().as_chunks().0.iter().map(|&b| f32::from_le_bytes(b)).collect()),
            Dtype::F64 => Values::F64(view.data().as_chunks().0.iter().map(|&b| f64::from_le_bytes(b)).collect()),
            other => return Err(ParametersError::DType { name: name.into(), found: format!("{other:?}") }),
        };
        let dims = Dims::new(view.shape()).map_err(|error| ParametersError::Format(format!("{name}: {error}")))?;
        found.push((name.into(), values, dims));
    }
    Ok(found)
}

fn half_values(bytes: &[u8], value: impl Fn([u8; 2]) -> f32) -> Values {
    Values::F32(bytes.as_chunks().0.iter().map(|&bytes| value(bytes)).collect())
}
