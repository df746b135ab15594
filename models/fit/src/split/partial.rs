//! Poses of a prototype that explain a part of a segment's outline, the rest of theirs lying inside the segment.
//!
//! A start lays a vertex of the prototype on a sample, outward direction on outward direction, at one of a few sizes.
//! The best starts at each sample are refined with lopsided residuals: standing out is charged, lying behind is not.

use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::sort;

use super::{EXPLAINED_PX, Part};
use crate::pose::equations::{Normal, Robustness, SampleLanes};
use crate::pose::field::OutlineField;
use crate::pose::gauss_newton::{LEAST_GAIN, PosePx, wrapped};
use crate::pose::search::{Prototype, insert};
use crate::segment::{EdgeSample, Segment};
use crate::tuning::{DIRECTION_REACH_PX, LEAST_EXPLAINED, MOST_STANDING_OUT, STANDING_OUT_PX};

/// Samples that starts are laid on.
const SEEDS: usize = 16;
/// Samples that tell starts apart; refinement uses [`REFINE_SAMPLES`], the end all.
const START_SAMPLES: usize = 48;
const REFINE_SAMPLES: usize = 80;
/// Every how many vertices one is laid on a seed.
const VERTEX_STRIDE: usize = 2;
/// Sizes relative to that of a single object of the segment's area.
const SIZES: [f64; 7] = [0.3, 0.42, 0.54, 0.66, 0.78, 0.9, 1.02];
/// Starts per seed and prototype that are refined.
const KEPT: usize = 2;
/// Widths (px) of residuals behind the outline, stage by stage, and the steps of each.
const STAGES: [(f64, usize); 3] = [(2.0, 5), (1.0, 5), (0.4, 6)];

/// A part with the samples it explains.
#[derive(Clone, Debug)]
pub(super) struct Candidate<T> {
    pub(super) part: Part<T>,
    /// One bit per sample.
    pub(super) explained: Vec<u64>,
    /// Samples explained.
    pub(super) count: usize,
}

/// Parts that explain some of the samples and stand out nowhere, those that explain most first.
pub(super) fn search<T: Real>(segment: &Segment<T>, prototypes: &[Prototype<T>]) -> Vec<Candidate<T>> {
    let samples = &segment.samples;
    let mut found: Vec<Candidate<T>> = Vec::new();
    for (point, outward) in seeds(samples) {
        for (index, prototype) in prototypes.iter().enumerate() {
            for pose in starts(segment, prototype, point, outward).into_iter().flatten() {
                let pose = settle(pose.1, &prototype.field, samples);
                let part = Part { prototype: index, pose };
                let known = found.iter().any(|other| same(&other.part, &part, prototype.symmetry));
                if !known && let Some(candidate) = judge(part, &prototype.field, samples) {
                    found.push(candidate);
                }
            }
        }
    }
    sort::descending(&mut found, |candidate| candidate.count as f64);
    found
}

/// Samples far from each other, with the outward direction there.
fn seeds<T: Real>(samples: &[EdgeSample<T>]) -> Vec<([T; 2], [T; 2])> {
    let mut distances: Vec<T> = alloc::vec![T::infinity(); samples.len()];
    let mut next = 0;
    let mut out = Vec::with_capacity(SEEDS);
    for _ in 0..SEEDS.min(samples.len()) {
        let point = samples[next].point;
        out.extend(outward(samples, samples[next]).map(|direction| {
            let foot = [0, 1].map(|c| point[c] - samples[next].distance * direction[c]);
            (foot, direction)
        }));
        let mut farthest = (-T::one(), 0);
        for (i, (distance, sample)) in distances.iter_mut().zip(samples).enumerate() {
            *distance = distance.min(squared(sample.point, point));
            if *distance > farthest.0 {
                farthest = (*distance, i);
            }
        }
        next = farthest.1;
    }
    out
}

fn squared<T: Real>(a: [T; 2], b: [T; 2]) -> T {
    (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])
}

/// The direction in which distances grow around a sample; none where they are not those of a smooth outline.
fn outward<T: Real>(samples: &[EdgeSample<T>], at: EdgeSample<T>) -> Option<[T; 2]> {
    // Least squares of distance = n.(p - p0) + c over the neighbors: means first, then a 2 x 2 system.
    let reach = T::of(DIRECTION_REACH_PX * DIRECTION_REACH_PX);
    let near = || samples.iter().filter(move |sample| squared(sample.point, at.point) <= reach);
    let count = T::of_usize(near().count());
    let mut mean = [T::zero(); 3];
    for sample in near() {
        for (sum, value) in mean.iter_mut().zip([sample.point[0], sample.point[1], sample.distance]) {
            *sum += value / count;
        }
    }
    let (mut xx, mut xy, mut yy, mut xd, mut yd) = (T::zero(), T::zero(), T::zero(), T::zero(), T::zero());
    for sample in near() {
        let (x, y, d) = (sample.point[0] - mean[0], sample.point[1] - mean[1], sample.distance - mean[2]);
        xx += x * x;
        xy += x * y;
        yy += y * y;
        xd += x * d;
        yd += y * d;
    }
    let determinant = xx * yy - xy * xy;
    if count < T::of(4.0) || determinant <= T::of(1e-6) {
        return None;
    }
    let n = [(yy * xd - xy * yd) / determinant, (xx * yd - xy * xd) / determinant];
    let length = (n[0] * n[0] + n[1] * n[1]).sqrt();
    (length > T::of(0.6)).then(|| [n[0] / length, n[1] / length])
}

/// Starts at one seed: the best few over vertices and sizes.
fn starts<T: Real>(
    segment: &Segment<T>,
    prototype: &Prototype<T>,
    point: [T; 2],
    outward: [T; 2],
) -> [Option<(T, PosePx<T>)>; KEPT] {
    let samples = SampleLanes::new(&segment.samples, 1 + segment.samples.len() / START_SAMPLES, false);
    let mut best = [None; KEPT];
    let vertices = prototype.outline.len() - 1;
    // Symmetric vertices give symmetric poses; a disk needs one vertex.
    let used = if prototype.symmetry == 0 { 1 } else { vertices.div_ceil(prototype.symmetry) };
    let single = (T::of_usize(segment.pixels) / prototype.field.area).sqrt();
    for i in (0..used).step_by(VERTEX_STRIDE) {
        // The middle of an edge has a direction, a vertex does not.
        let (a, b) = (prototype.outline[i], prototype.outline[i + 1]);
        let half = T::of(0.5);
        let middle = [half * (a[0] + b[0]), half * (a[1] + b[1])];
        let (_, normal) = prototype.field.distance(middle);
        let rotation = outward[1].atan2(outward[0]) - normal[1].atan2(normal[0]);
        let (sin, cos) = rotation.sin_cos();
        for size in SIZES {
            let scale = T::of(size) * single;
            let turned = [cos * middle[0] - sin * middle[1], sin * middle[0] + cos * middle[1]];
            let translation = [point[0] - scale * turned[0], point[1] - scale * turned[1]];
            let pose = PosePx { translation, log_scale: scale.ln(), rotation };
            let cost = lopsided(&pose, &prototype.field, &samples, T::of(STAGES[0].0)).cost;
            insert(&mut best, cost, pose);
        }
    }
    best
}

/// Normal equations of a pose that may lie behind the samples: residuals beyond `width_px` stop counting there, and only
/// beyond [`STANDING_OUT_PX`] in front.
fn lopsided<T: Real>(pose: &PosePx<T>, field: &OutlineField<T>, samples: &SampleLanes<T>, width_px: T) -> Normal<T> {
    let one = T::one();
    let behind = one / (width_px * width_px);
    let before = T::of(1.0 / (STANDING_OUT_PX * STANDING_OUT_PX));
    let robustness = Robustness { width_px, rough: false };
    pose.normal_by(field, samples, robustness, |residual| if residual < T::zero() { before } else { behind })
}

fn settle<T: Real>(mut pose: PosePx<T>, field: &OutlineField<T>, samples: &[EdgeSample<T>]) -> PosePx<T> {
    let samples = SampleLanes::new(samples, 1 + samples.len() / REFINE_SAMPLES, false);
    for (width, steps) in STAGES {
        let (moved, _, _) =
            pose.descend(steps, T::of(LEAST_GAIN), |pose| lopsided(pose, field, &samples, T::of(width)));
        pose = moved;
    }
    pose
}

/// What a part explains; none if it stands out or explains next to nothing.
fn judge<T: Real>(part: Part<T>, field: &OutlineField<T>, samples: &[EdgeSample<T>]) -> Option<Candidate<T>> {
    let mut explained = alloc::vec![0_u64; samples.len().div_ceil(64)];
    let (mut count, mut before) = (0, 0);
    let limit = T::of(EXPLAINED_PX);
    for (i, residual) in part.residuals(field, samples).enumerate() {
        if residual.abs() <= limit {
            explained[i / 64] |= 1 << (i % 64);
            count += 1;
        }
        before += usize::from(residual < -(limit + limit));
    }
    let all = T::of_usize(samples.len());
    let good =
        T::of_usize(before) <= T::of(MOST_STANDING_OUT) * all && T::of_usize(count) >= T::of(LEAST_EXPLAINED) * all;
    good.then_some(Candidate { part, explained, count })
}

/// Whether two parts are one up to symmetry.
fn same<T: Real>(a: &Part<T>, b: &Part<T>, symmetry: usize) -> bool {
    let near = |x: T, y: T, tolerance: f64| (x - y).abs() <= T::of(tolerance);
    let turn = T::of(core::f64::consts::TAU) / T::of_usize(symmetry.max(1));
    let off = wrapped(a.pose.rotation - b.pose.rotation, turn).abs();
    a.prototype == b.prototype
        && near(a.pose.translation[0], b.pose.translation[0], 0.3)
        && near(a.pose.translation[1], b.pose.translation[1], 0.3)
        && near(a.pose.log_scale, b.pose.log_scale, 0.03)
        && (symmetry == 0 || off <= T::of(0.04))
}
