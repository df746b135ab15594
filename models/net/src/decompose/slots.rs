//! Slot Attention: parts compete for the places of an image, a decoder paints each.

use dvp_core::tensor::{Backend, Stride, Tensor, TensorError};
use serde::{Deserialize, Serialize};

use super::Verdict;
use super::broadcast::{BroadcastDecoder, Component};
use super::inputs::{batch_of, check_channels, check_step, noise};
use super::parts::Parts;
use super::slot_attention::{Places, SlotAttention};
use super::terms::Terms;
use crate::error::{NetError, require};
use crate::layers::Convolution;
use crate::weights::Weights;

/// Side of the kernels.
const KERNEL: usize = 5;
/// What slots start from where nothing is to be drawn anew.
const CHANCE: u64 = 1;

/// Sizes of a [`Slots`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct SlotsConfig {
    /// Pixels along a side of its images.
    pub side: usize,
    /// Parts, the background counted.
    pub slots: usize,
    /// Rounds of attention.
    pub rounds: usize,
    /// Channels of the convolutions that see the image.
    pub encoder_channels: Vec<usize>,
    /// Pixels both ways for each place that slots compete for; 1 as published.
    pub encoder_step: usize,
    /// Numbers of a slot.
    pub width: usize,
    /// Width of the perceptron of slots.
    pub hidden: usize,
    /// Channels of the decoder of parts.
    pub decoder_channels: Vec<usize>,
    /// Pixels both ways for each place that the decoder decodes.
    pub decoder_step: usize,
}

impl SlotsConfig {
    /// The published widths; five parts.
    ///
    /// *Source*: Locatello et al. (2020) and their implementation (`google-research/slot_attention`), for CLEVR. There the decoder
    /// begins with a grid of 8 x 8 that transposed convolutions double; here it decodes every place of the full grid.
    #[must_use]
    pub fn published(side: usize) -> Self {
        Self {
            side,
            slots: 5,
            rounds: 3,
            encoder_channels: vec![64; 4],
            encoder_step: 1,
            width: 64,
            hidden: 128,
            decoder_channels: vec![64; 5],
            decoder_step: 1,
        }
    }

    /// Sizes that a processor can train: a quarter of the published channels, slots compete for every second pixel both ways, and as
    /// many are decoded.
    #[must_use]
    pub fn small(side: usize) -> Self {
        Self {
            encoder_channels: vec![16; 3],
            encoder_step: 2,
            width: 32,
            hidden: 64,
            decoder_channels: vec![16; 3],
            decoder_step: 2,
            ..Self::published(side)
        }
    }

    /// Sizes for tests: three parts.
    #[must_use]
    pub fn tiny(side: usize) -> Self {
        Self {
            slots: 3,
            rounds: 2,
            encoder_channels: vec![4, 4],
            width: 6,
            hidden: 8,
            decoder_channels: vec![4],
            ..Self::small(side)
        }
    }

    /// Refuses sizes of which no Slot Attention can be made.
    ///
    /// # Errors
    /// [`NetError::Config`], which names the key.
    pub fn validate(&self) -> Result<(), NetError> {
        require(self.slots > 1, "slots", self.slots, "must be at least 2")?;
        require(self.side > 0, "side", self.side, "must be at least 1")?;
        for (key, value) in [("rounds", self.rounds), ("width", self.width), ("hidden", self.hidden)] {
            require(value > 0, key, value, "must be at least 1")?;
        }
        check_channels("encoder_channels", &self.encoder_channels)?;
        check_channels("decoder_channels", &self.decoder_channels)?;
        check_step("encoder_step", self.encoder_step, self.side)?;
        check_step("decoder_step", self.decoder_step, self.side)
    }
}

/// Convolutions see the image; slots, which start from a draw, compete for its places; each is decoded to colors and the logit of a
/// mask. The image is the mean of the colors, weighted by the softmax of the logits. The loss is its mean squared error.
///
/// *Source*: Locatello et al.: Object-Centric Learning with Slot Attention (2020). Differences: colors are in \[0, 1\], by a sigmoid;
/// the decoder sees places as two channels more, which its first convolution maps, instead of adding a linear map of them; its grid
/// (see [`SlotsConfig::published`]).
#[derive(Clone, Debug)]
pub struct Slots<B: Backend> {
    config: SlotsConfig,
    encoder: Vec<Convolution<B>>,
    places: Places<B>,
    attention: SlotAttention<B>,
    decoder: BroadcastDecoder<B>,
}

impl<B: Backend> Slots<B> {
    /// Takes `encoder.K`, `places.*`, `attention.*` and `painter.*`.
    ///
    /// # Errors
    /// [`NetError::Config`]; as [`Weights::get`].
    pub fn load(config: &SlotsConfig, weights: &Weights<'_, B>) -> Result<Self, NetError> {
        config.validate()?;
        let SlotsConfig { side, rounds, width, hidden, encoder_step, decoder_step, .. } = *config;
        let mut from = 3;
        let mut encoder = Vec::with_capacity(config.encoder_channels.len());
        for (k, &to) in config.encoder_channels.iter().enumerate() {
            let stride = Stride { step: if k == 0 { encoder_step } else { 1 }, padding: KERNEL / 2 };
            encoder.push(Convolution::load(&weights.under(&format!("encoder.{k}")), [from, to], KERNEL, stride)?);
            from = to;
        }
        let places = Places::load(&weights.under("places"), from)?;
        let attention = SlotAttention::load(&weights.under("attention"), from, width, hidden, rounds)?;
        let grid = [side / decoder_step, decoder_step];
        let decoder = BroadcastDecoder::load(&weights.under("painter"), width, &config.decoder_channels, KERNEL, grid)?;
        Ok(Self { config: config.clone(), encoder, places, attention, decoder })
    }

    /// The loss of images, batch x 3 x side x side; `chance` numbers the draw that slots start from.
    ///
    /// # Errors
    /// [`NetError::Input`] for other extents; if the framework refuses.
    pub fn judge(&self, images: &Tensor<B>, chance: u64) -> Result<Verdict<B>, NetError> {
        let batch = batch_of(images, self.config.side)?;
        let SlotsConfig { slots, width, .. } = self.config;
        let parts = self.see(images, &noise(images, &[batch, slots, width], chance)?)?;
        let masks = parts.log_masks.exp()?.reshape(&[batch, slots, 1, self.config.side, self.config.side])?;
        let painted = parts.colors.mul(&masks)?.sum(1)?.reshape(images.dims().extents())?;
        let difference = painted.sub(images)?;
        let loss = difference.mul(&difference)?.mean_all()?;
        let terms = Terms { pixels: loss.number()?, ..Terms::default() };
        Ok(Verdict { loss, terms, parts })
    }

    /// The parts of images, batch x 3 x side x side. Slots start from one draw, the same for every image and at every time.
    ///
    /// # Errors
    /// As [`Self::judge`].
    pub fn parts(&self, images: &Tensor<B>) -> Result<Parts<B>, NetError> {
        let batch = batch_of(images, self.config.side)?;
        let SlotsConfig { slots, width, .. } = self.config;
        let noise = noise(images, &[1, slots, width], CHANCE)?.expand(&[batch, slots, width])?;
        Ok(self.see(images, &noise)?)
    }

    /// The parts, from slots that start from `noise`, batch x slots x width.
    fn see(&self, images: &Tensor<B>, noise: &Tensor<B>) -> Result<Parts<B>, TensorError> {
        let mut x = images.clone();
        for convolution in &self.encoder {
            x = convolution.forward(&x)?.relu()?;
        }
        let found = self.attention.forward(&self.places.forward(&x)?, noise)?;
        let SlotsConfig { side, slots, width, .. } = self.config;
        let batch = found.dims().get(0).unwrap_or(1);
        let Component { colors, logits } = self.decoder.decode(&found.reshape(&[batch * slots, width])?)?;
        let log_masks = logits.reshape(&[batch, slots, side, side])?.log_softmax(1)?;
        Ok(Parts { log_masks, colors: colors.reshape(&[batch, slots, 3, side, side])? })
    }
}
