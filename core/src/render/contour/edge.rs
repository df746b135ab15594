//! Edges of rings, and the blocks of pixels near them.

use crate::real::Real;
use crate::render::tile::{Window, pixel_range};
use crate::simd::lanes;

/// Pixels of a row that are worked on together; they may start at any column.
pub(super) const BLOCK: usize = 8;

/// Edges with a squared length below this are skipped, in the doubled frame's units: a repeated vertex, not an edge.
pub(super) const SHORTEST_SQUARED: f64 = 1e-12;

/// Up to this length, in pixels, positions along an edge are good to 0.01 px in f32.
const LONGEST_PX: f64 = 16_384.0;

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
    /// The pixels within reach.
    pub(super) near: Near,
}

/// The pixels near an edge: `blocks` times [`BLOCK`] columns from `column` on, rows `top..=bottom`, all counted from the
/// window's top left pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Near {
    pub(super) column: usize,
    pub(super) blocks: usize,
    /// First and last column that are really near; blocks may reach beyond them.
    pub(super) first: usize,
    pub(super) last: usize,
    pub(super) top: usize,
    pub(super) bottom: usize,
}

/// A block of pixels, seen from an edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Columns<T> {
    /// Horizontal offsets to the start of the edge.
    x: [T; BLOCK],
    /// The part that x has in the position along the edge.
    share: [T; BLOCK],
}

impl<T: Real> Edge<T> {
    /// A rectangle inside the window that holds all its pixels within `reach` of the edge; `None` if there are none.
    #[inline(always)]
    pub(super) fn find_near(&self, reach: T, window: Window) -> Option<Near> {
        let zero = T::zero();
        let [x, y] = self.start;
        let [dx, dy] = self.along;
        let (left, right) = (x + dx.min(zero) - reach, x + dx.max(zero) + reach);
        let (top, bottom) = (y + dy.min(zero) - reach, y + dy.max(zero) + reach);
        let (first, last) = pixel_range(left, right, window.width())?;
        let (top, bottom) = pixel_range(top, bottom, window.rows)?;
        let blocks = (last - first) / BLOCK + 1;
        // Blocks move left rather than leave the window.
        let column = first.min(window.width() - blocks * BLOCK);
        Some(Near { column, blocks, first, last, top, bottom })
    }

    /// The rows in which the `block`-th block near the edge has pixels within reach: those of the part of the edge that
    /// passes by. Long edges would visit their whole box otherwise.
    #[inline(always)]
    pub(super) fn rows(&self, block: usize, reach: T, window: Window) -> Option<(usize, usize)> {
        let Near { column, blocks, top, bottom, .. } = self.near;
        let [dx, dy] = self.along;
        // Of steep edges all parts pass by; of very long ones rounding hides which.
        if blocks == 1 || dx.abs() < T::one() || dx.abs() + dy.abs() > T::of(LONGEST_PX) {
            return Some((top, bottom));
        }
        let (zero, one) = (T::zero(), T::one());
        let left = T::of_usize(column + block * BLOCK) - reach - self.start[0];
        let right = left + T::of_usize(BLOCK - 1) + reach + reach;
        let (u, v) = ((left / dx).max(zero).min(one), (right / dx).max(zero).min(one));
        let (y, z) = (self.start[1] + u * dy, self.start[1] + v * dy);
        // Half a pixel more, so that rounding loses none.
        let margin = reach + T::of(0.5);
        pixel_range(y.min(z) - margin, y.max(z) + margin, window.rows)
    }

    /// What the pixels of a block share in all rows.
    #[inline(always)]
    pub(super) fn columns(&self, column: usize) -> Columns<T> {
        let left = T::of_usize(column) - self.start[0];
        let x: [T; BLOCK] = lanes(|i| left + T::of_usize(i));
        let slope = self.along[0] * self.inverse_squared;
        Columns { x, share: lanes(|i| x[i] * slope) }
    }

    /// Offsets from the closest points of the edge to a block of pixels, and the closest points' positions along the edge,
    /// in \[0, 1\].
    #[inline(always)]
    pub(super) fn offsets<const FUSED: bool>(
        &self,
        columns: &Columns<T>,
        row: T,
    ) -> ([T; BLOCK], [T; BLOCK], [T; BLOCK]) {
        let (zero, one) = (T::zero(), T::one());
        let [dx, dy] = self.along;
        let y = row - self.start[1];
        let row_share = y * (dy * self.inverse_squared);
        // One operation for all lanes after the other: loops that do several become branches.
        let position: [T; BLOCK] = lanes(|i| columns.share[i] + row_share);
        let position: [T; BLOCK] = lanes(|i| if position[i] > zero { position[i] } else { zero });
        let position: [T; BLOCK] = lanes(|i| if position[i] < one { position[i] } else { one });
        let ex = lanes(|i| position[i].times_plus::<FUSED>(-dx, columns.x[i]));
        let ey = lanes(|i| position[i].times_plus::<FUSED>(-dy, y));
        (ex, ey, position)
    }
}
