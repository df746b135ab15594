//! Rigid motions that could take one of two equal objects to the other, told from the outline of their union.
//!
//! Let M take the first object to the second, U be their union. Every point p of the outline of U lies on one of them, so
//! M p or M^-1 p lies in U. And where both show the same stretch of their outline, M takes one to the other. A start
//! lays a point of the outline on another, outward direction on outward direction.

use alloc::vec::Vec;

use dvp_core::Real;

use crate::pose::equations::{Robustness, SampleLanes};
use crate::pose::field::OutlineField;
use crate::pose::gauss_newton::{Frame, PosePx, wrapped};
use crate::segment::EdgeSample;
use crate::tuning::{FAR_PX, INSIDE_PX, LEAST_SHIFT, MOST_INSIDE_TWICE, MOST_UNEXPLAINED, ROUGHLY_INSIDE_PX};

/// Points of the outline that starts are made of.
const ANCHORS: usize = 56;
/// Starts that are refined.
const KEPT: usize = 40;
/// Widths (px) of residuals while a motion is refined, and steps.
const WIDTHS: [f64; 2] = [1.5, 0.7];
const STEPS: usize = 6;

/// The motion (px) from where `first` places a shape to where `second` does.
pub(super) fn between<T: Real>(first: &PosePx<T>, second: &PosePx<T>) -> PosePx<T> {
    let (rotation, log_scale) = (second.rotation - first.rotation, second.log_scale - first.log_scale);
    let turn = PosePx { translation: [T::zero(); 2], log_scale, rotation };
    let [x, y] = Frame::new(&turn).to_pixels(first.translation);
    let translation = [second.translation[0] - x, second.translation[1] - y];
    PosePx { translation, ..turn }
}

/// A point of an outline with its outward direction.
#[derive(Clone, Copy, Debug)]
struct Anchor<T> {
    point: [T; 2],
    angle: T,
}

/// How well a motion explains an outline.
#[derive(Clone, Copy, Debug)]
struct Merit<T> {
    /// Mean squared distance (px^2) of points that neither it nor its inverse takes inside.
    outside: T,
    /// Share of points that either leaves more than the limit outside.
    unexplained: T,
    /// Share of points that both take inside.
    twice: T,
}

/// Motions that could take one of two equal objects to the other, the most credible first; `contour` is the outline of their
/// union, `field` its signed distance, both in px.
pub(super) fn search<T: Real>(contour: &[[T; 2]], field: &OutlineField<T>) -> Vec<PosePx<T>> {
    let anchors = anchors(contour);
    let mut kept: Vec<(T, PosePx<T>)> = Vec::with_capacity(KEPT + 1);
    let least_shift = T::of(LEAST_SHIFT) * field.area.sqrt();
    let rough = T::of(ROUGHLY_INSIDE_PX);
    for (i, a) in anchors.iter().enumerate() {
        for b in &anchors[i + 1..] {
            let pose = laid_on(*a, *b);
            let worst = if kept.len() < KEPT { T::infinity() } else { kept[KEPT - 1].0 };
            let Some(cost) = outside(&pose, &anchors, field, rough, worst) else { continue };
            if shift(&pose, &anchors) >= least_shift
                && merit(&pose, &anchors, field, rough).twice <= T::of(MOST_INSIDE_TWICE)
            {
                keep(&mut kept, cost, pose, field.centroid);
            }
        }
    }
    let samples: Vec<EdgeSample<T>> =
        contour.iter().map(|&point| EdgeSample { point, distance: T::zero(), weight: T::one() }).collect();
    let samples = SampleLanes::new(&samples, 1, false);
    let mut found: Vec<(T, PosePx<T>)> = Vec::new();
    for (_, start) in kept {
        let mut pose = start;
        for width in WIDTHS {
            let robustness = Robustness { width_px: T::of(width), rough: false };
            pose = pose.refine(field, &samples, robustness, STEPS).0;
        }
        let merit = merit(&pose, &anchors, field, T::of(INSIDE_PX));
        let credible = merit.unexplained <= T::of(MOST_UNEXPLAINED) && merit.twice <= T::of(MOST_INSIDE_TWICE);
        if credible && pose.log_scale.abs() < T::of(0.1) && shift(&pose, &anchors) >= least_shift {
            keep(&mut found, merit.outside, pose, field.centroid);
        }
    }
    found.into_iter().map(|(_, pose)| pose).collect()
}

/// Points at equal steps along the contour with outward directions.
fn anchors<T: Real>(contour: &[[T; 2]]) -> Vec<Anchor<T>> {
    let points = dvp_core::contour::resample(contour, 2 * ANCHORS);
    let n = points.len();
    let outward_sign = if dvp_core::contour::signed_area(&points) > T::zero() { T::one() } else { -T::one() };
    (0..n)
        .step_by(2)
        .map(|i| {
            let (a, b) = (points[(i + n - 2) % n], points[(i + 2) % n]);
            let (x, y) = (b[0] - a[0], b[1] - a[1]);
            Anchor { point: points[i], angle: (-x * outward_sign).atan2(y * outward_sign) }
        })
        .collect()
}

/// The rigid motion that lays `a` on `b`.
fn laid_on<T: Real>(a: Anchor<T>, b: Anchor<T>) -> PosePx<T> {
    let rotation = b.angle - a.angle;
    let (sin, cos) = rotation.sin_cos();
    let [x, y] = a.point;
    let translation = [b.point[0] - (cos * x - sin * y), b.point[1] - (sin * x + cos * y)];
    PosePx { translation, log_scale: T::zero(), rotation }
}

/// Mean displacement of the anchors.
fn shift<T: Real>(pose: &PosePx<T>, anchors: &[Anchor<T>]) -> T {
    let frame = Frame::new(pose);
    let sum: T = anchors
        .iter()
        .map(|anchor| {
            let moved = frame.to_pixels(anchor.point);
            (moved[0] - anchor.point[0]).hypot(moved[1] - anchor.point[1])
        })
        .sum();
    sum / T::of_usize(anchors.len().max(1))
}

/// Mean squared distance beyond `limit` of anchors that neither the motion nor its inverse takes inside; none if above `worst`.
fn outside<T: Real>(pose: &PosePx<T>, anchors: &[Anchor<T>], field: &OutlineField<T>, limit: T, worst: T) -> Option<T> {
    let frame = Frame::new(pose);
    let share = T::one() / T::of_usize(anchors.len().max(1));
    let mut cost = T::zero();
    // A scattered order meets a gross miss early.
    for k in 0..anchors.len() {
        let point = anchors[(k * 23) % anchors.len()].point;
        let beyond = nearest(&frame, field, point).0 - limit;
        if beyond > T::zero() {
            let beyond = beyond.min(T::of(FAR_PX));
            cost += beyond * beyond * share;
            if cost > worst {
                return None;
            }
        }
    }
    Some(cost)
}

/// The smaller and the larger of the distances of M p and M^-1 p.
fn nearest<T: Real>(frame: &Frame<T>, field: &OutlineField<T>, point: [T; 2]) -> (T, T) {
    let (there, _) = field.distance(frame.to_pixels(point));
    let (back, _) = field.distance(frame.to_unit(point));
    (there.min(back), there.max(back))
}

fn merit<T: Real>(pose: &PosePx<T>, anchors: &[Anchor<T>], field: &OutlineField<T>, limit: T) -> Merit<T> {
    let frame = Frame::new(pose);
    let share = T::one() / T::of_usize(anchors.len().max(1));
    let mut merit = Merit { outside: T::zero(), unexplained: T::zero(), twice: T::zero() };
    for anchor in anchors {
        let (near, far) = nearest(&frame, field, anchor.point);
        let beyond = near.max(T::zero()).min(T::of(FAR_PX));
        merit.outside += beyond * beyond * share;
        merit.unexplained += if near > limit { share } else { T::zero() };
        merit.twice += if far <= limit { share } else { T::zero() };
    }
    merit
}

/// Keeps the best motions, ascending, of those alike only the best; a motion and its inverse are alike.
fn keep<T: Real>(kept: &mut Vec<(T, PosePx<T>)>, cost: T, pose: PosePx<T>, center: [T; 2]) {
    if let Some(at) = kept.iter().position(|(_, other)| alike(other, &pose, center)) {
        if kept[at].0 <= cost {
            return;
        }
        kept.remove(at);
    }
    let at = kept.iter().position(|(held, _)| *held > cost).unwrap_or(kept.len());
    kept.insert(at, (cost, pose));
    kept.truncate(KEPT);
}

fn alike<T: Real>(a: &PosePx<T>, b: &PosePx<T>, center: [T; 2]) -> bool {
    let (fa, fb) = (Frame::new(a), Frame::new(b));
    let close = |p: [T; 2], q: [T; 2]| (p[0] - q[0]).hypot(p[1] - q[1]) < T::of(2.0);
    let turned = |angle: T| wrapped(angle, T::of(core::f64::consts::TAU)).abs() < T::of(0.12);
    (turned(a.rotation - b.rotation) && close(fa.to_pixels(center), fb.to_pixels(center)))
        || (turned(a.rotation + b.rotation) && close(fa.to_pixels(center), fb.to_unit(center)))
}
