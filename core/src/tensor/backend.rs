//! What a framework must provide: about 25 operations on its own arrays, unchecked; [`Tensor`](super::Tensor) checks.

use alloc::string::String;
use alloc::sync::Arc;
use core::fmt;

use crate::diff_op::{HostOp, OpError};
use crate::dims::Dims;
use crate::real::{DType, Values};

/// Functions of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unary {
    /// |x|; derivative 0 at 0.
    Abs,
    /// cos x, x in radians.
    Cos,
    /// The error function.
    Erf,
    /// e^x.
    Exp,
    /// Natural logarithm.
    Log,
    /// max(x, 0); derivative 0 at 0.
    Relu,
    /// sin x, x in radians.
    Sin,
    /// Square root; its derivative at 0 is infinite.
    Sqrt,
    /// Hyperbolic tangent.
    Tanh,
}

impl Unary {
    /// All of them: tests run over it.
    pub const ALL: [Self; 9] =
        [Self::Abs, Self::Cos, Self::Erf, Self::Exp, Self::Log, Self::Relu, Self::Sin, Self::Sqrt, Self::Tanh];
}

/// Functions of two numbers, with broadcasting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Binary {
    /// a + b.
    Add,
    /// a / b.
    Div,
    /// a b.
    Mul,
    /// a - b.
    Sub,
}

impl Binary {
    /// All of them: tests run over it.
    pub const ALL: [Self; 4] = [Self::Add, Self::Div, Self::Mul, Self::Sub];
}

/// How a window walks over an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Stride {
    /// Pixels from window to window, at least 1, both ways.
    pub step: usize,
    /// Rows and columns added on every side.
    pub padding: usize,
}

impl Stride {
    /// Windows of `extent` pixels along a side of `len` pixels; none fits if it is 0.
    #[must_use]
    pub fn windows(&self, len: usize, extent: usize) -> usize {
        match (len + 2 * self.padding).checked_sub(extent) {
            Some(room) if self.step > 0 => room / self.step + 1,
            _ => 0,
        }
    }
}

/// A framework: arrays on a device, and gradients of what was computed with them.
///
/// Callers have checked extents, number types and devices; nothing is checked again. Arrays are cheap to clone and never
/// change. Number types are kept: no operation rounds f64 to f32. Gradients flow through every operation unless its docs
/// say otherwise.
pub trait Backend: Clone + fmt::Debug + Send + Sync + 'static {
    /// Where arrays live.
    type Device: Clone + fmt::Debug + PartialEq + Send + Sync;
    /// An array.
    type Array: Clone + fmt::Debug + Send + Sync;
    /// What [`Self::backward`] leaves.
    type Gradients: fmt::Debug;

    /// The name in messages and tables.
    const NAME: &'static str;

    /// An array of `dims` from its values in row-major order; constant: no gradient is kept for it.
    ///
    /// # Errors
    /// [`BackendError`] if the framework refuses.
    fn upload(values: Values, dims: &Dims, device: &Self::Device) -> Result<Self::Array, BackendError>;

    /// The values in row-major order.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn download(array: &Self::Array) -> Result<Values, BackendError>;

    /// The extents.
    fn dims(array: &Self::Array) -> Dims;

    /// The number type.
    fn dtype(array: &Self::Array) -> DType;

    /// Where the array lives.
    fn device(array: &Self::Array) -> Self::Device;

    /// The same numbers in another type; no gradient flows through it.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn cast(array: &Self::Array, dtype: DType) -> Result<Self::Array, BackendError>;

    /// The function of every number.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn unary(function: Unary, array: &Self::Array) -> Result<Self::Array, BackendError>;

    /// scale x + offset for every number x.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn affine(array: &Self::Array, scale: f64, offset: f64) -> Result<Self::Array, BackendError>;

    /// The function of pairs of numbers. Both arrays have the same rank; along each axis their extents are equal, or one
    /// of them is 1 and stretches.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn binary(function: Binary, a: &Self::Array, b: &Self::Array) -> Result<Self::Array, BackendError>;

    /// 1 where a > b, 0 elsewhere, in the type of the operands, whose extents are as for [`Self::binary`]; no gradient
    /// flows through it.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn greater(a: &Self::Array, b: &Self::Array) -> Result<Self::Array, BackendError>;

    /// The same numbers in row-major order with other extents.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn reshape(array: &Self::Array, dims: &Dims) -> Result<Self::Array, BackendError>;

    /// Axis k of the result is axis `axes[k]` of the array.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn permute(array: &Self::Array, axes: &[usize]) -> Result<Self::Array, BackendError>;

    /// Axes of extent 1 stretched to `dims`, of the same rank.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn expand(array: &Self::Array, dims: &Dims) -> Result<Self::Array, BackendError>;

    /// `len` indices of an axis from `start` on.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn slice(array: &Self::Array, axis: usize, start: usize, len: usize) -> Result<Self::Array, BackendError>;

    /// At least one array, one after the other along an axis; their other extents are equal.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn concat(arrays: &[&Self::Array], axis: usize) -> Result<Self::Array, BackendError>;

    /// The given indices of an axis, in their order; an index may come more than once.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn select(array: &Self::Array, axis: usize, indices: &[usize]) -> Result<Self::Array, BackendError>;

    /// Sums along an axis, which keeps extent 1.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn sum(array: &Self::Array, axis: usize) -> Result<Self::Array, BackendError>;

    /// Largest numbers along an axis, which keeps extent 1; no gradient flows through it.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn max(array: &Self::Array, axis: usize) -> Result<Self::Array, BackendError>;

    /// Products of matrices, batch x m x k times batch x k x n.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn matmul(a: &Self::Array, b: &Self::Array) -> Result<Self::Array, BackendError>;

    /// Cross-correlation of images, batch x c x h x w, with kernels o x c x kh x kw: batch x o x rows x columns of
    /// [`Stride::windows`]. The padding is zeros.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn conv2d(images: &Self::Array, kernels: &Self::Array, stride: Stride) -> Result<Self::Array, BackendError>;

    /// A step of the core, on the host: `input` batch x values of all inputs of an item, result batch x values of its
    /// output. From another device the values are copied and come back. If the gradient of `input` is tracked, the way
    /// back is the op's own; should that fail, [`Self::backward`] does with the op's words or, where a framework cannot
    /// stop on its way, the gradient is NaN.
    ///
    /// # Errors
    /// [`BackendError`], with the op's own words if it refuses.
    fn host_op(op: &Arc<dyn HostOp>, input: &Self::Array) -> Result<Self::Array, BackendError>;

    /// The same numbers as a parameter: gradients are kept for it, and do not flow further back.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn parameter(array: &Self::Array) -> Result<Self::Array, BackendError>;

    /// The same numbers as a constant.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn detach(array: &Self::Array) -> Result<Self::Array, BackendError>;

    /// Whether the array is a parameter or was computed from one.
    fn is_tracked(array: &Self::Array) -> bool;

    /// Gradients of a single number with respect to every parameter it was computed from. The graph may be used up.
    ///
    /// # Errors
    /// As [`Self::upload`].
    fn backward(number: &Self::Array) -> Result<Self::Gradients, BackendError>;

    /// The gradient of a parameter, as a constant; none if the number did not depend on it.
    fn gradient(gradients: &Self::Gradients, parameter: &Self::Array) -> Option<Self::Array>;
}

/// Why a framework refused.
#[derive(Debug)]
#[non_exhaustive]
pub enum BackendError {
    /// A step of the core refused.
    Op(OpError),
    /// The framework did, in its own words.
    Framework(String),
}

impl fmt::Display for BackendError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Op(error) => write!(f, "{error}"),
            Self::Framework(message) => f.write_str(message),
        }
    }
}

impl core::error::Error for BackendError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Op(error) => Some(error),
            Self::Framework(_) => None,
        }
    }
}

impl From<OpError> for BackendError {
    fn from(error: OpError) -> Self {
        Self::Op(error)
    }
}
