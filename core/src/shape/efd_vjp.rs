//! The way back of [`OutlineBasis::outline`]: gradients of vertices to gradients of descriptors.

use super::ShapeError;
use super::efd::{LANES, OutlineBasis};
use crate::real::Real;

impl<T: Real> OutlineBasis<T> {
    /// Adds to `grad_rows` the gradient of sum(grad_vertices x outline) with respect to the descriptors.
    ///
    /// The outline is linear in the descriptors, so that they are not needed. *Dimensions*: K vertices, at most N rows.
    /// Allocates nothing.
    ///
    /// # Errors
    /// As [`Self::outline`].
    #[inline(never)]
    pub fn outline_vjp(&self, grad_vertices: &[[T; 2]], grad_rows: &mut [[T; 4]]) -> Result<(), ShapeError> {
        self.check(grad_rows.len(), grad_vertices.len())?;
        self.pull_back(0, grad_vertices, grad_rows);
        Ok(())
    }

    /// As [`Self::outline_vjp`] for the harmonics from `skip` + 1 on, `skip` a multiple of [`LANES`], lengths checked by the
    /// caller.
    #[inline]
    pub(crate) fn pull_back(&self, skip: usize, grad_vertices: &[[T; 2]], grad_rows: &mut [[T; 4]]) {
        let half = self.half();
        let (front, back) = grad_vertices.split_at(half);
        let groups = self.by_harmonic.chunks_exact(half).skip(skip / LANES);
        for (group, rows) in groups.zip(grad_rows.chunks_mut(LANES)) {
            let zero = [T::zero(); LANES];
            let (mut grad_a, mut grad_b, mut grad_c, mut grad_d) = (zero, zero, zero, zero);
            // The middle vertex of an odd number has no mirror.
            let mirrors = back.iter().rev().copied().chain(core::iter::once([T::zero(); 2]));
            for (([cos, sin], &[x, y]), [mirror_x, mirror_y]) in group.iter().zip(front).zip(mirrors) {
                let (x_even, x_odd) = (x + mirror_x, x - mirror_x);
                let (y_even, y_odd) = (y + mirror_y, y - mirror_y);
                for lane in 0..LANES {
                    grad_a[lane] += x_even * cos[lane];
                    grad_b[lane] += x_odd * sin[lane];
                    grad_c[lane] += y_even * cos[lane];
                    grad_d[lane] += y_odd * sin[lane];
                }
            }
            for (lane, row) in rows.iter_mut().enumerate() {
                row[0] += grad_a[lane];
                row[1] += grad_b[lane];
                row[2] += grad_c[lane];
                row[3] += grad_d[lane];
            }
        }
    }
}
