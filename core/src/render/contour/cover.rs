//! Forward: squared distance to the closest edge in the band, inside by parity, coverage.

use alloc::vec::Vec;

use super::Band;
use super::edge::{BLOCK, Edge, SHORTEST_SQUARED};
use crate::dims::ImageSize;
use crate::real::Real;
use crate::render::tile::{ChunkState, LANES, Lanes, Tile, grow, reserved_chunks};
use crate::simd::Kernel;

/// Squared distance of pixels that no edge looked at, px^2.
const UNSEEN: f64 = 1e30;

/// All pixels of a chunk.
const ALL: u32 = (1 << LANES) - 1;

/// What the forward pass leaves for the backward pass, per object.
#[derive(Debug, Default)]
pub struct ContourRecord<T> {
    pub(super) edges: Vec<Edge<T>>,
    /// Index into `edges` of the closest edge, per pixel of the window; means something where an edge is within reach.
    pub(super) closest: Vec<T>,
    /// Which pixels of a chunk are inside, the leftmost in the lowest bit.
    pub(super) inside: Vec<u32>,
    /// Squared distance per pixel, px^2; `UNSEEN` everywhere between calls.
    squared: Vec<T>,
}

/// The forward kernel.
pub(super) struct Cover<'a, T> {
    pub(super) band: Band<T>,
    pub(super) outline_px: &'a [[T; 2]],
    pub(super) size: ImageSize,
    pub(super) tile: &'a mut Tile<T>,
    pub(super) record: &'a mut ContourRecord<T>,
}

impl<T: Real> Kernel for Cover<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(mut self) {
        let window = self.tile.window();
        let (chunks, reserved) = (window.chunks * window.rows, reserved_chunks(self.size));
        let record = &mut *self.record;
        grow(&mut record.closest, chunks * LANES, reserved * LANES);
        grow(&mut record.inside, chunks, reserved);
        record.inside[..chunks].fill(0);
        if record.squared.len() < chunks * LANES {
            record.squared.resize(chunks.max(reserved) * LANES, T::of(UNSEEN));
        }
        self.prepare_edges();
        for index in 0..self.record.edges.len() {
            self.near_edge(index);
        }
        self.finish();
    }
}

impl<T: Real> Cover<'_, T> {
    /// Lists the edges, and flips a bit where a row meets one: what stands to the right changes sides.
    #[inline(always)]
    fn prepare_edges(&mut self) {
        let window = self.tile.window();
        let origin = [T::of_usize(window.left()), T::of_usize(window.top)];
        let unit = T::of_usize(self.size.unit_px());
        let shortest = T::of(SHORTEST_SQUARED * 0.25) * unit * unit;
        let record = &mut *self.record;
        record.edges.clear();
        record.edges.reserve(self.outline_px.len());
        for (from, a) in self.outline_px.iter().enumerate() {
            let to = if from + 1 < self.outline_px.len() { from + 1 } else { 0 };
            let b = &self.outline_px[to];
            let (a, b) = ([a[0] - origin[0], a[1] - origin[1]], [b[0] - origin[0], b[1] - origin[1]]);
            let along = [b[0] - a[0], b[1] - a[1]];
            let squared = along[0] * along[0] + along[1] * along[1];
            if squared >= shortest {
                record.edges.push(Edge { from, to, start: a, along, inverse_squared: squared.recip() });
            }
            // Rows with low <= row < high meet the edge: each row meets a closed outline an even number of times.
            let (low, high) = (a[1].min(b[1]).ceil().to_count(), b[1].max(a[1]).ceil().to_count().min(window.rows));
            let slope = along[0] / along[1];
            for row in low..high {
                let x = a[0] + (T::of_usize(row) - a[1]) * slope;
                let column = x.ceil().to_count();
                if column < window.width() {
                    record.inside[row * window.chunks + column / LANES] ^= 1 << (column % LANES);
                }
            }
        }
    }

    /// Lowers the distance of the pixels within reach of an edge.
    #[inline(always)]
    fn near_edge(&mut self, index: usize) {
        let record = &mut *self.record;
        let edge = record.edges[index];
        let [dx, dy] = edge.along;
        let name = T::of_usize(index);
        let window = self.tile.window();
        edge.for_each_block(self.band.reach, window, |blocks| {
            let (x, share) = edge.columns(blocks.column);
            for row in blocks.top..=blocks.bottom {
                let (y, row_share) = edge.row(row);
                let start = row * window.width() + blocks.column;
                let Some(squared) = record.squared[start..].first_chunk_mut::<BLOCK>() else { return };
                let Some(closest) = record.closest[start..].first_chunk_mut::<BLOCK>() else { return };
                for i in 0..BLOCK {
                    let u = (share[i] + row_share).max(T::zero()).min(T::one());
                    let (ex, ey) = (x[i] - u * dx, y - u * dy);
                    let d2 = ex * ex + ey * ey;
                    let closer = d2 < squared[i];
                    squared[i] = if closer { d2 } else { squared[i] };
                    closest[i] = if closer { name } else { closest[i] };
                }
                let first = row * window.chunks;
                self.tile.states[first + blocks.column / LANES] = ChunkState::Mixed;
                self.tile.states[first + (blocks.column + BLOCK - 1) / LANES] = ChunkState::Mixed;
            }
        });
    }

    /// Turns flips into sides and distances into coverage.
    #[inline(always)]
    fn finish(&mut self) {
        let window = self.tile.window();
        for row in 0..window.rows {
            let mut side = 0;
            for chunk in row * window.chunks..(row + 1) * window.chunks {
                let mut inside = self.record.inside[chunk];
                for shift in [1, 2, 4, 8] {
                    inside ^= inside << shift;
                }
                inside = (inside ^ side) & ALL;
                side = if inside >> (LANES - 1) == 1 { ALL } else { 0 };
                self.record.inside[chunk] = inside;
                if self.tile.states[chunk] == ChunkState::Mixed || (inside != 0 && inside != ALL) {
                    self.finish_chunk(chunk, inside);
                } else if inside == ALL {
                    self.tile.states[chunk] = ChunkState::Full;
                }
            }
        }
    }

    /// Coverage of a chunk that the band may reach; forgets its distances.
    #[inline(always)]
    fn finish_chunk(&mut self, chunk: usize, inside: u32) {
        let Band { offset, sharpness, cut, full, .. } = self.band;
        let Some(squared) = self.record.squared[chunk * LANES..].first_chunk_mut::<LANES>() else { return };
        let mut coverage: Lanes<T> = [T::zero(); LANES];
        for i in 0..LANES {
            let d2 = if (inside >> i) & 1 == 1 { -squared[i] } else { squared[i] };
            let p = (((d2 - offset) * sharpness).exp_lanes() + T::one()).recip();
            let p = if d2 < full { T::one() } else { p };
            coverage[i] = if d2 > cut { T::zero() } else { p };
        }
        *squared = [T::of(UNSEEN); LANES];
        self.tile.coverage[chunk] = coverage;
        self.tile.states[chunk] = ChunkState::Mixed;
    }
}
