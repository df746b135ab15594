//! How coverage and distance belong together at the edges of a picture.
//!
//! In: soft pixels (`gather`) and their coverages. Out: which law they follow (`evidence`), and their distances to the
//! outline under it.

mod evidence;
mod gather;
#[cfg(test)]
mod tests;

use dvp_core::Real;
use dvp_core::render::{EdgeLaw, EdgeProfile};

pub(crate) use evidence::EdgeEvidence;

/// How coverage and distance belong together at the edges of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum EdgeKind<T> {
    /// A profile in distance or its square.
    Profile(EdgeProfile<T>),
    /// Share of the pixel's area.
    Area,
    /// All or nothing by the pixel's center.
    Hard,
}

impl<T: Real> EdgeKind<T> {
    /// The kind that a profile paints.
    pub(crate) fn of(profile: EdgeProfile<T>) -> Self {
        if profile.law == EdgeLaw::Area { Self::Area } else { Self::Profile(profile) }
    }

    /// The profile that renders this kind at `unit_px` pixels per scene unit.
    pub(crate) fn profile(&self, unit_px: T) -> EdgeProfile<T> {
        match self {
            Self::Profile(profile) => *profile,
            Self::Area => EdgeProfile::area(),
            Self::Hard => EdgeProfile::hard(unit_px),
        }
    }

    /// Standard deviation (px) of distances read from noiseless pixels: what the inversion itself gets wrong.
    pub(crate) fn distance_noise(&self) -> T {
        match self {
            // Exact but for the seams of whoever draws triangles.
            Self::Profile(edge) if edge.law == EdgeLaw::SquaredDistance => T::of(0.003),
            // Blur is no logistic, and rounds corners.
            Self::Profile(_) => T::of(0.02),
            // The direction of the outline is not known: up to 0.1 px along diagonals.
            Self::Area => T::of(0.05),
            // Uniform over a pixel.
            Self::Hard => T::of(0.29),
        }
    }

    /// Signed distance (px, positive outside) at which coverage is `coverage`, and the slope of coverage there per px; none
    /// where coverage is too close to 0 or 1 to tell.
    pub(crate) fn distance(&self, coverage: T, unit_px: T) -> Option<(T, T)> {
        let (one, half) = (T::one(), T::of(0.5));
        let settled = !(coverage > T::of(0.02) && coverage < T::of(0.985));
        match self {
            Self::Profile(_) | Self::Area if settled => None,
            Self::Profile(edge) => {
                let edge = edge.in_pixels(unit_px);
                let distance = edge.distance(coverage);
                Some((distance, -edge.coverage(distance).1))
            }
            // Of a half plane along the pixel grid; others differ by a few hundredths of a pixel.
            Self::Area => Some((half - coverage, one)),
            // The outline passes somewhere within half a pixel.
            Self::Hard => Some((if coverage > half { -half } else { half }, half)),
        }
    }
}
