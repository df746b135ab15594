//! Any step of the core as one node of candle's graph.

use alloc::sync::Arc;
use std::sync::{Mutex, PoisonError};

use candle_core::backend::{BackendDevice, BackendStorage};
use candle_core::{CpuStorage, CudaStorage, CustomOp1, Device, Error, Layout, Result, Shape, Storage, Tensor};
use dvp_core::diff_op::{HostOp, OpError};
use dvp_core::real::Values;
use dvp_core::tensor::BackendError;

use crate::values::{borrow, dtype, refused, storage, upload};

/// The step for every item of `input`, batch x values. The node keeps what the step saved.
pub(crate) fn host_op(op: &Arc<dyn HostOp>, input: &Tensor) -> core::result::Result<Tensor, BackendError> {
    let input = input.contiguous().map_err(refused)?;
    let batch = input.dims().first().copied().unwrap_or(1);
    // Forward runs before there is a node: candle's own errors would keep the step's words, but not the error.
    let (output, saved) = forward(op, batch, &input, input.track_op())?;
    let shape = Shape::from((batch, op.signature().output().len()));
    if input.track_op() {
        input.apply_op1(Step { op: Arc::clone(op), batch, output: Mutex::new(Some(output)), shape, saved })
    } else {
        upload(output, shape.dims(), input.device())
    }
    .map_err(refused)
}

type Forward = core::result::Result<(Values, Values), BackendError>;

fn forward(op: &Arc<dyn HostOp>, batch: usize, input: &Tensor, save: bool) -> Forward {
    let input = input.detach().to_device(&Device::Cpu).map_err(refused)?;
    let (storage, layout) = input.storage_and_layout();
    let values = match &*storage {
        Storage::Cpu(storage) => borrow(storage, layout),
        _ => None,
    };
    let values = values.ok_or_else(|| unsupported(&input, op.signature().name()))?;
    Ok(op.forward(batch, values, save)?)
}

fn unsupported(array: &Tensor, op: &'static str) -> BackendError {
    refused(Error::UnsupportedDTypeForOp(array.dtype(), op))
}

/// A step whose output is there already: candle takes it when it makes the node.
struct Step {
    op: Arc<dyn HostOp>,
    batch: usize,
    output: Mutex<Option<Values>>,
    shape: Shape,
    saved: Values,
}

impl Step {
    fn take(&self) -> Result<CpuStorage> {
        let output = self.output.lock().unwrap_or_else(PoisonError::into_inner).take();
        output.map(storage).ok_or_else(|| Error::Msg(format!("{}: a node is made once", self.op.signature().name())))
    }

    fn pull(&self, input: &Tensor, grad: &Tensor) -> Result<Values> {
        let (input_storage, input_layout) = input.storage_and_layout();
        let (grad_storage, grad_layout) = grad.storage_and_layout();
        let (Storage::Cpu(input_storage), Storage::Cpu(grad_storage)) = (&*input_storage, &*grad_storage) else {
            return Err(Error::Msg(format!("{}: runs on the host", self.op.signature().name())));
        };
        let operands = borrow(input_storage, input_layout).zip(borrow(grad_storage, grad_layout));
        let (input, grad) = operands.ok_or(Error::UnsupportedDTypeForOp(input.dtype(), self.op.signature().name()))?;
        self.op
            .vjp(self.batch, input, self.saved.as_ref(), grad)
            .map_err(|error: OpError| Error::Msg(error.to_string()))
    }
}

impl CustomOp1 for Step {
    fn name(&self) -> &'static str {
        self.op.signature().name()
    }

    fn cpu_fwd(&self, _: &CpuStorage, _: &Layout) -> Result<(CpuStorage, Shape)> {
        Ok((self.take()?, self.shape.clone()))
    }

    fn cuda_fwd(&self, input: &CudaStorage, _: &Layout) -> Result<(CudaStorage, Shape)> {
        Ok((input.device().storage_from_cpu_storage_owned(self.take()?)?, self.shape.clone()))
    }

    fn bwd(&self, input: &Tensor, _: &Tensor, grad: &Tensor) -> Result<Option<Tensor>> {
        let device = input.device();
        let host = |array: &Tensor| array.detach().to_device(&Device::Cpu)?.contiguous();
        let values = self.pull(&host(input)?, &host(grad)?)?;
        debug_assert_eq!(values.dtype(), dtype(input));
        upload(values, input.dims(), device).map(Some)
    }
}
