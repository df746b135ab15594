//! The one ruler: description length in bits.
//!
//! `bits = chi2 / (2 ln 2) + sum over numbers of log2(range / (sqrt(2 pi) sigma)) + structure`: what the samples miss by, what
//! the numbers cost that are needed to say where the outline is. A number that the picture pins down to sigma is worth the
//! logarithm of how many places it could have been told apart from; one that cannot be seen costs nothing.

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::tuning;

/// The price of misfits and numbers in one picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ruler {
    /// Range of positions and lengths: the larger side of the picture, pixels.
    pub extent: f64,
}

impl Ruler {
    /// Bits of a sum of squared misfits, each divided by its variance.
    #[must_use]
    pub fn misfit(&self, chi2: f64) -> f64 {
        chi2 * (0.5 * core::f64::consts::LOG2_E)
    }

    /// Bits of a position or length that is known to `sigma` pixels.
    #[must_use]
    pub fn number(&self, sigma: f64) -> f64 {
        let places = self.extent / ((2.0 * core::f64::consts::PI).sqrt() * sigma.max(tuning::RENDERER_SIGMA * 0.1));
        places.max(1.0).log2()
    }
}
