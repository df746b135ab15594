//! Tensors of burn as tensors of the core and back, with their tapes: a step of the core can stand anywhere in a model
//! written with burn, and the other way round.

use burn::backend::Dispatch;
use burn::backend::ops::FloatTensorOps;
use burn::tensor::Shape;
use dvp_core::tensor::{Backend, Tensor, TensorError};

use crate::Burn;
use crate::values::BurnArray;

/// A tensor of burn as one of the core, on the same device. Nothing is copied; if burn tracks its gradient, it goes on
/// doing so. Extents are kept: what burn has as `[1]` is not of rank 0.
///
/// # Errors
/// [`TensorError::Backend`] if the rank is above [`MAX_RANK`](dvp_core::dims::MAX_RANK) or the numbers are neither f32 nor
/// f64.
pub fn from_burn<const D: usize>(tensor: burn::Tensor<D>) -> Result<Tensor<Burn>, TensorError> {
    let array = BurnArray::new(tensor.into_dispatch());
    array.map(Tensor::from_array).map_err(|cause| TensorError::Backend { op: "from_burn", backend: Burn::NAME, cause })
}

/// A tensor of the core as one of burn, on the same device. Nothing is copied; if its gradient is tracked, burn goes on
/// tracking it. Burn has no rank 0: a single number becomes `[1]`.
///
/// # Errors
/// [`TensorError::Operand`] if its rank is not `D`.
pub fn to_burn<const D: usize>(tensor: &Tensor<Burn>) -> Result<burn::Tensor<D>, TensorError> {
    let rank = tensor.dims().rank();
    let array = tensor.array().tensor();
    match (rank, D) {
        (0, 1) => Ok(burn::Tensor::from_dispatch(Dispatch::float_reshape(array, Shape::from([1])))),
        _ if rank == D => Ok(burn::Tensor::from_dispatch(array)),
        _ => {
            let must = "must have the rank of the tensor asked for; reshape it";
            Err(TensorError::Operand { op: "to_burn", dims: *tensor.dims(), must })
        }
    }
}
