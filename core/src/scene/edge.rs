//! Edge profiles: how coverage falls from 1 inside to 0 outside an outline.

use crate::real::Real;

/// What coverage is measured by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum EdgeLaw {
    /// Signed squared distance to the outline, squared length in the doubled frame (the shorter image side is 2): the
    /// reference renderer's.
    #[default]
    SquaredDistance,
    /// Signed distance to the outline, length in the doubled frame: blur. At sigma s the profile is within 0.0095 of an
    /// edge blurred with a Gaussian of standard deviation 1.70 s.
    Distance,
    /// The pixel's area inside the outline: what drawing programs paint, at any image size. `offset`, `sigma` and `cut`
    /// are then those of the nearest profile in distance, in pixels, for all that needs a distance.
    Area,
}

/// How coverage falls from 1 inside to 0 outside an outline:
/// p = logistic((offset - d) / sigma), 0 where d > cut, with d as the law measures it (negative inside); under
/// [`EdgeLaw::Area`] the pixel's area inside.
///
/// *Units*: those of the law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeProfile<T> {
    /// What d is.
    pub law: EdgeLaw,
    /// d at which coverage is 1/2; above 0 the object is fattened.
    pub offset: T,
    /// Softness; above 0.
    pub sigma: T,
    /// d beyond which coverage is exactly 0.
    pub cut: T,
}

/// ln(999): profiles in distance are cut where coverage falls to 0.001, a quarter of a step of 8 bits.
const CUT_SIGMAS: f64 = 6.906_754_778_648_554;
/// Sigma (px) of the logistic nearest to area coverage: off by at most 0.064 from the share of a half plane along the
/// pixel grid, by 0.03 from that of one along the diagonal.
const AREA_SIGMA_PX: f64 = 0.19;
/// Sigma (px) of hard pixels: coverage 0.02 or 0.98 at a tenth of a pixel from the outline.
const HARD_SIGMA_PX: f64 = 0.0257;

impl<T: Real> EdgeProfile<T> {
    /// The reference renderer's: offset 5e-4, sigma 1e-4, cut ln(1/1e-4 - 1) 1e-4 = 9.21e-4 (at 128 px: half coverage
    /// 1.43 px outside the outline, nothing beyond 1.94 px).
    #[must_use]
    pub fn reference() -> Self {
        let law = EdgeLaw::SquaredDistance;
        Self { law, offset: T::of(5e-4), sigma: T::of(1e-4), cut: T::of(9.210_240_366_975_849e-4) }
    }

    /// Area coverage.
    #[must_use]
    pub fn area() -> Self {
        Self { law: EdgeLaw::Area, ..Self::distance(T::of(AREA_SIGMA_PX)) }
    }

    /// Half coverage on the outline, softness `sigma` (length in the doubled frame).
    #[must_use]
    pub fn distance(sigma: T) -> Self {
        Self { law: EdgeLaw::Distance, offset: T::zero(), sigma, cut: sigma * T::of(CUT_SIGMAS) }
    }

    /// Nearly hard pixels at `unit_px` pixels per scene unit: coverage 0.02 or 0.98 at a tenth of a pixel from the
    /// outline.
    #[must_use]
    pub fn hard(unit_px: T) -> Self {
        Self::distance(T::of(HARD_SIGMA_PX * 2.0) / unit_px)
    }

    /// The same edges in a frame with `factor` times as many units per length: what a window of the image sees, whose
    /// shorter side is its own unit.
    #[must_use]
    pub fn magnified(&self, factor: T) -> Self {
        let per_unit = match self.law {
            EdgeLaw::SquaredDistance => factor * factor,
            EdgeLaw::Distance => factor,
            EdgeLaw::Area => T::one(),
        };
        let [offset, sigma, cut] = [self.offset, self.sigma, self.cut].map(|v| v * per_unit);
        Self { law: self.law, offset, sigma, cut }
    }

    /// Signed distance (positive outside) at which coverage is 1/2, scene units.
    #[must_use]
    pub fn half_coverage(&self) -> T {
        let doubled = match self.law {
            EdgeLaw::SquaredDistance => signed_root(self.offset),
            EdgeLaw::Distance => self.offset,
            EdgeLaw::Area => T::zero(),
        };
        doubled * T::of(0.5)
    }

    /// The profile at `unit_px` pixels per scene unit.
    #[must_use]
    pub fn in_pixels(&self, unit_px: T) -> PixelProfile<T> {
        // The doubled frame has half as many pixels per unit.
        let doubled_px = unit_px * T::of(0.5);
        let per_unit = match self.law {
            EdgeLaw::SquaredDistance => doubled_px * doubled_px,
            EdgeLaw::Distance => doubled_px,
            EdgeLaw::Area => T::one(),
        };
        PixelProfile {
            squared: self.law == EdgeLaw::SquaredDistance,
            offset: self.offset * per_unit,
            sharpness: (self.sigma * per_unit).recip(),
            cut: self.cut * per_unit,
        }
    }
}

/// An [`EdgeProfile`] at some number of pixels per scene unit, area coverage as the nearest profile in distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelProfile<T> {
    /// Whether coverage is measured by px^2 (signed squared distance) or by px (signed distance).
    pub squared: bool,
    /// Where coverage is 1/2, px^2 or px.
    pub offset: T,
    /// 1 / softness, 1/px^2 or 1/px.
    pub sharpness: T,
    /// Beyond it coverage is 0, px^2 or px.
    pub cut: T,
}

impl<T: Real> PixelProfile<T> {
    /// Coverage at a signed distance (px, positive outside), and its derivative per px.
    #[inline(always)]
    pub fn coverage(&self, distance: T) -> (T, T) {
        let (one, two) = (T::one(), T::of(2.0));
        let (measure, change) =
            if self.squared { (distance * distance.abs(), two * distance.abs()) } else { (distance, one) };
        if measure > self.cut {
            return (T::zero(), T::zero());
        }
        let coverage = one / (one + ((measure - self.offset) * self.sharpness).exp_lanes::<false>());
        (coverage, -coverage * (one - coverage) * self.sharpness * change)
    }

    /// Signed distance (px, positive outside) at which coverage is `coverage`, which lies in (0, 1).
    #[inline]
    pub fn distance(&self, coverage: T) -> T {
        self.px(self.offset - (coverage / (T::one() - coverage)).ln() / self.sharpness)
    }

    /// Signed distance (px) of a value of the profile's measure.
    #[inline]
    pub fn px(&self, measure: T) -> T {
        if self.squared { signed_root(measure) } else { measure }
    }

    /// The value of the measure at which coverage is `below_one` less than 1.
    #[inline]
    pub fn full(&self, below_one: f64) -> T {
        self.offset + T::of(libm::log(below_one)) / self.sharpness
    }
}

fn signed_root<T: Real>(square: T) -> T {
    square.abs().sqrt() * square.signum()
}
