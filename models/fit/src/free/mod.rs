//! From edge samples to an outline of unknown shape.
//!
//! In: the samples of one segment. Out: an [`Efd`](dvp_core::Efd) with its pose, with as few harmonics as the samples
//! support. `start` traces a first outline, `loops` cuts off where it crosses itself, `polygon_fit` moves its vertices and
//! `outline_fit` its center and coefficients until it lies at the sampled distances (`foot` measures them, `basis` is the Fourier
//! basis), `forecast` tells what fewer harmonics would miss, and `grow` decides how many pay. Where others hide the outline, it
//! goes on the shortest way.

pub(crate) mod basis;
pub(crate) mod foot;
mod forecast;
pub(crate) mod grow;
mod loops;
pub(crate) mod outline_fit;
pub(crate) mod polygon_fit;
pub(crate) mod start;
#[cfg(test)]
mod tests;
