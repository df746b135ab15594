//! The edge profile in pixels.

use crate::real::Real;
use crate::render::EdgeProfile;

/// Doubled area, in the doubled frame, up to which a triangle counts as a line and is left out: the reference's.
const LEAST_DOUBLED_AREA: f64 = 1e-8;

/// An [`EdgeProfile`] at some number of pixels per scene unit.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelProfile<T> {
    /// Signed squared distance of half coverage, px^2.
    offset: T,
    /// 1 / softness, 1 / px^2.
    sharpness: T,
    /// Signed squared distance beyond which coverage is 0, px^2.
    cut: T,
    /// Distance from a triangle within which coverage can be above 0, px.
    pub(super) reach: T,
    /// Doubled area up to which a triangle is left out, px^2.
    pub(super) least_area: T,
}

impl<T: Real> PixelProfile<T> {
    pub(super) fn new(edge: &EdgeProfile<T>, unit_px: T) -> Self {
        // A squared length in the doubled frame, where the shorter side is 2.
        let square = unit_px * unit_px * T::of(0.25);
        Self {
            offset: edge.offset * square,
            sharpness: (edge.sigma * square).recip(),
            cut: edge.cut * square,
            reach: (edge.cut.max(T::zero()) * square).sqrt(),
            least_area: T::of(LEAST_DOUBLED_AREA) * square,
        }
    }

    /// Coverage at a signed squared distance: logistic((offset - d2) / sigma), 0 beyond the cut.
    #[inline(always)]
    pub(super) fn coverage(&self, d2: T) -> T {
        let odds = ((d2 - self.offset) * self.sharpness).exp_lanes::<false>();
        let p = (T::one() + odds).recip();
        if d2 <= self.cut { p } else { T::zero() }
    }

    /// Derivative of [`Self::coverage`] by d2; 0 beyond the cut.
    #[inline(always)]
    pub(super) fn slope(&self, d2: T) -> T {
        let odds = ((d2 - self.offset) * self.sharpness).exp_lanes::<false>();
        let p = (T::one() + odds).recip();
        if d2 <= self.cut { -p * (odds * p) * self.sharpness } else { T::zero() }
    }
}
