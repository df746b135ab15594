//! The ellipse through points of a part of it.

use alloc::vec::Vec;

use dvp_core::Real;

use crate::cholesky::{factor, packed, solve};

/// Vertices of the ellipse.
const VERTICES: usize = 64;
/// Fewer points tell no ellipse.
const LEAST_POINTS: usize = 8;

/// Vertices of the ellipse that comes closest to the points; none if that is no ellipse.
///
/// x^2 + y^2 + g (x^2 - y^2) + b x y + d x + e y + f = 0 by linear least squares: biased where points are rough, and meant
/// for a start.
pub(crate) fn ellipse_through<T: Real>(points: &[[T; 2]]) -> Option<Vec<[T; 2]>> {
    if points.len() < LEAST_POINTS {
        return None;
    }
    let share = T::one() / T::of_usize(points.len());
    let mean = [0, 1].map(|c| points.iter().map(|p| p[c]).sum::<T>() * share);
    let square = |p: &[T; 2]| (p[0] - mean[0]) * (p[0] - mean[0]) + (p[1] - mean[1]) * (p[1] - mean[1]);
    let size = (points.iter().map(square).sum::<T>() * share).sqrt();
    if size <= T::zero() {
        return None;
    }
    const N: usize = 5;
    let mut matrix = [T::zero(); packed(N, 0)];
    let mut unknown = [T::zero(); N];
    for p in points {
        let [x, y] = [0, 1].map(|c| (p[c] - mean[c]) / size);
        let row = [x * x - y * y, x * y, x, y, T::one()];
        for i in 0..N {
            for j in 0..=i {
                matrix[packed(i, j)] += row[i] * row[j] * share;
            }
            unknown[i] -= row[i] * (x * x + y * y) * share;
        }
    }
    if !factor(&mut matrix, N) {
        return None;
    }
    solve(&matrix, N, &mut unknown);
    let [g, b, d, e, f] = unknown;
    // Quadratic form (p, q; q, r), center where its gradient is 0, value there.
    let (p, q, r) = (T::one() + g, b * T::of(0.5), T::one() - g);
    let determinant = p * r - q * q;
    if p <= T::zero() || determinant <= T::of(1e-3) {
        return None;
    }
    let half = T::of(-0.5) / determinant;
    let center = [half * (r * d - q * e), half * (p * e - q * d)];
    let value = f + T::of(0.5) * (d * center[0] + e * center[1]);
    if value >= T::zero() {
        return None;
    }
    // Through the Cholesky factor of the form: v = center + sqrt(-value) L^-T (cos, sin).
    let (l, radius) = (p.sqrt(), (-value).sqrt());
    let (m, n) = (q / l, (determinant / p).sqrt());
    let vertex = |i: usize| {
        let (sin, cos) = (T::of(core::f64::consts::TAU) * T::of_usize(i) / T::of_usize(VERTICES)).sin_cos();
        let y = sin / n;
        let x = (cos - m * y) / l;
        [mean[0] + size * (center[0] + radius * x), mean[1] + size * (center[1] + radius * y)]
    };
    Some((0..VERTICES).map(vertex).collect())
}
