//! Products of matrices, and convolution.

use alloc::vec::Vec;

use super::backend::{Backend, Stride};
use super::error::TensorError;
use super::handle::Tensor;
use crate::dims::Dims;

impl<B: Backend> Tensor<B> {
    /// Products of matrices: .. x m x k times .. x k x n gives .. x m x n. The axes in front broadcast; a second operand
    /// of rank 2 multiplies all matrices of the first in one product.
    ///
    /// # Errors
    /// [`TensorError::Dims`] if the inner extents differ or the axes in front do not broadcast;
    /// [`TensorError::DTypes`], [`TensorError::Devices`].
    pub fn matmul(&self, other: &Self) -> Result<Self, TensorError> {
        self.check_pair("matmul", other)?;
        let (left, right) = (*self.dims(), *other.dims());
        let refuse = |must| TensorError::dims("matmul", &left, &right, must);
        let (Some((m, k)), Some((k_other, n))) = (matrix(&left), matrix(&right)) else {
            return Err(refuse("both must have at least two axes"));
        };
        if k != k_other {
            return Err(refuse("the last extent of the first must be the last but one of the second"));
        }
        let front = |dims: &Dims| Dims::new(&dims.extents()[..dims.rank() - 2]);
        let (front_left, front_right) = (front(&left)?, front(&right)?);
        if right.rank() == 2 {
            // One product of all rows; batches of one matrix would copy it.
            let rows = front_left.len() * m;
            let product = self.reshape(&[1, rows, k])?.product(&other.reshape(&[1, k, n])?)?;
            return product.reshape(&matrices(&front_left, m, n));
        }
        let batch = front_left.broadcast(&front_right).ok_or_else(|| refuse("the axes in front must broadcast"))?;
        let a = self.expand(&matrices(&batch, m, k))?.reshape(&[batch.len(), m, k])?;
        let b = other.expand(&matrices(&batch, k, n))?.reshape(&[batch.len(), k, n])?;
        a.product(&b)?.reshape(&matrices(&batch, m, n))
    }

    fn product(&self, other: &Self) -> Result<Self, TensorError> {
        Self::wrap("matmul", B::matmul(self.array(), other.array()))
    }

    /// Cross-correlation of images, batch x c x h x w, with kernels o x c x kh x kw: batch x o x rows x columns. The
    /// padding is zeros.
    ///
    /// # Errors
    /// [`TensorError::Dims`] if the ranks are not 4, the channels differ or the kernel is larger than the padded image;
    /// [`TensorError::DTypes`], [`TensorError::Devices`].
    pub fn conv2d(&self, kernels: &Self, stride: Stride) -> Result<Self, TensorError> {
        self.check_pair("conv2d", kernels)?;
        let (left, right) = (*self.dims(), *kernels.dims());
        let refuse = |must| Err(TensorError::dims("conv2d", &left, &right, must));
        let (&[_, c, h, w], &[_, kernel_c, kh, kw]) = (left.extents(), right.extents()) else {
            return refuse("images must be batch x c x h x w, kernels o x c x kh x kw");
        };
        if c != kernel_c {
            return refuse("images and kernels must have the same channels, their second extents");
        }
        if kh == 0 || kw == 0 || stride.windows(h, kh) == 0 || stride.windows(w, kw) == 0 {
            return refuse("the kernel must fit into the padded image, with steps of at least 1");
        }
        Self::wrap("conv2d", B::conv2d(self.array(), kernels.array(), stride))
    }
}

/// Rows and columns of the last two axes.
fn matrix(dims: &Dims) -> Option<(usize, usize)> {
    match dims.extents() {
        [.., rows, columns] => Some((*rows, *columns)),
        _ => None,
    }
}

fn matrices(front: &Dims, rows: usize, columns: usize) -> Vec<usize> {
    let mut extents = front.extents().to_vec();
    extents.extend([rows, columns]);
    extents
}
