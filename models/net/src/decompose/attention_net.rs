//! The attention of MONet: which pixels of what is left belong to the next part.

use dvp_core::tensor::{Backend, Stride, Tensor, TensorError};

use crate::error::NetError;
use crate::layers::{Convolution, InstanceNorm, Mlp, halved, repeated};
use crate::weights::Weights;

/// Kernels of 3 x 3 that keep the size.
const SAME: Stride = Stride { step: 1, padding: 1 };

/// A U-Net: blocks of a convolution, instance norm and ReLU; between two blocks the image is halved, on the way up doubled;
/// each block of the way up sees what the one of its size saw on the way down; a perceptron between the smallest two.
///
/// *Source*: Burgess et al.: MONet (2019), appendix B.2.
#[derive(Clone, Debug)]
pub(super) struct AttentionNet<B: Backend> {
    down: Vec<Block<B>>,
    middle: Mlp<B>,
    /// From the smallest to the largest.
    up: Vec<Block<B>>,
    last: Convolution<B>,
}

/// Convolution, instance norm, ReLU.
#[derive(Clone, Debug)]
struct Block<B: Backend> {
    convolution: Convolution<B>,
    norm: InstanceNorm<B>,
}

impl<B: Backend> Block<B> {
    fn load(weights: &Weights<'_, B>, from: usize, to: usize) -> Result<Self, NetError> {
        let convolution = Convolution::load_plain(&weights.under("convolution"), [from, to], 3, SAME)?;
        Ok(Self { convolution, norm: InstanceNorm::load(&weights.under("norm"), to)? })
    }

    fn forward(&self, x: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        self.norm.forward(&self.convolution.forward(x)?)?.relu()
    }
}

impl<B: Backend> AttentionNet<B> {
    /// Takes `down.K` and `up.K`, each a `convolution` and a `norm`, `middle.layers.K` and `last`. `side`: pixels along a side,
    /// a multiple of 2 for each block but the first.
    ///
    /// # Errors
    /// As [`Weights::get`].
    pub(super) fn load(
        weights: &Weights<'_, B>,
        side: usize,
        channels: &[usize],
        hidden: usize,
    ) -> Result<Self, NetError> {
        // The colors and the logarithm of the scope.
        let mut from = 4;
        let mut down = Vec::with_capacity(channels.len());
        for (k, &to) in channels.iter().enumerate() {
            down.push(Block::load(&weights.under(&format!("down.{k}")), from, to)?);
            from = to;
        }
        let smallest = side >> channels.len().saturating_sub(1);
        let numbers = from * smallest * smallest;
        let middle = Mlp::load(&weights.under("middle"), &[numbers, hidden, hidden, numbers])?;
        let mut up = Vec::with_capacity(channels.len());
        for (k, &own) in channels.iter().enumerate().rev() {
            let to = channels[k.saturating_sub(1)];
            up.push(Block::load(&weights.under(&format!("up.{k}")), from + own, to)?);
            from = to;
        }
        let last = Convolution::load(&weights.under("last"), [from, 1], 1, Stride { step: 1, padding: 0 })?;
        Ok(Self { down, middle, up, last })
    }

    /// Logarithms of the share that the next part takes of every pixel's scope, and of the share that it leaves.
    ///
    /// *Dimensions*: images batch x 3 x side x side, scope batch x 1 x side x side, as the results.
    ///
    /// # Errors
    /// As [`Tensor::conv2d`].
    pub(super) fn forward(&self, images: &Tensor<B>, log_scope: &Tensor<B>) -> Result<[Tensor<B>; 2], TensorError> {
        let mut x = Tensor::concat(&[images, log_scope], 1)?;
        let mut seen = Vec::with_capacity(self.down.len());
        for (k, block) in self.down.iter().enumerate() {
            x = block.forward(&if k == 0 { x } else { halved(&x)? })?;
            seen.push(x.clone());
        }
        let extents = x.dims().extents().to_vec();
        let batch = extents.first().copied().unwrap_or(1).max(1);
        let flat = x.reshape(&[batch, x.dims().len() / batch])?;
        x = self.middle.forward(&flat)?.relu()?.reshape(&extents)?;
        for (k, (block, seen)) in self.up.iter().zip(seen.iter().rev()).enumerate() {
            x = if k == 0 { x } else { repeated(&x, 2)? };
            x = block.forward(&Tensor::concat(&[&x, seen], 1)?)?;
        }
        let logit = self.last.forward(&x)?;
        // log sigmoid(x) = -softplus(-x), and log(1 - sigmoid(x)) = -softplus(x) = log sigmoid(x) - x.
        let taken = softplus(&logit.affine(-1.0, 0.0)?)?.affine(-1.0, 0.0)?;
        let left = taken.sub(&logit)?;
        Ok([taken, left])
    }
}

/// log(1 + e^x), without overflow.
///
/// Where no channel sees anything x is 0, or the bias. So nothing here may have a kink at 0, as max(x, 0) and |x| have, whose
/// derivatives are taken for 0 there: what is taken out of the powers is a constant.
fn softplus<B: Backend>(x: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
    let largest = x.relu()?.detach()?;
    let powers = largest.affine(-1.0, 0.0)?.exp()?.add(&x.sub(&largest)?.exp()?)?;
    powers.log()?.add(&largest)
}
