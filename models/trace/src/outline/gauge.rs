//! One curve of a chain, ready to be held against many samples: what it misses each by, and the slopes of that.

use dvp_core::Vec2;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::chain::{Chain, Curve};
use super::cubic::{at, basis, nearer, unit};
use super::track::LEAST_COSINE;
use crate::sample::Sample;

/// A curve, and what all samples need of it.
pub(super) enum Gauge {
    Line(Straight),
    Arc(Round),
    Cubic(Cubic),
}

/// A curve of `N` numbers: those of its first point, its own, those of its last point.
pub(super) trait Held<const N: usize> {
    /// By how much the curve passes `sample` along its axis, in its sigmas, and the slopes of that. `t` is the sample's parameter on a cubic,
    /// made better. None where the curve has no length.
    fn miss(&self, sample: &Sample, t: &mut f64) -> Option<(f64, [f64; N])>;
}

/// A line. It is an arc of bulge 0, but most curves are lines, and less is to be computed of them.
pub(super) struct Straight {
    middle: Vec2<f64>,
    chord: Vec2<f64>,
    /// Half the chord, turned by a right angle, and its length.
    across: Vec2<f64>,
    steepness: f64,
}

/// An arc, from the middle of its chord.
pub(super) struct Round {
    middle: Vec2<f64>,
    chord: Vec2<f64>,
    bulge: f64,
}

/// A cubic.
pub(super) struct Cubic([Vec2<f64>; 4]);

impl Gauge {
    /// Curve `k` of a chain.
    pub(super) fn of(chain: &Chain, k: usize) -> Self {
        let [from, to] = [k, chain.next(k)].map(|point| chain.points[point]);
        let (middle, chord) = ((from + to) * 0.5, to - from);
        match chain.curves[k] {
            Curve::Line => {
                let across = chord.perp() * -0.5;
                Self::Line(Straight { middle, chord, across, steepness: across.length_squared().sqrt() })
            }
            Curve::Arc(bulge) => Self::Arc(Round { middle, chord, bulge }),
            Curve::Cubic([a, b]) => Self::Cubic(Cubic([from, a, b, to])),
        }
    }

    /// By how much the curve passes `sample`, as [`Held::miss`] has it; the place on a cubic is searched from `t` on.
    pub(super) fn misfit(&self, sample: &Sample, t: f64) -> Option<f64> {
        match self {
            Self::Line(line) => line.miss(sample, &mut 0.0).map(|(misfit, _)| misfit),
            Self::Arc(arc) => arc.miss(sample, &mut 0.0).map(|(misfit, _)| misfit),
            Self::Cubic(cubic) => {
                let mut t = t;
                (0..SEARCHES).filter_map(|_| cubic.miss(sample, &mut t)).last().map(|(misfit, _)| misfit)
            }
        }
    }
}

/// Steps from a guess to the place on a cubic that is nearest to a sample.
pub(super) const SEARCHES: usize = 4;

impl Held<4> for Straight {
    #[inline]
    fn miss(&self, sample: &Sample, _: &mut f64) -> Option<(f64, [f64; 4])> {
        let q = sample.point - self.middle;
        let along = held(self.across.dot(sample.axis), self.steepness) * sample.sigma;
        if self.steepness <= 0.0 || !along.is_finite() {
            return None;
        }
        let scale = -1.0 / along;
        let by_chord = q.perp() * 0.5;
        let from = (self.across * -0.5 - by_chord) * scale;
        let to = (self.across * -0.5 + by_chord) * scale;
        Some((-0.5 * self.chord.cross(q) * scale, [from.x, from.y, to.x, to.y]))
    }
}

impl Held<5> for Round {
    /// The circle through both ends is where g = bulge (|q|^2 - |c|^2 / 4) + (bulge^2 - 1) / 2 (c x q) is 0: c the chord, q from its middle
    /// to the point.
    #[inline]
    fn miss(&self, sample: &Sample, _: &mut f64) -> Option<(f64, [f64; 5])> {
        let Self { middle, chord, bulge } = *self;
        let q = sample.point - middle;
        let (quarter, cross) = (q.length_squared() - 0.25 * chord.length_squared(), chord.cross(q));
        let factor = 0.5 * (bulge * bulge - 1.0);
        let g = bulge * quarter + factor * cross;
        let by_q = q * (2.0 * bulge) + chord.perp() * factor;
        let by_chord = chord * (-0.5 * bulge) - q.perp() * factor;
        let steepness = by_q.length_squared().sqrt();
        let along = held(by_q.dot(sample.axis), steepness) * sample.sigma;
        if steepness <= 0.0 || !along.is_finite() {
            return None;
        }
        let scale = -1.0 / along;
        let (from, to) = ((by_q * -0.5 - by_chord) * scale, (by_q * -0.5 + by_chord) * scale);
        Some((g * scale, [from.x, from.y, (quarter + bulge * cross) * scale, to.x, to.y]))
    }
}

impl Held<8> for Cubic {
    #[inline]
    fn miss(&self, sample: &Sample, t: &mut f64) -> Option<(f64, [f64; 8])> {
        let Self(cubic) = self;
        *t = nearer(cubic, sample.point, *t);
        let (place, velocity) = at(cubic, *t);
        let across = unit(velocity)?.perp();
        let across = across / (held(across.dot(sample.axis), 1.0) * sample.sigma);
        let [from, a, b, to] = basis(*t).map(|share| across * share);
        Some(((place - sample.point).dot(across), [from.x, from.y, a.x, a.y, b.x, b.y, to.x, to.y]))
    }
}

/// A component of a vector of given length, away from 0.
fn held(component: f64, length: f64) -> f64 {
    let least = LEAST_COSINE * length;
    if component.abs() >= least { component } else { least.copysign(component) }
}
