//! The position table, resampled to the patches of an image.

use dvp_core::tensor::{Backend, Tensor, TensorError};

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

/// Weights of `from` samples in each of `to`, `to` x `from`; each row sums to 1.
///
/// Sample k lies at k + 1/2 of as many; where samples get fewer, the kernel is stretched by as much, so that none is
/// passed over.
pub(super) fn bicubic(from: usize, to: usize) -> Vec<f64> {
    let step = from as f64 / to as f64;
    let stretch = step.max(1.0);
    let mut weights = Vec::with_capacity(from * to);
    for k in 0..to {
        let center = step * (k as f64 + 0.5);
        let row: Vec<f64> = (0..from).map(|j| cubic((j as f64 + 0.5 - center) / stretch)).collect();
        let sum: f64 = row.iter().sum();
        weights.extend(row.iter().map(|weight| weight / sum));
    }
    weights
}

/// Keys' cubic kernel of slope -1/2 at 1: 1 at 0, 0 at the other whole numbers and beyond 2.
///
/// *Source*: Keys: Cubic convolution interpolation for digital image processing (1981), eq. 15.
fn cubic(x: f64) -> f64 {
    let x = x.abs();
    if x < 1.0 {
        (1.5 * x - 2.5) * x * x + 1.0
    } else if x < 2.0 {
        ((2.5 - 0.5 * x) * x - 4.0) * x + 2.0
    } else {
        0.0
    }
}
