//! The position table, resampled to the patches of an image.

use dvp_core::tensor::{Backend, Tensor, TensorError};

use crate::layers::bicubic;

/// The table, side x side x width in rows of patches, at `rows` x `columns` patches: rows * columns x width.
///
/// *Source*: the public implementation: PyTorch's bicubic `interpolate` with antialiasing. The table comes out
/// unchanged for its own extents.
///
/// # Errors
/// [`TensorError::Dims`] if the table has other extents.
pub(super) fn resample<B: Backend>(
    table: &Tensor<B>,
    side: usize,
    rows: usize,
    columns: usize,
    width: usize,
) -> Result<Tensor<B>, TensorError> {
    let table = table.reshape(&[side, side * width])?;
    let vertical = table.like(bicubic(side, rows), &[rows, side])?;
    let horizontal = table.like(bicubic(side, columns), &[columns, side])?;
    let tall = vertical.matmul(&table)?.reshape(&[rows, side, width])?;
    horizontal.reshape(&[1, columns, side])?.matmul(&tall)?.reshape(&[rows * columns, width])
}
