//! The way back of the outline length.

use super::length::{edge, edges};
use crate::real::Real;

/// Adds `cotangent` times the gradient of the length to `grad_vertices`; returns the length. Vertices without a partner
/// in `grad_vertices` get no gradient.
pub fn outline_length_vjp<T: Real>(vertices: &[[T; 2]], cotangent: T, grad_vertices: &mut [[T; 2]]) -> T {
    let mut sum = T::zero();
    for (i, j) in edges(vertices.len().min(grad_vertices.len())) {
        let [dx, dy, length] = edge(vertices[i], vertices[j]);
        if length > T::zero() {
            let [x, y] = [dx, dy].map(|d| cotangent * d / length);
            grad_vertices[j][0] += x;
            grad_vertices[j][1] += y;
            grad_vertices[i][0] -= x;
            grad_vertices[i][1] -= y;
        }
        sum += length;
    }
    sum
}
