//! Why an operation on tensors was refused.

use alloc::boxed::Box;
use alloc::string::String;
use core::fmt;

use super::backend::BackendError;
use crate::dims::{Dims, DimsError};
use crate::real::DType;

/// Why an operation on tensors was refused; names the operation and its operands.
#[derive(Debug)]
#[non_exhaustive]
pub enum TensorError {
    /// Two operands whose extents do not go together.
    Dims {
        /// Name of the operation.
        op: &'static str,
        /// Extents of the two operands.
        operands: Box<[Dims; 2]>,
        /// What the operation needs.
        must: &'static str,
    },
    /// An operand of the wrong rank or extents.
    Operand {
        /// Name of the operation.
        op: &'static str,
        /// Its extents.
        dims: Dims,
        /// What the operation needs.
        must: &'static str,
    },
    /// An axis that the operand does not have.
    Axis {
        /// Name of the operation.
        op: &'static str,
        /// The axis asked for.
        axis: usize,
        /// Extents of the operand.
        dims: Dims,
    },
    /// Indices beyond the extent of an axis.
    Range {
        /// Name of the operation.
        op: &'static str,
        /// First index beyond.
        index: usize,
        /// The axis.
        axis: usize,
        /// Extents of the operand.
        dims: Dims,
    },
    /// A number of values that does not fill the extents.
    Values {
        /// Number of values.
        len: usize,
        /// Extents to fill.
        dims: Dims,
    },
    /// Operands of different number types.
    DTypes {
        /// Name of the operation.
        op: &'static str,
        /// Type of the first operand.
        left: DType,
        /// Type of the second operand.
        right: DType,
    },
    /// Operands on different devices.
    Devices {
        /// Name of the operation.
        op: &'static str,
        /// Device of the first operand.
        left: String,
        /// Device of the second operand.
        right: String,
    },
    /// Extents that are no dims.
    NoDims(DimsError),
    /// The framework refused.
    Backend {
        /// Name of the operation.
        op: &'static str,
        /// Name of the backend.
        backend: &'static str,
        /// Why.
        cause: BackendError,
    },
}

impl fmt::Display for TensorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Dims { op, operands, must } => write!(f, "{op} of {} and {}: {must}", operands[0], operands[1]),
            Self::Operand { op, dims, must } => write!(f, "{op} of {dims}: {must}"),
            Self::Axis { op, axis, dims } => write!(f, "{op} of {dims}: there is no axis {axis}"),
            Self::Range { op, index, axis, dims } => {
                write!(f, "{op} of {dims}: index {index} is beyond axis {axis}")
            }
            Self::Values { len, dims } => write!(f, "{len} values do not fill {dims}, which has {}", dims.len()),
            Self::DTypes { op, left, right } => {
                write!(f, "{op} of {left} and {right} numbers: cast one of the operands")
            }
            Self::Devices { op, left, right } => {
                write!(f, "{op} of a tensor on {left} and one on {right}: move one of the operands")
            }
            Self::NoDims(error) => write!(f, "{error}"),
            Self::Backend { op, backend, cause } => write!(f, "{op} on {backend}: {cause}"),
        }
    }
}

impl TensorError {
    /// Two operands whose extents do not go together.
    pub(super) fn dims(op: &'static str, left: &Dims, right: &Dims, must: &'static str) -> Self {
        Self::Dims { op, operands: Box::new([*left, *right]), must }
    }
}

impl core::error::Error for TensorError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Backend { cause, .. } => Some(cause),
            Self::NoDims(error) => Some(error),
            _ => None,
        }
    }
}

impl From<DimsError> for TensorError {
    fn from(error: DimsError) -> Self {
        Self::NoDims(error)
    }
}
