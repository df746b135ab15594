//! A hidden stretch of an outline from what is seen of it, where that repeats itself.
//!
//! In: a closed contour, which of its points are seen, and where the outline may run. A turn by a part of a circle, or a
//! reflection, is supposed wherever it carries one seen stretch onto another; it is credible if it carries every seen point
//! onto a seen one or where none could be seen, and if that ties it down. Out: the contour with its hidden stretches
//! replaced by what the motion makes of the seen ones. `suppose` finds motions that may be symmetries, `refine` moves them to
//! where they agree best, `walk` draws the hidden stretches; golden tests of hidden parts prove it.

mod motion;
mod refine;
mod suppose;
mod walk;

use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::contour::{resample, signed_area};
use dvp_core::geometry::{LineSegment, Similarity, Vec2};

use crate::Completion;
use motion::Symmetry;

/// Points of the contour that are looked at.
const POINTS: usize = 120;
/// Carried points of a reflection, which tells less than a turn, that must agree, as a share of those seen.
const LEAST_MIRRORED: f64 = 0.3;
/// Distance (px) of carried points that agree, and most of their root mean square.
const AGREES_PX: f64 = 1.2;
const MOST_RMS_PX: f64 = 0.5;
/// Carried points that must agree, as a share of those seen.
const LEAST_AGREEING: f64 = 0.25;
/// What carried points may miss, before a symmetry is refined and after.
const FIRST: Limits = Limits { agrees_px: 4.0, forbidden: 0.1, stride: 3 };
const LAST: Limits = Limits { agrees_px: AGREES_PX, forbidden: 0.02, stride: 1 };

/// What carried points may miss.
struct Limits {
    agrees_px: f64,
    /// Share of them that lies where the outline would be seen.
    forbidden: f64,
    /// Every how many points are carried.
    stride: usize,
}

/// Least turning (radians) of what agrees: an outline that is straight agrees with anything.
const LEAST_TURNING: f64 = 1.2;
const LEAST_MIRRORED_TURNING: f64 = 3.0;

/// What is seen of a closed contour.
struct Seen<'a, T> {
    points: Vec<[T; 2]>,
    /// Per point.
    shows: Vec<bool>,
    spacing: T,
    allows: &'a dyn Fn([T; 2]) -> bool,
}

/// The contour with its hidden stretches replaced, as a symmetry has them; none if there is no hidden stretch, or no
/// symmetry that completes it all.
pub(crate) fn complete<T: Real>(
    contour: &[[T; 2]],
    shows: impl Fn([T; 2]) -> bool,
    allows: &dyn Fn([T; 2]) -> bool,
) -> Option<(Vec<[T; 2]>, Completion)> {
    let mut points = resample(contour, POINTS);
    if signed_area(&points) < T::zero() {
        points.reverse();
    }
    let step = |a: [T; 2], b: [T; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let spacing = step(*points.first()?, *points.get(1)?);
    let shows: Vec<bool> = points.iter().map(|&point| shows(point)).collect();
    let seen = Seen { points, shows, spacing, allows };
    let mut supposed = seen.turns();
    supposed.extend(seen.mirrors());
    supposed.iter().find_map(|symmetry| {
        seen.is_credible(symmetry, &symmetry.motions(), &FIRST).then_some(())?;
        let refined = seen.refined(*symmetry)?;
        let motions = refined.motions();
        seen.is_credible(&refined, &motions, &LAST).then_some(())?;
        Some((seen.walk(&motions)?, refined.completion()))
    })
}

impl<T: Real> Seen<'_, T> {
    /// Distance (px, signed) of a point to the nearest seen stretch, the normal there, and the point before it.
    fn nearest(&self, point: Vec2<T>) -> Option<(T, Vec2<T>, usize)> {
        let mut best: Option<(T, Vec2<T>, usize)> = None;
        for i in 0..POINTS {
            let j = (i + 1) % POINTS;
            if !self.shows[i] || !self.shows[j] {
                continue;
            }
            let segment = LineSegment::new(self.points[i].into(), self.points[j].into());
            let offset = segment.nearest(point).offset;
            let distance = offset.length();
            if best.is_none_or(|(nearest, ..)| distance < nearest.abs()) {
                let normal = -segment.along.perp() / segment.along.length().max(T::of(1e-4));
                let sign = if offset.dot(normal) < T::zero() { -T::one() } else { T::one() };
                best = Some((sign * distance, normal, i));
            }
        }
        best
    }

    /// Whether carried points lie on what is seen, or where nothing could be seen.
    fn is_credible(&self, symmetry: &Symmetry<T>, motions: &[Similarity<T>], limits: &Limits) -> bool {
        let mirror = matches!(symmetry, Symmetry::Mirror { .. });
        let seen = self.shows.iter().filter(|&&shows| shows).count() * motions.len();
        let most = T::of(limits.forbidden) * T::of_usize(seen) / T::of_usize(limits.stride);
        let (mut agreeing, mut squares, mut forbidden) = (0, T::zero(), 0);
        let mut agrees = Vec::from([false; POINTS]);
        for motion in motions {
            for i in (0..POINTS).step_by(limits.stride).filter(|&i| self.shows[i]) {
                let at = motion.point(self.points[i].into());
                match self.nearest(at) {
                    Some((distance, ..)) if distance.abs() < T::of(limits.agrees_px) => {
                        agreeing += 1;
                        squares += distance * distance;
                        agrees[i] = true;
                    }
                    _ if (self.allows)(at.to_array()) => {}
                    _ => forbidden += 1,
                }
                if T::of_usize(forbidden) > most {
                    return false;
                }
            }
        }
        if limits.stride > 1 {
            return true;
        }
        let least = if mirror { LEAST_MIRRORED } else { LEAST_AGREEING / f64::of_usize(motions.len()) };
        let least_turning = if mirror { LEAST_MIRRORED_TURNING } else { LEAST_TURNING };
        T::of_usize(agreeing) >= T::of(least) * T::of_usize(seen)
            && squares <= T::of(MOST_RMS_PX * MOST_RMS_PX) * T::of_usize(agreeing)
            && self.turning(&agrees) >= T::of(least_turning)
    }

    /// Sum of the angles (radians, without their signs) by which the contour turns at the points, those of noise left out.
    fn turning(&self, at: &[bool]) -> T {
        // Over two points on either side: single steps are those of pixels.
        let direction = |from: usize, to: usize| {
            let (p, q) = (self.points[from % POINTS], self.points[to % POINTS]);
            [q[0] - p[0], q[1] - p[1]]
        };
        let turns = (0..POINTS).step_by(2).filter(|&i| at[i] && at[(i + 2) % POINTS] && at[(i + POINTS - 2) % POINTS]);
        let angle = |i: usize| {
            let (u, v) = (direction(i + POINTS - 2, i), direction(i, i + 2));
            (u[0] * v[1] - u[1] * v[0]).atan2(u[0] * v[0] + u[1] * v[1])
        };
        turns.map(|i| angle(i).abs()).filter(|&angle| angle > T::of(0.05)).sum()
    }
}
