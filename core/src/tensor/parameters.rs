//! Named parameters of a model.

use alloc::boxed::Box;
use alloc::collections::BTreeMap;
use alloc::string::String;
use core::fmt;

use super::backend::Backend;
use super::error::TensorError;
use super::gradient::Gradients;
use super::handle::Tensor;
use crate::dims::Dims;

/// Parameters by name, in the order of their names.
///
/// Names are paths with dots, as in published weights: `encoder.layer.0.norm1.weight`.
#[derive(Clone, Debug)]
pub struct Parameters<B: Backend> {
    by_name: BTreeMap<String, Tensor<B>>,
}

impl<B: Backend> Default for Parameters<B> {
    fn default() -> Self {
        Self { by_name: BTreeMap::new() }
    }
}

impl<B: Backend> Parameters<B> {
    /// No parameters.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a tensor as a parameter, in place of one of the same name.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn insert(&mut self, name: impl Into<String>, tensor: &Tensor<B>) -> Result<(), TensorError> {
        self.by_name.insert(name.into(), tensor.parameter()?);
        Ok(())
    }

    /// The parameter of a name.
    ///
    /// # Errors
    /// [`ParametersError::Missing`].
    pub fn get(&self, name: &str) -> Result<&Tensor<B>, ParametersError> {
        self.by_name.get(name).ok_or_else(|| ParametersError::Missing { name: name.into() })
    }

    /// New values for a parameter.
    ///
    /// # Errors
    /// [`ParametersError::Missing`] if there is none of that name, [`ParametersError::Dims`] if it has other extents.
    pub fn set(&mut self, name: &str, tensor: &Tensor<B>) -> Result<(), ParametersError> {
        let expected = *self.get(name)?.dims();
        if *tensor.dims() != expected {
            return Err(ParametersError::Dims { name: name.into(), extents: Box::new([expected, *tensor.dims()]) });
        }
        Ok(self.insert(name, tensor)?)
    }

    /// Names and parameters, in the order of names.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Tensor<B>)> {
        self.by_name.iter().map(|(name, tensor)| (name.as_str(), tensor))
    }

    /// Number of parameters: of tensors, not of numbers.
    #[must_use]
    pub fn len(&self) -> usize {
        self.by_name.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.by_name.is_empty()
    }

    /// Numbers in all parameters together.
    #[must_use]
    pub fn value_count(&self) -> usize {
        self.by_name.values().map(|tensor| tensor.dims().len()).sum()
    }

    /// Gradients by name; parameters that the number did not depend on are left out.
    #[must_use]
    pub fn gradients(&self, gradients: &Gradients<B>) -> BTreeMap<String, Tensor<B>> {
        self.by_name.iter().filter_map(|(name, tensor)| Some((name.clone(), gradients.of(tensor)?))).collect()
    }
}

/// Why parameters were not found, set or read.
#[derive(Debug)]
#[non_exhaustive]
pub enum ParametersError {
    /// No parameter of that name.
    Missing {
        /// The name asked for.
        name: String,
    },
    /// A name that the model does not have.
    Unexpected {
        /// The name found.
        name: String,
    },
    /// Other extents than the model's.
    Dims {
        /// The parameter.
        name: String,
        /// Extents in the model, and extents found.
        extents: Box<[Dims; 2]>,
    },
    /// A number type that is not read.
    DType {
        /// The parameter.
        name: String,
        /// The type in the file's words.
        found: String,
    },
    /// A number that half precision cannot hold.
    Half {
        /// The parameter.
        name: String,
        /// The number.
        value: f64,
    },
    /// The bytes are no safetensors file.
    Format(String),
    /// The framework refused.
    Tensor(TensorError),
}

impl fmt::Display for ParametersError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing { name } => {
                write!(f, "there is no parameter {name}; are these the weights of another model?")
            }
            Self::Unexpected { name } => {
                write!(f, "the model has no parameter {name}; are these the weights of another model?")
            }
            Self::Dims { name, extents } => {
                let [expected, found] = &**extents;
                write!(f, "parameter {name} is {found}, the model needs {expected}; check the model's sizes")
            }
            Self::DType { name, found } => {
                write!(
                    f,
                    "parameter {name} holds {found} numbers; only F16, BF16, F32 and F64 are read: convert the file"
                )
            }
            Self::Half { name, value } => {
                write!(f, "parameter {name} holds {value}, F16 ends at 65504; store it in single precision")
            }
            Self::Format(reason) => write!(f, "not a safetensors file, or a damaged one: {reason}"),
            Self::Tensor(error) => write!(f, "{error}"),
        }
    }
}

impl core::error::Error for ParametersError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        if let Self::Tensor(error) = self { Some(error) } else { None }
    }
}

impl From<TensorError> for ParametersError {
    fn from(error: TensorError) -> Self {
        Self::Tensor(error)
    }
}
