//! Any step of the core as one node of burn's tape, on any device: values come to the host and go back.

use alloc::sync::Arc;
use core::fmt;

use burn::backend::autodiff::checkpoint::base::Checkpointer;
use burn::backend::autodiff::checkpoint::strategy::{BalancedCheckpointing, CheckpointStrategy, NoCheckpointing};
use burn::backend::autodiff::grads::Gradients;
use burn::backend::autodiff::ops::{Backward, Ops, OpsKind, unary};
use burn::backend::{
    Autodiff, Backend, BackendTensor, DispatchAutodiffContext, DispatchKindConversion, DispatchTensor,
    DispatchTensorKind, Flex, GradientCheckpointingStrategy as Checkpointing, TensorMetadata,
};
use dvp_core::diff_op::HostOp;
use dvp_core::dims::Dims;
use dvp_core::real::Values;
use dvp_core::tensor::BackendError;

use crate::values::{BurnArray, HostValues, framework, shape, upload};

/// The output of `op` for `input`, batch x values; a node of the tape if `input` is on one.
pub(crate) fn host_op(op: &Arc<dyn HostOp>, input: &BurnArray) -> Result<BurnArray, BackendError> {
    let strategy = match input.autodiff() {
        DispatchAutodiffContext::Disabled => return BurnArray::new(forward(op, input.tensor(), false)?.0),
        DispatchAutodiffContext::Enabled(strategy) => strategy,
    };
    let tensor = input.tensor();
    let DispatchTensorKind::Autodiff(kind) = &tensor.kind else {
        return Err(framework(&"a tracked tensor must hold floats"));
    };
    let output = match (&**kind, strategy) {
        (DispatchTensorKind::Flex(_), Checkpointing::Disabled) => node::<Flex, NoCheckpointing>(op, tensor),
        (DispatchTensorKind::Flex(_), Checkpointing::Balanced) => node::<Flex, BalancedCheckpointing>(op, tensor),
        #[cfg(any(feature = "wgpu", feature = "cuda"))]
        (DispatchTensorKind::Cube(_), Checkpointing::Disabled) => {
            node::<burn::backend::Cube, NoCheckpointing>(op, tensor)
        }
        #[cfg(any(feature = "wgpu", feature = "cuda"))]
        (DispatchTensorKind::Cube(_), Checkpointing::Balanced) => {
            node::<burn::backend::Cube, BalancedCheckpointing>(op, tensor)
        }
        _ => Err(framework(&format_args!("{:?} needs a feature of this crate", input.device()))),
    }?;
    BurnArray::new(output)
}

/// What the way back needs: the step, and what the way there was given and left.
struct Saved {
    op: Arc<dyn HostOp>,
    input: HostValues,
    saved: Values,
    /// Of the input.
    dims: Dims,
}

impl fmt::Debug for Saved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Saved").field("op", &self.op).field("dims", &self.dims).finish_non_exhaustive()
    }
}

/// The output on the device of `input`, a constant, and what the way back needs.
fn forward(op: &Arc<dyn HostOp>, input: DispatchTensor, save: bool) -> Result<(DispatchTensor, Saved), BackendError> {
    let device = input.device();
    let dims = Dims::new(input.shape().as_slice()).map_err(|error| framework(&error))?;
    let batch = dims.get(0).unwrap_or(1);
    let input = HostValues::new(input)?;
    let (values, saved) = op.forward(batch, input.borrow(op.dtype())?, save)?;
    let rows = Dims::new(&[batch, op.signature().output().len()]).map_err(|error| framework(&error))?;
    let output = upload(values, &rows, &device)?;
    Ok((output, Saved { op: Arc::clone(op), input, saved, dims }))
}

/// The gradient of the input on the device of `grad`, that of the output.
fn vjp(saved: &Saved, grad: DispatchTensor) -> Result<DispatchTensor, BackendError> {
    let (op, device) = (&saved.op, grad.device());
    let grad = HostValues::new(grad)?;
    let (input, grad) = (saved.input.borrow(op.dtype())?, grad.borrow(op.dtype())?);
    let grad = op.vjp(saved.dims.get(0).unwrap_or(1), input, saved.saved.as_ref(), grad)?;
    upload(grad, &saved.dims, &device)
}

/// The step as burn's tape knows it.
#[derive(Debug)]
struct HostNode;

impl<B: Backend> Backward<B, 1> for HostNode
where
    DispatchTensor: DispatchKindConversion<B>,
{
    type State = Arc<Saved>;

    fn backward(self, ops: Ops<Arc<Saved>, 1>, grads: &mut Gradients, _: &mut Checkpointer) {
        let saved = ops.state;
        unary::<B, _>(ops.parents, ops.node, grads, |grad| {
            let (device, dtype) = (grad.device(), grad.dtype());
            // The walk back cannot stop halfway: a refused item poisons the gradient, where every optimizer sees it.
            vjp(&saved, outside::<B>(grad))
                .and_then(inside::<B>)
                .unwrap_or_else(|_| B::float_full(shape(&saved.dims), f64::NAN.into(), &device, dtype.into()))
        });
    }
}

/// The step as a node, for a tracked `input` on the backend `B`.
fn node<B: Backend, C: CheckpointStrategy>(
    op: &Arc<dyn HostOp>,
    input: DispatchTensor,
) -> Result<DispatchTensor, BackendError>
where
    DispatchTensor: DispatchKindConversion<B> + DispatchKindConversion<Autodiff<B, C>>,
{
    let (values, guard) = inside::<Autodiff<B, C>>(input)?.into_parts();
    let (output, saved) = forward(op, outside::<B>(values), true)?;
    let output = inside::<B>(output)?;
    let output = match HostNode.prepare::<C>([guard]).compute_bound().stateful() {
        OpsKind::Tracked(step) => step.finish(Arc::new(saved), output),
        OpsKind::UnTracked(step) => step.finish(output),
    };
    Ok(outside::<Autodiff<B, C>>(output))
}

fn inside<B: Backend>(tensor: DispatchTensor) -> Result<B::FloatTensorPrimitive, BackendError>
where
    DispatchTensor: DispatchKindConversion<B>,
{
    match <DispatchTensor as DispatchKindConversion<B>>::try_into_backend(tensor) {
        Ok(BackendTensor::Float(tensor)) => Ok(tensor),
        Ok(other) => Err(framework(&format_args!("expected floats, got {}", other.name()))),
        Err(message) => Err(BackendError::Framework(message)),
    }
}

fn outside<B: Backend>(tensor: B::FloatTensorPrimitive) -> DispatchTensor
where
    DispatchTensor: DispatchKindConversion<B>,
{
    <DispatchTensor as DispatchKindConversion<B>>::from_backend(BackendTensor::Float(tensor))
}
