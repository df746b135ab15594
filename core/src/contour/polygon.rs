//! Measures of closed polygons, and points at equal distances along them.

use alloc::vec::Vec;

use crate::real::Real;

/// The edges of a closed polygon, each as its two ends.
fn edges<T: Real>(polygon: &[[T; 2]]) -> impl Iterator<Item = [[T; 2]; 2]> + Clone {
    let ends = polygon.iter().skip(1).chain(polygon.first());
    polygon.iter().zip(ends).map(|(&start, &end)| [start, end])
}

fn length<T: Real>([start, end]: [[T; 2]; 2]) -> T {
    (end[0] - start[0]).hypot(end[1] - start[1])
}

/// The area inside, positive if the polygon turns from +x to +y (clockwise on a screen, where y is down); parts wound
/// twice count twice.
#[must_use]
pub fn signed_area<T: Real>(polygon: &[[T; 2]]) -> T {
    // From the first vertex, so that a polygon far from the origin loses no digits.
    let [[x, y], rest @ ..] = polygon else { return T::zero() };
    let (x, y) = (*x, *y);
    // The closing edge ends there and adds nothing.
    let twice: T = polygon.iter().zip(rest).map(|(p, q)| (p[0] - x) * (q[1] - y) - (q[0] - x) * (p[1] - y)).sum();
    twice * T::of(0.5)
}

/// The center of the area inside; none without area. Parts wound twice count twice.
#[must_use]
pub fn centroid<T: Real>(polygon: &[[T; 2]]) -> Option<[T; 2]> {
    let &[x, y] = polygon.first()?;
    let mut sums = [T::zero(); 3];
    for [p, q] in edges(polygon) {
        let (p, q) = ([p[0] - x, p[1] - y], [q[0] - x, q[1] - y]);
        let cross = p[0] * q[1] - q[0] * p[1];
        sums = [sums[0] + (p[0] + q[0]) * cross, sums[1] + (p[1] + q[1]) * cross, sums[2] + cross];
    }
    let weight = T::of(3.0) * sums[2];
    (weight != T::zero()).then(|| [x + sums[0] / weight, y + sums[1] / weight])
}

/// The length of all edges, the closing one included.
#[must_use]
pub fn perimeter<T: Real>(polygon: &[[T; 2]]) -> T {
    edges(polygon).map(length).sum()
}

/// Whether a point is inside by the even-odd rule; points on an edge may be on either side.
#[must_use]
pub fn contains<T: Real>(polygon: &[[T; 2]], [x, y]: [T; 2]) -> bool {
    // A ray to +x crosses edges that have one end above it and one end not.
    let crossings = edges(polygon)
        .filter(|&[p, q]| (p[1] > y) != (q[1] > y) && x < p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]));
    crossings.count() % 2 == 1
}

/// `count` points at equal distances along the polygon, the first vertex first; none if there is no vertex.
#[must_use]
pub fn resample<T: Real>(polygon: &[[T; 2]], count: usize) -> Vec<[T; 2]> {
    let step = perimeter(polygon) / T::of_usize(count.max(1));
    let mut edges = edges(polygon);
    let Some(mut edge) = edges.next() else { return Vec::new() };
    // Distance from the first vertex to the start of the edge.
    let mut before = T::zero();
    let mut points = Vec::with_capacity(count);
    for i in 0..count {
        let at = T::of_usize(i) * step;
        while before + length(edge) < at {
            before += length(edge);
            match edges.next() {
                Some(next) => edge = next,
                // Past the last edge by rounding only.
                None => break,
            }
        }
        let whole = length(edge);
        let t = if whole > T::zero() { ((at - before) / whole).min(T::one()) } else { T::zero() };
        let [p, q] = edge;
        points.push([p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])]);
    }
    points
}
