//! A chunk of several objects under over: pixel <- pixel (1 - p f) + color p f, object after object.

use super::sink::PixelSink;
use super::{Pass, Place, ground, tint};
use crate::image::CHANNELS;
use crate::real::Real;
use crate::render::tile::{LANES, Lanes};
use crate::simd::lanes;

impl<T: Real, S: PixelSink<T>, const N: usize> Pass<'_, '_, T, S, N> {
    /// Paints the chunk of `scratch.layers`.
    #[inline(always)]
    pub(super) fn over(&mut self, place: Place) {
        let drawing = self.composition.drawing;
        let (zero, one) = (T::zero(), T::one());
        let mut values = [[zero; LANES]; N];
        for (channel, values) in values.iter_mut().enumerate() {
            *values = [ground::<T, N>(drawing, channel); LANES];
        }
        for (layer, kept) in self.scratch.layers.iter().zip(&mut self.scratch.kept) {
            let k = layer.object;
            let (f, color) = (drawing.confidences[k], &drawing.colors[k]);
            kept.coverage = layer.chunk.map_or([one; LANES], |chunk| self.composition.tiles[k].coverage[chunk]);
            for channel in 0..N {
                let (below, c) = (values[channel], tint(color, channel));
                kept.below[channel] = below;
                values[channel] = lanes(|i| below[i] + kept.coverage[i] * f * (c - below[i]));
            }
        }
        let mut g = [[zero; LANES]; N];
        for channel in 0..N {
            g[channel] = self.sink.chunk(channel, place, &values[channel]);
        }
        if !S::BACKWARD {
            return;
        }
        // From the top down, g is the gradient of the color that the layers above were painted on.
        for (layer, kept) in self.scratch.layers.iter().zip(&self.scratch.kept).rev() {
            let k = layer.object;
            let (f, color) = (drawing.confidences[k], &drawing.colors[k]);
            let sums = &mut self.scratch.objects[k];
            let p = kept.coverage;
            let painted: Lanes<T> = lanes(|i| p[i] * f);
            let mut grad = [zero; LANES];
            for channel in 0..N {
                let (above, below, c) = (g[channel], kept.below[channel], tint(color, channel));
                grad = lanes(|i| grad[i] + above[i] * (c - below[i]));
                if channel < CHANNELS {
                    sums.color[channel] = lanes(|i| sums.color[channel][i] + above[i] * painted[i]);
                }
                g[channel] = lanes(|i| above[i] * (one - painted[i]));
            }
            sums.confidence = lanes(|i| sums.confidence[i] + p[i] * grad[i]);
            if let Some(chunk) = layer.chunk {
                self.composition.tiles[k].grad[chunk] = lanes(|i| grad[i] * f);
            }
        }
        if Self::OPAQUE {
            for channel in 0..CHANNELS {
                let background = &mut self.scratch.background[channel];
                *background = lanes(|i| background[i] + g[channel][i]);
            }
        }
    }
}
