//! Edges of an outline, and the blocks of pixels near them.

use core::array;

use crate::real::Real;
use crate::render::tile::{Window, pixel_range};

/// Pixels of a row that are worked on together; they may start at any column.
pub(super) const BLOCK: usize = 8;

/// Edges with a squared length below this are skipped, in the doubled frame's units: a repeated vertex, not an edge.
pub(super) const SHORTEST_SQUARED: f64 = 1e-12;

/// An edge from `start` to `start + along`, with the window's top left pixel as origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge<T> {
    /// Index of the first vertex.
    pub(super) from: usize,
    /// Index of the second vertex.
    pub(super) to: usize,
    pub(super) start: [T; 2],
    pub(super) along: [T; 2],
    /// 1 / squared length.
    pub(super) inverse_squared: T,
}

/// [`BLOCK`] columns from `column` on, rows `top..=bottom`, counted from the window's top left pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blocks {
    pub(super) column: usize,
    pub(super) top: usize,
    pub(super) bottom: usize,
}

impl<T: Real> Edge<T> {
    /// Calls `visit` with blocks that together hold all pixels of the window within `reach` of the edge.
    #[inline(always)]
    pub(super) fn for_each_block(&self, reach: T, window: Window, mut visit: impl FnMut(Blocks)) {
        let zero = T::zero();
        let [x, y] = self.start;
        let [dx, dy] = self.along;
        let (left, right) = (x + dx.min(zero) - reach, x + dx.max(zero) + reach);
        let (top, bottom) = (y + dy.min(zero) - reach, y + dy.max(zero) + reach);
        let Some((first, last)) = pixel_range(left, right, window.width()) else { return };
        let Some((top, bottom)) = pixel_range(top, bottom, window.rows) else { return };
        // Blocks never overlap, or the backward pass would count pixels twice; they move left rather than leave the window.
        let count = (last - first) / BLOCK + 1;
        let column = first.min(window.width() - count * BLOCK);
        for i in 0..count {
            visit(Blocks { column: column + i * BLOCK, top, bottom });
        }
    }

    /// For the block of pixels at `column`: offsets to the start, and the share of the position along the edge that x decides.
    #[inline(always)]
    pub(super) fn columns(&self, column: usize) -> ([T; BLOCK], [T; BLOCK]) {
        let left = T::of_usize(column) - self.start[0];
        let x: [T; BLOCK] = array::from_fn(|i| left + T::of_usize(i));
        (x, x.map(|x| x * (self.along[0] * self.inverse_squared)))
    }

    /// The share of the position along the edge that the row decides, and the row's offset to the start.
    #[inline(always)]
    pub(super) fn row(&self, row: usize) -> (T, T) {
        let y = T::of_usize(row) - self.start[1];
        (y, y * (self.along[1] * self.inverse_squared))
    }
}
