//! Tensors of candle as tensors of the core and back, in the same graph: a step of the core can stand anywhere in a model
//! written with candle, and the other way round.

use candle_core::DType;
use dvp_core::dims::Dims;
use dvp_core::tensor::{Backend, BackendError, Tensor, TensorError};

use crate::Candle;

/// A tensor of candle as one of the core, on the same device. Nothing is copied; gradients flow through, and a
/// [`Var`](candle_core::Var)'s tensor is a parameter.
///
/// # Errors
/// [`TensorError::NoDims`] if the rank is above [`MAX_RANK`](dvp_core::dims::MAX_RANK), [`TensorError::Backend`] if the
/// numbers are neither f32 nor f64.
pub fn from_candle(tensor: &candle_core::Tensor) -> Result<Tensor<Candle>, TensorError> {
    Dims::new(tensor.dims())?;
    match tensor.dtype() {
        DType::F32 | DType::F64 => Ok(Tensor::from_array(tensor.clone())),
        other => {
            let cause = BackendError::Framework(format!("numbers are {other:?}; cast them to F32 or F64"));
            Err(TensorError::Backend { op: "from_candle", backend: Candle::NAME, cause })
        }
    }
}

/// A tensor of the core as one of candle, on the same device. Nothing is copied; gradients flow through.
///
/// Where candle's errors are asked for, those of the core go in as they are:
/// `tensor.map_err(candle_core::Error::wrap)?`.
#[must_use]
pub fn to_candle(tensor: &Tensor<Candle>) -> candle_core::Tensor {
    tensor.array().clone()
}
