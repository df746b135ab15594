//! How the objects of a scene mix: a setting that belongs to the scene, because the same objects look different without it.
//!
//! Here stands the law for one pixel; `render` has it for chunks of pixels, `render/dense` in tensor operations.
//! `tests/property/compositing.rs` holds the law against what is rendered, `tests/gradient/compositing.rs` its slopes
//! against central differences.

use crate::image::CHANNELS;
use crate::real::Real;

/// How objects that share a pixel mix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Compositing {
    /// The paper's: with weights w = p exp((f - 1) / gamma), gamma 0.1, the color is the weighted mean m, alpha = 1 - prod (1 - p f),
    /// the pixel m alpha + background (1 - alpha). Free of order.
    #[default]
    Blend,
    /// Painter's order: pixel <- pixel (1 - p f) + color p f, object after object.
    Over,
}

/// An object at a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer<T> {
    /// Color, [0, 1].
    pub color: [T; CHANNELS],
    /// Share p of the pixel that the object covers, [0, 1].
    pub coverage: T,
    /// Confidence f, [0, 1].
    pub confidence: T,
    /// [`Compositing::weight`] of the confidence, kept because it takes an exponential.
    pub weight: T,
}

impl<T: Real> Layer<T> {
    /// An object of this color, coverage and confidence.
    #[must_use]
    pub fn new(color: [T; CHANNELS], coverage: T, confidence: T) -> Self {
        Self { color, coverage, confidence, weight: Compositing::weight(confidence) }
    }

    fn opacity(&self) -> T {
        self.coverage * self.confidence
    }
}

impl Compositing {
    /// 1 / gamma of [`Self::Blend`], the reference's.
    pub const SHARPNESS: f64 = 10.0;

    /// Guard of [`Self::Blend`]'s division by the sum of weights, the reference's.
    pub const SMALLEST_WEIGHT: f64 = 1e-7;

    /// Weight of an object in the mean of [`Self::Blend`], per unit of its coverage: exp((f - 1) / gamma).
    #[must_use]
    pub fn weight<T: Real>(confidence: T) -> T {
        ((confidence - T::one()) * T::of(Self::SHARPNESS)).exp()
    }

    /// How much of each color a pixel shows. `layers` are its objects in the order in which they are painted; `shares[k]`
    /// becomes the share of `layers[k]`. Returns the share of the background. The pixel is the sum of the colors, each times
    /// its share.
    ///
    /// *Dimensions*: as many shares as layers.
    pub fn shares<T: Real>(self, layers: &[Layer<T>], shares: &mut [T]) -> T {
        let one = T::one();
        match self {
            Self::Blend => {
                let clear = layers.iter().fold(one, |clear, layer| clear * (one - layer.opacity()));
                let scale = (one - clear) / total_weight(layers);
                for (share, layer) in shares.iter_mut().zip(layers) {
                    *share = layer.coverage * layer.weight * scale;
                }
                clear
            }
            Self::Over => {
                let mut clear = one;
                for (share, layer) in shares.iter_mut().zip(layers).rev() {
                    *share = layer.opacity() * clear;
                    clear *= one - layer.opacity();
                }
                clear
            }
        }
    }

    /// How a pixel changes with the coverage of each object: `slopes[k]` becomes the derivative of its channels with respect to
    /// the coverage of `layers[k]`.
    ///
    /// *Dimensions*: as many slopes as layers.
    pub fn slopes<T: Real>(self, background: [T; CHANNELS], layers: &[Layer<T>], slopes: &mut [[T; CHANNELS]]) {
        let one = T::one();
        let clear_of = |layers: &[Layer<T>]| layers.iter().fold(one, |clear, layer| clear * (one - layer.opacity()));
        match self {
            Self::Blend => {
                let total = total_weight(layers);
                // Where the guard holds the sum of weights, it does not change with them.
                let is_guarded = total <= T::of(Self::SMALLEST_WEIGHT);
                let alpha = one - clear_of(layers);
                let mean: [T; CHANNELS] = core::array::from_fn(|c| {
                    layers.iter().map(|layer| layer.coverage * layer.weight * layer.color[c]).sum::<T>() / total
                });
                for (k, (slope, layer)) in slopes.iter_mut().zip(layers).enumerate() {
                    // Formed of the others: dividing by 1 - p f would be 0 / 0 inside an object.
                    let others = clear_of(&layers[..k]) * clear_of(&layers[k + 1..]);
                    *slope = core::array::from_fn(|c| {
                        let own = if is_guarded { layer.color[c] } else { layer.color[c] - mean[c] };
                        (mean[c] - background[c]) * layer.confidence * others + alpha * layer.weight * own / total
                    });
                }
            }
            Self::Over => {
                let mut below = background;
                for (k, (slope, layer)) in slopes.iter_mut().zip(layers).enumerate() {
                    let above = clear_of(&layers[k + 1..]);
                    *slope = core::array::from_fn(|c| layer.confidence * (layer.color[c] - below[c]) * above);
                    below = core::array::from_fn(|c| below[c] + layer.opacity() * (layer.color[c] - below[c]));
                }
            }
        }
    }
}

/// Sum of the weights, guarded.
fn total_weight<T: Real>(layers: &[Layer<T>]) -> T {
    let total: T = layers.iter().map(|layer| layer.coverage * layer.weight).sum();
    total.max(T::of(Compositing::SMALLEST_WEIGHT))
}
