//! The compositing pass: coverage tiles and colors in; pixels, loss and gradients out, in one walk over the image.
//!
//! The walk goes chunk by chunk. Most chunks have one color (the background's, or that of one object that covers all of
//! it): they are merged into spans, whose gradient follows from the sum of the pixels' gradients. Chunks on the edge of
//! a single object have a closed form too; only where objects meet is the general formula worked out.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | [`Composition`], the walk, the spans |
//! | `single.rs` | a chunk with one object in it |
//! | `blend.rs`, `over.rs` | a chunk with several, for each way of mixing |
//! | `ramp.rs` | the colors of objects that have more than one |
//! | `channels.rs` | red, green, blue, and alpha where it is wanted |
//! | `sink.rs` | what happens to pixels: stored, or compared with a target |
//! | `scratch.rs` | sums per object, and their way into the gradient |

mod blend;
mod channels;
mod over;
mod ramp;
mod scratch;
mod single;
mod sink;
#[cfg(test)]
mod tests;

pub(super) use scratch::CompositeScratch;
pub(super) use sink::{Forward, Loss, Mae, Mse, Pull};

use crate::dims::ImageSize;
use crate::image::CHANNELS;
use crate::real::Real;
use crate::render::Compositing;
use crate::render::tile::{ChunkState, LANES, Lanes, Tile};
use crate::scene::Drawing;
use crate::simd::{Kernel, dispatch};
use channels::{ground, tint};
use sink::PixelSink;

/// What there is to composite.
pub(super) struct Composition<'a, T> {
    pub(super) drawing: &'a Drawing<T>,
    pub(super) size: ImageSize,
    pub(super) compositing: Compositing,
    /// A lower bound of coverage where it is not 0.
    pub(super) smallest_coverage: T,
    /// One per object; windows without rows are skipped.
    pub(super) tiles: &'a mut [Tile<T>],
}

/// What a chunk is painted with.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Paint {
    /// The background alone.
    Background,
    /// One object, everywhere in the chunk.
    Solid(usize),
    /// The edge of one object.
    Edge { object: usize, chunk: usize },
    /// Several objects.
    Several,
}

/// Where a chunk stands in the image.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// First pixel, row x width + column.
    start: usize,
    /// Pixels inside the image, 1 to [`LANES`].
    len: usize,
}

/// An object whose window holds the current row.
#[derive(Clone, Copy, Debug)]
struct Active {
    object: usize,
    /// First chunk of the window, and their number.
    left: usize,
    chunks: usize,
    /// Index of the row's first chunk in the tile.
    first: usize,
}

/// An object in a chunk of several.
#[derive(Clone, Copy, Debug)]
struct Layer {
    object: usize,
    /// Index into the tile, or `None` where the object covers all of the chunk.
    chunk: Option<usize>,
}

/// Consecutive pixels of one color.
#[derive(Clone, Copy)]
struct Span {
    object: Option<usize>,
    start: usize,
    len: usize,
}

impl<'a, T: Real> Composition<'a, T> {
    /// Paints `N` channels, RGB or premultiplied RGBA, into `sink` and returns its loss (0 if it has none). Backward sinks
    /// leave gradients in the tiles (coverage) and in `scratch` (everything else).
    pub(super) fn run<S: PixelSink<T>, const N: usize>(self, scratch: &mut CompositeScratch<T>, sink: S) -> T {
        scratch.reset(self.drawing, self.compositing, self.smallest_coverage);
        scratch.reset_ramps(self.drawing, T::of_usize(self.size.unit_px()));
        dispatch(Pass::<T, S, N> { composition: self, scratch, sink })
    }
}

/// The walk, ready to be compiled per instruction set.
struct Pass<'a, 's, T, S, const N: usize> {
    composition: Composition<'a, T>,
    scratch: &'s mut CompositeScratch<T>,
    sink: S,
}

impl<T: Real, S: PixelSink<T>, const N: usize> Kernel for Pass<'_, '_, T, S, N> {
    type Output = T;

    #[inline(always)]
    fn run(mut self) -> T {
        let width = self.composition.size.width();
        let chunks = width.div_ceil(LANES);
        let mut span = Span { object: None, start: 0, len: 0 };
        for row in 0..self.composition.size.height() {
            self.find_active(row);
            let mut c = 0;
            while c < chunks {
                let (paint, until) = self.paints(c, chunks);
                let start = row * width + c * LANES;
                let end = (row * width + until * LANES).min((row + 1) * width);
                let object = match paint {
                    Paint::Background => Some(None),
                    Paint::Solid(object) => Some(Some(object)),
                    Paint::Edge { .. } | Paint::Several => None,
                };
                if let Some(object) = object {
                    if span.object == object {
                        span.len += end - start;
                    } else {
                        self.flush(span);
                        span = Span { object, start, len: end - start };
                    }
                } else {
                    self.flush(span);
                    span = Span { object: None, start: end, len: 0 };
                    let place = Place { start, len: end - start };
                    match paint {
                        Paint::Edge { object, chunk } => self.edge(place, object, chunk),
                        _ => self.several(place),
                    }
                }
                c = until;
            }
        }
        self.flush(span);
        self.sink.finish()
    }
}

impl<T: Real, S: PixelSink<T>, const N: usize> Pass<'_, '_, T, S, N> {
    /// Whether nothing is the background, not clear.
    const OPAQUE: bool = N == CHANNELS;

    /// Lists the objects whose window holds the row.
    #[inline(always)]
    fn find_active(&mut self, row: usize) {
        self.scratch.active.clear();
        for (object, tile) in self.composition.tiles.iter().enumerate() {
            let window = tile.window();
            if row >= window.top && row - window.top < window.rows {
                let first = (row - window.top) * window.chunks;
                self.scratch.active.push(Active { object, left: window.left_chunk, chunks: window.chunks, first });
            }
        }
    }

    /// What paints chunk `c` of the row, and the chunk up to which that holds. Fills `scratch.layers` for several objects.
    #[inline(always)]
    fn paints(&mut self, c: usize, chunks: usize) -> (Paint, usize) {
        self.scratch.layers.clear();
        let mut until = chunks;
        for active in &self.scratch.active {
            let column = c.wrapping_sub(active.left);
            if column < active.chunks {
                until = c + 1;
                let (object, chunk) = (active.object, active.first + column);
                match self.composition.tiles[object].states[chunk] {
                    ChunkState::Empty => {}
                    ChunkState::Mixed => self.scratch.layers.push(Layer { object, chunk: Some(chunk) }),
                    ChunkState::Full => self.scratch.layers.push(Layer { object, chunk: None }),
                }
            } else if active.left > c {
                until = until.min(active.left);
            }
        }
        let paint = match *self.scratch.layers {
            [] => Paint::Background,
            [Layer { object, chunk }] if self.scratch.objects[object].plain => match chunk {
                None => Paint::Solid(object),
                Some(chunk) => Paint::Edge { object, chunk },
            },
            _ => Paint::Several,
        };
        (paint, until)
    }

    /// Paints a span, and adds its gradient: with p = 1, pixel = b + f (c - b).
    #[inline(always)]
    fn flush(&mut self, span: Span) {
        if span.len == 0 {
            return;
        }
        let drawing = self.composition.drawing;
        let painted = span.object.map(|k| (drawing.confidences[k], &drawing.colors[k]));
        for channel in 0..N {
            let b = ground::<T, N>(drawing, channel);
            let value = painted.map_or(b, |(f, color)| b + f * (tint(color, channel) - b));
            let sum = self.sink.span(channel, span.start, span.len, value);
            if S::BACKWARD {
                if Self::OPAQUE {
                    self.scratch.background[channel][0] += sum;
                }
                if let Some(k) = span.object {
                    self.scratch.objects[k].covered[channel][0] += sum;
                }
            }
        }
    }

    /// The colors of object `k` in a chunk.
    #[inline(always)]
    fn colors(&self, k: usize, place: Place) -> [Lanes<T>; CHANNELS] {
        let Composition { drawing, size, .. } = &self.composition;
        match self.scratch.objects[k].ramp {
            None => drawing.colors[k].map(|value| [value; LANES]),
            Some(ramp) => self.scratch.ramp_colors(drawing, ramp, place, size.width()),
        }
    }

    /// Paints a chunk of several objects.
    #[inline(always)]
    fn several(&mut self, place: Place) {
        match self.composition.compositing {
            Compositing::Blend => self.blend(place),
            Compositing::Over => self.over(place),
        }
    }
}
