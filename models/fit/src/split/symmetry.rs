//! Symmetries of an outline that is known in part, and what they say of the rest.
//!
//! A turn or a reflection is credible if the samples it carries to stretches of the outline that other samples support lie
//! there, and if those it carries elsewhere are allowed there (a hidden stretch must be hidden).

use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::geometry::Similarity;
use dvp_core::sort;

use crate::free::foot::EdgeLanes;
use crate::pose::equations::{Robustness, SampleLanes};
use crate::pose::field::OutlineField;
use crate::pose::gauss_newton::PosePx;
use crate::segment::EdgeSample;
use crate::tuning::{AGREES_PX, LEAST_AGREEING, LEAST_TESTED, MOST_FORBIDDEN};

/// Rotational symmetries looked for, the highest first.
const ORDERS: [usize; 5] = [6, 5, 4, 3, 2];
/// Directions of mirror axes tried, over half a turn, and how many of them are refined.
const AXES: usize = 36;
const REFINED_AXES: usize = 3;
/// Samples used to look for symmetries.
const SEARCH_SAMPLES: usize = 120;
/// Edges around that of a sample which it supports.
const SUPPORTED_EDGES: usize = 1;

/// A symmetry moved to where the samples that it carries agree best with the outline.
fn refined<T: Real>(
    symmetry: Similarity<T>,
    field: &OutlineField<T>,
    samples: &[EdgeSample<T>],
) -> Option<Similarity<T>> {
    let mirrored = |point: [T; 2]| if symmetry.reflected { [point[0], -point[1]] } else { point };
    let carried: Vec<EdgeSample<T>> = samples.iter().map(|s| EdgeSample { point: mirrored(s.point), ..*s }).collect();
    let carried = SampleLanes::new(&carried, 1, false);
    // Poses take the unit outline to the samples; a symmetry takes the samples to the outline.
    let back = Similarity { reflected: false, ..symmetry }.inverse()?;
    let mut pose = PosePx { translation: back.translation.to_array(), log_scale: T::zero(), rotation: back.angle() };
    for width in [2.0, 0.7] {
        let robustness = Robustness { width_px: T::of(width), rough: false };
        pose = PosePx { log_scale: T::zero(), ..pose.refine(field, &carried, robustness, 5).0 };
    }
    Some(Similarity { reflected: symmetry.reflected, ..pose.similarity().inverse()? })
}

/// An outline with what is known of it.
#[derive(Debug)]
pub(super) struct PartlyKnown<'a, T> {
    field: &'a OutlineField<T>,
    samples: &'a [EdgeSample<T>],
    lanes: EdgeLanes<T>,
    supported: Vec<bool>,
}

impl<'a, T: Real> PartlyKnown<'a, T> {
    /// `outline` is closed (the last vertex repeats the first), `field` its distance.
    pub(super) fn new(outline: &[[T; 2]], field: &'a OutlineField<T>, samples: &'a [EdgeSample<T>]) -> Self {
        let mut lanes = EdgeLanes::default();
        lanes.set(outline);
        let edges = outline.len() - 1;
        let mut supported = alloc::vec![false; edges];
        for sample in samples {
            let at = lanes.closest(sample.point) + edges;
            for edge in at - SUPPORTED_EDGES..=at + SUPPORTED_EDGES {
                supported[edge % edges] = true;
            }
        }
        Self { field, samples, lanes, supported }
    }

    /// The symmetries of the outline but for the identity; `allowed` tells whether an outline may pass at a distance
    /// (px) from a point.
    pub(super) fn symmetries(&mut self, allowed: impl Fn([T; 2], T) -> bool) -> Vec<Similarity<T>> {
        let stride = 1 + self.samples.len() / SEARCH_SAMPLES;
        let few: Vec<EdgeSample<T>> = self.samples.iter().step_by(stride).copied().collect();
        let full = T::of(core::f64::consts::TAU);
        let mut found = Vec::new();
        for order in ORDERS {
            let step = full / T::of_usize(order);
            let turn = refined(Similarity::turn_about(self.field.centroid.into(), step), self.field, &few);
            let Some(center) = turn.and_then(|turn| turn.fixed_point()) else { continue };
            if self.holds(&Similarity::turn_about(center, step), &few, &allowed) {
                found.extend((1..order).map(|i| Similarity::turn_about(center, step * T::of_usize(i))));
                break;
            }
        }
        if found.is_empty() {
            let mut axes: Vec<(T, Similarity<T>)> = (0..AXES)
                .map(|i| {
                    let angle = T::of(core::f64::consts::PI) * T::of_usize(i) / T::of_usize(AXES);
                    let mirror = Similarity::reflection(self.field.centroid.into(), angle);
                    (self.miss(&mirror, &few), mirror)
                })
                .collect();
            sort::ascending(&mut axes, |(miss, _)| miss.as_f64());
            let near = axes.iter().take(REFINED_AXES);
            let moved: Vec<Similarity<T>> = near.filter_map(|(_, axis)| refined(*axis, self.field, &few)).collect();
            found.extend(moved.into_iter().find(|mirror| self.holds(mirror, &few, &allowed)));
        }
        found
    }

    /// Sum of the robust misses (px^2) of the carried samples.
    fn miss(&self, symmetry: &Similarity<T>, samples: &[EdgeSample<T>]) -> T {
        let misses = samples.iter().map(|sample| {
            let off = self.field.distance(symmetry.point(sample.point.into()).to_array()).0 - sample.distance;
            let squared = off * off;
            squared / (T::one() + squared * T::of(0.25))
        });
        misses.sum()
    }

    fn holds(
        &mut self,
        symmetry: &Similarity<T>,
        samples: &[EdgeSample<T>],
        allowed: impl Fn([T; 2], T) -> bool,
    ) -> bool {
        let (mut tested, mut agreeing, mut forbidden) = (0, 0, 0);
        for sample in samples {
            let point = symmetry.point(sample.point.into()).to_array();
            forbidden += usize::from(!allowed(point, sample.distance));
            if self.supported[self.lanes.closest(point)] {
                tested += 1;
                let off = self.field.distance(point).0 - sample.distance;
                agreeing += usize::from(off.abs() <= T::of(AGREES_PX));
            }
        }
        let share = |part: usize, all: usize| T::of_usize(part) / T::of_usize(all.max(1));
        share(tested, samples.len()) >= T::of(LEAST_TESTED)
            && share(agreeing, tested) >= T::of(LEAST_AGREEING)
            && share(forbidden, samples.len()) <= T::of(MOST_FORBIDDEN)
    }

    /// The samples that `symmetries` carry to stretches without any.
    pub(super) fn carried(&mut self, symmetries: &[Similarity<T>]) -> Vec<EdgeSample<T>> {
        let mut out = Vec::new();
        for symmetry in symmetries {
            for sample in self.samples {
                let point = symmetry.point(sample.point.into()).to_array();
                if !self.supported[self.lanes.closest(point)] {
                    out.push(EdgeSample { point, ..*sample });
                }
            }
        }
        out
    }
}
