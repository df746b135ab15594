//! A chunk of several objects under over: pixel <- pixel (1 - p f) + color p f, object after object.

use super::channels::tints;
use super::sink::PixelSink;
use super::{Pass, Place, ground};
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
        for at in 0..self.scratch.layers.len() {
            let layer = self.scratch.layers[at];
            let k = layer.object;
            let (f, colors) = (drawing.confidences[k], self.colors(k, place));
            let kept = &mut self.scratch.kept[at];
            kept.coverage = layer.chunk.map_or([one; LANES], |chunk| self.composition.tiles[k].coverage[chunk]);
            for channel in 0..N {
                let (below, c) = (values[channel], tints(&colors, channel));
                kept.below[channel] = below;
                values[channel] = lanes(|i| below[i] + kept.coverage[i] * f * (c[i] - below[i]));
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
        for at in (0..self.scratch.layers.len()).rev() {
            let (layer, kept) = (self.scratch.layers[at], self.scratch.kept[at]);
            let k = layer.object;
            let (f, colors) = (drawing.confidences[k], self.colors(k, place));
            let sums = &mut self.scratch.objects[k];
            let p = kept.coverage;
            let painted: Lanes<T> = lanes(|i| p[i] * f);
            let (mut grad, mut own) = ([zero; LANES], [[zero; LANES]; CHANNELS]);
            for channel in 0..N {
                let (above, below, c) = (g[channel], kept.below[channel], tints(&colors, channel));
                grad = lanes(|i| grad[i] + above[i] * (c[i] - below[i]));
                if channel < CHANNELS {
                    own[channel] = lanes(|i| above[i] * painted[i]);
                    sums.color[channel] = lanes(|i| sums.color[channel][i] + own[channel][i]);
                }
                g[channel] = lanes(|i| above[i] * (one - painted[i]));
            }
            sums.confidence = lanes(|i| sums.confidence[i] + p[i] * grad[i]);
            if let Some(ramp) = sums.ramp {
                self.scratch.pull_ramp(drawing, ramp, place, self.composition.size.width(), &own);
            }
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
