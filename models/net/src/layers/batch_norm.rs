//! Batch norm.

use dvp_core::tensor::{Backend, Tensor, TensorError};

use crate::error::NetError;
use crate::weights::Weights;

/// Added to variances: PyTorch's default.
const EPSILON: f64 = 1e-5;
/// Share of a batch in the running statistics: PyTorch's default.
const MOMENTUM: f64 = 0.1;

/// Which statistics norms go by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Those of the batch; running ones follow.
    Training,
    /// The running ones.
    Inference,
}

/// Channels of images with mean 0 and variance 1 over a batch, times a weight plus a bias.
///
/// *Source*: Ioffe and Szegedy: Batch Normalization (2015), with the constants of PyTorch.
#[derive(Clone, Debug)]
pub struct BatchNorm<B: Backend> {
    weight: Tensor<B>,
    bias: Tensor<B>,
    /// Mean and variance, constants.
    running: [Tensor<B>; 2],
}

/// What a [`BatchNorm`] makes of a batch: the batch, and in training the running mean and variance after it.
pub type Normed<B> = (Tensor<B>, Option<[Tensor<B>; 2]>);

impl<B: Backend> BatchNorm<B> {
    /// Names of the running mean and variance.
    pub const RUNNING: [&'static str; 2] = ["running_mean", "running_var"];

    /// Takes `weight`, `bias`, `running_mean` and `running_var`, all of `channels` numbers.
    ///
    /// # Errors
    /// As [`Weights::get`].
    pub fn load(weights: &Weights<'_, B>, channels: usize) -> Result<Self, NetError> {
        let row = |name| Ok::<_, NetError>(weights.get(name, &[channels])?.reshape(&[1, channels, 1, 1])?);
        let [mean, variance] = Self::RUNNING.map(row);
        Ok(Self { weight: row("weight")?, bias: row("bias")?, running: [mean?.detach()?, variance?.detach()?] })
    }

    /// batch x channels x rows x columns to the same extents; in training also the running mean and variance after this
    /// batch, each of `channels` numbers.
    ///
    /// *Derivative*: in training through the statistics of the batch too.
    ///
    /// # Errors
    /// As [`Tensor::permute`] and [`Tensor::mul`] for other extents.
    pub fn forward(&self, x: &Tensor<B>, phase: Phase) -> Result<Normed<B>, TensorError> {
        let [mean, variance] = match phase {
            Phase::Inference => self.running.clone(),
            Phase::Training => {
                let mean = x.mean(0)?.mean(2)?.mean(3)?;
                let centered = x.sub(&mean)?;
                [mean, centered.mul(&centered)?.mean(0)?.mean(2)?.mean(3)?]
            }
        };
        let normal = x.sub(&mean)?.div(&variance.affine(1.0, EPSILON)?.sqrt()?)?;
        let scaled = normal.mul(&self.weight)?.add(&self.bias)?;
        Ok((scaled, if phase == Phase::Training { Some(self.follow(x, [&mean, &variance])?) } else { None }))
    }

    /// The running statistics after a batch; of the variance that without bias, as PyTorch takes it.
    fn follow(&self, x: &Tensor<B>, [mean, variance]: [&Tensor<B>; 2]) -> Result<[Tensor<B>; 2], TensorError> {
        let count = x.dims().len() / mean.dims().len().max(1);
        let unbiased = count as f64 / count.saturating_sub(1).max(1) as f64;
        let blend = |running: &Tensor<B>, new: &Tensor<B>, factor: f64| {
            let sum = running.affine(1.0 - MOMENTUM, 0.0)?.add(&new.detach()?.affine(MOMENTUM * factor, 0.0)?)?;
            sum.reshape(&[sum.dims().len()])
        };
        Ok([blend(&self.running[0], mean, 1.0)?, blend(&self.running[1], variance, unbiased)?])
    }
}

#[cfg(test)]
mod tests {
    use dvp_core::tensor::{Host, HostDevice, Parameters};

    use super::*;

    fn norm(parameters: &Parameters<Host>) -> BatchNorm<Host> {
        BatchNorm::load(&Weights::new(parameters), 2).unwrap()
    }

    fn parameters() -> Parameters<Host> {
        let mut parameters = Parameters::new();
        for (name, values) in [
            ("weight", [2.0, 1.0]),
            ("bias", [0.5, 0.0]),
            ("running_mean", [1.0, 0.0]),
            ("running_var", [4.0 - EPSILON, 1.0]),
        ] {
            parameters.insert(name, &Tensor::new(values.to_vec(), &[2], &HostDevice).unwrap()).unwrap();
        }
        parameters
    }

    #[test]
    fn by_hand() {
        // Channel 0 holds 1 and 5 (mean 3, variance 4, unbiased 8), channel 1 holds 0 and 0.
        let x = Tensor::<Host>::new(vec![1.0_f64, 0.0, 5.0, 0.0], &[2, 2, 1, 1], &HostDevice).unwrap();
        let parameters = parameters();
        let (y, running) = norm(&parameters).forward(&x, Phase::Training).unwrap();
        for (found, expected) in y.to_f64().unwrap().iter().zip([-1.5, 0.0, 2.5, 0.0]) {
            assert!((found - expected).abs() < 1e-5, "{found} for {expected}");
        }
        let [mean, variance] = running.unwrap().map(|tensor| tensor.to_f64().unwrap());
        assert!((mean[0] - 1.2).abs() < 1e-12 && (variance[0] - (0.9 * (4.0 - EPSILON) + 0.8)).abs() < 1e-12);
        let (y, running) = norm(&parameters).forward(&x, Phase::Inference).unwrap();
        assert!(running.is_none());
        // (1 - 1) / 2 2 + 0.5 and (5 - 1) / 2 2 + 0.5.
        assert!((y.to_f64().unwrap()[2] - 4.5).abs() < 1e-12 && (y.to_f64().unwrap()[0] - 0.5).abs() < 1e-12);
    }
}
