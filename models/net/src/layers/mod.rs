//! What the models are made of. Inputs are batch x tokens x width; a batch of 1 stretches.
//!
//! | file | holds |
//! |---|---|
//! | `linear` | [`Linear`]: x W^T + b |
//! | `layer_norm` | [`LayerNorm`] |
//! | `mlp` | [`Mlp`]: linear maps with ReLU between |
//! | `attention` | [`attend`]: attention of several heads |
//! | `gru` | a gated recurrent unit |
//! | `batch_norm` | [`BatchNorm`] |
//! | `convolution`, `instance_norm`, `nearest` | images: kernels, norms per channel, half and twice the size |
//! | `bicubic` | resampling along an axis |
//!
//! Weights have the names and the orientation of PyTorch's modules.

mod attention;
mod batch_norm;
mod bicubic;
mod convolution;
mod gru;
mod instance_norm;
mod layer_norm;
mod linear;
mod mlp;
mod nearest;
#[cfg(test)]
mod tests;

pub use attention::attend;
pub(crate) use attention::join_heads;
pub use batch_norm::{BatchNorm, Normed, Phase};
pub(crate) use bicubic::{Taps, bicubic, taps};
pub(crate) use convolution::Convolution;
pub(crate) use gru::Gru;
pub(crate) use instance_norm::InstanceNorm;
pub use layer_norm::LayerNorm;
pub use linear::Linear;
pub use mlp::Mlp;
pub(crate) use nearest::{halved, places, repeated};
