//! Closed paths of cubic Bezier segments as a shape model, as vector graphics and the LIVE baseline have them.

use alloc::vec::Vec;

use super::{ShapeError, ShapeModel};
use crate::real::Real;

/// Closed cubic paths: 6 parameters per segment, its start and its two control points (x, y each); a segment ends where
/// the next one starts, the last one where the first one starts.
#[derive(Clone, Debug, PartialEq)]
pub struct CubicBezier<T> {
    segment_count: usize,
    /// Bernstein weights of start, two controls and end, at the parameters j / samples of a segment.
    weights: Vec<[T; 4]>,
}

impl<T: Real> CubicBezier<T> {
    /// Paths of `segment_count` segments, each sampled at `samples` parameters from its start on.
    ///
    /// # Errors
    /// [`ShapeError::TooFewPoints`] if that makes fewer than 3 vertices.
    pub fn new(segment_count: usize, samples: usize) -> Result<Self, ShapeError> {
        let len = segment_count.saturating_mul(samples);
        if len < 3 {
            return Err(ShapeError::TooFewPoints { len });
        }
        let weights = (0..samples).map(|j| {
            let t = T::of_usize(j) / T::of_usize(samples);
            let (u, three) = (T::one() - t, T::of(3.0));
            [u * u * u, three * u * u * t, three * u * t * t, t * t * t]
        });
        Ok(Self { segment_count, weights: weights.collect() })
    }

    /// The indices of the four points of a segment.
    fn points(&self, segment: usize) -> [usize; 4] {
        let start = 3 * segment;
        [start, start + 1, start + 2, 3 * ((segment + 1) % self.segment_count)]
    }
}

impl<T: Real> ShapeModel<T> for CubicBezier<T> {
    fn parameter_count(&self) -> usize {
        6 * self.segment_count
    }

    fn vertex_count(&self) -> usize {
        self.segment_count * self.weights.len()
    }

    fn outline(&self, parameters: &[T], vertices: &mut [[T; 2]]) -> Result<(), ShapeError> {
        self.check(parameters, vertices)?;
        let points: &[[T; 2]] = parameters.as_chunks().0;
        for (segment, vertices) in vertices.chunks_exact_mut(self.weights.len()).enumerate() {
            let [p, q, r, s] = self.points(segment).map(|i| points[i]);
            for (vertex, &[wp, wq, wr, ws]) in vertices.iter_mut().zip(&self.weights) {
                *vertex = core::array::from_fn(|i| wp * p[i] + wq * q[i] + wr * r[i] + ws * s[i]);
            }
        }
        Ok(())
    }

    fn outline_vjp(
        &self,
        parameters: &[T],
        grad_vertices: &[[T; 2]],
        grad_parameters: &mut [T],
    ) -> Result<(), ShapeError> {
        self.check(parameters, grad_vertices)?;
        self.check(grad_parameters, grad_vertices)?;
        let grad_points: &mut [[T; 2]] = grad_parameters.as_chunks_mut().0;
        for (segment, grads) in grad_vertices.chunks_exact(self.weights.len()).enumerate() {
            let indices = self.points(segment);
            for (&[gx, gy], weights) in grads.iter().zip(&self.weights) {
                for (&index, &weight) in indices.iter().zip(weights) {
                    grad_points[index][0] += weight * gx;
                    grad_points[index][1] += weight * gy;
                }
            }
        }
        Ok(())
    }
}
