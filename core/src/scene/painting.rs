//! How a scene is painted: settings that belong to the scene, because the same objects look different without them.

use crate::real::Real;

/// How coverage falls from 1 inside to 0 outside an outline:
/// p = logistic((offset - d2) / sigma), 0 where d2 > cut, with d2 the signed squared distance (negative inside).
///
/// *Units*: squared length in the doubled frame (the shorter image side is 2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeProfile<T> {
    /// Signed squared distance at which coverage is 1/2; above 0 the object is fattened.
    pub offset: T,
    /// Softness; above 0.
    pub sigma: T,
    /// Signed squared distance beyond which coverage is exactly 0.
    pub cut: T,
}

impl<T: Real> EdgeProfile<T> {
    /// The reference renderer's: offset 5e-4, sigma 1e-4, cut ln(1/1e-4 - 1) 1e-4 = 9.21e-4 (at 128 px: half coverage
    /// 1.43 px outside the outline, nothing beyond 1.94 px).
    #[must_use]
    pub fn reference() -> Self {
        Self { offset: T::of(5e-4), sigma: T::of(1e-4), cut: T::of(9.210_240_366_975_849e-4) }
    }

    /// The profile nearest to area coverage (what drawing programs produce) at `unit_px` pixels per scene unit:
    /// half coverage on the outline, a quarter a quarter of a pixel outside. At most 0.06 off the share of a half plane
    /// along the pixel grid; for exact areas use the exact-coverage renderer.
    #[must_use]
    pub fn area(unit_px: T) -> Self {
        Self::centered(T::of(0.0569), unit_px)
    }

    /// Nearly hard pixels at `unit_px` pixels per scene unit: coverage 0.02 or 0.98 at a tenth of a pixel from the
    /// outline.
    #[must_use]
    pub fn hard(unit_px: T) -> Self {
        Self::centered(T::of(0.0025), unit_px)
    }

    /// Half coverage on the outline, softness in px^2, cut where coverage is 1e-4.
    fn centered(sigma_px2: T, unit_px: T) -> Self {
        let doubled = T::of(2.0) / unit_px;
        let sigma = sigma_px2 * doubled * doubled;
        Self { offset: T::zero(), sigma, cut: sigma * T::of(9.210_240_366_975_85) }
    }
}

/// How objects that share a pixel mix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Compositing {
    /// The paper's: with weights w = p exp((f - 1) / 0.1), the color is the weighted mean m, alpha = 1 - prod (1 - p f),
    /// the pixel m alpha + background (1 - alpha). Free of order.
    #[default]
    Blend,
    /// Painter's order: pixel <- pixel (1 - p f) + color p f, object after object.
    Over,
}
