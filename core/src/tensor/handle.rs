//! The handle of an array: what it is, and how values come in and go out.

use alloc::format;
use alloc::vec;
use alloc::vec::Vec;

use super::backend::{Backend, BackendError};
use super::error::TensorError;
use crate::dims::Dims;
use crate::real::{DType, Real, Values};

/// An array of a backend. Cheap to clone; never changes.
///
/// # Examples
/// ```
/// use dvp_core::tensor::{Host, HostDevice, Tensor};
/// let x = Tensor::<Host>::new(vec![1.0_f64, 2.0, 3.0], &[3], &HostDevice)?.parameter()?;
/// let loss = x.mul(&x)?.sum_all()?;
/// let gradients = loss.backward()?;
/// assert_eq!(loss.number()?, 14.0);
/// assert_eq!(gradients.of(&x).map(|g| g.to_f64()).transpose()?, Some(vec![2.0, 4.0, 6.0]));
/// # Ok::<(), dvp_core::tensor::TensorError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Tensor<B: Backend> {
    array: B::Array,
    dims: Dims,
    dtype: DType,
}

impl<B: Backend> Tensor<B> {
    /// A constant tensor of `extents` from its values in row-major order.
    ///
    /// # Errors
    /// [`TensorError::Values`] if the number of values is not that of the extents.
    pub fn new<T: Real>(values: Vec<T>, extents: &[usize], device: &B::Device) -> Result<Self, TensorError> {
        Self::from_values(T::into_values(values), &Dims::new(extents)?, device)
    }

    /// As [`Self::new`], of a number type chosen at run time.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn from_values(values: Values, dims: &Dims, device: &B::Device) -> Result<Self, TensorError> {
        if values.len() != dims.len() {
            return Err(TensorError::Values { len: values.len(), dims: *dims });
        }
        Self::wrap("upload", B::upload(values, dims, device))
    }

    /// A constant tensor filled with one number.
    ///
    /// # Errors
    /// As [`Dims::new`], or if the framework refuses.
    pub fn full(value: f64, extents: &[usize], dtype: DType, device: &B::Device) -> Result<Self, TensorError> {
        let dims = Dims::new(extents)?;
        Self::from_values(Values::F64(vec![value; dims.len()]).cast(dtype), &dims, device)
    }

    /// A tensor around a framework's own array.
    #[must_use]
    pub fn from_array(array: B::Array) -> Self {
        Self { dims: B::dims(&array), dtype: B::dtype(&array), array }
    }

    /// The framework's own array.
    #[must_use]
    pub fn array(&self) -> &B::Array {
        &self.array
    }

    /// The framework's own array.
    #[must_use]
    pub fn into_array(self) -> B::Array {
        self.array
    }

    /// The extents.
    #[must_use]
    pub fn dims(&self) -> &Dims {
        &self.dims
    }

    /// The number type.
    #[must_use]
    pub fn dtype(&self) -> DType {
        self.dtype
    }

    /// Where the values live.
    #[must_use]
    pub fn device(&self) -> B::Device {
        B::device(&self.array)
    }

    /// The values in row-major order.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn values(&self) -> Result<Values, TensorError> {
        B::download(&self.array).map_err(|cause| Self::refused("download", cause))
    }

    /// The values in row-major order as f64; exact.
    ///
    /// # Errors
    /// As [`Self::values`].
    pub fn to_f64(&self) -> Result<Vec<f64>, TensorError> {
        Ok(match self.values()? {
            Values::F64(values) => values,
            values => values.to_f64(),
        })
    }

    /// The only value.
    ///
    /// # Errors
    /// [`TensorError::Operand`] if there are more or none.
    pub fn number(&self) -> Result<f64, TensorError> {
        match self.to_f64()?[..] {
            [number] => Ok(number),
            _ => Err(self.operand("number", "must hold a single value")),
        }
    }

    /// The same numbers in another type, as a constant.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn cast(&self, dtype: DType) -> Result<Self, TensorError> {
        Self::wrap("cast", B::cast(&self.array, dtype))
    }

    /// A constant tensor with these values, in the type and on the device of this one.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn like(&self, values: Vec<f64>, extents: &[usize]) -> Result<Self, TensorError> {
        Self::from_values(Values::F64(values).cast(self.dtype), &Dims::new(extents)?, &self.device())
    }

    /// A result of the backend as a tensor or as an error that names the operation.
    pub(super) fn wrap(op: &'static str, result: Result<B::Array, BackendError>) -> Result<Self, TensorError> {
        result.map(Self::from_array).map_err(|cause| Self::refused(op, cause))
    }

    pub(super) fn refused(op: &'static str, cause: BackendError) -> TensorError {
        TensorError::Backend { op, backend: B::NAME, cause }
    }

    pub(super) fn operand(&self, op: &'static str, must: &'static str) -> TensorError {
        TensorError::Operand { op, dims: self.dims, must }
    }

    /// Operands of one operation must have one number type and one device.
    pub(super) fn check_pair(&self, op: &'static str, other: &Self) -> Result<(), TensorError> {
        if self.dtype != other.dtype {
            return Err(TensorError::DTypes { op, left: self.dtype, right: other.dtype });
        }
        let (left, right) = (self.device(), other.device());
        if left == right {
            Ok(())
        } else {
            Err(TensorError::Devices { op, left: format!("{left:?}"), right: format!("{right:?}") })
        }
    }

    pub(super) fn check_axis(&self, op: &'static str, axis: usize) -> Result<usize, TensorError> {
        self.dims.get(axis).ok_or(TensorError::Axis { op, axis, dims: self.dims })
    }
}
