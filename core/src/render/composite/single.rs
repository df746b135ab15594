//! A chunk on the edge of one object: pixel = b + p f (c - b), whichever way objects mix.

use super::sink::PixelSink;
use super::{Pass, Place, ground, tint};
use crate::real::Real;
use crate::render::tile::LANES;
use crate::simd::lanes;

impl<T: Real, S: PixelSink<T>, const N: usize> Pass<'_, '_, T, S, N> {
    /// Paints chunk `chunk` of the tile of `object`.
    #[inline(always)]
    pub(super) fn edge(&mut self, place: Place, object: usize, chunk: usize) {
        let drawing = self.composition.drawing;
        let (f, color) = (drawing.confidences[object], &drawing.colors[object]);
        let tile = &mut self.composition.tiles[object];
        let p = tile.coverage[chunk];
        let sums = &mut self.scratch.objects[object].covered;
        let mut grad = [T::zero(); LANES];
        for channel in 0..N {
            let b = ground::<T, N>(drawing, channel);
            let contrast = f * (tint(color, channel) - b);
            let g = self.sink.chunk(channel, place, &lanes(|i| b + p[i] * contrast));
            if S::BACKWARD {
                if Self::OPAQUE {
                    let background = &mut self.scratch.background[channel];
                    *background = lanes(|i| background[i] + g[i]);
                }
                sums[channel] = lanes(|i| sums[channel][i] + p[i] * g[i]);
                grad = lanes(|i| grad[i] + g[i] * contrast);
            }
        }
        if S::BACKWARD {
            tile.grad[chunk] = grad;
        }
    }
}
