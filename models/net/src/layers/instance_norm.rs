//! Instance norm with weights.

use dvp_core::real::DType;
use dvp_core::tensor::{Backend, InstanceNormOp, Tensor, TensorError};

use crate::error::NetError;
use crate::weights::Weights;

/// Added to the variance.
const EPSILON: f64 = 1e-5;

/// Each channel of each image with mean 0 and variance 1 over its pixels, times a weight plus a bias.
///
/// *Source*: Ulyanov, Vedaldi, Lempitsky: Instance Normalization (2016).
#[derive(Clone, Debug)]
pub(crate) struct InstanceNorm<B: Backend> {
    weight: Tensor<B>,
    bias: Tensor<B>,
}

impl<B: Backend> InstanceNorm<B> {
    /// Takes `weight` and `bias`, both of `channels` numbers.
    ///
    /// # Errors
    /// As [`Weights::get`].
    pub(crate) fn load(weights: &Weights<'_, B>, channels: usize) -> Result<Self, NetError> {
        Ok(Self { weight: weights.get("weight", &[channels])?, bias: weights.get("bias", &[channels])? })
    }

    /// batch x channels x h x w to the same extents.
    ///
    /// # Errors
    /// [`TensorError::Operand`] if the rank is not 4; as [`Tensor::apply`].
    pub(crate) fn forward(&self, x: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        let &[batch, channels, h, w] = x.dims().extents() else {
            let must = "must be batch x channels x h x w";
            return Err(TensorError::Operand { op: "instance_norm", dims: *x.dims(), must });
        };
        let of_each = |numbers: &Tensor<B>| numbers.expand(&[batch, channels]);
        let inputs = [&x.reshape(&[batch, channels, h * w])?, &of_each(&self.weight)?, &of_each(&self.bias)?];
        let op = InstanceNormOp::new(channels, h * w, EPSILON)?;
        let normed = match x.dtype() {
            DType::F32 => Tensor::apply::<f32, _>(op, &inputs)?,
            DType::F64 => Tensor::apply::<f64, _>(op, &inputs)?,
        };
        normed.reshape(&[batch, channels, h, w])
    }
}
