//! One shape at two places: its outline and the motion from the first to the second, moved together.
//!
//! By turns, each would wait for the other, and be held where the other one was wrong.

use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::shape::REFERENCE_VERTICES;

use super::assign;
use super::overlap::Overlap;
use crate::cholesky::{factor, packed, solve};
use crate::free::basis::Basis;
use crate::free::foot::{EdgeLanes, Foot, foot};
use crate::free::outline_fit::{FreeOutline, damp};
use crate::pose::gauss_newton::{Frame, PosePx};
use crate::segment::EdgeSample;
use crate::tuning::UNION_WIDTH_PX;

/// Numbers of a motion: where it takes the center of the outline, how it turns and how it scales.
const OF_MOTION: usize = 4;

/// An outline (px), and the motion that finds it again.
#[derive(Clone, Debug)]
pub(super) struct Pair<T> {
    pub(super) outline: FreeOutline<T>,
    pub(super) motion: PosePx<T>,
}

/// What a pair is fitted to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target<'a, T> {
    /// Those of the union.
    pub(super) samples: &'a [EdgeSample<T>],
    /// What is known of the first alone.
    pub(super) carried: &'a [EdgeSample<T>],
    pub(super) overlap: Overlap<T>,
    pub(super) basis: &'a Basis<T>,
}

/// Memory of [`Pair::refined`].
#[derive(Clone, Debug, Default)]
pub(super) struct PairScratch<T> {
    vertices: Vec<[T; 2]>,
    lanes: EdgeLanes<T>,
    hessian: Vec<T>,
    pub(super) gradient: Vec<T>,
    row: Vec<T>,
}

impl<T: Real> Pair<T> {
    /// The pair with the samples nearer to their distances.
    pub(super) fn refined(mut self, target: &Target<'_, T>, steps: usize, scratch: &mut PairScratch<T>) -> Self {
        let mut cost = self.normal(target, scratch);
        // As for outlines: weaker damping lets vertices slide.
        let weakest = T::of(1e-3);
        let mut damping = T::of(4e-3);
        for _ in 0..steps {
            let n = scratch.gradient.len();
            damp(&mut scratch.hessian, n, damping);
            if !factor(&mut scratch.hessian, n) {
                break;
            }
            solve(&scratch.hessian, n, &mut scratch.gradient);
            let moved = self.moved(&scratch.gradient);
            let next = moved.normal(target, scratch);
            if next < cost {
                (self, cost, damping) = (moved, next, (damping * T::of(0.25)).max(weakest));
            } else {
                damping *= T::of(10.0);
                self.normal(target, scratch);
            }
        }
        self
    }

    /// The pair after a step, which is taken off: of the outline, then of the motion.
    pub(super) fn moved(&self, step: &[T]) -> Self {
        let mut outline = self.outline.clone();
        let (of_outline, of_motion) = step.split_at(step.len() - OF_MOTION);
        for (i, &by) in of_outline.iter().enumerate() {
            *outline.coefficient_mut(i) -= by;
        }
        let lever = self.lever();
        let mut motion = self.motion;
        motion.rotation -= of_motion[2] / lever;
        motion.log_scale -= of_motion[3] / lever;
        // Turned and scaled about the center of the outline.
        let center = self.outline.center;
        let [was, is] = [self.motion, motion].map(|motion| Frame::new(&motion).to_pixels(center));
        for c in 0..2 {
            motion.translation[c] += was[c] - is[c] - of_motion[c];
        }
        Self { outline, motion }
    }

    /// How far (px) the outline moves about for a turn of 1, so that all numbers are in pixels.
    fn lever(&self) -> T {
        let squares = self.outline.rows[0].into_iter().map(|v| v * v).sum::<T>();
        (squares * T::of(0.5)).sqrt().max(T::one())
    }

    /// Normal equations of the outline and the motion, half the cost's; returns the robust cost.
    pub(super) fn normal(&self, target: &Target<'_, T>, scratch: &mut PairScratch<T>) -> T {
        let Target { samples, carried, overlap, basis } = target;
        let harmonics = self.outline.rows.len();
        let of_outline = 2 + 4 * harmonics;
        let n = of_outline + OF_MOTION;
        let PairScratch { vertices, lanes, hessian, gradient, row } = scratch;
        self.outline.write_vertices(basis, REFERENCE_VERTICES, vertices);
        lanes.set(vertices);
        for (values, len) in [(&mut *hessian, packed(n, 0)), (&mut *gradient, n), (&mut *row, n)] {
            values.clear();
            values.resize(len, T::zero());
        }
        let frame = Frame::new(&self.motion);
        let (center, lever) = (self.outline.center, self.lever());
        let inverse = T::of(1.0 / (UNION_WIDTH_PX * UNION_WIDTH_PX));
        let mut cost = T::zero();
        // The distance from an outline falls as its vertices move outward.
        let of_vertices = |row: &mut [T], foot: &Foot<T>, by: T| {
            let [start, end] = [foot.edge, foot.edge + 1].map(|vertex| basis.row(vertex, harmonics));
            let unknowns = row[..of_outline].as_chunks_mut::<2>().0.iter_mut();
            for ((unknowns, &p), &q) in unknowns.zip(start).zip(end) {
                let share = by * ((T::one() - foot.share) * p + foot.share * q);
                unknowns[0] -= share * foot.direction[0];
                unknowns[1] -= share * foot.direction[1];
            }
        };
        let mut add = |row: &[T], residual: T, weight: T| {
            let squared = residual * residual;
            let falloff = T::one() / (T::one() + squared * inverse);
            let base = weight * weight * falloff;
            cost += base * squared;
            for (i, &value) in row.iter().enumerate() {
                let by = base * falloff * value;
                gradient[i] += by * residual;
                for (h, &other) in hessian[packed(i, 0)..=packed(i, i)].iter_mut().zip(row) {
                    *h += by * other;
                }
            }
        };
        for sample in *samples {
            let back = frame.to_unit(sample.point);
            let [first, second] = [sample.point, back].map(|point| foot(vertices, lanes, point));
            let (distance, [share, other]) = overlap.union([first.distance, frame.scale * second.distance]);
            row.fill(T::zero());
            if share > T::zero() {
                of_vertices(row, &first, share);
            }
            if other > T::zero() {
                of_vertices(row, &second, other * frame.scale);
                let [nx, ny] = second.direction;
                let arm = [back[0] - center[0], back[1] - center[1]];
                let turned = nx * arm[1] - ny * arm[0];
                let grown = second.distance - nx * arm[0] - ny * arm[1];
                let in_pixels = frame.scale / lever;
                row[of_outline..].copy_from_slice(&[
                    other * (frame.sin * ny - frame.cos * nx),
                    -other * (frame.sin * nx + frame.cos * ny),
                    other * in_pixels * turned,
                    other * in_pixels * grown,
                ]);
            }
            add(row, distance - sample.distance, sample.weight);
        }
        for sample in *carried {
            let foot = foot(vertices, lanes, sample.point);
            row.fill(T::zero());
            of_vertices(row, &foot, T::one());
            add(row, foot.distance - sample.distance, sample.weight);
        }
        cost
    }

    /// Robust mean squared distance error of the union (px^2).
    pub(super) fn misfit(&self, target: &Target<'_, T>, scratch: &mut PairScratch<T>) -> T {
        let PairScratch { vertices, lanes, .. } = scratch;
        self.outline.write_vertices(target.basis, REFERENCE_VERTICES, vertices);
        lanes.set(vertices);
        let frame = Frame::new(&self.motion);
        let distance = |point: [T; 2]| foot(vertices, lanes, point).distance;
        assign::robust_mean(target.samples.iter().map(|sample| {
            let second = frame.scale * distance(frame.to_unit(sample.point));
            target.overlap.union([distance(sample.point), second]).0 - sample.distance
        }))
    }
}
