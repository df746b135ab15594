//! Symmetries of an outline that is known in part, and what they say of the rest.
//!
//! A turn or a reflection is credible if the samples it carries to stretches of the outline that other samples support lie
//! there, and if those it carries elsewhere are allowed there (a hidden stretch must be hidden).

use alloc::vec::Vec;

use dvp_core::Real;

use crate::free::foot::EdgeLanes;
use crate::pose::equations::{Robustness, SampleLanes};
use crate::pose::field::OutlineField;
use crate::pose::gauss_newton::{Frame, PosePx};
use crate::segment::EdgeSample;

/// Rotational symmetries looked for, the highest first.
const ORDERS: [usize; 5] = [6, 5, 4, 3, 2];
/// Directions of mirror axes tried, over half a turn, and how many of them are refined.
const AXES: usize = 36;
const REFINED_AXES: usize = 3;
/// Samples used to look for symmetries.
const SEARCH_SAMPLES: usize = 120;
/// Distance error (px) of a sample that agrees.
const AGREES_PX: f64 = 0.6;
/// Least share of the samples that must be carried to supported stretches, and of those that must agree.
const LEAST_TESTED: f64 = 0.25;
const LEAST_AGREEING: f64 = 0.9;
/// Most samples that may be carried to where they are not allowed, as a share of all.
const MOST_FORBIDDEN: f64 = 0.06;
/// Edges around that of a sample which it supports.
const SUPPORTED_EDGES: usize = 1;

/// A rigid motion, after a reflection at the x axis or not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Carry<T> {
    reflected: bool,
    /// Carries points by its inverse.
    pose: PosePx<T>,
}

impl<T: Real> Carry<T> {
    /// The turn by `angle` (radians) about `center`.
    fn turn(center: [T; 2], angle: T) -> Self {
        Self::about(center, center, angle, false)
    }

    /// The reflection at the line through `center` at `angle` (radians).
    fn reflection(center: [T; 2], angle: T) -> Self {
        Self::about([center[0], -center[1]], center, angle + angle, true)
    }

    /// R(angle) (p - from) + to.
    fn about(from: [T; 2], to: [T; 2], angle: T, reflected: bool) -> Self {
        let (sin, cos) = angle.sin_cos();
        // The inverse of a pose: R(-rotation) (p - translation).
        let back = [cos * to[0] + sin * to[1], cos * to[1] - sin * to[0]];
        let translation = [from[0] - back[0], from[1] - back[1]];
        Self { reflected, pose: PosePx { translation, log_scale: T::zero(), rotation: -angle } }
    }

    pub(super) fn point(&self, [x, y]: [T; 2]) -> [T; 2] {
        Frame::new(&self.pose).to_unit(if self.reflected { [x, -y] } else { [x, y] })
    }

    /// The point a turn leaves in place.
    fn center(&self) -> Option<[T; 2]> {
        // c = R (c - t), so (1 - R) c = -R t.
        let (sin, cos) = (-self.pose.rotation).sin_cos();
        let [x, y] = self.pose.translation;
        let (p, q) = (-(cos * x - sin * y), -(sin * x + cos * y));
        let (a, b) = (T::one() - cos, sin);
        let determinant = a * a + b * b;
        (determinant > T::of(1e-6)).then(|| [(a * p - b * q) / determinant, (b * p + a * q) / determinant])
    }

    fn refined(self, field: &OutlineField<T>, samples: &[EdgeSample<T>]) -> Self {
        let sign = if self.reflected { -T::one() } else { T::one() };
        let turned: Vec<EdgeSample<T>> =
            samples.iter().map(|s| EdgeSample { point: [s.point[0], sign * s.point[1]], ..*s }).collect();
        let turned = SampleLanes::new(&turned, 1, false);
        let mut pose = self.pose;
        for width in [2.0, 0.7] {
            let robustness = Robustness { width_px: T::of(width), rough: false };
            pose = PosePx { log_scale: T::zero(), ..pose.refine(field, &turned, robustness, 5).0 };
        }
        Self { pose, ..self }
    }
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
    pub(super) fn symmetries(&mut self, allowed: impl Fn([T; 2], T) -> bool) -> Vec<Carry<T>> {
        let stride = 1 + self.samples.len() / SEARCH_SAMPLES;
        let few: Vec<EdgeSample<T>> = self.samples.iter().step_by(stride).copied().collect();
        let full = T::of(core::f64::consts::TAU);
        let mut found = Vec::new();
        for order in ORDERS {
            let step = full / T::of_usize(order);
            let turn = Carry::turn(self.field.centroid, step).refined(self.field, &few);
            let Some(center) = turn.center() else { continue };
            if self.holds(&Carry::turn(center, step), &few, &allowed) {
                found.extend((1..order).map(|i| Carry::turn(center, step * T::of_usize(i))));
                break;
            }
        }
        if found.is_empty() {
            let mut axes: Vec<(T, Carry<T>)> = (0..AXES)
                .map(|i| {
                    let angle = T::of(core::f64::consts::PI) * T::of_usize(i) / T::of_usize(AXES);
                    let carry = Carry::reflection(self.field.centroid, angle);
                    (self.miss(&carry, &few), carry)
                })
                .collect();
            axes.sort_by(|a, b| a.0.partial_cmp(&b.0).unwrap_or(core::cmp::Ordering::Equal));
            let refined = axes.iter().take(REFINED_AXES).map(|(_, carry)| carry.refined(self.field, &few));
            let refined: Vec<Carry<T>> = refined.collect();
            found.extend(refined.into_iter().find(|carry| self.holds(carry, &few, &allowed)));
        }
        found
    }

    /// Sum of the robust misses (px^2) of the carried samples.
    fn miss(&self, carry: &Carry<T>, samples: &[EdgeSample<T>]) -> T {
        let misses = samples.iter().map(|sample| {
            let off = self.field.distance(carry.point(sample.point)).0 - sample.distance;
            let squared = off * off;
            squared / (T::one() + squared * T::of(0.25))
        });
        misses.sum()
    }

    fn holds(&mut self, carry: &Carry<T>, samples: &[EdgeSample<T>], allowed: impl Fn([T; 2], T) -> bool) -> bool {
        let (mut tested, mut agreeing, mut forbidden) = (0, 0, 0);
        for sample in samples {
            let point = carry.point(sample.point);
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
    pub(super) fn carried(&mut self, symmetries: &[Carry<T>]) -> Vec<EdgeSample<T>> {
        let mut out = Vec::new();
        for carry in symmetries {
            for sample in self.samples {
                let point = carry.point(sample.point);
                if !self.supported[self.lanes.closest(point)] {
                    out.push(EdgeSample { point, ..*sample });
                }
            }
        }
        out
    }
}
