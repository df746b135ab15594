//! From edge samples to an outline of unknown shape.
//!
//! In: the samples of one segment. Out: an [`Efd`](dvp_core::Efd) with its pose, with as few harmonics as the samples
//! support. `start` traces a first outline, `outline_fit` moves center and coefficients until it lies at the sampled
//! distances (on the Fourier `basis`), `grow` adds harmonics while they pay.

pub(crate) mod basis;
pub(crate) mod grow;
pub(crate) mod outline_fit;
pub(crate) mod start;
