//! Samples of a boundary, one after the other, with what pieces of the outline are scored by.

use alloc::vec::Vec;
use core::ops::Range;

use dvp_core::Vec2;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::moments::Moments;
use crate::sample::{RingSamples, Sample};
use crate::tuning;

/// Position along the boundary, in samples: the direction at a sample is that of the chord this far to both sides.
const REACH: usize = 3;

/// Least cosine between the normal of the boundary and the axis of a sample that is believed: samples are taken along the axis
/// that is closer to the normal, so that less only occurs beside corners.
pub(super) const LEAST_COSINE: f64 = 0.4;

/// Samples in the order of the walk.
#[derive(Clone, Debug)]
pub(super) struct Track {
    /// The samples that can be used; their sigma includes what renderers are off by, their axis has length 1.
    pub(super) samples: Vec<Sample>,
    /// 1 / variance of the distance between the outline and each sample, 1/px^2.
    pub(super) weights: Vec<f64>,
    /// Length of the walk from the first sample to each, pixels.
    pub(super) lengths: Vec<f64>,
    /// Whether the boundary is hidden between the sample before (of the first: the last) and this one.
    pub(super) hidden: Vec<bool>,
    /// Whether the outline leads back to its start.
    pub(super) closed: bool,
    /// Median of the samples' sigma, pixels.
    pub(super) sigma: f64,
}

impl Track {
    /// The track of a closed outline; none if fewer than three samples can be used.
    pub(super) fn of_ring(ring: &RingSamples) -> Option<Self> {
        let whole = ring.closed && ring.runs.len() == 1;
        Self::new(ring.runs.iter().map(Vec::as_slice), true, whole)
    }

    /// The track of an open line; none if fewer than three samples can be used.
    pub(super) fn of_line(samples: &[Sample]) -> Option<Self> {
        Self::new(core::iter::once(samples), false, false)
    }

    fn new<'a>(runs: impl Iterator<Item = &'a [Sample]>, closed: bool, whole: bool) -> Option<Self> {
        let (mut samples, mut hidden) = (Vec::new(), Vec::new());
        for run in runs {
            let first = samples.len();
            samples.extend(run.iter().filter_map(usable));
            if samples.len() - first <= tuning::OUTLINE_SPOILED && !whole {
                // Too few to be more than what a corner beside the gap spoils.
                samples.truncate(first);
                continue;
            }
            hidden.resize(samples.len(), false);
            if let (Some(mark), false) = (hidden.get_mut(first), whole) {
                *mark = true;
            }
        }
        let mut sigmas: Vec<f64> = samples.iter().map(|sample: &Sample| sample.sigma).collect();
        if sigmas.len() < 3 {
            return None;
        }
        let (_, &mut sigma, _) = sigmas.select_nth_unstable_by(samples.len() / 2, f64::total_cmp);
        let mut track = Self { samples, weights: Vec::new(), lengths: Vec::new(), hidden, closed, sigma };
        track.weights = (0..track.len()).map(|k| track.weight(k)).collect();
        track.measure();
        Some(track)
    }

    /// How many samples there are.
    pub(super) fn len(&self) -> usize {
        self.samples.len()
    }

    /// The deviation of a sample of the track without what renderers are off by.
    pub(super) fn own_sigma(sample: &Sample) -> f64 {
        (sample.sigma * sample.sigma - tuning::RENDERER_SIGMA * tuning::RENDERER_SIGMA).max(1e-8).sqrt()
    }

    /// Where sample `k` says that the boundary is.
    pub(super) fn point(&self, k: usize) -> Vec2<f64> {
        self.samples[k].point
    }

    /// Whether the boundary is hidden somewhere between two samples.
    pub(super) fn is_hidden(&self, before: usize, after: usize) -> bool {
        let after = if after <= before { after + self.len() } else { after };
        (before + 1..=after).any(|k| self.hidden[k % self.len()])
    }

    /// Whether the boundary, hidden just before sample `k`, is seen on either side of the gap to lead away from the other side: then no piece
    /// leads over.
    pub(super) fn folds(&self, k: usize) -> bool {
        if !self.hidden[k] || k == 0 {
            return false;
        }
        let gap = self.point(k) - self.point(k - 1);
        let [before, behind] = [k - 1, k].map(|k| self.neighborhood(k, REACH));
        let is_back = |around: Range<usize>| (self.point(around.end) - self.point(around.start)).dot(gap) < 0.0;
        is_back(before) || is_back(behind)
    }

    /// The moments of the samples `range`, counted on past the last, around the first of them.
    pub(super) fn moments(&self, range: Range<usize>) -> Moments {
        let origin = self.point(range.start % self.len());
        let mut moments = Moments::default();
        for k in range.map(|k| k % self.len()) {
            moments.add(self.point(k) - origin, self.weights[k]);
        }
        moments
    }

    /// The same boundary walked from sample `start` on.
    pub(super) fn rotate(&mut self, start: usize) {
        self.samples.rotate_left(start);
        self.weights.rotate_left(start);
        self.hidden.rotate_left(start);
        self.measure();
    }

    fn measure(&mut self) {
        let mut length = 0.0;
        self.lengths = (0..self.len())
            .map(|k| {
                length += (self.point(k) - self.point(k.saturating_sub(1))).length();
                length
            })
            .collect();
    }

    /// Length of the walk along the samples `range`, counted on past the last.
    pub(super) fn length(&self, range: &Range<usize>) -> f64 {
        let count = self.len();
        let whole = (self.point(0) - self.point(count - 1)).length() + self.lengths[count - 1];
        let at = |k: usize| self.lengths[k % count] + if k / count > range.start / count { whole } else { 0.0 };
        at(range.end.saturating_sub(1).max(range.start)) - at(range.start)
    }

    /// The samples up to `reach` before and after sample `k` that are seen in one stretch with it.
    fn neighborhood(&self, k: usize, reach: usize) -> Range<usize> {
        let first = (k.saturating_sub(reach)..k).rev().take_while(|&i| !self.hidden[i + 1]).last().unwrap_or(k);
        let last = (k + 1..(k + reach + 1).min(self.len())).take_while(|&i| !self.hidden[i]).last().unwrap_or(k);
        first..last
    }

    fn weight(&self, k: usize) -> f64 {
        let Sample { axis, sigma, .. } = self.samples[k];
        let around = self.neighborhood(k, REACH);
        let chord = self.point(around.end) - self.point(around.start);
        let cosine = chord.normalized().map_or(1.0, |direction| direction.cross(axis).abs());
        (sigma * cosine.max(LEAST_COSINE)).powi(-2)
    }
}

/// The sample as it is used; none if it says nothing.
fn usable(sample: &Sample) -> Option<Sample> {
    let axis = sample.axis.normalized().filter(|axis| axis.is_finite())?;
    let good = sample.point.is_finite() && sample.sigma.is_finite() && sample.sigma >= 0.0;
    good.then(|| Sample { axis, sigma: sample.sigma.hypot(tuning::RENDERER_SIGMA), ..*sample })
}
