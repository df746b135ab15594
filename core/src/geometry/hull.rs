//! Convex hulls.

use alloc::vec::Vec;

use super::Vec2;
use crate::real::Real;
use crate::sort;

/// The corners of the convex hull, in the direction of a turn from +x toward +y (clockwise on a screen), without points
/// on its sides; fewer than three if all points lie on a line, anything of points that are not finite.
///
/// Time: n log n. *Source*: A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979.
///
/// # Examples
/// ```
/// let points = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.5], [2.0, 2.0], [0.0, 2.0]];
/// assert_eq!(dvp_core::geometry::convex_hull(&points), [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
/// ```
#[must_use]
pub fn convex_hull<T: Real>(points: &[[T; 2]]) -> Vec<[T; 2]> {
    let mut sorted = points.to_vec();
    sort::ascending(&mut sorted, |point| point[1].as_f64());
    sort::ascending(&mut sorted, |point| point[0].as_f64());
    sorted.dedup();
    if sorted.len() < 2 {
        return sorted;
    }
    let mut hull: Vec<[T; 2]> = Vec::new();
    let mut chain = |points: &mut dyn Iterator<Item = &[T; 2]>| {
        let first = hull.len();
        for &point in points {
            push_turning(&mut hull, first, point);
        }
        hull.pop();
    };
    chain(&mut sorted.iter());
    chain(&mut sorted.iter().rev());
    hull
}

/// Appends a point to the chain `hull[first..]`, first taking away those after which the chain would not turn from +x
/// toward +y.
pub fn push_turning<T: Real>(hull: &mut Vec<[T; 2]>, first: usize, point: [T; 2]) {
    while let [.., a, b] = hull[first..] {
        let [a, b] = [Vec2::from(a), Vec2::from(b)];
        if (b - a).cross(Vec2::from(point) - a) > T::zero() {
            break;
        }
        hull.pop();
    }
    hull.push(point);
}
