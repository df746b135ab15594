//! The backend that is always there: plain vectors and a tape. Without a framework, and the third opinion beside two.
//!
//! | file | holds |
//! |---|---|
//! | `mod` | [`Host`]: the operations, each with its way back |
//! | `array` | [`HostArray`]: shared values, and the node of the tape if tracked |
//! | `tape` | nodes, and [`HostGradients`]: the walk back |
//! | `strided` | copies and sums over axes |
//! | `unary` | functions of one number and their derivatives |
//! | `matmul` | products of matrices |

mod array;
mod matmul;
mod strided;
mod tape;
mod unary;

use alloc::sync::Arc;
use alloc::vec;
use alloc::vec::Vec;

pub use array::HostArray;
pub use tape::HostGradients;

use super::backend::{Backend, BackendError, Binary, Stride, Unary};
use super::unfold::Unfold;
use crate::diff_op::{Batched, HostOp};
use crate::dims::Dims;
use crate::real::{DType, Real, Values};
use array::{by_type, by_types};
use strided::{copy_strided, reduce_to, scatter};

/// Plain vectors on the host, with a tape.
#[derive(Clone, Copy, Debug)]
pub struct Host;

/// The only place where host arrays live.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct HostDevice;

impl Backend for Host {
    type Device = HostDevice;
    type Array = HostArray;
    type Gradients = HostGradients;

    const NAME: &'static str = "host";

    fn upload(values: Values, dims: &Dims, _: &HostDevice) -> Result<HostArray, BackendError> {
        Ok(HostArray::constant(values, *dims))
    }

    fn download(array: &HostArray) -> Result<Values, BackendError> {
        Ok(array.values().clone())
    }

    fn dims(array: &HostArray) -> Dims {
        array.dims()
    }

    fn dtype(array: &HostArray) -> DType {
        array.values().dtype()
    }

    fn device(_: &HostArray) -> HostDevice {
        HostDevice
    }

    fn cast(array: &HostArray, dtype: DType) -> Result<HostArray, BackendError> {
        Ok(HostArray::constant(array.values().clone().cast(dtype), array.dims()))
    }

    fn unary(function: Unary, array: &HostArray) -> Result<HostArray, BackendError> {
        let values = by_type!(array.values(), x => x.iter().map(|&x| unary::value(function, x)).collect());
        let input = array.clone();
        Ok(HostArray::tracked(values, array.dims(), &[array], move |grad| {
            let derivative = by_types!(input.values(), grad, (x, g) => {
                x.iter().zip(g).map(|(&x, &g)| g * unary::derivative(function, x)).collect()
            });
            Ok(vec![derivative])
        }))
    }

    fn affine(array: &HostArray, scale: f64, offset: f64) -> Result<HostArray, BackendError> {
        let values = by_type!(array.values(), x => scaled(x, scale, offset));
        Ok(HostArray::tracked(values, array.dims(), &[array], move |grad| {
            Ok(vec![by_type!(grad, g => scaled(g, scale, 0.0))])
        }))
    }

    fn binary(function: Binary, a: &HostArray, b: &HostArray) -> Result<HostArray, BackendError> {
        let dims = broadcast(a, b);
        let (left, right) = (stretched(a, &dims), stretched(b, &dims));
        let values = by_types!(&left, &right, (x, y) => combine(x, y, |x, y| match function {
            Binary::Add => x + y,
            Binary::Div => x / y,
            Binary::Mul => x * y,
            Binary::Sub => x - y,
        }));
        let (own_a, own_b) = (a.dims(), b.dims());
        Ok(HostArray::tracked(values, dims, &[a, b], move |grad| {
            let (for_a, for_b) = match function {
                Binary::Add => (grad.clone(), grad.clone()),
                Binary::Sub => (grad.clone(), by_type!(grad, g => scaled(g, -1.0, 0.0))),
                Binary::Mul => (
                    by_types!(grad, &right, (g, y) => combine(g, y, |g, y| g * y)),
                    by_types!(grad, &left, (g, x) => combine(g, x, |g, x| g * x)),
                ),
                Binary::Div => {
                    let for_a = by_types!(grad, &right, (g, y) => combine(g, y, |g, y| g / y));
                    let ratio = by_types!(&left, &right, (x, y) => combine(x, y, |x, y| -(x / y)));
                    let for_b = by_types!(&for_a, &ratio, (g, r) => combine(g, r, |g, r| g * r));
                    (for_a, for_b)
                }
            };
            Ok(vec![reduce_to(&for_a, &dims, &own_a), reduce_to(&for_b, &dims, &own_b)])
        }))
    }

    fn greater(a: &HostArray, b: &HostArray) -> Result<HostArray, BackendError> {
        let dims = broadcast(a, b);
        let values = by_types!(&stretched(a, &dims), &stretched(b, &dims), (x, y) => combine(x, y, mask));
        Ok(HostArray::constant(values, dims))
    }

    fn reshape(array: &HostArray, dims: &Dims) -> Result<HostArray, BackendError> {
        Ok(array.viewed(*dims))
    }

    fn permute(array: &HostArray, axes: &[usize]) -> Result<HostArray, BackendError> {
        let own = array.dims();
        let extents: Vec<usize> = axes.iter().map(|&axis| own.extents()[axis]).collect();
        let dims = Dims::new(&extents).map_err(|error| framework(&error))?;
        let mut back = vec![0; axes.len()];
        for (k, &axis) in axes.iter().enumerate() {
            back[axis] = k;
        }
        let values = permuted(array.values(), &own, axes, &dims);
        Ok(HostArray::tracked(values, dims, &[array], move |grad| Ok(vec![permuted(grad, &dims, &back, &own)])))
    }

    fn expand(array: &HostArray, dims: &Dims) -> Result<HostArray, BackendError> {
        let (own, dims) = (array.dims(), *dims);
        let values = stretched(array, &dims);
        Ok(HostArray::tracked(values, dims, &[array], move |grad| Ok(vec![reduce_to(grad, &dims, &own)])))
    }

    fn slice(array: &HostArray, axis: usize, start: usize, len: usize) -> Result<HostArray, BackendError> {
        let own = array.dims();
        let values = by_type!(array.values(), x => strided::cut(x, &own, axis, [start, len]));
        Ok(HostArray::tracked(values, own.with(axis, len), &[array], move |grad| {
            let mut whole = Values::zeros(grad.dtype(), own.len());
            strided::paste(&mut whole, &own, axis, start, grad);
            Ok(vec![whole])
        }))
    }

    fn concat(arrays: &[&HostArray], axis: usize) -> Result<HostArray, BackendError> {
        let [first, ..] = arrays else { return Err(BackendError::Framework("nothing to join".into())) };
        let extents: Vec<usize> = arrays.iter().map(|array| array.dims().extents()[axis]).collect();
        let dims = first.dims().with(axis, extents.iter().sum());
        let mut values = Values::zeros(first.values().dtype(), dims.len());
        let mut parts = Vec::with_capacity(arrays.len());
        let mut start = 0;
        for (array, &extent) in arrays.iter().zip(&extents) {
            strided::paste(&mut values, &dims, axis, start, array.values());
            parts.push([start, extent]);
            start += extent;
        }
        Ok(HostArray::tracked(values, dims, arrays, move |grad| {
            Ok(parts.iter().map(|&part| by_type!(grad, g => strided::cut(g, &dims, axis, part))).collect())
        }))
    }

    fn select(array: &HostArray, axis: usize, indices: &[usize]) -> Result<HostArray, BackendError> {
        let own = array.dims();
        let values = selected(array.values(), &own, axis, indices);
        let indices = indices.to_vec();
        Ok(HostArray::tracked(values, own.with(axis, indices.len()), &[array], move |grad| {
            let mut whole = Values::zeros(grad.dtype(), own.len());
            scatter(&mut whole, &own, axis, &indices, grad);
            Ok(vec![whole])
        }))
    }

    fn sum(array: &HostArray, axis: usize) -> Result<HostArray, BackendError> {
        let own = array.dims();
        let dims = own.with(axis, 1);
        let values = reduce_to(array.values(), &own, &dims);
        Ok(HostArray::tracked(values, dims, &[array], move |grad| Ok(vec![stretch(grad, &dims, &own)])))
    }

    fn max(array: &HostArray, axis: usize) -> Result<HostArray, BackendError> {
        let own = array.dims();
        let values = by_type!(array.values(), x => strided::largest(x, &own, axis));
        Ok(HostArray::constant(values, own.with(axis, 1)))
    }

    fn matmul(a: &HostArray, b: &HostArray) -> Result<HostArray, BackendError> {
        let (&[batch, m, k], &[_, _, n]) = (a.dims().extents(), b.dims().extents()) else {
            return Err(BackendError::Framework("matrices must come in batches".into()));
        };
        let dims = Dims::new(&[batch, m, n]).map_err(|error| framework(&error))?;
        let values = by_types!(a.values(), b.values(), (x, y) => matmul::batched(x, y, [batch, m, k, n]));
        let (left, right) = (a.clone(), b.clone());
        Ok(HostArray::tracked(values, dims, &[a, b], move |grad| {
            let across = |array: &HostArray| {
                let (dims, [batch, rows, columns]) = (array.dims(), three(array.dims()));
                by_type!(array.values(), x => copy_strided(x, &dims, &[0, 2, 1], &[batch, columns, rows]))
            };
            let for_a = by_types!(grad, &across(&right), (g, y) => matmul::batched(g, y, [batch, m, n, k]));
            let for_b = by_types!(&across(&left), grad, (x, g) => matmul::batched(x, g, [batch, k, m, n]));
            Ok(vec![for_a, for_b])
        }))
    }

    fn conv2d(images: &HostArray, kernels: &HostArray, stride: Stride) -> Result<HostArray, BackendError> {
        let (&[batch, c, h, w], &[o, _, kh, kw]) = (images.dims().extents(), kernels.dims().extents()) else {
            return Err(BackendError::Framework("images and kernels must have four axes".into()));
        };
        let (pixels, columns) = (c * h * w, c * kh * kw);
        let [rows_out, columns_out] = [stride.windows(h, kh), stride.windows(w, kw)];
        let dims = |extents: &[usize]| Dims::new(extents).map_err(|error| framework(&error));
        let op = Unfold::new([c, h, w], [kh, kw], stride).map_err(|error| framework(&error))?;
        let op: Arc<dyn HostOp> = match images.values().dtype() {
            DType::F32 => Arc::new(Batched::<f32, _>::new(op)),
            DType::F64 => Arc::new(Batched::<f64, _>::new(op)),
        };
        let windows = Self::host_op(&op, &images.viewed(dims(&[batch, pixels])?))?;
        let windows = windows.viewed(dims(&[batch, columns, rows_out * columns_out])?);
        let kernels = Self::expand(&kernels.viewed(dims(&[1, o, columns])?), &dims(&[batch, o, columns])?)?;
        Ok(Self::matmul(&kernels, &windows)?.viewed(dims(&[batch, o, rows_out, columns_out])?))
    }

    fn host_op(op: &Arc<dyn HostOp>, input: &HostArray) -> Result<HostArray, BackendError> {
        let batch = input.dims().get(0).unwrap_or(1);
        let (values, saved) = op.forward(batch, input.values().as_ref(), input.is_tracked())?;
        let dims = Dims::new(&[batch, op.signature().output().len()]).map_err(|error| framework(&error))?;
        let (op, own) = (Arc::clone(op), input.clone());
        Ok(HostArray::tracked(values, dims, &[input], move |grad| {
            Ok(vec![op.vjp(batch, own.values().as_ref(), saved.as_ref(), grad.as_ref())?])
        }))
    }

    fn parameter(array: &HostArray) -> Result<HostArray, BackendError> {
        Ok(array.as_parameter())
    }

    fn detach(array: &HostArray) -> Result<HostArray, BackendError> {
        Ok(array.as_constant())
    }

    fn is_tracked(array: &HostArray) -> bool {
        array.is_tracked()
    }

    fn backward(number: &HostArray) -> Result<HostGradients, BackendError> {
        tape::backward(number)
    }

    fn gradient(gradients: &HostGradients, parameter: &HostArray) -> Option<HostArray> {
        gradients.of(parameter)
    }
}

fn framework(error: &dyn core::fmt::Display) -> BackendError {
    BackendError::Framework(alloc::format!("{error}"))
}

fn scaled<T: Real>(x: &[T], scale: f64, offset: f64) -> Vec<T> {
    let (scale, offset) = (T::of(scale), T::of(offset));
    x.iter().map(|&x| scale * x + offset).collect()
}

fn combine<T: Real>(x: &[T], y: &[T], f: impl Fn(T, T) -> T) -> Vec<T> {
    x.iter().zip(y).map(|(&x, &y)| f(x, y)).collect()
}

fn mask<T: Real>(x: T, y: T) -> T {
    if x > y { T::one() } else { T::zero() }
}

/// The dims of both operands together; callers have checked that there are some.
fn broadcast(a: &HostArray, b: &HostArray) -> Dims {
    a.dims().broadcast(&b.dims()).unwrap_or(a.dims())
}

fn stretched(array: &HostArray, dims: &Dims) -> Values {
    stretch(array.values(), &array.dims(), dims)
}

/// Axes of extent 1 stretched to `to`, of the same rank.
fn stretch(values: &Values, from: &Dims, to: &Dims) -> Values {
    if from == to {
        return values.clone();
    }
    let axes: Vec<usize> = (0..to.rank()).collect();
    by_type!(values, x => copy_strided(x, from, &axes, to.extents()))
}

fn permuted(values: &Values, from: &Dims, axes: &[usize], to: &Dims) -> Values {
    by_type!(values, x => copy_strided(x, from, axes, to.extents()))
}

fn selected(values: &Values, dims: &Dims, axis: usize, indices: &[usize]) -> Values {
    by_type!(values, x => strided::select(x, dims, axis, indices))
}

fn three(dims: Dims) -> [usize; 3] {
    core::array::from_fn(|axis| dims.get(axis).unwrap_or(1))
}
