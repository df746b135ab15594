//! Differentiable steps as functions on slices, for any framework or none.
//!
//! In: the inputs of one item of a batch, one after the other in one slice. Out: its output and, backward, the gradient of
//! its inputs. A [`DiffOp`] knows nothing of tensors; [`Batched`] runs it over a batch (in parallel with the feature
//! `parallel`) and hides its number type, so that a framework's adapter wraps every op of the crate at once, as [`HostOp`].
//!
//! | file | holds |
//! |---|---|
//! | `mod` | the contract, [`DiffOp`], and its errors |
//! | `signature` | [`Signature`]: names and extents of what a step takes and gives |
//! | `batch` | [`HostOp`], [`Batched`]: a batch of items, either number type |
//! | `memory` | memory of a step, kept from batch to batch |
//! | `atan2` | [`Atan2`]: a (y, x) pair to an angle |
//!
//! The other ops stand beside the maths that they wrap: outlines and prototypes in [`shape`](crate::shape), poses in
//! [`scene`](crate::scene), images in [`render`](crate::render), losses in [`loss`](crate::loss), windows of pixels in
//! [`tensor`](crate::tensor). Each is checked against central differences in `tests/backend`.

mod atan2;
mod batch;
mod memory;
mod signature;
#[cfg(test)]
mod tests;

use alloc::boxed::Box;
use core::fmt;

pub use atan2::Atan2;
pub(crate) use atan2::atan2_vjp;
pub use batch::{Batched, HostOp};
pub use signature::{OpInput, Signature};

use crate::real::{DType, Real};

/// A step with a hand-written way back, item by item.
///
/// *Derivative*: [`Self::vjp`] must be that of [`Self::forward`]; where a step is not differentiable its docs say what is
/// taken instead.
pub trait DiffOp<T: Real>: fmt::Debug + Send + Sync {
    /// Memory kept between items.
    type Scratch: Default + Send;
    /// Why an item is refused.
    type Error: core::error::Error + Send + Sync + 'static;

    /// What the step takes and gives.
    fn signature(&self) -> &Signature;

    /// Writes the output of item `item`. `saved` holds [`Signature::saved_len`] zeros to write to, or nothing if no
    /// gradient will be asked for.
    ///
    /// # Errors
    /// If the item is refused; `output` may then hold anything.
    fn forward(
        &self,
        item: usize,
        input: &[T],
        output: &mut [T],
        saved: &mut [T],
        scratch: &mut Self::Scratch,
    ) -> Result<(), Self::Error>;

    /// Adds to `grad_input` the gradient of sum(`grad_output` x output).
    ///
    /// # Errors
    /// As [`Self::forward`].
    fn vjp(
        &self,
        item: usize,
        input: &[T],
        saved: &[T],
        grad_output: &[T],
        grad_input: &mut [T],
        scratch: &mut Self::Scratch,
    ) -> Result<(), Self::Error>;
}

/// Why a [`HostOp`] was refused.
#[derive(Debug)]
#[non_exhaustive]
pub enum OpError {
    /// A slice has the wrong length.
    Length {
        /// Name of the op.
        op: &'static str,
        /// Which slice.
        what: &'static str,
        /// Expected length.
        expected: usize,
        /// What came.
        len: usize,
    },
    /// Numbers of another type than the op's.
    DType {
        /// Name of the op.
        op: &'static str,
        /// Type of the op.
        expected: DType,
        /// Type of the numbers.
        found: DType,
    },
    /// The op holds something for each item, but for another number of items.
    Batch {
        /// Name of the op.
        op: &'static str,
        /// Items that it is made for.
        expected: usize,
        /// Items that came.
        found: usize,
    },
    /// The step refused an item.
    Item {
        /// Name of the op.
        op: &'static str,
        /// Which item of the batch.
        item: usize,
        /// What it said.
        cause: Box<dyn core::error::Error + Send + Sync>,
    },
}

impl fmt::Display for OpError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { op, what, expected, len } => write!(f, "{op}: {what} has {len} values, needs {expected}"),
            Self::DType { op, expected, found } => {
                write!(f, "{op}: made for {expected}, got {found}; make the op in the tensors' type, or cast them")
            }
            Self::Batch { op, expected, found } => {
                write!(f, "{op}: made for {expected} items, got {found}; make one op per batch")
            }
            Self::Item { op, item, cause } => write!(f, "{op}, item {item}: {cause}"),
        }
    }
}

impl core::error::Error for OpError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Item { cause, .. } => Some(cause.as_ref()),
            _ => None,
        }
    }
}

/// Adds `factor` times `values` to `sums`, as far as both go.
pub(crate) fn add_scaled<T: Real>(sums: &mut [T], values: &[T], factor: T) {
    sums.iter_mut().zip(values).for_each(|(sum, &value)| *sum += factor * value);
}
