//! Sizes of the encoder.

use serde::{Deserialize, Serialize};

use crate::error::{NetError, require};

/// Sizes of a [`Dinov2`](super::Dinov2), under the keys of the published `config.json`; its other keys are passed over.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Dinov2Config {
    /// Numbers per token.
    pub hidden_size: usize,
    /// Blocks.
    pub num_hidden_layers: usize,
    /// Heads of each block's attention.
    pub num_attention_heads: usize,
    /// Width of a block's perceptron over that of a token.
    pub mlp_ratio: usize,
    /// The function between its two maps; only `gelu` is here.
    pub hidden_act: String,
    /// Added to variances.
    pub layer_norm_eps: f64,
    /// Side in pixels of the images that the position table was made for.
    pub image_size: usize,
    /// Side of a patch in pixels.
    pub patch_size: usize,
    /// Channels of an image.
    pub num_channels: usize,
    /// Whether queries, keys and values have biases; only models that have are here.
    pub qkv_bias: bool,
    /// Whether the perceptrons are gated; only models whose are not are here.
    pub use_swiglu_ffn: bool,
    /// Register tokens.
    pub num_register_tokens: usize,
}

impl Dinov2Config {
    /// Patches along a side of the images that the position table was made for.
    #[must_use]
    pub fn table_side(&self) -> usize {
        self.image_size / self.patch_size.max(1)
    }

    /// Checks that a model can be made of these sizes.
    ///
    /// # Errors
    /// [`NetError::Config`].
    pub fn validate(&self) -> Result<(), NetError> {
        let heads = self.num_attention_heads;
        require(self.hidden_size > 0, "hidden_size", self.hidden_size, "must be at least 1")?;
        let divides = heads > 0 && self.hidden_size.is_multiple_of(heads);
        require(divides, "num_attention_heads", heads, "must divide hidden_size")?;
        require(self.mlp_ratio > 0, "mlp_ratio", self.mlp_ratio, "must be at least 1")?;
        require(self.hidden_act == "gelu", "hidden_act", &self.hidden_act, "only gelu is supported")?;
        let positive = self.layer_norm_eps > 0.0 && self.layer_norm_eps.is_finite();
        require(positive, "layer_norm_eps", self.layer_norm_eps, "must be a positive number")?;
        require(self.patch_size > 0, "patch_size", self.patch_size, "must be at least 1")?;
        require(self.table_side() > 0, "image_size", self.image_size, "must be at least patch_size")?;
        require(self.num_channels > 0, "num_channels", self.num_channels, "must be at least 1")?;
        require(self.qkv_bias, "qkv_bias", self.qkv_bias, "only models with these biases are supported")?;
        require(!self.use_swiglu_ffn, "use_swiglu_ffn", self.use_swiglu_ffn, "gated perceptrons are not supported")
    }
}
