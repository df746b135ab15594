//! The operations, each by burn's own on tensors of any rank.

use alloc::sync::Arc;

use burn::backend::ops::{ActivationOps, BoolTensorOps, FloatTensorOps, IntTensorOps};
use burn::backend::{Dispatch, DispatchAutodiffContext, DispatchTensor, get_or_init_device_settings};
use burn::tensor::{Device, Slice, TensorData};
use dvp_core::diff_op::HostOp;
use dvp_core::dims::Dims;
use dvp_core::real::{DType, Values};
use dvp_core::tensor::{Backend, BackendError, Binary, Stride, Unary};

use crate::gradient::{self, BurnGradients};
use crate::values::{self, BurnArray, burn_dtype, framework, shape};
use crate::{convolution, host_op};

/// Burn, on any of its devices; chosen with each tensor, by [`Device`].
#[derive(Clone, Copy, Debug)]
pub struct Burn;

impl Backend for Burn {
    type Device = Device;
    type Array = BurnArray;
    type Gradients = BurnGradients;

    const NAME: &'static str = "burn";

    fn upload(values: Values, dims: &Dims, device: &Device) -> Result<BurnArray, BackendError> {
        Ok(BurnArray::new(values::upload(values, dims, &device.as_dispatch().clone().inner())?)?.of_rank(dims))
    }

    fn download(array: &BurnArray) -> Result<Values, BackendError> {
        values::download(array.constant(), array.dtype())
    }

    fn dims(array: &BurnArray) -> Dims {
        array.dims()
    }

    fn dtype(array: &BurnArray) -> DType {
        array.dtype()
    }

    fn device(array: &BurnArray) -> Device {
        array.device()
    }

    fn cast(array: &BurnArray, dtype: DType) -> Result<BurnArray, BackendError> {
        values::check_dtype(dtype, array.device().as_dispatch())?;
        like(Dispatch::float_cast(array.constant(), burn_dtype(dtype).into()), array)
    }

    fn unary(function: Unary, array: &BurnArray) -> Result<BurnArray, BackendError> {
        let run = match function {
            Unary::Abs => Dispatch::float_abs,
            Unary::Cos => Dispatch::float_cos,
            Unary::Erf => Dispatch::float_erf,
            Unary::Exp => Dispatch::float_exp,
            Unary::Log => Dispatch::float_log,
            Unary::Relu => Dispatch::relu,
            Unary::Sin => Dispatch::float_sin,
            Unary::Sqrt => Dispatch::float_sqrt,
            Unary::Tanh => Dispatch::float_tanh,
        };
        like(run(array.tensor()), array)
    }

    #[expect(clippy::float_cmp, reason = "steps that change nothing are left out")]
    fn affine(array: &BurnArray, scale: f64, offset: f64) -> Result<BurnArray, BackendError> {
        let mut tensor = array.tensor();
        if scale != 1.0 {
            tensor = Dispatch::float_mul_scalar(tensor, scale.into());
        }
        if offset != 0.0 {
            tensor = Dispatch::float_add_scalar(tensor, offset.into());
        }
        like(tensor, array)
    }

    fn binary(function: Binary, a: &BurnArray, b: &BurnArray) -> Result<BurnArray, BackendError> {
        one_tape(&[a, b])?;
        let run = match function {
            Binary::Add => Dispatch::float_add,
            Binary::Div => Dispatch::float_div,
            Binary::Mul => Dispatch::float_mul,
            Binary::Sub => Dispatch::float_sub,
        };
        like(run(a.tensor(), b.tensor()), a)
    }

    fn greater(a: &BurnArray, b: &BurnArray) -> Result<BurnArray, BackendError> {
        let settings = get_or_init_device_settings::<Dispatch>(a.device().as_dispatch());
        let mask = Dispatch::float_greater(a.constant(), b.constant(), settings.bool_dtype);
        like(Dispatch::bool_into_float(mask, burn_dtype(a.dtype()).into()), a)
    }

    fn reshape(array: &BurnArray, dims: &Dims) -> Result<BurnArray, BackendError> {
        Ok(BurnArray::new(Dispatch::float_reshape(array.tensor(), shape(dims)))?.of_rank(dims))
    }

    fn permute(array: &BurnArray, axes: &[usize]) -> Result<BurnArray, BackendError> {
        if axes.is_empty() {
            return Ok(array.clone());
        }
        BurnArray::new(Dispatch::float_permute(array.tensor(), axes))
    }

    fn expand(array: &BurnArray, dims: &Dims) -> Result<BurnArray, BackendError> {
        like(Dispatch::float_expand(array.tensor(), shape(dims)), array)
    }

    fn slice(array: &BurnArray, axis: usize, start: usize, len: usize) -> Result<BurnArray, BackendError> {
        let dims = array.dims();
        // Burn's CPU makes views that start behind the end of an array without numbers, and panics when it reads them.
        let start = if len == 0 || dims.len() == 0 { 0 } else { start };
        let mut ranges: Vec<Slice> = dims.extents().iter().map(|&extent| Slice::from(0..extent)).collect();
        if let Some(range) = ranges.get_mut(axis) {
            *range = Slice::from(start..start + len);
        }
        BurnArray::new(Dispatch::float_slice(array.tensor(), &ranges))
    }

    fn concat(arrays: &[&BurnArray], axis: usize) -> Result<BurnArray, BackendError> {
        one_tape(arrays)?;
        BurnArray::new(Dispatch::float_cat(arrays.iter().map(|array| array.tensor()).collect(), axis))
    }

    fn select(array: &BurnArray, axis: usize, indices: &[usize]) -> Result<BurnArray, BackendError> {
        BurnArray::new(Dispatch::float_select(array.tensor(), axis, whole_numbers(indices, &array.device())?))
    }

    fn sum(array: &BurnArray, axis: usize) -> Result<BurnArray, BackendError> {
        BurnArray::new(Dispatch::float_sum_dim(array.tensor(), axis))
    }

    fn max(array: &BurnArray, axis: usize) -> Result<BurnArray, BackendError> {
        BurnArray::new(Dispatch::float_max_dim(array.constant(), axis))
    }

    fn matmul(a: &BurnArray, b: &BurnArray) -> Result<BurnArray, BackendError> {
        one_tape(&[a, b])?;
        BurnArray::new(Dispatch::float_matmul(a.tensor(), b.tensor()))
    }

    fn conv2d(images: &BurnArray, kernels: &BurnArray, stride: Stride) -> Result<BurnArray, BackendError> {
        one_tape(&[images, kernels])?;
        convolution::conv2d(images, kernels, stride)
    }

    fn host_op(op: &Arc<dyn HostOp>, input: &BurnArray) -> Result<BurnArray, BackendError> {
        host_op::host_op(op, input)
    }

    fn parameter(array: &BurnArray) -> Result<BurnArray, BackendError> {
        gradient::parameter(array)
    }

    fn detach(array: &BurnArray) -> Result<BurnArray, BackendError> {
        like(array.constant(), array)
    }

    fn is_tracked(array: &BurnArray) -> bool {
        array.is_tracked()
    }

    fn backward(number: &BurnArray) -> Result<BurnGradients, BackendError> {
        gradient::backward(number)
    }

    fn gradient(gradients: &BurnGradients, parameter: &BurnArray) -> Option<BurnArray> {
        gradients.of(parameter)
    }
}

/// Of the rank of `array`, which only rank 0 does not show in burn's tensors.
fn like(tensor: DispatchTensor, array: &BurnArray) -> Result<BurnArray, BackendError> {
    Ok(BurnArray::new(tensor)?.of_rank(&array.dims()))
}

/// Burn panics if tapes with and without checkpointing meet.
fn one_tape(arrays: &[&BurnArray]) -> Result<(), BackendError> {
    let mut tapes =
        arrays.iter().map(|array| array.autodiff()).filter(|tape| *tape != DispatchAutodiffContext::Disabled);
    let first = tapes.next();
    if tapes.all(|tape| Some(tape) == first) {
        Ok(())
    } else {
        Err(framework(&"one operand is computed with burn's gradient checkpointing, another without; use one of them"))
    }
}

/// Indices on a device, in its own type of integers.
fn whole_numbers(indices: &[usize], device: &Device) -> Result<DispatchTensor, BackendError> {
    let indices: Result<Vec<i64>, _> = indices.iter().map(|&index| i64::try_from(index)).collect();
    let indices = indices.map_err(|error| framework(&error))?;
    let len = indices.len();
    let dtype = get_or_init_device_settings::<Dispatch>(device.as_dispatch()).int_dtype;
    let data = TensorData::new(indices, [len]).convert_dtype(dtype.into());
    Ok(Dispatch::int_from_data(data, device.as_dispatch()))
}
