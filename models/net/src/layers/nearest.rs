//! Images of half and of twice the size, and where their pixels are.

use dvp_core::tensor::{Backend, Tensor, TensorError};

/// The upper left one of every 2 x 2 pixels: batch x c x h x w to half of h and w, which must be even.
///
/// # Errors
/// [`TensorError::Operand`] if the rank is not 4 or a side is odd.
pub(crate) fn halved<B: Backend>(x: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
    match *x.dims().extents() {
        [batch, c, h, w] if h.is_multiple_of(2) && w.is_multiple_of(2) => {
            let rows = x.reshape(&[batch, c, h / 2, 2 * w])?.slice(3, 0, w)?;
            rows.reshape(&[batch, c, h / 2, w / 2, 2])?.slice(4, 0, 1)?.reshape(&[batch, c, h / 2, w / 2])
        }
        _ => {
            let must = "must be batch x c x h x w with even sides";
            Err(TensorError::Operand { op: "halved", dims: *x.dims(), must })
        }
    }
}

/// Every pixel `times` times both ways: batch x c x h x w to times h and w.
///
/// # Errors
/// [`TensorError::Operand`] if the rank is not 4.
pub(crate) fn repeated<B: Backend>(x: &Tensor<B>, times: usize) -> Result<Tensor<B>, TensorError> {
    let &[batch, c, h, w] = x.dims().extents() else {
        return Err(TensorError::Operand { op: "repeated", dims: *x.dims(), must: "must be batch x c x h x w" });
    };
    if times == 1 {
        return Ok(x.clone());
    }
    let wide = x.reshape(&[batch * c * h, 1, w, 1])?.expand(&[batch * c * h, times, w, times])?;
    wide.reshape(&[batch, c, times * h, times * w])
}

/// Horizontal, then vertical places of a grid, -1 to 1 between the borders of the image.
pub(crate) fn places(rows: usize, columns: usize) -> Vec<f64> {
    let place = |k: usize, count: usize| (2 * k + 1) as f64 / count as f64 - 1.0;
    let cells = || (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    cells().map(|(_, column)| place(column, columns)).chain(cells().map(|(row, _)| place(row, rows))).collect()
}
