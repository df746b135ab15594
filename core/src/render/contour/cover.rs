//! Forward: squared distance to the closest edge in the band, inside by parity, coverage.

use alloc::vec::Vec;

use super::Band;
use super::edge::{BLOCK, Edge, Near, SHORTEST_SQUARED};
use crate::dims::ImageSize;
use crate::real::Real;
use crate::render::exact::ExactRecord;
use crate::render::tile::{ChunkState, LANES, Lanes, Tile, grow};
use crate::scene::PixelProfile;
use crate::shape::Rings;
use crate::simd::{Kernel, lanes};

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
    /// Chunks that the band may reach.
    pub(super) mixed: Vec<usize>,
    /// Squared distance per pixel, px^2.
    pub(super) squared: Vec<T>,
    /// Of area coverage, which needs none of the others.
    pub(super) exact: ExactRecord<T>,
}

/// The forward kernel; fills `record.closest` only if `BACKWARD`.
pub(super) struct Cover<'a, T, const BACKWARD: bool> {
    pub(super) band: Band<T>,
    pub(super) rings_px: Rings<'a, T>,
    pub(super) size: ImageSize,
    pub(super) tile: &'a mut Tile<T>,
    pub(super) record: &'a mut ContourRecord<T>,
}

impl<T: Real, const BACKWARD: bool> Kernel for Cover<'_, T, BACKWARD> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.cover::<false>();
    }

    #[inline(always)]
    fn run_fused(self) {
        self.cover::<true>();
    }
}

impl<T: Real, const BACKWARD: bool> Cover<'_, T, BACKWARD> {
    #[inline(always)]
    fn cover<const FUSED: bool>(mut self) {
        let window = self.tile.window();
        let (chunks, reserved) = (window.chunks * window.rows, self.tile.reserved());
        let record = &mut *self.record;
        if BACKWARD {
            grow(&mut record.closest, chunks * LANES, reserved * LANES);
        }
        grow(&mut record.inside, chunks, reserved);
        record.inside[..chunks].fill(0);
        grow(&mut record.squared, chunks * LANES, reserved * LANES);
        record.squared[..chunks * LANES].fill(T::of(UNSEEN));
        self.prepare_edges();
        for index in 0..self.record.edges.len() {
            self.near_edge::<FUSED>(index);
        }
        self.find_sides();
        if self.band.profile.squared {
            self.finish::<FUSED, true>();
        } else {
            self.finish::<FUSED, false>();
        }
    }

    /// Lists the edges of all rings, and flips a bit where a row meets one: what stands to the right changes sides.
    #[inline(always)]
    fn prepare_edges(&mut self) {
        let window = self.tile.window();
        let origin = [T::of_usize(window.left()), T::of_usize(window.top)];
        let unit = T::of_usize(self.size.unit_px());
        let shortest = T::of(SHORTEST_SQUARED * 0.25) * unit * unit;
        let record = &mut *self.record;
        record.edges.clear();
        record.edges.reserve(self.rings_px.vertices.len());
        for ring in self.rings_px.ranges() {
            let first = ring.start;
            let ring = &self.rings_px.vertices[ring];
            for (from, a) in ring.iter().enumerate() {
                let to = if from + 1 < ring.len() { from + 1 } else { 0 };
                let b = &ring[to];
                let (from, to) = (first + from, first + to);
                let (a, b) = ([a[0] - origin[0], a[1] - origin[1]], [b[0] - origin[0], b[1] - origin[1]]);
                let along = [b[0] - a[0], b[1] - a[1]];
                let squared = along[0] * along[0] + along[1] * along[1];
                if squared >= shortest {
                    let edge =
                        Edge { from, to, start: a, along, inverse_squared: squared.recip(), near: Near::default() };
                    if let Some(near) = edge.find_near(self.band.reach, window) {
                        record.edges.push(Edge { near, ..edge });
                    }
                }
                // Rows with low <= row < high meet the edge: each row meets a closed ring an even number of times.
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
    }

    /// Lowers the distance of the pixels within reach of an edge.
    #[inline(always)]
    fn near_edge<const FUSED: bool>(&mut self, index: usize) {
        let record = &mut *self.record;
        let edge = record.edges[index];
        let name = T::of_usize(index);
        let window = self.tile.window();
        let near = edge.near;
        for block in 0..near.blocks {
            let column = near.column + block * BLOCK;
            let columns = edge.columns(column);
            let Some((top, bottom)) = edge.rows(block, self.band.reach, window) else { continue };
            let first_chunk = column.max(near.first) / LANES;
            let last_chunk = (column + BLOCK - 1).min(near.last) / LANES;
            let mut y = T::of_usize(top);
            for row in top..bottom + 1 {
                self.tile.states[row * window.chunks + first_chunk] = ChunkState::Mixed;
                self.tile.states[row * window.chunks + last_chunk] = ChunkState::Mixed;
                let start = row * window.width() + column;
                let Some(squared) = record.squared[start..].first_chunk_mut::<BLOCK>() else { return };
                let (ex, ey, _) = edge.offsets::<FUSED>(&columns, y);
                y += T::one();
                let d2: [T; BLOCK] = lanes(|i| ex[i].times_plus::<FUSED>(ex[i], ey[i] * ey[i]));
                let old = *squared;
                let least: [T; BLOCK] = lanes(|i| if d2[i] < old[i] { d2[i] } else { old[i] });
                // Stored as they are, choices would become masked stores, which are slow on some processors.
                *squared = lanes(|i| if least[i] > T::zero() { least[i] } else { T::zero() });
                if BACKWARD {
                    let Some(closest) = record.closest[start..].first_chunk_mut::<BLOCK>() else { return };
                    let names = *closest;
                    let change: [T; BLOCK] = lanes(|i| if d2[i] < old[i] { name - names[i] } else { T::zero() });
                    *closest = lanes(|i| names[i] + change[i]);
                }
            }
        }
    }

    /// Turns flips into sides, and lists the chunks whose coverage is to be worked out.
    #[inline(always)]
    fn find_sides(&mut self) {
        let window = self.tile.window();
        let record = &mut *self.record;
        record.mixed.clear();
        record.mixed.reserve((window.rows * window.chunks).max(self.tile.reserved()));
        for row in 0..window.rows {
            let mut side = 0;
            for chunk in row * window.chunks..(row + 1) * window.chunks {
                let mut inside = record.inside[chunk];
                for shift in [1, 2, 4, 8] {
                    inside ^= inside << shift;
                }
                inside = (inside ^ side) & ALL;
                side = if inside >> (LANES - 1) == 1 { ALL } else { 0 };
                record.inside[chunk] = inside;
                let state = &mut self.tile.states[chunk];
                if *state == ChunkState::Mixed || (inside != 0 && inside != ALL) {
                    *state = ChunkState::Mixed;
                    record.mixed.push(chunk);
                    continue;
                }
                if inside == ALL {
                    *state = ChunkState::Full;
                }
                if BACKWARD {
                    // Compositing writes gradients of mixed chunks only, but blocks of an edge may reach into others.
                    self.tile.grad[chunk] = [T::zero(); LANES];
                }
            }
        }
    }

    /// Turns distances into coverage.
    #[inline(always)]
    fn finish<const FUSED: bool, const SQUARED: bool>(&mut self) {
        let Band { profile: PixelProfile { offset, sharpness, cut, .. }, full, .. } = self.band;
        let (one, zero) = (T::one(), T::zero());
        for &chunk in &self.record.mixed {
            let inside = self.record.inside[chunk];
            let Some(squared) = self.record.squared[chunk * LANES..].first_chunk::<LANES>() else { return };
            let far: Lanes<T> = if SQUARED { *squared } else { lanes(|i| squared[i].sqrt()) };
            let d: Lanes<T> = lanes(|i| if (inside >> i) & 1 == 1 { -far[i] } else { far[i] });
            let steps: Lanes<T> = lanes(|i| (d[i] - offset) * sharpness);
            let powers: Lanes<T> = lanes(|i| steps[i].exp_lanes::<FUSED>());
            let p: Lanes<T> = lanes(|i| one / (powers[i] + one));
            let p: Lanes<T> = lanes(|i| if d[i] < full { one } else { p[i] });
            self.tile.coverage[chunk] = lanes(|i| if d[i] > cut { zero } else { p[i] });
        }
    }
}
