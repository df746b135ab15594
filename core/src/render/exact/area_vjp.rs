//! Backward: how the area of each pixel follows the vertices.

use super::area::{ExactRecord, even_odd_slope, orientation};
use super::pieces::for_each_piece;
use crate::real::Real;
use crate::render::tile::{LANES, Tile};
use crate::simd::Kernel;

/// Adds to `grad_outline` the gradient of sum(grad x coverage) over the pixels of a tile.
///
/// An area changes by what its boundary sweeps: a piece of the edge from a to b moves by (1 - u) da + u db, so the pixel
/// gains the integral of that against the normal (a_y - b_y, b_x - a_x). Only pixels that the outline crosses
/// contribute: the cost is that of its length. Exact; where an axis-parallel edge lies on the pixel grid, coverage
/// has a kink and this is one of the two one-sided derivatives.
pub(super) struct CoverVjp<'a, T> {
    pub(super) tile: &'a Tile<T>,
    pub(super) record: &'a ExactRecord<T>,
    pub(super) grad_outline: &'a mut [[T; 2]],
}

impl<T: Real> Kernel for CoverVjp<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { tile, record, grad_outline } = self;
        let outline = &record.outline;
        let window = tile.window();
        let (zero, half) = (T::zero(), T::of(0.5));
        let orientation = orientation(outline);
        for (k, &a) in outline.iter().enumerate() {
            let next = if k + 1 == outline.len() { 0 } else { k + 1 };
            let b = outline[next];
            let along = [b[0] - a[0], b[1] - a[1]];
            // The longer component measures the position along the edge without cancellation.
            let axis = usize::from(along[1].abs() > along[0].abs());
            if along[axis] == zero {
                continue;
            }
            let per_length = T::one() / along[axis];
            let (mut at_a, mut at_b) = (zero, zero);
            for_each_piece(a, b, window.width(), window.rows, |piece| {
                if piece.is_left_of_window() {
                    return;
                }
                let (chunk, lane) = (piece.row * window.chunks + piece.column / LANES, piece.column % LANES);
                let share = (piece.to[axis] - piece.from[axis]) * per_length;
                let middle = (half * (piece.from[axis] + piece.to[axis]) - a[axis]) * per_length;
                let slope = even_odd_slope(record.winding[chunk][lane], orientation);
                let weight = tile.grad[chunk][lane] * slope * share;
                at_a += weight * (T::one() - middle);
                at_b += weight * middle;
            });
            for (vertex, weight) in [(k, at_a), (next, at_b)] {
                grad_outline[vertex][0] -= along[1] * weight;
                grad_outline[vertex][1] += along[0] * weight;
            }
        }
    }
}
