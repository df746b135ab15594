//! The core's [`Backend`] on candle.

use alloc::sync::Arc;

use candle_core::Tensor;
use candle_core::backprop::GradStore;
use dvp_core::diff_op::HostOp;
use dvp_core::dims::Dims;
use dvp_core::real::{DType, Values};
use dvp_core::tensor::{Backend, BackendError, Binary, Stride, Unary};

use crate::kinks::Kinked;
use crate::values::{CandleDevice, refused};
use crate::{arithmetic, convolution, fold, gradient, host_op, product, values};

/// Arrays and gradients of candle.
#[derive(Clone, Copy, Debug)]
pub struct Candle;

type Made = Result<Tensor, BackendError>;

impl Backend for Candle {
    type Device = CandleDevice;
    type Array = Tensor;
    type Gradients = GradStore;

    const NAME: &'static str = "candle";

    fn upload(values: Values, dims: &Dims, device: &CandleDevice) -> Made {
        values::upload(values, dims.extents(), &device.0).map_err(refused)
    }

    fn download(array: &Tensor) -> Result<Values, BackendError> {
        values::download(array).map_err(refused)
    }

    fn dims(array: &Tensor) -> Dims {
        values::dims(array)
    }

    fn dtype(array: &Tensor) -> DType {
        values::dtype(array)
    }

    fn device(array: &Tensor) -> CandleDevice {
        CandleDevice(array.device().clone())
    }

    fn cast(array: &Tensor, dtype: DType) -> Made {
        array.detach().to_dtype(values::candle_dtype(dtype)).map_err(refused)
    }

    fn unary(function: Unary, array: &Tensor) -> Made {
        match function {
            Unary::Abs => Kinked::Abs.of(array),
            Unary::Cos => array.cos(),
            Unary::Erf => array.erf(),
            Unary::Exp => array.exp(),
            Unary::Log => array.log(),
            Unary::Relu => Kinked::Relu.of(array),
            Unary::Sin => array.sin(),
            Unary::Sqrt => array.sqrt(),
            Unary::Tanh => array.tanh(),
        }
        .map_err(refused)
    }

    fn affine(array: &Tensor, scale: f64, offset: f64) -> Made {
        arithmetic::affine(array, scale, offset).map_err(refused)
    }

    fn binary(function: Binary, a: &Tensor, b: &Tensor) -> Made {
        arithmetic::binary(function, a, b).map_err(refused)
    }

    fn greater(a: &Tensor, b: &Tensor) -> Made {
        a.detach().broadcast_gt(&b.detach()).and_then(|mask| mask.to_dtype(a.dtype())).map_err(refused)
    }

    fn reshape(array: &Tensor, dims: &Dims) -> Made {
        array.reshape(dims.extents()).map_err(refused)
    }

    fn permute(array: &Tensor, axes: &[usize]) -> Made {
        array.permute(axes).map_err(refused)
    }

    fn expand(array: &Tensor, dims: &Dims) -> Made {
        array.broadcast_as(dims.extents()).map_err(refused)
    }

    fn slice(array: &Tensor, axis: usize, start: usize, len: usize) -> Made {
        array.narrow(axis, start, len).map_err(refused)
    }

    fn concat(arrays: &[&Tensor], axis: usize) -> Made {
        Tensor::cat(arrays, axis).map_err(refused)
    }

    fn select(array: &Tensor, axis: usize, indices: &[usize]) -> Made {
        let select = || {
            let indices: Result<Vec<u32>, _> = indices.iter().map(|&index| u32::try_from(index)).collect();
            let indices = indices.map_err(candle_core::Error::wrap)?;
            array.contiguous()?.index_select(&Tensor::new(indices, array.device())?, axis)
        };
        select().map_err(refused)
    }

    fn sum(array: &Tensor, axis: usize) -> Made {
        fold::sum(array, axis).map_err(refused)
    }

    fn max(array: &Tensor, axis: usize) -> Made {
        fold::max(array, axis).map_err(refused)
    }

    fn matmul(a: &Tensor, b: &Tensor) -> Made {
        product::matmul(a, b).map_err(refused)
    }

    fn conv2d(images: &Tensor, kernels: &Tensor, stride: Stride) -> Made {
        convolution::conv2d(images, kernels, stride).map_err(refused)
    }

    fn host_op(op: &Arc<dyn HostOp>, input: &Tensor) -> Made {
        host_op::host_op(op, input)
    }

    fn parameter(array: &Tensor) -> Made {
        gradient::parameter(array).map_err(refused)
    }

    fn detach(array: &Tensor) -> Made {
        Ok(array.detach())
    }

    fn is_tracked(array: &Tensor) -> bool {
        array.track_op()
    }

    fn backward(number: &Tensor) -> Result<GradStore, BackendError> {
        number.backward().map_err(refused)
    }

    fn gradient(gradients: &GradStore, parameter: &Tensor) -> Option<Tensor> {
        gradient::gradient(gradients, parameter)
    }
}
