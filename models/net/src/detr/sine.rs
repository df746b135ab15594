//! Positions as sines and cosines.

use core::f64::consts::{FRAC_PI_2, TAU};

use dvp_core::tensor::{Backend, Tensor, TensorError, Unary};

/// Ratio of the longest wave to the shortest, as in the papers.
const TEMPERATURE: f64 = 10_000.0;

/// Points (x, y), .. x 2 in units of the image, as .. x `width` numbers: the waves of y, then those of x. `width` is a
/// multiple of 4.
///
/// *Source*: Vaswani et al.: Attention Is All You Need (2017), section 3.5, over angles of 2 pi per image.
///
/// # Errors
/// [`TensorError::Axis`], [`TensorError::Range`] if there are no two coordinates.
pub(super) fn embed_points<B: Backend>(points: &Tensor<B>, width: usize) -> Result<Tensor<B>, TensorError> {
    let Some(last) = points.dims().rank().checked_sub(1) else {
        return Err(TensorError::Operand { op: "embed_points", dims: *points.dims(), must: "must be .. x 2" });
    };
    let half = width / 2;
    let frequencies = (0..half).map(|k| TAU / TEMPERATURE.powf((2 * (k / 2)) as f64 / half as f64)).collect();
    // Every other number is a cosine: a sine a quarter turn ahead.
    let phases = (0..half).map(|k| if k % 2 == 0 { 0.0 } else { FRAC_PI_2 }).collect();
    let (frequencies, phases) = (points.like(frequencies, &[half])?, points.like(phases, &[half])?);
    let waves = |axis| points.slice(last, axis, 1)?.mul(&frequencies)?.add(&phases)?.unary(Unary::Sin);
    Tensor::concat(&[&waves(1)?, &waves(0)?], last)
}

/// The cells of a grid, row by row: 1 x `rows` * `columns` x `width`, in the type and on the device of `like`.
///
/// A cell counts as its lower right corner.
///
/// *Source*: the public implementation, which counts cells from 1 and adds 1e-6 to the divisor.
///
/// # Errors
/// If the framework refuses.
pub(super) fn embed_grid<B: Backend>(
    rows: usize,
    columns: usize,
    width: usize,
    like: &Tensor<B>,
) -> Result<Tensor<B>, TensorError> {
    let at = |k: usize, count: usize| (k + 1) as f64 / (count as f64 + 1e-6);
    let cells = (0..rows).flat_map(|row| (0..columns).flat_map(move |column| [at(column, columns), at(row, rows)]));
    embed_points(&like.like(cells.collect(), &[1, rows * columns, 2])?, width)
}
