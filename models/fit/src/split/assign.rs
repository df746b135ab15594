//! Refines a set of parts together: each sample belongs to the outline that reaches it first.

use alloc::vec::Vec;

use dvp_core::Real;

use super::{CROSSING_PX, Part, PartSet};
use crate::pose::equations::{Robustness, SampleLanes};
use crate::pose::field::OutlineField;
use crate::pose::gauss_newton::Frame;
use crate::pose::search::Prototype;
use crate::segment::EdgeSample;
use crate::tuning::UNION_WIDTH_PX;

/// Rounds of assignment and refinement, and the steps of each part per round.
const ROUNDS: usize = 6;
const STEPS: usize = 3;
/// Width (px) of residuals: the first rounds reach farther.
const WIDTHS: [f64; ROUNDS] = [1.0, 1.0, 0.5, 0.5, 0.3, 0.3];

impl<T: Real> Part<T> {
    /// Distance of the posed outline minus the sampled one (px), per sample; negative: the outline stands out.
    pub(super) fn residuals(&self, field: &OutlineField<T>, samples: &[EdgeSample<T>]) -> impl Iterator<Item = T> {
        let frame = Frame::new(&self.pose);
        samples.iter().map(move |sample| frame.scale * field.distance(frame.to_unit(sample.point)).0 - sample.distance)
    }
}

/// Refines `parts` on the samples nearest to each.
pub(super) fn refine<T: Real>(
    mut parts: Vec<Part<T>>,
    samples: &[EdgeSample<T>],
    prototypes: &[Prototype<T>],
) -> PartSet<T> {
    let mut own: Vec<Vec<EdgeSample<T>>> = alloc::vec![Vec::new(); parts.len()];
    for width in WIDTHS {
        assign(&parts, samples, prototypes, &mut own);
        let robustness = Robustness { width_px: T::of(width), rough: false };
        for (part, own) in parts.iter_mut().zip(&own) {
            let own = SampleLanes::new(own, 1, true);
            let (pose, _, _) = part.pose.refine(&prototypes[part.prototype].field, &own, robustness, STEPS);
            part.pose = pose;
        }
    }
    let cost = cost(&parts, samples, prototypes);
    PartSet { parts, cost }
}

/// Gives every sample to the part that reaches it first; those at crossings to none.
fn assign<T: Real>(
    parts: &[Part<T>],
    samples: &[EdgeSample<T>],
    prototypes: &[Prototype<T>],
    own: &mut [Vec<EdgeSample<T>>],
) {
    own.iter_mut().for_each(Vec::clear);
    let residuals: Vec<Vec<T>> =
        parts.iter().map(|part| part.residuals(&prototypes[part.prototype].field, samples).collect()).collect();
    for (i, sample) in samples.iter().enumerate() {
        let mut nearest = (T::infinity(), 0);
        let mut second = T::infinity();
        for (k, residual) in residuals.iter().map(|of_part| of_part[i]).enumerate() {
            if residual < nearest.0 {
                second = nearest.0;
                nearest = (residual, k);
            } else {
                second = second.min(residual);
            }
        }
        if second + sample.distance > T::of(CROSSING_PX) {
            own[nearest.1].push(*sample);
        }
    }
}

/// Robust mean squared distance error of the union (px^2).
fn cost<T: Real>(parts: &[Part<T>], samples: &[EdgeSample<T>], prototypes: &[Prototype<T>]) -> T {
    let mut nearest = alloc::vec![T::infinity(); samples.len()];
    for part in parts {
        for (held, residual) in nearest.iter_mut().zip(part.residuals(&prototypes[part.prototype].field, samples)) {
            *held = held.min(residual);
        }
    }
    robust_mean(nearest.into_iter())
}

/// Mean of squared residuals (px^2), those beyond [`UNION_WIDTH_PX`] counting little.
pub(super) fn robust_mean<T: Real>(residuals: impl ExactSizeIterator<Item = T>) -> T {
    let count = T::of_usize(residuals.len().max(1));
    let inverse = T::of(1.0 / (UNION_WIDTH_PX * UNION_WIDTH_PX));
    residuals.map(|r| r * r / (T::one() + r * r * inverse)).sum::<T>() / count
}
