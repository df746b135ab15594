//! Adam on flat slices, and its descent of a scene's image loss.
//!
//! In: a parameter slice and its gradient. Out: the slice after one step. `tests/golden/optim.rs` holds the numbers of
//! PyTorch.
//!
//! | file | |
//! |---|---|
//! | `mod` | [`Adam`] |
//! | `descent` | Adam joined with a renderer, the schedule of [`dvp_core::optim`] and the vector of [`crate::parameters`] |
//! | `fixed_shapes` | drawings while the shapes stay |
//! | `contour_length` | the price on long outlines |

pub mod contour_length;
pub mod descent;
pub mod fixed_shapes;
#[cfg(test)]
mod tests;

use alloc::vec::Vec;

use dvp_core::Real;

pub use dvp_core::optim::AdamSettings;

/// Adam with bias correction, as PyTorch computes it:
/// p <- p - lr / (1 - beta1^k) m / (sqrt(v) / sqrt(1 - beta2^k) + epsilon).
///
/// *Source*: Kingma and Ba, Adam: a method for stochastic optimization, ICLR 2015; epsilon stands outside the root.
#[derive(Clone, Debug, Default)]
pub struct Adam<T> {
    settings: AdamSettings,
    mean: Vec<T>,
    square: Vec<T>,
    // beta1^k and beta2^k: kept in f64, because 1 - beta2 has three digits only in f32.
    decay1: f64,
    decay2: f64,
}

impl<T: Real> Adam<T> {
    /// An optimizer for `parameter_count` parameters.
    #[must_use]
    pub fn new(settings: AdamSettings, parameter_count: usize) -> Self {
        let mut adam = Self { settings, mean: Vec::new(), square: Vec::new(), decay1: 1.0, decay2: 1.0 };
        adam.reset(parameter_count);
        adam
    }

    /// Forgets every step; allocates only if `parameter_count` is larger than ever before.
    pub fn reset(&mut self, parameter_count: usize) {
        for moment in [&mut self.mean, &mut self.square] {
            moment.clear();
            moment.resize(parameter_count, T::zero());
        }
        (self.decay1, self.decay2) = (1.0, 1.0);
    }

    /// One step down `gradient`. Parameters beyond the length given to [`Self::reset`], or without a gradient, stay.
    pub fn step(&mut self, parameters: &mut [T], gradient: &[T], learning_rate: f64) {
        let AdamSettings { beta1, beta2, epsilon, .. } = self.settings;
        self.decay1 *= beta1;
        self.decay2 *= beta2;
        let rate = T::of(learning_rate / (1.0 - self.decay1));
        let root = T::of(1.0 / num_traits::Float::sqrt(1.0 - self.decay2));
        let (keep1, take1, keep2, take2) = (T::of(beta1), T::of(1.0 - beta1), T::of(beta2), T::of(1.0 - beta2));
        let epsilon = T::of(epsilon);
        let moments = self.mean.iter_mut().zip(&mut self.square);
        for ((value, &slope), (mean, square)) in parameters.iter_mut().zip(gradient).zip(moments) {
            *mean = keep1 * *mean + take1 * slope;
            *square = keep2 * *square + take2 * slope * slope;
            *value -= rate * *mean / (square.sqrt() * root + epsilon);
        }
    }
}
