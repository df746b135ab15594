//! Cuts an edge at the pixel grid.

use crate::real::Real;

/// The part of an edge that lies in one pixel of a window.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece<T> {
    /// Row of the pixel, from the top of the window.
    pub(super) row: usize,
    /// Column of the pixel, from the left of the window.
    pub(super) column: usize,
    /// Where the piece begins, in the direction of the edge.
    pub(super) from: [T; 2],
    /// Where it ends.
    pub(super) to: [T; 2],
}

/// What is done with the pieces of an edge. Implementations mark both `#[inline(always)]`, so that they are compiled for
/// the instruction set of their kernel.
pub(super) trait Visit<T> {
    /// A piece in a pixel of the window.
    fn piece(&mut self, piece: Piece<T>);

    /// A part to the left of the window, of which only the height (positive downward) matters to its row.
    fn left(&mut self, row: usize, height: T);
}

/// Shows `visit` each part of the edge from `a` to `b` that matters to the window of `width` x `height` pixels.
///
/// Parts above, below and to the right do not. The cost is bounded by `width` + `height`, however long the edge; in each
/// row the heights of the parts add up to exactly the height of the edge in that row, up to rounding.
///
/// *Units*: pixels from the upper left corner of the window; pixel (r, c) spans \[c, c + 1\] x \[r, r + 1\].
#[inline(always)]
pub(super) fn for_each_piece<T: Real>(a: [T; 2], b: [T; 2], width: usize, height: usize, visit: &mut impl Visit<T>) {
    let zero = T::zero();
    let (top, bottom, down) = if a[1] <= b[1] { (a, b, true) } else { (b, a, false) };
    let rows = T::of_usize(height);
    // Written so that NaN fails each test.
    if !(bottom[1] >= zero && top[1] < rows && (top[0] < T::of_usize(width) || bottom[0] < T::of_usize(width))) {
        return;
    }
    let rise = bottom[1] - top[1];
    let run = bottom[0] - top[0];
    let (least, greatest) = (top[0].min(bottom[0]), top[0].max(bottom[0]));
    let at = |y: T| [(top[0] + (y - top[1]) / rise * run).max(least).min(greatest), y];
    let mut row = top[1].max(zero).floor();
    let end = bottom[1].min(rows);
    let mut upper = if top[1] >= row { top } else { at(row) };
    // An edge without height lies in one row, even if that begins where the edge ends.
    while row < end || rise == zero {
        let next = row + T::one();
        let lower = if bottom[1] <= next { bottom } else { at(next) };
        in_row(upper, lower, down, row, width, visit);
        if bottom[1] <= next {
            return;
        }
        upper = lower;
        row = next;
    }
}

/// The pieces between two points of one row, `upper` not below `lower`.
#[inline(always)]
fn in_row<T: Real>(upper: [T; 2], lower: [T; 2], down: bool, row: T, width: usize, visit: &mut impl Visit<T>) {
    let zero = T::zero();
    let columns = T::of_usize(width);
    let rightward = upper[0] <= lower[0];
    let (left, right) = if rightward { (upper, lower) } else { (lower, upper) };
    // Pieces come from left to right; the edge may run the other way.
    let along = rightward == down;
    let row = row.to_count();
    let slope = if right[0] > left[0] { (right[1] - left[1]) / (right[0] - left[0]) } else { zero };
    let mut start = left;
    if left[0] < zero {
        let y = if right[0] <= zero { right[1] } else { left[1] - left[0] * slope };
        visit.left(row, if along { y - left[1] } else { left[1] - y });
        if right[0] <= zero {
            return;
        }
        start = [zero, y];
    }
    let mut column = start[0].floor();
    while column < columns {
        let next = column + T::one();
        let is_last = right[0] <= next;
        let end = if is_last { right } else { [next, left[1] + (next - left[0]) * slope] };
        let (from, to) = if along { (start, end) } else { (end, start) };
        visit.piece(Piece { row, column: column.to_count(), from, to });
        if is_last {
            return;
        }
        start = end;
        column = next;
    }
}
