//! A staircase of cracks smoothed to a polygon that encloses as much.

use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::contour::{perimeter, resample, signed_area};

/// Passes of the mean with weights 1, 2, 1: together a bell of 2 cracks (standard deviation).
const PASSES: usize = 8;
/// Distance of the vertices of the polygon, px.
const SPACING_PX: f64 = 1.5;
/// Vertices of a ring, at least.
const FEWEST_VERTICES: usize = 8;

/// The polygon near the middles of cracks, with the signed area that they enclose in truth.
///
/// What a bell takes from a curve, and what another bell takes from that, is given back, so that curves whose radius is a few
/// pixels keep it.
pub(super) fn smooth_polygon<T: Real>(middles: &[[T; 2]], area: T) -> Vec<[T; 2]> {
    let smooth = blurred(middles);
    let taken: Vec<[T; 2]> = middles.iter().zip(&smooth).map(|(p, q)| [p[0] - q[0], p[1] - q[1]]).collect();
    let back = blurred(&taken);
    let smooth: Vec<[T; 2]> = smooth.iter().zip(&back).map(|(p, q)| [p[0] + q[0], p[1] + q[1]]).collect();
    let count = (perimeter(&smooth) / T::of(SPACING_PX)).to_count().max(FEWEST_VERTICES);
    let mut polygon = resample(&smooth, count);
    // Twice: moved vertices enclose what was missing only to first order.
    for _ in 0..2 {
        polygon = grown(&polygon, (area - signed_area(&polygon)) / perimeter(&polygon).max(T::of(1e-6)));
    }
    polygon
}

/// The closed chain under a bell.
fn blurred<T: Real>(points: &[[T; 2]]) -> Vec<[T; 2]> {
    let n = points.len();
    let (half, quarter) = (T::of(0.5), T::of(0.25));
    let mut blurred = points.to_vec();
    for _ in 0..PASSES {
        let before = blurred.clone();
        for (i, point) in blurred.iter_mut().enumerate() {
            let (a, b) = (before[(i + n - 1) % n], before[(i + 1) % n]);
            *point = [0, 1].map(|axis| half * before[i][axis] + quarter * (a[axis] + b[axis]));
        }
    }
    blurred
}

/// The polygon with its vertices moved by `distance` to the outside of a ring that turns from +x to +y.
fn grown<T: Real>(polygon: &[[T; 2]], distance: T) -> Vec<[T; 2]> {
    let n = polygon.len();
    let moved = |i: usize| {
        let (a, b) = (polygon[(i + n - 1) % n], polygon[(i + 1) % n]);
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        let step = distance / x.hypot(y).max(T::of(1e-6));
        [polygon[i][0] + y * step, polygon[i][1] - x * step]
    };
    (0..n).map(moved).collect()
}
