//! From edge samples to an outline of unknown shape.
//!
//! `basis` is the Fourier basis at the vertices, `outline_fit` moves center and coefficients, `solve` is its Cholesky.

mod basis;
mod outline_fit;
mod solve;
