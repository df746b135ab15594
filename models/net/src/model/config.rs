//! Sizes of a model.

use dvp_core::real::{DType, Real};
use dvp_core::shape::PrototypeBank;
use serde::{Deserialize, Serialize};

use crate::detr::DetrConfig;
use crate::dinov2::Dinov2Config;
use crate::encoder::{ConvConfig, EncoderConfig, VitConfig};
use crate::error::{NetError, require};

/// How a model says what shape an object has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum ShapeHead {
    /// Attention to the prototypes of a bank, mixed softly: DVP+.
    Prototypes,
    /// The descriptors themselves, of so many harmonics: DVP.
    Direct {
        /// Harmonics, at least 1.
        harmonics: usize,
    },
}

/// How a model says how an object is turned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum RotationHead {
    /// The sine and cosine of the angle: the paper's. A shape that a turn by 2 pi / k maps on itself has k right answers,
    /// between which such a head must jump somewhere.
    #[default]
    Plain,
    /// The sine and cosine of k times the angle, for each prototype with its own k: one right answer, no jump.
    BySymmetry,
}

/// What an object can be told by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Slots {
    /// Learned queries of a decoder, `num_queries` of them: the paper's.
    #[default]
    Queries,
    /// The places of the grid of features: each speaks for objects whose center is near its own. Learns in far fewer
    /// steps, as no query has to find out where to look; the decoder's sizes are not used.
    Cells {
        /// Rows of the grid.
        rows: usize,
        /// Columns of the grid.
        columns: usize,
    },
}

/// Sizes of a [`Model`](super::Model).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct ModelConfig {
    /// From an image to features.
    pub encoder: EncoderConfig,
    /// Whether features are standardized over a batch before the transformer: for frozen encoders.
    pub batch_norm: bool,
    /// From features to a latent per object slot.
    pub transformer: DetrConfig,
    /// What fills the slots.
    #[serde(default)]
    pub slots: Slots,
    /// Width of the perceptrons in the heads, of three layers each.
    pub head_width: usize,
    /// How shapes are told.
    pub shape: ShapeHead,
    /// How rotations are told.
    #[serde(default)]
    pub rotation: RotationHead,
}

impl ModelConfig {
    /// The paper's: a frozen DINOv2 ViT-B/14 with registers, a transformer of 6 + 6 layers of width 256, 8 queries.
    /// 86.6 M numbers in the encoder, 20 M that train.
    #[must_use]
    pub fn paper() -> Self {
        let model = Dinov2Config {
            hidden_size: 768,
            num_hidden_layers: 12,
            num_attention_heads: 12,
            mlp_ratio: 4,
            hidden_act: "gelu".into(),
            layer_norm_eps: 1e-6,
            image_size: 518,
            patch_size: 14,
            num_channels: 3,
            qkv_bias: true,
            use_swiglu_ffn: false,
            num_register_tokens: 4,
        };
        Self {
            encoder: EncoderConfig::Vit(VitConfig { model, side: 126, frozen: true }),
            batch_norm: true,
            transformer: transformer(256, 8, 6, 2048),
            slots: Slots::Queries,
            head_width: 256,
            shape: ShapeHead::Prototypes,
            rotation: RotationHead::Plain,
        }
    }

    /// About 1.4 M numbers, trained from nothing.
    #[must_use]
    pub fn small() -> Self {
        Self::conv(&[32, 64, 128], 1, transformer(128, 8, 2, 256))
    }

    /// About 0.06 M numbers: for tests and first looks.
    #[must_use]
    pub fn tiny() -> Self {
        Self::conv(&[16, 24, 32], 0, transformer(32, 8, 1, 64))
    }

    /// About 0.4 M numbers, trained from nothing, with cells for slots: learns in the fewest steps. For images of 128 x 128
    /// pixels.
    #[must_use]
    pub fn cells() -> Self {
        let encoder = EncoderConfig::Conv(ConvConfig { patch: 8, channels: vec![48, 96], residual: 1 });
        let transformer = transformer(96, 8, 1, 192);
        Self {
            encoder,
            transformer,
            slots: Slots::Cells { rows: 8, columns: 8 },
            head_width: 96,
            rotation: RotationHead::BySymmetry,
            ..Self::small()
        }
    }

    fn conv(channels: &[usize], residual: usize, transformer: DetrConfig) -> Self {
        let head_width = transformer.d_model;
        let encoder = EncoderConfig::Conv(ConvConfig { patch: 4, channels: channels.to_vec(), residual });
        Self {
            encoder,
            batch_norm: false,
            transformer,
            slots: Slots::Queries,
            head_width,
            shape: ShapeHead::Prototypes,
            rotation: RotationHead::Plain,
        }
    }

    /// Whether the encoder keeps its weights, so that what it makes of an image need be computed only once.
    #[must_use]
    pub fn has_frozen_encoder(&self) -> bool {
        matches!(&self.encoder, EncoderConfig::Vit(vit) if vit.frozen)
    }

    /// Slots for objects.
    #[must_use]
    pub fn objects(&self) -> usize {
        match self.slots {
            Slots::Queries => self.transformer.num_queries,
            Slots::Cells { rows, columns } => rows * columns,
        }
    }

    /// Harmonics of the shapes that a model tells, `bank` being the prototypes it knows.
    #[must_use]
    pub fn harmonics<T: Real>(&self, bank: &PrototypeBank<T>) -> usize {
        match self.shape {
            ShapeHead::Prototypes => bank.harmonic_count(),
            ShapeHead::Direct { harmonics } => harmonics,
        }
    }

    /// The type that models train in.
    pub const DTYPE: DType = DType::F32;

    /// Checks what the parts do not check themselves.
    pub(super) fn validate(&self) -> Result<(), NetError> {
        require(self.head_width > 0, "head_width", self.head_width, "must be at least 1")?;
        match self.shape {
            ShapeHead::Direct { harmonics: 0 } => require(false, "shape.direct.harmonics", 0, "must be at least 1"),
            _ => Ok(()),
        }
    }
}

fn transformer(width: usize, heads: usize, layers: usize, wide: usize) -> DetrConfig {
    DetrConfig {
        d_model: width,
        num_queries: 8,
        encoder_layers: layers,
        encoder_attention_heads: heads,
        encoder_ffn_dim: wide,
        decoder_layers: layers,
        decoder_attention_heads: heads,
        decoder_ffn_dim: wide,
        activation_function: "relu".into(),
        position_embedding_type: "sine".into(),
    }
}
