//! Adam on named parameters, written on tensors: the same numbers on every backend.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::String;

use super::backend::Backend;
use super::error::TensorError;
use super::handle::Tensor;
use super::parameters::{Parameters, ParametersError};
use crate::optim::AdamSettings;

/// What moments are called.
const KINDS: [&str; 2] = ["mean", "square"];

/// Adam with bias correction:
/// p <- p - lr / (1 - beta1^k) m / (sqrt(v) / sqrt(1 - beta2^k) + epsilon).
///
/// *Source*: Kingma and Ba, Adam: a method for stochastic optimization, ICLR 2015; epsilon stands outside the root.
#[derive(Clone, Debug)]
pub struct Adam<B: Backend> {
    settings: AdamSettings,
    /// Means of the gradient and of its square, by name.
    moments: BTreeMap<String, [Tensor<B>; 2]>,
    /// Steps made, k.
    steps: u32,
}

impl<B: Backend> Adam<B> {
    /// An optimizer that has made no step.
    #[must_use]
    pub fn new(settings: AdamSettings) -> Self {
        Self { settings, moments: BTreeMap::new(), steps: 0 }
    }

    /// Steps made.
    #[must_use]
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// The means of gradients, `mean.NAME`, and of their squares, `square.NAME`: with [`Self::steps`] all that
    /// [`Self::resume`] needs to go on to the same numbers.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn moments(&self) -> Result<Parameters<B>, TensorError> {
        let mut all = Parameters::new();
        for (name, moments) in &self.moments {
            for (kind, tensor) in KINDS.into_iter().zip(moments) {
                all.insert(format!("{kind}.{name}"), tensor)?;
            }
        }
        Ok(all)
    }

    /// The optimizer that has made `steps` steps and has these [`Self::moments`].
    ///
    /// # Errors
    /// [`ParametersError::Missing`] if one of a pair is not there, [`ParametersError::Unexpected`] for another name.
    pub fn resume(settings: AdamSettings, steps: u32, moments: &Parameters<B>) -> Result<Self, ParametersError> {
        let mut adam = Self { steps, ..Self::new(settings) };
        for (name, _) in moments.iter() {
            let kind = KINDS.into_iter().find_map(|kind| name.strip_prefix(kind)?.strip_prefix('.'));
            let Some(own) = kind else { return Err(ParametersError::Unexpected { name: name.into() }) };
            let [mean, square] = KINDS.map(|kind| moments.get(&format!("{kind}.{own}")));
            adam.moments.insert(own.into(), [mean?.detach()?, square?.detach()?]);
        }
        Ok(adam)
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
        self.steps = self.steps.saturating_add(1);
        let left = |beta: f64| 1.0 - num_traits::pow(beta, self.steps as usize);
        let rate = learning_rate / left(beta1);
        let root = 1.0 / num_traits::Float::sqrt(left(beta2));
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
