//! Backward: how the area of each pixel follows the vertices.

use super::area::{ExactRecord, even_odd_slope};
use super::pieces::{Piece, Visit, for_each_piece};
use crate::real::Real;
use crate::render::tile::{LANES, Tile};
use crate::shape::Rings;
use crate::simd::Kernel;

/// Adds to `grad_px` the gradient of sum(grad x coverage) over the pixels of a tile.
///
/// An area changes by what its boundary sweeps: a piece of the edge from a to b moves by (1 - u) da + u db, so the pixel
/// gains the integral of that against the normal (a_y - b_y, b_x - a_x). Only pixels that an edge crosses
/// contribute: the cost is that of its length. Exact; where an axis-parallel edge lies on the pixel grid, coverage
/// has a kink and this is one of the two one-sided derivatives.
pub(super) struct CoverVjp<'a, T> {
    pub(super) rings_px: Rings<'a, T>,
    pub(super) tile: &'a Tile<T>,
    pub(super) record: &'a ExactRecord<T>,
    pub(super) grad_px: &'a mut [[T; 2]],
}

impl<T: Real> Kernel for CoverVjp<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { rings_px, tile, record, grad_px } = self;
        let window = tile.window();
        let zero = T::zero();
        for (start, end) in record.orientation.edges(rings_px) {
            let (a, b) = (record.vertices[start], record.vertices[end]);
            let along = [b[0] - a[0], b[1] - a[1]];
            // The longer component measures the position along the edge without cancellation.
            let axis = usize::from(along[1].abs() > along[0].abs());
            if along[axis] == zero {
                continue;
            }
            let per_length = T::one() / along[axis];
            let mut sweep = Sweep { tile, record, axis, origin: a[axis], per_length, at_a: zero, at_b: zero };
            for_each_piece(a, b, window.width(), window.rows, &mut sweep);
            for (vertex, weight) in [(start, sweep.at_a), (end, sweep.at_b)] {
                grad_px[vertex][0] -= along[1] * weight;
                grad_px[vertex][1] += along[0] * weight;
            }
        }
    }
}

/// Adds up how far the area under the gradient follows the two ends of an edge, per length of its normal.
struct Sweep<'a, T> {
    tile: &'a Tile<T>,
    record: &'a ExactRecord<T>,
    /// The component along which the edge is longer, where it starts there, and 1 / its length.
    axis: usize,
    origin: T,
    per_length: T,
    at_a: T,
    at_b: T,
}

impl<T: Real> Visit<T> for Sweep<'_, T> {
    #[inline(always)]
    fn piece(&mut self, piece: Piece<T>) {
        let at = piece.row * self.tile.window().chunks + piece.column / LANES;
        let lane = piece.column % LANES;
        let (from, to) = (piece.from[self.axis], piece.to[self.axis]);
        let share = (to - from) * self.per_length;
        let middle = (T::of(0.5) * (from + to) - self.origin) * self.per_length;
        let slope = even_odd_slope(self.record.winding[at][lane]);
        let weight = self.tile.grad[at][lane] * slope * share;
        self.at_a += weight * (T::one() - middle);
        self.at_b += weight * middle;
    }

    #[inline(always)]
    fn left(&mut self, _row: usize, _height: T) {}
}
