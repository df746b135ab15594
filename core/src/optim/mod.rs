//! What optimizers share, whatever they step: settings of Adam, and a learning rate that is cut when the loss stops falling.
//!
//! | file | holds |
//! |---|---|
//! | `mod` | [`AdamSettings`] |
//! | `plateau` | [`Plateau`], [`PlateauSettings`] |
//!
//! `tests/golden/optim.rs` holds PyTorch's numbers.

mod plateau;

pub use plateau::{Plateau, PlateauSettings};

/// Settings of Adam, on slices or on tensors ([`crate::tensor::Adam`]); the defaults are PyTorch's. To change some: start
/// with the default, set fields.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct AdamSettings {
    /// Decay of the mean of the gradient, [0, 1).
    pub beta1: f64,
    /// Decay of the mean of the squared gradient, [0, 1).
    pub beta2: f64,
    /// Added to the root of the squared mean; above 0.
    pub epsilon: f64,
}

impl Default for AdamSettings {
    fn default() -> Self {
        Self { beta1: 0.9, beta2: 0.999, epsilon: 1e-8 }
    }
}
