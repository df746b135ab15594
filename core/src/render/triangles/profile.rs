//! The edge profile in pixels.

use crate::real::Real;
use crate::render::EdgeProfile;
use crate::scene::PixelProfile;

/// Doubled area, in the doubled frame, up to which a triangle counts as a line and is left out: the reference's.
const LEAST_DOUBLED_AREA: f64 = 1e-8;

/// An [`EdgeProfile`] at some number of pixels per scene unit, as a function of signed squared distance, px^2.
#[derive(Clone, Copy, Debug)]
pub(super) struct SquaredProfile<T> {
    edge: PixelProfile<T>,
    /// Distance from a triangle within which coverage can be above 0, px.
    pub(super) reach: T,
    /// Doubled area up to which a triangle is left out, px^2.
    pub(super) least_area: T,
}

impl<T: Real> SquaredProfile<T> {
    pub(super) fn new(edge: &EdgeProfile<T>, unit_px: T) -> Self {
        // A squared length in the doubled frame, where the shorter side is 2.
        let square = unit_px * unit_px * T::of(0.25);
        let edge = edge.in_pixels(unit_px);
        let reach = edge.px(edge.cut.max(T::zero()));
        Self { edge, reach, least_area: T::of(LEAST_DOUBLED_AREA) * square }
    }

    /// Coverage at a signed squared distance; 0 beyond the cut.
    #[inline(always)]
    pub(super) fn coverage(&self, d2: T) -> T {
        let measure = self.measure(d2);
        let p = (T::one() + self.odds(measure)).recip();
        if measure <= self.edge.cut { p } else { T::zero() }
    }

    /// Derivative of [`Self::coverage`] by d2; 0 beyond the cut.
    #[inline(always)]
    pub(super) fn slope(&self, d2: T) -> T {
        let measure = self.measure(d2);
        let odds = self.odds(measure);
        let p = (T::one() + odds).recip();
        let slope = -p * (odds * p) * self.edge.sharpness;
        if measure > self.edge.cut || (!self.edge.squared && measure == T::zero()) {
            T::zero()
        } else if self.edge.squared {
            slope
        } else {
            // d = sqrt(d2): the derivative is 1 / (2 |d|).
            slope * T::of(0.5) / measure.abs()
        }
    }

    /// What coverage is measured by.
    #[inline(always)]
    fn measure(&self, d2: T) -> T {
        if self.edge.squared { d2 } else { d2.abs().sqrt() * d2.signum() }
    }

    #[inline(always)]
    fn odds(&self, measure: T) -> T {
        ((measure - self.edge.offset) * self.edge.sharpness).exp_lanes::<false>()
    }
}
