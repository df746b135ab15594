//! Forward: the area of each pixel that lies inside of rings.

use alloc::vec::Vec;

use super::orientation::Orientation;
use super::pieces::{Piece, Visit, for_each_piece};
use crate::real::Real;
use crate::render::tile::{ChunkState, LANES, Lanes, Tile, grow};
use crate::shape::Rings;
use crate::simd::Kernel;

/// What the forward pass of an object leaves for the backward pass, and memory.
#[derive(Clone, Debug, Default)]
pub struct ExactRecord<T> {
    /// The vertices from the upper left corner of the tile, where pixel (r, c) spans \[c, c + 1\] x \[r, r + 1\].
    pub(super) vertices: Vec<[T; 2]>,
    /// Which way round each ring is walked.
    pub(super) orientation: Orientation<T>,
    /// Integral of the winding number over each pixel of mixed chunks.
    pub(super) winding: Vec<Lanes<T>>,
    /// Per chunk, what its last pixel hands on to the pixels further right.
    carry: Vec<T>,
    /// Per row, the height of the edges to the left of the tile.
    entry: Vec<T>,
}

/// Covers one object, whose orientation stands in the record.
pub(super) struct Cover<'a, T> {
    pub(super) rings_px: Rings<'a, T>,
    pub(super) tile: &'a mut Tile<T>,
    pub(super) record: &'a mut ExactRecord<T>,
}

impl<T: Real> Kernel for Cover<'_, T> {
    type Output = ();

    /// Each piece of an edge adds its height, weighted by the area to its right, to its pixel and the rest to the next
    /// pixel of the row; a running sum along the row carries it to everything further right. Chunks without a piece
    /// are wholly inside or outside: the sum is rounded there, so that no rounding error travels on.
    #[inline(always)]
    fn run(self) {
        let Self { rings_px, tile, record } = self;
        let window = tile.window();
        let (width, chunks) = (window.width(), window.chunks);
        record.prepare(
            rings_px.vertices,
            [window.left(), window.top],
            chunks * window.rows,
            window.rows,
            tile.reserved(),
        );
        let ExactRecord { vertices, orientation, winding, carry, entry } = record;
        let mut sums = Accumulate { tile: &mut *tile, winding, carry, entry, chunks };
        for (ring, reversed) in (Rings { vertices, ..rings_px }).iter().zip(orientation.reversed()) {
            let Some(&last) = ring.last() else { continue };
            let mut a = last;
            for &b in ring {
                let (from, to) = if reversed { (b, a) } else { (a, b) };
                a = b;
                for_each_piece(from, to, width, window.rows, &mut sums);
            }
        }
        for (row, &entry) in entry.iter().enumerate() {
            let mut sum = entry;
            for chunk in row * chunks..(row + 1) * chunks {
                if tile.states[chunk] == ChunkState::Mixed {
                    for value in &mut winding[chunk] {
                        sum += *value;
                        *value = sum;
                    }
                    sum += carry[chunk];
                    tile.coverage[chunk] = winding[chunk].map(even_odd);
                } else {
                    sum = sum.round();
                    if even_odd(sum) > T::of(0.5) {
                        tile.states[chunk] = ChunkState::Full;
                    }
                }
            }
        }
    }
}

/// Adds up, per pixel, what pieces hand to the running sum of their row.
struct Accumulate<'a, T> {
    tile: &'a mut Tile<T>,
    winding: &'a mut [Lanes<T>],
    carry: &'a mut [T],
    entry: &'a mut [T],
    chunks: usize,
}

impl<T: Real> Visit<T> for Accumulate<'_, T> {
    #[inline(always)]
    fn piece(&mut self, piece: Piece<T>) {
        let height = piece.to[1] - piece.from[1];
        let (chunk, lane) = (piece.row * self.chunks + piece.column / LANES, piece.column % LANES);
        if self.tile.states[chunk] == ChunkState::Empty {
            self.tile.states[chunk] = ChunkState::Mixed;
            self.winding[chunk] = [T::zero(); LANES];
            self.carry[chunk] = T::zero();
        }
        let right = T::of(0.5) * (piece.from[0] + piece.to[0]) - T::of_usize(piece.column);
        self.winding[chunk][lane] += height * (T::one() - right);
        let next = if lane + 1 < LANES { &mut self.winding[chunk][lane + 1] } else { &mut self.carry[chunk] };
        *next += height * right;
    }

    #[inline(always)]
    fn left(&mut self, row: usize, height: T) {
        self.entry[row] += height;
    }
}

impl<T: Real> ExactRecord<T> {
    #[inline(always)]
    fn prepare(&mut self, vertices_px: &[[T; 2]], corner: [usize; 2], chunks: usize, rows: usize, reserved: usize) {
        let shift = corner.map(|corner| T::of(0.5) - T::of_usize(corner));
        self.vertices.clear();
        self.vertices.extend(vertices_px.iter().map(|&[x, y]| [x + shift[0], y + shift[1]]));
        grow(&mut self.winding, chunks, reserved);
        grow(&mut self.carry, chunks, reserved);
        if self.entry.capacity() < rows {
            self.entry.reserve(rows.max(reserved));
        }
        self.entry.clear();
        self.entry.resize(rows, T::zero());
    }
}

/// Coverage under the even-odd rule from the mean winding number of a pixel: the distance to the nearest even number.
///
/// Exact where the pixel holds two neighboring winding numbers only (every pixel, unless edges cross each other); where
/// edges cross inside the pixel, parts of other winding numbers are averaged first.
#[inline(always)]
fn even_odd<T: Real>(winding: T) -> T {
    let half = T::of(0.5);
    (winding - (winding * half + half).floor() * T::of(2.0)).abs()
}

/// Derivative of coverage by the winding number: +1 or -1. At its kinks, the whole numbers, it takes the side on which rings
/// that do not cross each other lie: winding from 0 to 1.
#[inline(always)]
pub(super) fn even_odd_slope<T: Real>(winding: T) -> T {
    // What rounding leaves of a sum along a row.
    let tie = T::of(100.0) * T::epsilon();
    let folded = winding - ((winding + T::one() - tie) * T::of(0.5)).floor() * T::of(2.0);
    if folded > -tie { T::one() } else { -T::one() }
}
