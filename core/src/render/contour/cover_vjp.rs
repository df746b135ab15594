//! Backward: gradient of coverage to gradient of the vertices of the closest edge.
//!
//! With q = a + u (b - a) the closest point and e = x - q: d(d2)/da = -2 (1 - u) e, d(d2)/db = -2 u e; u itself needs no
//! derivative, for d2 is at its minimum over u, or u is clamped.

use super::Band;
use super::cover::ContourRecord;
use super::edge::BLOCK;
use crate::real::Real;
use crate::render::tile::{ChunkState, LANES, Tile};
use crate::simd::Kernel;

/// The backward kernel.
pub(super) struct CoverVjp<'a, T> {
    pub(super) band: Band<T>,
    pub(super) tile: &'a mut Tile<T>,
    pub(super) record: &'a mut ContourRecord<T>,
    pub(super) grad_outline_px: &'a mut [[T; 2]],
}

impl<T: Real> Kernel for CoverVjp<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(mut self) {
        self.scale_to_squared();
        for index in 0..self.record.edges.len() {
            self.sum_to_vertices(index);
        }
    }
}

impl<T: Real> CoverVjp<'_, T> {
    /// Replaces the gradient of coverage by that of the unsigned squared distance, times -2 for [`Self::sum_to_vertices`].
    #[inline(always)]
    fn scale_to_squared(&mut self) {
        let window = self.tile.window();
        let scale = T::of(2.0) * self.band.sharpness;
        for chunk in 0..window.chunks * window.rows {
            if self.tile.states[chunk] != ChunkState::Mixed {
                continue;
            }
            let (p, grad) = (&self.tile.coverage[chunk], &mut self.tile.grad[chunk]);
            let inside = self.record.inside[chunk];
            for i in 0..LANES {
                let side = if (inside >> i) & 1 == 1 { -scale } else { scale };
                grad[i] *= (p[i] * (T::one() - p[i])) * side;
            }
        }
    }

    /// Sums over the pixels closest to an edge.
    #[inline(always)]
    fn sum_to_vertices(&mut self, index: usize) {
        let edge = self.record.edges[index];
        let [dx, dy] = edge.along;
        let name = T::of_usize(index);
        let window = self.tile.window();
        let (grad, closest) = (self.tile.grad.as_flattened(), &self.record.closest);
        let zeros = [T::zero(); BLOCK];
        // Sums of g e and g u e.
        let (mut sx, mut sy, mut ux, mut uy) = (zeros, zeros, zeros, zeros);
        edge.for_each_block(self.band.reach, window, |blocks| {
            let (x, share) = edge.columns(blocks.column);
            for row in blocks.top..=blocks.bottom {
                let (y, row_share) = edge.row(row);
                let start = row * window.width() + blocks.column;
                let Some(grad) = grad[start..].first_chunk::<BLOCK>() else { return };
                let Some(closest) = closest[start..].first_chunk::<BLOCK>() else { return };
                for i in 0..BLOCK {
                    let u = (share[i] + row_share).max(T::zero()).min(T::one());
                    let g = if closest[i] == name { grad[i] } else { T::zero() };
                    let (gx, gy) = (g * (x[i] - u * dx), g * (y - u * dy));
                    sx[i] += gx;
                    sy[i] += gy;
                    ux[i] += u * gx;
                    uy[i] += u * gy;
                }
            }
        });
        let [sx, sy, ux, uy] = [sx, sy, ux, uy].map(|lanes| lanes.iter().copied().sum::<T>());
        self.grad_outline_px[edge.from][0] += sx - ux;
        self.grad_outline_px[edge.from][1] += sy - uy;
        self.grad_outline_px[edge.to][0] += ux;
        self.grad_outline_px[edge.to][1] += uy;
    }
}
