//! Per-object coverage tiles, and the renderer that turns any coverage model into images and gradients.
//!
//! ```text
//! rings (px) --CoverageModel::cover--> Tile --composite--> pixels, loss
//! grad rings <-CoverageModel::cover_vjp- Tile.grad <-composite-'
//! ```
//!
//! A [`Tile`] holds one object's coverage in a window of the image, in chunks of [`LANES`] pixels of a row. Chunk c of
//! the image holds columns 16 c .. 16 c + 15, and a tile's chunks are chunks of the image, so that objects meet chunk
//! by chunk. The last chunk may reach beyond the right border; what stands there is never painted.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | windows, chunk states, tiles |
//! | `model.rs` | the trait of coverage models |
//! | `check.rs` | the checks at the border |
//! | `renderer.rs` | [`TileRenderer`]: checks, tiles, compositing, and back |
//! | `visit.rs` | the coverage of each object by itself |

mod check;
mod model;
mod renderer;
#[cfg(test)]
mod tests;
mod visit;

use alloc::vec::Vec;

pub(super) use check::check_breaks;
pub use model::CoverageModel;
pub use renderer::{TileRenderer, TileScratch};

use crate::dims::ImageSize;
use crate::real::Real;

/// Pixels of a chunk.
pub const LANES: usize = 16;

/// One number per pixel of a chunk.
pub type Lanes<T> = [T; LANES];

/// Pixels are 1 apart and the center of the pixel in row r and column c is (c, r); coordinates are held inside of
/// +-2^29 px, where products of two still fit an f32.
const FARTHEST_PX: f64 = 536_870_912.0;

/// Up to this many pixels in all tiles together each of them reserves the whole image at once, so that a moving object never allocates again: 16
/// objects in 256 x 256 pixels. Many objects are small, and would take more memory than they ever need.
const RESERVED_PIXELS: usize = 1 << 20;

/// What is known of a chunk without looking at its pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ChunkState {
    /// Coverage 0 everywhere.
    #[default]
    Empty,
    /// Coverage as written in [`Tile::coverage`].
    Mixed,
    /// Coverage 1 everywhere.
    Full,
}

/// A rectangle of chunks inside an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Window {
    /// First chunk of each row, counted from the left border of the image.
    pub left_chunk: usize,
    /// Chunks per row.
    pub chunks: usize,
    /// First row.
    pub top: usize,
    /// Number of rows.
    pub rows: usize,
}

impl Window {
    /// The smallest window that holds each pixel center within `reach_px` of the box of `vertices_px`; `None` if the
    /// image holds no such pixel.
    #[must_use]
    pub fn around<T: Real>(vertices_px: &[[T; 2]], reach_px: T, size: ImageSize) -> Option<Self> {
        let [first, rest @ ..] = vertices_px else { return None };
        let (mut low, mut high) = (*first, *first);
        for v in rest {
            for i in 0..2 {
                low[i] = low[i].min(v[i]);
                high[i] = high[i].max(v[i]);
            }
        }
        let (left, right) = pixel_range(low[0] - reach_px, high[0] + reach_px, size.width())?;
        let (top, bottom) = pixel_range(low[1] - reach_px, high[1] + reach_px, size.height())?;
        let left_chunk = left / LANES;
        Some(Self { left_chunk, chunks: right / LANES - left_chunk + 1, top, rows: bottom - top + 1 })
    }

    /// Column of the leftmost pixel.
    #[must_use]
    pub fn left(&self) -> usize {
        self.left_chunk * LANES
    }

    /// Pixels per row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.chunks * LANES
    }
}

/// First and last integer in \[low, high\] and in 0..count; `None` if there is none.
#[inline(always)]
pub fn pixel_range<T: Real>(low: T, high: T, count: usize) -> Option<(usize, usize)> {
    if high < T::zero() {
        return None;
    }
    let first = low.ceil().to_count();
    let last = high.floor().to_count().min(count - 1);
    (first <= last).then_some((first, last))
}

/// One object's coverage in its window.
#[derive(Clone, Debug, Default)]
pub struct Tile<T> {
    window: Window,
    /// Chunks to reserve when memory for some must be taken.
    reserved: usize,
    /// Row by row, `window.chunks` per row (longer than that where the tile was larger before).
    pub states: Vec<ChunkState>,
    /// Chunk by chunk in the same order; only that of `Mixed` chunks means anything.
    pub coverage: Vec<Lanes<T>>,
    /// Backward: derivative of the scalar with respect to `coverage`, written by compositing for `Mixed` chunks. May be shorter otherwise.
    pub grad: Vec<Lanes<T>>,
}

impl<T: Real> Tile<T> {
    /// The window covered.
    #[must_use]
    pub fn window(&self) -> Window {
        self.window
    }

    /// Moves to `window`, all chunks empty, keeping the memory; coverage and gradient keep what they hold. One of `tiles`; `backward`: whether it needs
    /// room for gradients.
    pub(crate) fn reset(&mut self, window: Window, size: ImageSize, tiles: usize, backward: bool) {
        self.window = window;
        let are_few = tiles.saturating_mul(size.pixels()) <= RESERVED_PIXELS;
        self.reserved = if are_few { size.height() * size.width().div_ceil(LANES) } else { 0 };
        let count = window.chunks * window.rows;
        grow(&mut self.states, count, self.reserved);
        self.states[..count].fill(ChunkState::Empty);
        grow(&mut self.coverage, count, self.reserved);
        if backward {
            grow(&mut self.grad, count, self.reserved);
        }
    }

    /// Chunks to reserve where memory must be taken for what goes with this tile: all of the image where few objects share it.
    pub(crate) fn reserved(&self) -> usize {
        self.reserved
    }
}

/// Makes `memory` hold at least `len` elements, and `reserved` if it must grow; what it holds stays.
pub(crate) fn grow<V: Clone + Default>(memory: &mut Vec<V>, len: usize, reserved: usize) {
    if memory.len() < len {
        memory.resize(len.max(reserved), V::default());
    }
}
