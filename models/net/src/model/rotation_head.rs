//! Latents to angles.

use dvp_core::diff_op::Atan2;
use dvp_core::real::Real;
use dvp_core::shape::{PrototypeBank, SYMMETRY_TOLERANCE, Symmetry};
use dvp_core::tensor::{Backend, Tensor, TensorError};

use super::config::{ModelConfig, RotationHead, ShapeHead};
use crate::error::{NetError, require};
use crate::layers::Mlp;
use crate::weights::Weights;

/// What tells rotations: a perceptron to the sine and cosine of an angle, or of one per prototype.
#[derive(Clone, Debug)]
pub(super) struct RotationReader<B: Backend> {
    head: Mlp<B>,
    /// Shares of a turn that the angle of each prototype stands for, 1 x 1 x prototypes.
    shares: Option<Tensor<B>>,
}

impl<B: Backend> RotationReader<B> {
    pub(super) fn load<T: Real>(
        config: &ModelConfig,
        bank: &PrototypeBank<T>,
        weights: &Weights<'_, B>,
    ) -> Result<Self, NetError> {
        let (width, wide) = (config.transformer.d_model, config.head_width);
        let head = |outputs| Mlp::load(weights, &[width, wide, wide, outputs]);
        match config.rotation {
            RotationHead::Plain => Ok(Self { head: head(2)?, shares: None }),
            RotationHead::BySymmetry => {
                let known = config.shape == ShapeHead::Prototypes;
                require(known, "rotation", "by_symmetry", "symmetries are those of prototypes: shape must be so too")?;
                let share = |efd: &dvp_core::shape::Efd<T>| match efd.symmetry(T::of(SYMMETRY_TOLERANCE)) {
                    Symmetry::Finite(order) => 1.0 / order.max(1) as f64,
                    Symmetry::Continuous => 1.0,
                };
                let shares: Vec<f64> = bank.prototypes().iter().map(share).collect();
                let head = head(2 * shares.len())?;
                let count = shares.len();
                let shares = head.like(shares, &[1, 1, count])?;
                Ok(Self { head, shares: Some(shares) })
            }
        }
    }

    /// Latents, batch x objects x width, and the weights of prototypes, batch x objects x prototypes, to angles, batch x
    /// objects, radians. Of one angle per prototype that of the heaviest is taken.
    ///
    /// *Derivative*: with respect to the angle that was taken, not to the choice.
    pub(super) fn forward<T: Real>(
        &self,
        x: &Tensor<B>,
        prototypes: Option<&Tensor<B>>,
    ) -> Result<Tensor<B>, NetError> {
        let pairs = self.head.forward(x)?.tanh()?;
        let &[batch, objects, outputs] = pairs.dims().extents() else {
            return Err(NetError::Input { input: "latents", dims: *x.dims(), must: "must be batch x objects x width" });
        };
        let count = outputs / 2;
        let op = Atan2::new(&[objects, count]).map_err(TensorError::from)?;
        let angles = Tensor::apply::<T, _>(op, &[&pairs.slice(2, 0, count)?, &pairs.slice(2, count, count)?])?;
        match (&self.shares, prototypes) {
            (Some(shares), Some(weights)) => {
                let chosen = weights.max_detached(2)?.greater(&weights.detach()?)?.affine(-1.0, 1.0)?;
                let angles = angles.mul(shares)?.mul(&chosen)?.sum(2)?;
                Ok(angles.reshape(&[batch, objects])?)
            }
            _ => Ok(angles.reshape(&[batch, objects])?),
        }
    }
}
