//! The normal form of descriptors, as one differentiable step of a batch.

use alloc::vec::Vec;

use super::{Efd, ShapeError};
use crate::diff_op::{DiffOp, OpInput, Signature};
use crate::dims::DimsError;
use crate::real::Real;

/// Descriptors to their [normal form](Efd::normalize): objects x harmonics x 4, both.
///
/// *Derivative*: [`Efd::normalize_vjp`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NormalizeOp {
    signature: Signature,
    harmonics: usize,
}

impl NormalizeOp {
    /// Normal forms of `objects` shapes of `harmonics` harmonics per item.
    ///
    /// # Errors
    /// As [`Dims::new`](crate::dims::Dims::new).
    pub fn new(objects: usize, harmonics: usize) -> Result<Self, DimsError> {
        let descriptors = OpInput::new("descriptors", &[objects, harmonics, 4])?;
        Ok(Self { signature: Signature::new("normalize", [descriptors], descriptors.dims), harmonics })
    }
}

impl<T: Real> DiffOp<T> for NormalizeOp {
    type Scratch = Efd<T>;
    type Error = ShapeError;

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn forward(
        &self,
        _: usize,
        input: &[T],
        output: &mut [T],
        _: &mut [T],
        efd: &mut Efd<T>,
    ) -> Result<(), ShapeError> {
        let len = (4 * self.harmonics).max(1);
        for (rows, normal) in input.chunks_exact(len).zip(output.chunks_exact_mut(len)) {
            take(efd, rows);
            normal.copy_from_slice(efd.normalize()?.efd.rows().as_flattened());
        }
        Ok(())
    }

    fn vjp(
        &self,
        _: usize,
        input: &[T],
        _: &[T],
        grad_output: &[T],
        grad_input: &mut [T],
        efd: &mut Efd<T>,
    ) -> Result<(), ShapeError> {
        let len = (4 * self.harmonics).max(1);
        let grads = grad_output.chunks_exact(len).zip(grad_input.chunks_exact_mut(len));
        for (rows, (grad_normal, grad)) in input.chunks_exact(len).zip(grads) {
            take(efd, rows);
            efd.normalize_vjp(grad_normal.as_chunks().0, grad.as_chunks_mut().0)?;
        }
        Ok(())
    }
}

/// The rows of one shape, in the memory of the last.
fn take<T: Real>(efd: &mut Efd<T>, values: &[T]) {
    let mut rows: Vec<[T; 4]> = core::mem::take(&mut efd.rows);
    rows.clear();
    rows.extend_from_slice(values.as_chunks().0);
    *efd = Efd::new(rows);
}
