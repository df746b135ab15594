//! What a fit cannot tell: how much of an outline is out of sight.

use dvp_core::contour::contains;
use dvp_core::geometry::{Bounds, LineSegment};
use dvp_core::{ImageSize, Real};

use alloc::vec::Vec;

/// Share of the vertices that lie in the image.
pub(crate) fn visible_share<T: Real>(outline_px: &[[T; 2]], size: ImageSize) -> f64 {
    let (width, height) = (T::of_usize(size.width()), T::of_usize(size.height()));
    let inside = |&&[x, y]: &&[T; 2]| x >= T::zero() && y >= T::zero() && x < width && y < height;
    let seen = outline_px.iter().filter(inside).count();
    T::of_usize(seen).as_f64() / T::of_usize(outline_px.len().max(1)).as_f64()
}

/// What lies no deeper (px) behind another outline than this may as well touch it.
const TOUCHING_PX: f64 = 1.0;
/// Points looked at on each edge of an outline.
const POINTS: usize = 4;

/// Share of the length of a closed outline (scene units) that lies in the image but inside of `covers`.
pub(crate) fn hidden_share<'a, T: Real>(
    outline: &[[T; 2]],
    covers: impl Iterator<Item = &'a [[T; 2]]>,
    size: ImageSize,
) -> f64 {
    let unit = T::of_usize(size.unit_px());
    let limits = [size.width(), size.height()].map(|v| T::of_usize(v) / unit);
    let Some(bounds) = Bounds::of_vertices(outline) else { return 0.0 };
    let reaches = |cover: &&[[T; 2]]| Bounds::of_vertices(cover).is_some_and(|cover| cover.meets(&bounds, T::zero()));
    let covers: Vec<&[[T; 2]]> = covers.filter(reaches).collect();
    if covers.is_empty() {
        return 0.0;
    }
    let deep = T::of(TOUCHING_PX) / unit;
    let is_hidden = |point: [T; 2]| {
        (0..2).all(|c| point[c] > T::zero() && point[c] < limits[c])
            && covers.iter().any(|cover| contains(cover, point) && is_farther(cover, point, deep))
    };
    let (mut hidden, mut total) = (T::zero(), T::zero());
    for edge in outline.windows(2) {
        let step = [0, 1].map(|c| edge[1][c] - edge[0][c]);
        let length = step[0].hypot(step[1]);
        total += length;
        for i in 0..POINTS {
            let t = (T::of_usize(i) + T::of(0.5)) / T::of_usize(POINTS);
            if is_hidden([0, 1].map(|c| edge[0][c] + t * step[c])) {
                hidden += length / T::of_usize(POINTS);
            }
        }
    }
    if total > T::zero() { (hidden / total).as_f64() } else { 0.0 }
}

/// Whether every edge of a closed outline is farther from the point than `distance`.
fn is_farther<T: Real>(outline: &[[T; 2]], point: [T; 2], distance: T) -> bool {
    let mut edges = outline.windows(2).map(|edge| LineSegment::new(edge[0].into(), edge[1].into()));
    edges.all(|edge| edge.nearest(point.into()).distance() > distance)
}
