//! Backward: gradient of coverage to gradient of the vertices of the closest edge.
//!
//! With q = a + u (b - a) the closest point and e = x - q: d(d2)/da = -2 (1 - u) e, d(d2)/db = -2 u e; u itself needs no
//! derivative, for d2 is at its minimum over u, or u is clamped.

use super::Band;
use super::cover::ContourRecord;
use super::edge::BLOCK;
use crate::real::Real;
use crate::render::tile::{LANES, Lanes, Tile};
use crate::simd::{Kernel, lanes};

/// The backward kernel.
pub(super) struct CoverVjp<'a, T> {
    pub(super) band: Band<T>,
    pub(super) tile: &'a mut Tile<T>,
    pub(super) record: &'a mut ContourRecord<T>,
    pub(super) grad_px: &'a mut [[T; 2]],
}

impl<T: Real> Kernel for CoverVjp<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.pull_back::<false>();
    }

    #[inline(always)]
    fn run_fused(self) {
        self.pull_back::<true>();
    }
}

impl<T: Real> CoverVjp<'_, T> {
    #[inline(always)]
    fn pull_back<const FUSED: bool>(mut self) {
        self.scale_to_squared();
        for index in 0..self.record.edges.len() {
            self.sum_to_vertices::<FUSED>(index);
        }
    }

    /// Replaces the gradient of coverage by that of the unsigned squared distance, times -2 for [`Self::sum_to_vertices`].
    #[inline(always)]
    fn scale_to_squared(&mut self) {
        let (one, profile) = (T::one(), self.band.profile);
        let scale = if profile.squared { T::of(2.0) * profile.sharpness } else { profile.sharpness };
        for &chunk in &self.record.mixed {
            let (p, grad) = (&self.tile.coverage[chunk], &mut self.tile.grad[chunk]);
            let inside = self.record.inside[chunk];
            let slope: Lanes<T> = lanes(|i| p[i] * (one - p[i]));
            let side: Lanes<T> = lanes(|i| if (inside >> i) & 1 == 1 { -scale } else { scale });
            *grad = lanes(|i| grad[i] * (slope[i] * side[i]));
            if !profile.squared {
                // d(d) = d(d2) / (2 d); on the outline itself there is no direction.
                let Some(squared) = self.record.squared[chunk * LANES..].first_chunk::<LANES>() else { return };
                let far: Lanes<T> = lanes(|i| squared[i].sqrt());
                *grad = lanes(|i| if far[i] > T::zero() { grad[i] / far[i] } else { T::zero() });
            }
        }
    }

    /// Sums over the pixels closest to an edge.
    #[inline(always)]
    fn sum_to_vertices<const FUSED: bool>(&mut self, index: usize) {
        let edge = self.record.edges[index];
        let name = T::of_usize(index);
        let window = self.tile.window();
        let (grad, closest) = (self.tile.grad.as_flattened(), &self.record.closest);
        // Sums of g e and g u e. Even and odd rows have their own, which keeps them in memory: the loop vectorizes then.
        let mut sums = [[[T::zero(); BLOCK]; 4]; 2];
        let near = edge.near;
        for block in 0..near.blocks {
            let column = near.column + block * BLOCK;
            let columns = edge.columns(column);
            let Some((top, bottom)) = edge.rows(block, self.band.reach, window) else { continue };
            let mut y = T::of_usize(top);
            for row in top..=bottom {
                let start = row * window.width() + column;
                let Some(grad) = grad[start..].first_chunk::<BLOCK>() else { return };
                let Some(closest) = closest[start..].first_chunk::<BLOCK>() else { return };
                let (grad, closest) = (*grad, *closest);
                let (ex, ey, position) = edge.offsets::<FUSED>(&columns, y);
                y += T::one();
                let g: [T; BLOCK] = lanes(|i| if closest[i] == name { grad[i] } else { T::zero() });
                let gx: [T; BLOCK] = lanes(|i| g[i] * ex[i]);
                let gy: [T; BLOCK] = lanes(|i| g[i] * ey[i]);
                let [sx, sy, ux, uy] = &mut sums[row % 2];
                *sx = lanes(|i| sx[i] + gx[i]);
                *sy = lanes(|i| sy[i] + gy[i]);
                *ux = lanes(|i| position[i].times_plus::<FUSED>(gx[i], ux[i]));
                *uy = lanes(|i| position[i].times_plus::<FUSED>(gy[i], uy[i]));
            }
        }
        let [even, odd] = sums;
        let [sx, sy, ux, uy] = lanes(|i| (0..BLOCK).map(|lane| even[i][lane] + odd[i][lane]).sum::<T>());
        self.grad_px[edge.from][0] += sx - ux;
        self.grad_px[edge.from][1] += sy - uy;
        self.grad_px[edge.to][0] += ux;
        self.grad_px[edge.to][1] += uy;
    }
}
