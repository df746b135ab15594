//! A chunk of several objects under blend: with S = sum w p, the color is m = sum w p c / max(S, 1e-7), alpha is
//! 1 - prod (1 - p f), the pixel b + alpha (m - b).

use super::sink::PixelSink;
use super::{Pass, Place, SHARPNESS, SMALLEST_WEIGHT};
use crate::image::CHANNELS;
use crate::real::Real;
use crate::render::tile::LANES;

impl<T: Real, S: PixelSink<T>> Pass<'_, '_, T, S> {
    /// Paints the chunk of `scratch.layers`.
    #[inline(always)]
    pub(super) fn blend(&mut self, place: Place) {
        let drawing = self.composition.drawing;
        let (zero, one) = (T::zero(), T::one());
        let mut weights = [zero; LANES];
        let mut mean = [[zero; LANES]; CHANNELS];
        let mut clear = [one; LANES];
        for (layer, kept) in self.scratch.layers.iter().zip(&mut self.scratch.kept) {
            let k = layer.object;
            let (f, w, color) = (drawing.confidences[k], self.scratch.objects[k].weight, drawing.colors[k]);
            kept.coverage = layer.chunk.map_or([one; LANES], |chunk| self.composition.tiles[k].coverage[chunk]);
            kept.below[0] = clear;
            for i in 0..LANES {
                let p = kept.coverage[i];
                weights[i] += w * p;
                clear[i] *= one - p * f;
                for channel in 0..CHANNELS {
                    mean[channel][i] += w * p * color[channel];
                }
            }
        }
        // 1 where the guard sleeps, 0 where it acts.
        let (mut live, mut share) = ([zero; LANES], [zero; LANES]);
        let guard = T::of(SMALLEST_WEIGHT);
        for i in 0..LANES {
            live[i] = if weights[i] > guard { one } else { zero };
            share[i] = one / weights[i].max(guard);
        }
        // Sums over the channels of g (m - b) and g m.
        let (mut lift, mut pull) = ([zero; LANES], [zero; LANES]);
        let mut g = [[zero; LANES]; CHANNELS];
        for channel in 0..CHANNELS {
            let b = drawing.background[channel];
            let mut values = [zero; LANES];
            for i in 0..LANES {
                mean[channel][i] *= share[i];
                values[i] = b + (one - clear[i]) * (mean[channel][i] - b);
            }
            g[channel] = self.sink.chunk(channel, place, &values);
            if S::BACKWARD {
                for i in 0..LANES {
                    self.scratch.background[channel][i] += g[channel][i] * clear[i];
                    lift[i] += g[channel][i] * (mean[channel][i] - b);
                    pull[i] += g[channel][i] * mean[channel][i] * live[i];
                }
            }
        }
        if !S::BACKWARD {
            return;
        }
        for i in 0..LANES {
            share[i] *= one - clear[i];
        }
        // Products without one factor are formed of the others: dividing by 1 - p f would be 0 / 0 inside an object.
        let mut above = [one; LANES];
        for (layer, kept) in self.scratch.layers.iter().zip(&self.scratch.kept).rev() {
            let k = layer.object;
            let (f, color) = (drawing.confidences[k], drawing.colors[k]);
            let sums = &mut self.scratch.objects[k];
            let w = sums.weight;
            let mut grad = [zero; LANES];
            for i in 0..LANES {
                let p = kept.coverage[i];
                let others = lift[i] * kept.below[0][i] * above[i];
                let mut tint = -pull[i];
                for channel in 0..CHANNELS {
                    tint += g[channel][i] * color[channel];
                    sums.color[channel][i] += g[channel][i] * share[i] * (w * p);
                }
                let tint = tint * share[i] * w;
                grad[i] = f * others + tint;
                sums.confidence[i] += p * (others + T::of(SHARPNESS) * tint);
                above[i] *= one - p * f;
            }
            if let Some(chunk) = layer.chunk {
                self.composition.tiles[k].grad[chunk] = grad;
            }
        }
    }
}
