//! A chunk of several objects under over: pixel <- pixel (1 - p f) + color p f, object after object.

use super::sink::PixelSink;
use super::{Pass, Place};
use crate::image::CHANNELS;
use crate::real::Real;
use crate::render::tile::LANES;

impl<T: Real, S: PixelSink<T>> Pass<'_, '_, T, S> {
    /// Paints the chunk of `scratch.layers`.
    #[inline(always)]
    pub(super) fn over(&mut self, place: Place) {
        let drawing = self.composition.drawing;
        let (zero, one) = (T::zero(), T::one());
        let mut values = drawing.background.map(|b| [b; LANES]);
        for (layer, kept) in self.scratch.layers.iter().zip(&mut self.scratch.kept) {
            let k = layer.object;
            let (f, color) = (drawing.confidences[k], drawing.colors[k]);
            kept.coverage = layer.chunk.map_or([one; LANES], |chunk| self.composition.tiles[k].coverage[chunk]);
            kept.below = values;
            for channel in 0..CHANNELS {
                for i in 0..LANES {
                    let below = values[channel][i];
                    values[channel][i] = below + kept.coverage[i] * f * (color[channel] - below);
                }
            }
        }
        let mut g = [[zero; LANES]; CHANNELS];
        for channel in 0..CHANNELS {
            g[channel] = self.sink.chunk(channel, place, &values[channel]);
        }
        if !S::BACKWARD {
            return;
        }
        // From the top down, g is the gradient of the color that the layers above were painted on.
        for (layer, kept) in self.scratch.layers.iter().zip(&self.scratch.kept).rev() {
            let k = layer.object;
            let (f, color) = (drawing.confidences[k], drawing.colors[k]);
            let sums = &mut self.scratch.objects[k];
            let mut grad = [zero; LANES];
            for channel in 0..CHANNELS {
                for i in 0..LANES {
                    let painted = kept.coverage[i] * f;
                    grad[i] += g[channel][i] * (color[channel] - kept.below[channel][i]);
                    sums.color[channel][i] += g[channel][i] * painted;
                    g[channel][i] *= one - painted;
                }
            }
            for i in 0..LANES {
                sums.confidence[i] += kept.coverage[i] * grad[i];
                grad[i] *= f;
            }
            if let Some(chunk) = layer.chunk {
                self.composition.tiles[k].grad[chunk] = grad;
            }
        }
        for channel in 0..CHANNELS {
            for i in 0..LANES {
                self.scratch.background[channel][i] += g[channel][i];
            }
        }
    }
}
