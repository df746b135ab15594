//! Which edge profile a picture was drawn with, told from its soft pixels.
//!
//! Three kinds are told apart: the reference renderer's (lopsided: coverage lingers near 1 and drops off fast), area coverage
//! (what drawing programs produce: even), and hard pixels (no soft ones). Only the ratio of counts matters, so the picture's
//! size does not.

use dvp_core::Real;
use dvp_core::render::{EdgeLaw, EdgeProfile};

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

/// Counts of soft pixels between the background and one object, by coverage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct CoverageCounts {
    /// Below 0.015 or above 0.985.
    pub(crate) settled: usize,
    /// 0.015 to 0.1.
    pub(crate) low: usize,
    /// 0.1 to 0.9.
    pub(crate) middle: usize,
    /// 0.9 to 0.985.
    pub(crate) high: usize,
}

impl CoverageCounts {
    pub(crate) fn add<T: Real>(&mut self, coverage: T) {
        if coverage < T::of(0.015) || coverage > T::of(0.985) {
            self.settled += 1;
        } else if coverage < T::of(0.1) {
            self.low += 1;
        } else if coverage <= T::of(0.9) {
            self.middle += 1;
        } else {
            self.high += 1;
        }
    }

    /// The kind that the counts speak for, and another one to try where they leave a doubt.
    ///
    /// At uniform distances the reference profile gives low : middle : high as 0.34 : 1 : 0.75, area coverage
    /// 0.11 : 1 : 0.11; straight edges along the pixel grid stray from that.
    pub(crate) fn kinds<T: Real>(&self) -> (EdgeKind<T>, Option<EdgeKind<T>>) {
        let soft = self.low + self.middle + self.high;
        let reference = EdgeKind::Profile(EdgeProfile::reference());
        if soft + self.settled < FEW {
            (reference, None)
        } else if soft * 20 < self.settled {
            (EdgeKind::Hard, None)
        } else if 2 * self.high > self.middle {
            (reference, None)
        } else if 10 * self.high > self.middle && soft > FEW {
            (reference, Some(EdgeKind::Area))
        } else {
            (EdgeKind::Area, None)
        }
    }
}

/// Fewer soft pixels than this tell nothing.
const FEW: usize = 12;

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
            Self::Profile(_) => T::of(0.01),
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
