//! Latents to shapes.

use dvp_core::dims::Dims;
use dvp_core::real::Real;
use dvp_core::shape::PrototypeBank;
use dvp_core::tensor::{Backend, Tensor, TensorError};

use super::config::{ModelConfig, ShapeHead};
use crate::error::{NetError, require};
use crate::layers::{LayerNorm, Linear, Mlp};
use crate::weights::Weights;

/// Bounds of a prototype's weight.
///
/// *Source*: the paper's implementation.
const WEIGHT_BOUNDS: [f64; 2] = [1e-4, 0.9999];
/// Added to variances: PyTorch's default.
const NORM_EPSILON: f64 = 1e-5;

/// What tells shapes.
#[derive(Clone, Debug)]
pub(super) enum ShapeReader<B: Backend> {
    /// Attention of a latent to the prototypes of a bank.
    Prototypes(Box<Attention<B>>),
    /// The descriptors after the first ellipse's position and size, which normal forms fix.
    Direct { head: Mlp<B>, harmonics: usize },
}

/// What latents and prototypes are compared by.
#[derive(Clone, Debug)]
pub(super) struct Attention<B: Backend> {
    query: Projector<B>,
    key: Projector<B>,
    /// Descriptors, prototypes x 4 harmonics.
    bank: Tensor<B>,
}

/// Layer norm, a linear map, GELU.
#[derive(Clone, Debug)]
pub(super) struct Projector<B: Backend> {
    norm: LayerNorm<B>,
    linear: Linear<B>,
}

impl<B: Backend> Projector<B> {
    fn load(weights: &Weights<'_, B>, inputs: usize, outputs: usize) -> Result<Self, NetError> {
        Ok(Self {
            norm: LayerNorm::load(&weights.under("norm"), inputs, NORM_EPSILON)?,
            linear: Linear::load(&weights.under("linear"), inputs, outputs)?,
        })
    }

    fn forward(&self, x: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        self.linear.forward(&self.norm.forward(x)?)?.gelu()
    }
}

impl<B: Backend> ShapeReader<B> {
    pub(super) fn load<T: Real>(
        config: &ModelConfig,
        bank: &PrototypeBank<T>,
        weights: &Weights<'_, B>,
    ) -> Result<Self, NetError> {
        let (width, wide) = (config.transformer.d_model, config.head_width);
        match config.shape {
            ShapeHead::Direct { harmonics } => {
                let head = Mlp::load(weights, &[width, wide, wide, 4 * harmonics - 3])?;
                Ok(Self::Direct { head, harmonics })
            }
            ShapeHead::Prototypes => {
                let prototypes = bank.prototypes();
                require(!prototypes.is_empty(), "shape", "prototypes", "the bank must hold at least one prototype")?;
                let len = 4 * bank.harmonic_count();
                let query = Projector::load(&weights.under("query"), width, wide)?;
                let key = Projector::load(&weights.under("key"), len, wide)?;
                let rows = |efd: &dvp_core::shape::Efd<T>| {
                    let mut rows: Vec<T> = efd.rows().as_flattened().to_vec();
                    rows.resize(len, T::zero());
                    rows
                };
                let values = T::into_values(prototypes.iter().flat_map(rows).collect());
                let dims = Dims::new(&[prototypes.len(), len]).map_err(TensorError::from)?;
                // In the type and on the device of the weights.
                let like = query.linear.bias();
                let bank = Tensor::from_values(values.cast(like.dtype()), &dims, &like.device())?;
                Ok(Self::Prototypes(Box::new(Attention { query, key, bank })))
            }
        }
    }

    /// Latents, batch x objects x width, to descriptors in normal form, batch x objects x harmonics x 4, and the weights
    /// of the prototypes that they were mixed with, batch x objects x prototypes.
    pub(super) fn forward(&self, x: &Tensor<B>) -> Result<(Tensor<B>, Option<Tensor<B>>), NetError> {
        let &[batch, objects, _] = x.dims().extents() else {
            return Err(NetError::Input { input: "latents", dims: *x.dims(), must: "must be batch x objects x width" });
        };
        match self {
            Self::Prototypes(attention) => {
                let Attention { query, key, bank } = &**attention;
                let count = bank.dims().get(0).unwrap_or(1);
                let harmonics = bank.dims().get(1).unwrap_or(0) / 4;
                let scores = query.forward(x)?.matmul(&key.forward(bank)?.transpose()?)?;
                let weights = scores.affine((count as f64).sqrt().recip(), 0.0)?.softmax(2)?;
                let [low, high] = WEIGHT_BOUNDS;
                let weights = weights.clamp(low, high)?;
                // Mixtures of normal forms are normal forms: the first ellipse has its length 1 and angle 0 in all.
                let mixed = weights.matmul(bank)?.reshape(&[batch, objects, harmonics, 4])?;
                Ok((mixed, Some(weights)))
            }
            Self::Direct { head, harmonics } => {
                let free = head.forward(x)?.tanh()?;
                let first = x.like([1.0, 0.0, 0.0].repeat(batch * objects), &[batch, objects, 3])?;
                let rows = Tensor::concat(&[&first, &free], 2)?;
                Ok((rows.reshape(&[batch, objects, *harmonics, 4])?, None))
            }
        }
    }
}
