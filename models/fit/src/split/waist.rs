//! Whether an outline may be that of two objects: where their outlines cross, that of the union bends inward.

use alloc::vec::Vec;

use dvp_core::contour::signed_area;
use dvp_core::geometry::{LineSegment, Vec2, convex_hull};
use dvp_core::{ImageSize, Real};

/// Turn (radians) over four edges from which an outline bends inward.
const INWARD: f64 = 0.12;
const SHARPLY_INWARD: f64 = 0.2;
/// Depth (px) below its convex hull at which a traced outline is surely not convex: soft pixels place it to a part of a
/// pixel.
const HOLLOW_PX: f64 = 0.75;
/// Nearer to the image border (px) an outline is held by samples on one side only.
const BORDER_PX: f64 = 3.0;

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
    let (margin, extents) = (T::of(BORDER_PX), [size.width(), size.height()].map(T::of_usize));
    let shows = |i: usize| (0..2).all(|c| outline[i][c] > margin && outline[i][c] < extents[c] - margin);
    let inward = |i: &usize| {
        let own = turns[*i];
        shows(*i) && own < T::of(-INWARD) && (1..=2).all(|k| own <= turns[(i + k) % n] && own < turns[(i + n - k) % n])
    };
    let sharp = (0..n).filter(inward).any(|i| turns[i] < T::of(-SHARPLY_INWARD));
    sharp && (0..n).filter(inward).count() >= 2
}

/// Whether no point of a traced outline (px) lies deeper below its convex hull than an outline of pixels may by chance. Two
/// objects that overlap leave hollows where their outlines cross.
pub(crate) fn is_convex<T: Real>(contour: &[[T; 2]]) -> bool {
    let hull = convex_hull(contour);
    contour.iter().all(|&point| depth(&hull, point) <= T::of(HOLLOW_PX))
}

/// How far inside a convex polygon of [`convex_hull`] a point lies.
fn depth<T: Real>(hull: &[[T; 2]], point: [T; 2]) -> T {
    LineSegment::closed(hull).fold(T::infinity(), |least, side| {
        let across = side.along.cross(Vec2::from(point) - side.from);
        least.min(across / side.along.length().max(T::of(1e-9)))
    })
}
