//! Operations that move numbers and change none.

use super::backend::Backend;
use super::error::TensorError;
use super::handle::Tensor;
use crate::dims::Dims;

impl<B: Backend> Tensor<B> {
    /// The same numbers in row-major order with other extents.
    ///
    /// # Errors
    /// [`TensorError::Dims`] if the number of values changes.
    pub fn reshape(&self, extents: &[usize]) -> Result<Self, TensorError> {
        let right = Dims::new(extents)?;
        if right.len() != self.dims().len() {
            let must = "both must have the same number of values";
            return Err(TensorError::dims("reshape", self.dims(), &right, must));
        }
        if right == *self.dims() { Ok(self.clone()) } else { Self::wrap("reshape", B::reshape(self.array(), &right)) }
    }

    /// Axis k of the result is axis `axes[k]` of the tensor.
    ///
    /// # Errors
    /// [`TensorError::Operand`] if `axes` is no permutation of its axes.
    pub fn permute(&self, axes: &[usize]) -> Result<Self, TensorError> {
        let rank = self.dims().rank();
        if axes.len() != rank || (0..rank).any(|axis| !axes.contains(&axis)) {
            return Err(self.operand("permute", "axes must name each axis once"));
        }
        Self::wrap("permute", B::permute(self.array(), axes))
    }

    /// The last two axes exchanged.
    ///
    /// # Errors
    /// [`TensorError::Operand`] if there are fewer than two axes.
    pub fn transpose(&self) -> Result<Self, TensorError> {
        let rank = self.dims().rank();
        if rank < 2 {
            return Err(self.operand("transpose", "needs at least two axes"));
        }
        let mut axes: alloc::vec::Vec<usize> = (0..rank).collect();
        axes.swap(rank - 1, rank - 2);
        self.permute(&axes)
    }

    /// Stretches to `extents`: axes are aligned at the end, missing ones and those of extent 1 stretch.
    ///
    /// # Errors
    /// [`TensorError::Dims`] if another axis would have to change.
    pub fn expand(&self, extents: &[usize]) -> Result<Self, TensorError> {
        let right = Dims::new(extents)?;
        if self.dims().broadcast(&right) != Some(right) {
            let must = "each extent must equal the other's, or be 1 in the first";
            return Err(TensorError::dims("expand", self.dims(), &right, must));
        }
        if right == *self.dims() {
            return Ok(self.clone());
        }
        Self::wrap("expand", B::expand(self.with_rank(right.rank())?.array(), &right))
    }

    /// `len` indices of `axis` from `start` on.
    ///
    /// # Errors
    /// [`TensorError::Axis`], [`TensorError::Range`].
    pub fn slice(&self, axis: usize, start: usize, len: usize) -> Result<Self, TensorError> {
        let extent = self.check_axis("slice", axis)?;
        match start.checked_add(len) {
            Some(end) if end <= extent => {}
            _ => return Err(TensorError::Range { op: "slice", index: extent.max(start), axis, dims: *self.dims() }),
        }
        if len == extent { Ok(self.clone()) } else { Self::wrap("slice", B::slice(self.array(), axis, start, len)) }
    }

    /// The tensors one after the other along `axis`.
    ///
    /// # Errors
    /// [`TensorError::Operand`] without a tensor; [`TensorError::Dims`] if another extent differs;
    /// [`TensorError::Axis`], [`TensorError::DTypes`], [`TensorError::Devices`].
    pub fn concat(tensors: &[&Self], axis: usize) -> Result<Self, TensorError> {
        let Some((first, rest)) = tensors.split_first() else {
            return Err(TensorError::Operand { op: "concat", dims: Dims::SCALAR, must: "needs at least one tensor" });
        };
        let extent = first.check_axis("concat", axis)?;
        for other in rest {
            first.check_pair("concat", other)?;
            if other.dims().with(axis, extent) != *first.dims() {
                let must = "all extents but that of the axis must be equal";
                return Err(TensorError::dims("concat", first.dims(), other.dims(), must));
            }
        }
        if rest.is_empty() {
            return Ok((*first).clone());
        }
        let arrays: alloc::vec::Vec<&B::Array> = tensors.iter().map(|tensor| tensor.array()).collect();
        Self::wrap("concat", B::concat(&arrays, axis))
    }

    /// The given indices of `axis`, in their order; an index may come more than once.
    ///
    /// # Errors
    /// [`TensorError::Axis`], [`TensorError::Range`].
    pub fn select(&self, axis: usize, indices: &[usize]) -> Result<Self, TensorError> {
        let extent = self.check_axis("select", axis)?;
        if let Some(&index) = indices.iter().find(|&&index| index >= extent) {
            return Err(TensorError::Range { op: "select", index, axis, dims: *self.dims() });
        }
        Self::wrap("select", B::select(self.array(), axis, indices))
    }
}
