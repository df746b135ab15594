//! MONet: attention takes one part of an image after the other, an autoencoder describes each.

use dvp_core::tensor::{Backend, Tensor, TensorError};
use serde::{Deserialize, Serialize};

use super::Verdict;
use super::attention_net::AttentionNet;
use super::broadcast::Component;
use super::component_vae::{ComponentVae, Latents};
use super::inputs::{batch_of, check_channels, check_step, noise};
use super::parts::Parts;
use super::terms::{Terms, apart, mixture, told};
use crate::error::{NetError, require};
use crate::weights::Weights;

/// What networks see of masks and scopes: logarithms below are cut, a share of 5e-5.
const LOWEST: f64 = -10.0;

/// Sizes of a [`Monet`], and the factors of its loss.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct MonetConfig {
    /// Pixels along a side of its images.
    pub side: usize,
    /// Parts, the background counted.
    pub slots: usize,
    /// Channels of the blocks of the attention network; every block but the first has half the side of the one before.
    pub attention_channels: Vec<usize>,
    /// Width of its perceptron.
    pub attention_hidden: usize,
    /// Channels of the encoder of parts, whose convolutions halve the side.
    pub encoder_channels: Vec<usize>,
    /// Width of its perceptron.
    pub encoder_hidden: usize,
    /// Numbers that describe a part.
    pub latents: usize,
    /// Channels of the decoder of parts.
    pub decoder_channels: Vec<usize>,
    /// Pixels both ways for each place that the decoder decodes; 1 as published.
    pub decoder_step: usize,
    /// Factor on what the latents tell.
    pub beta: f64,
    /// Factor on what the masks tell that the latents do not.
    pub gamma: f64,
    /// Standard deviation of the colors of the first part, the background.
    pub sigma_background: f64,
    /// That of the other parts.
    pub sigma_foreground: f64,
}

impl MonetConfig {
    /// The published sizes for images of 64 x 64 pixels and, with one block more, of 128 x 128; five parts.
    ///
    /// *Source*: Burgess et al.: MONet (2019), appendix B, for Multi-dSprites. The channels of the attention network are those of
    /// a public implementation (`applied-ai-lab/genesis`), as the paper names none.
    #[must_use]
    pub fn published(side: usize) -> Self {
        Self {
            side,
            slots: 5,
            attention_channels: if side > 64 { vec![32, 32, 32, 64, 64, 64] } else { vec![32, 32, 64, 64, 64] },
            attention_hidden: 128,
            encoder_channels: vec![32, 32, 64, 64],
            encoder_hidden: 256,
            latents: 16,
            decoder_channels: vec![32; 4],
            decoder_step: 1,
            beta: 0.5,
            gamma: 0.5,
            sigma_background: 0.09,
            sigma_foreground: 0.11,
        }
    }

    /// Sizes that a processor can train: a quarter of the published widths, parts decoded at half the side.
    #[must_use]
    pub fn small(side: usize) -> Self {
        Self {
            attention_channels: Self::published(side).attention_channels.iter().map(|channels| channels / 4).collect(),
            attention_hidden: 64,
            encoder_channels: vec![8, 8, 16, 16],
            encoder_hidden: 64,
            decoder_channels: vec![16; 2],
            decoder_step: 2,
            ..Self::published(side)
        }
    }

    /// Sizes for tests: three parts.
    #[must_use]
    pub fn tiny(side: usize) -> Self {
        Self {
            slots: 3,
            attention_channels: vec![4, 4],
            attention_hidden: 8,
            encoder_channels: vec![4, 4],
            encoder_hidden: 8,
            latents: 3,
            decoder_channels: vec![4],
            ..Self::small(side)
        }
    }

    /// Refuses sizes of which no MONet can be made.
    ///
    /// # Errors
    /// [`NetError::Config`], which names the key.
    pub fn validate(&self) -> Result<(), NetError> {
        let blocks = self.attention_channels.len();
        require(self.slots > 1, "slots", self.slots, "must be at least 2")?;
        require(self.latents > 0, "latents", self.latents, "must be at least 1")?;
        require(self.attention_hidden > 0, "attention_hidden", self.attention_hidden, "must be at least 1")?;
        require(self.encoder_hidden > 0, "encoder_hidden", self.encoder_hidden, "must be at least 1")?;
        for (key, channels) in [
            ("attention_channels", &self.attention_channels),
            ("encoder_channels", &self.encoder_channels),
            ("decoder_channels", &self.decoder_channels),
        ] {
            check_channels(key, channels)?;
        }
        let tiled = self.side.is_multiple_of(1 << (blocks - 1)) && self.side >> (blocks - 1) > 1;
        require(tiled, "side", self.side, "must be 2 or more times 2 for each attention block but the first")?;
        check_step("decoder_step", self.decoder_step, self.side)?;
        for (key, value) in [("beta", self.beta), ("gamma", self.gamma)] {
            require(value.is_finite() && value >= 0.0, key, value, "must be 0 or above")?;
        }
        for (key, value) in [("sigma_background", self.sigma_background), ("sigma_foreground", self.sigma_foreground)] {
            require(value.is_finite() && value > 0.0, key, value, "must be above 0")?;
        }
        Ok(())
    }
}

/// Scopes and masks are shares of each pixel that sum to 1: every step of the attention takes a share of the scope that is left,
/// the last part takes the rest.
///
/// The loss, per pixel: minus the logarithm of the likelihood of the image, a mixture by the masks of the parts' colors; plus
/// beta times what the latents tell; plus gamma times the divergence of the masks from those that the autoencoder decodes.
///
/// *Source*: Burgess et al.: MONet: Unsupervised Scene Decomposition and Representation (2019). Differences: the paddings of the
/// decoder; logarithms of masks are cut at -10 before a network sees them; the loss is over the number of pixels.
#[derive(Clone, Debug)]
pub struct Monet<B: Backend> {
    config: MonetConfig,
    attention: AttentionNet<B>,
    vae: ComponentVae<B>,
}

/// All that comes of a batch.
struct Seen<B: Backend> {
    parts: Parts<B>,
    latents: Latents<B>,
    /// Logarithms of the decoded masks, batch x slots x side x side.
    decoded: Tensor<B>,
}

impl<B: Backend> Monet<B> {
    /// Takes `attention.*` and `vae.*`.
    ///
    /// # Errors
    /// [`NetError::Config`]; as [`Weights::get`].
    pub fn load(config: &MonetConfig, weights: &Weights<'_, B>) -> Result<Self, NetError> {
        config.validate()?;
        let MonetConfig { side, ref attention_channels, attention_hidden, .. } = *config;
        let attention = AttentionNet::load(&weights.under("attention"), side, attention_channels, attention_hidden)?;
        let vae = ComponentVae::load(&weights.under("vae"), config)?;
        Ok(Self { config: config.clone(), attention, vae })
    }

    /// The loss of images, batch x 3 x side x side; `chance` numbers the latents that are drawn.
    ///
    /// # Errors
    /// [`NetError::Input`] for other extents; if the framework refuses.
    pub fn judge(&self, images: &Tensor<B>, chance: u64) -> Result<Verdict<B>, NetError> {
        let Seen { parts, latents, decoded } = self.see(images, Some(chance))?;
        let MonetConfig { slots, beta, gamma, sigma_background, sigma_foreground, .. } = self.config;
        let mut deviations = vec![sigma_foreground; slots];
        deviations[0] = sigma_background;
        let pixels = mixture(images, &parts.log_masks, &parts.colors, &deviations)?;
        let count = images.dims().len() / 3;
        let told = told(&latents.mean, &latents.log_variance, count)?;
        let apart = apart(&parts.log_masks, &decoded)?;
        let loss = pixels.add(&told.affine(beta, 0.0)?)?.add(&apart.affine(gamma, 0.0)?)?;
        let terms = Terms { pixels: pixels.number()?, latents: told.number()?, masks: apart.number()? };
        Ok(Verdict { loss, terms, parts })
    }

    /// The parts of images, batch x 3 x side x side, by the means of their latents.
    ///
    /// # Errors
    /// As [`Self::judge`].
    pub fn parts(&self, images: &Tensor<B>) -> Result<Parts<B>, NetError> {
        Ok(self.see(images, None)?.parts)
    }

    fn see(&self, images: &Tensor<B>, chance: Option<u64>) -> Result<Seen<B>, NetError> {
        let MonetConfig { side, slots, .. } = self.config;
        let batch = batch_of(images, side)?;
        let log_masks = self.attend(images, batch)?;
        // Part after part, with all images each.
        let all: Vec<&Tensor<B>> = log_masks.iter().collect();
        let repeated = Tensor::concat(&vec![images; slots], 0)?;
        let latents = self.vae.encode(&repeated, &cut(&Tensor::concat(&all, 0)?)?)?;
        let drawn = match chance {
            Some(chance) => draw(&latents, chance)?,
            None => latents.mean.clone(),
        };
        let Component { colors, logits } = self.vae.decode(&drawn)?;
        let colors = colors.reshape(&[slots, batch, 3, side, side])?.permute(&[1, 0, 2, 3, 4])?;
        let logits = logits.reshape(&[slots, batch, side, side])?.permute(&[1, 0, 2, 3])?;
        let log_masks = Tensor::concat(&all, 1)?;
        Ok(Seen { parts: Parts { log_masks, colors }, latents, decoded: logits.log_softmax(1)? })
    }

    /// Logarithms of the masks, each batch x 1 x side x side.
    fn attend(&self, images: &Tensor<B>, batch: usize) -> Result<Vec<Tensor<B>>, TensorError> {
        let MonetConfig { side, slots, .. } = self.config;
        let mut scope = images.like(vec![0.0; batch * side * side], &[batch, 1, side, side])?;
        let mut masks = Vec::with_capacity(slots);
        for k in 1..slots {
            let seen = if k == 1 { scope.clone() } else { cut(&scope)? };
            let [taken, left] = self.attention.forward(images, &seen)?;
            masks.push(scope.add(&taken)?);
            scope = scope.add(&left)?;
        }
        masks.push(scope);
        Ok(masks)
    }
}

/// A draw from the distributions of latents.
fn draw<B: Backend>(latents: &Latents<B>, chance: u64) -> Result<Tensor<B>, TensorError> {
    let noise = noise(&latents.mean, latents.mean.dims().extents(), chance)?;
    latents.log_variance.affine(0.5, 0.0)?.exp()?.mul(&noise)?.add(&latents.mean)
}

/// Logarithms, those below the lowest as that.
fn cut<B: Backend>(logs: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
    logs.affine(1.0, -LOWEST)?.relu()?.affine(1.0, LOWEST)
}
