//! How the objects of a scene mix: a setting that belongs to the scene, because the same objects look different without it.

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

impl Compositing {
    /// 1 / gamma of [`Self::Blend`], the reference's.
    pub const SHARPNESS: f64 = 10.0;

    /// Guard of [`Self::Blend`]'s division by the sum of weights, the reference's.
    pub const SMALLEST_WEIGHT: f64 = 1e-7;
}
