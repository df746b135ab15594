//! Whether an outline may be that of two objects: where their outlines cross, that of the union bends inward.

use alloc::vec::Vec;

use crate::tuning::{WAIST_BORDER_PX, WAIST_HOLLOW_PX, WAIST_SHARP_TURN, WAIST_TURN};
use dvp_core::contour::signed_area;
use dvp_core::geometry::{LineSegment, Vec2, convex_hull};
use dvp_core::{ImageSize, Real};

/// Whether a closed outline (px, the last vertex repeats the first) bends inward in at least two places that show, sharply in
/// one; beyond the image border an outline is a guess.
pub(crate) fn is_waisted<T: Real>(outline: &[[T; 2]], size: ImageSize) -> bool {
    let n = outline.len().saturating_sub(1);
    if n < 8 {
        return false;
    }
    let sign = if signed_area(&outline[..n]) > T::zero() { T::one() } else { -T::one() };
    let turn = |i: usize| {
        let (a, b, c) = (outline[(i + n - 2) % n], outline[i % n], outline[(i + 2) % n]);
        let (p, q) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
        (p[0] * q[1] - p[1] * q[0]).atan2(p[0] * q[0] + p[1] * q[1]) * sign
    };
    let turns: Vec<T> = (0..n).map(turn).collect();
    let (margin, extents) = (T::of(WAIST_BORDER_PX), [size.width(), size.height()].map(T::of_usize));
    let shows = |i: usize| (0..2).all(|c| outline[i][c] > margin && outline[i][c] < extents[c] - margin);
    let inward = |i: &usize| {
        let own = turns[*i];
        shows(*i)
            && own < T::of(-WAIST_TURN)
            && (1..=2).all(|k| own <= turns[(i + k) % n] && own < turns[(i + n - k) % n])
    };
    let sharp = (0..n).filter(inward).any(|i| turns[i] < T::of(-WAIST_SHARP_TURN));
    sharp && (0..n).filter(inward).count() >= 2
}

/// Whether no point of a traced outline (px) lies deeper below its convex hull than an outline of pixels may by chance. Two
/// objects that overlap leave hollows where their outlines cross.
pub(crate) fn is_convex<T: Real>(contour: &[[T; 2]]) -> bool {
    let hull = convex_hull(contour);
    contour.iter().all(|&point| depth(&hull, point) <= T::of(WAIST_HOLLOW_PX))
}

/// How far inside a convex polygon of [`convex_hull`] a point lies.
fn depth<T: Real>(hull: &[[T; 2]], point: [T; 2]) -> T {
    LineSegment::closed(hull).fold(T::infinity(), |least, side| {
        let across = side.along.cross(Vec2::from(point) - side.from);
        least.min(across / side.along.length().max(T::of(1e-9)))
    })
}
