//! Adam on named parameters, written on tensors: the same numbers on every backend.

use alloc::collections::BTreeMap;
use alloc::string::String;

use super::backend::Backend;
use super::error::TensorError;
use super::handle::Tensor;
use super::parameters::{Parameters, ParametersError};
use crate::optim::AdamSettings;

/// Adam with bias correction:
/// p <- p - lr / (1 - beta1^k) m / (sqrt(v) / sqrt(1 - beta2^k) + epsilon).
///
/// *Source*: Kingma and Ba, Adam: a method for stochastic optimization, ICLR 2015; epsilon stands outside the root.
#[derive(Clone, Debug)]
pub struct Adam<B: Backend> {
    settings: AdamSettings,
    /// Means of the gradient and of its square, by name.
    moments: BTreeMap<String, [Tensor<B>; 2]>,
    /// beta1^k and beta2^k.
    decay: [f64; 2],
}

impl<B: Backend> Adam<B> {
    /// An optimizer that has made no step.
    #[must_use]
    pub fn new(settings: AdamSettings) -> Self {
        Self { settings, moments: BTreeMap::new(), decay: [1.0; 2] }
    }

    /// One step down `gradients`, by name. Parameters without a gradient stay.
    ///
    /// # Errors
    /// [`ParametersError::Missing`] if a gradient belongs to no parameter, [`TensorError::Dims`] if its extents differ.
    pub fn step(
        &mut self,
        parameters: &mut Parameters<B>,
        gradients: &BTreeMap<String, Tensor<B>>,
        learning_rate: f64,
    ) -> Result<(), ParametersError> {
        let AdamSettings { beta1, beta2, epsilon } = self.settings;
        self.decay[0] *= beta1;
        self.decay[1] *= beta2;
        let rate = learning_rate / (1.0 - self.decay[0]);
        let root = 1.0 / num_traits::Float::sqrt(1.0 - self.decay[1]);
        for (name, gradient) in gradients {
            let parameter = parameters.get(name)?.detach()?;
            let square = gradient.mul(gradient)?;
            let (mean, square) = match self.moments.get(name) {
                Some([mean, mean_square]) => (blend(mean, gradient, beta1)?, blend(mean_square, &square, beta2)?),
                None => (gradient.affine(1.0 - beta1, 0.0)?, square.affine(1.0 - beta2, 0.0)?),
            };
            let step = mean.affine(rate, 0.0)?.div(&square.sqrt()?.affine(root, epsilon)?)?;
            parameters.set(name, &parameter.sub(&step)?)?;
            self.moments.insert(name.clone(), [mean, square]);
        }
        Ok(())
    }
}

/// keep x + (1 - keep) y.
fn blend<B: Backend>(x: &Tensor<B>, y: &Tensor<B>, keep: f64) -> Result<Tensor<B>, TensorError> {
    x.affine(keep, 0.0)?.add(&y.affine(1.0 - keep, 0.0)?)
}
