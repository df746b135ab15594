//! Steps of the core as operations on tensors.

use alloc::sync::Arc;
use alloc::vec::Vec;

use super::backend::Backend;
use super::error::TensorError;
use super::handle::Tensor;
use crate::diff_op::{Batched, DiffOp, HostOp};
use crate::real::Real;

impl<B: Backend> Tensor<B> {
    /// The output of `op` for a batch of inputs, batch x the extents of each input, as one node of the graph with the op's
    /// own way back: batch x the extents of the output. Runs on the host; see [`Backend::host_op`].
    ///
    /// # Errors
    /// [`TensorError::Operand`] if there is another number of inputs than the op has or none of them,
    /// [`TensorError::Dims`] if an input has other extents; [`TensorError::DTypes`] if they are not of the op's type,
    /// [`TensorError::Devices`]; [`TensorError::Backend`] if the op refuses an item.
    pub fn apply<T: Real, O: DiffOp<T> + 'static>(op: O, inputs: &[&Self]) -> Result<Self, TensorError> {
        Self::apply_shared(&(Arc::new(Batched::new(op)) as Arc<dyn HostOp>), inputs)
    }

    /// As [`Self::apply`], of an op that is used again.
    ///
    /// # Errors
    /// As [`Self::apply`].
    pub fn apply_shared(op: &Arc<dyn HostOp>, inputs: &[&Self]) -> Result<Self, TensorError> {
        let signature = op.signature();
        let name = signature.name();
        let Some(first) = inputs.first() else {
            let dims = crate::dims::Dims::SCALAR;
            return Err(TensorError::Operand { op: name, dims, must: "needs its inputs" });
        };
        let batch = first.dims().get(0).ok_or_else(|| first.operand(name, "must have the batch as first axis"))?;
        let expected = signature.batched_inputs(batch)?;
        if inputs.len() != expected.len() {
            return Err(first.operand(name, "needs as many inputs as the op has"));
        }
        let mut rows = Vec::with_capacity(inputs.len());
        for (input, expected) in inputs.iter().zip(&expected) {
            first.check_pair(name, input)?;
            if input.dtype() != op.dtype() {
                return Err(TensorError::DTypes { op: name, left: input.dtype(), right: op.dtype() });
            }
            if input.dims() != expected {
                let must = "each input must be batch x the extents that the op was made for, the second ones here";
                return Err(TensorError::dims(name, input.dims(), expected, must));
            }
            rows.push(input.reshape(&[batch, expected.len() / batch.max(1)])?);
        }
        let rows: Vec<&Self> = rows.iter().collect();
        let flat = Self::concat(&rows, 1)?;
        let output = Self::wrap(name, B::host_op(op, flat.array()))?;
        output.reshape(signature.batched_output(batch)?.extents())
    }
}
