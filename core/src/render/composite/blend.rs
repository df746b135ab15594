//! A chunk of several objects under blend: with S = sum w p, the color is m = sum w p c / max(S, 1e-7), alpha is
//! 1 - prod (1 - p f), the pixel b + alpha (m - b). Where alpha is painted, it is that of the formula.

use super::sink::PixelSink;
use super::{Pass, Place, ground};
use crate::image::CHANNELS;
use crate::real::Real;
use crate::render::Compositing;
use crate::render::tile::{LANES, Lanes};
use crate::simd::lanes;

impl<T: Real, S: PixelSink<T>, const N: usize> Pass<'_, '_, T, S, N> {
    /// Paints the chunk of `scratch.layers`.
    #[inline(always)]
    pub(super) fn blend(&mut self, place: Place) {
        let drawing = self.composition.drawing;
        let (zero, one) = (T::zero(), T::one());
        let mut weights = [zero; LANES];
        let mut mean = [[zero; LANES]; CHANNELS];
        let mut clear = [one; LANES];
        for at in 0..self.scratch.layers.len() {
            let layer = self.scratch.layers[at];
            let k = layer.object;
            let (f, w, colors) = (drawing.confidences[k], self.scratch.objects[k].weight, self.colors(k, place));
            let kept = &mut self.scratch.kept[at];
            kept.coverage = layer.chunk.map_or([one; LANES], |chunk| self.composition.tiles[k].coverage[chunk]);
            kept.below[0] = clear;
            let p = kept.coverage;
            let pull: Lanes<T> = lanes(|i| w * p[i]);
            weights = lanes(|i| weights[i] + pull[i]);
            clear = lanes(|i| clear[i] * (one - p[i] * f));
            for channel in 0..CHANNELS {
                let c = &colors[channel];
                mean[channel] = lanes(|i| mean[channel][i] + pull[i] * c[i]);
            }
        }
        // 1 where the guard sleeps, 0 where it acts.
        let guard = T::of(Compositing::SMALLEST_WEIGHT);
        let live: Lanes<T> = lanes(|i| if weights[i] > guard { one } else { zero });
        let guarded: Lanes<T> = lanes(|i| if weights[i] > guard { weights[i] } else { guard });
        let share: Lanes<T> = lanes(|i| one / guarded[i]);
        // Sums over the channels of g (m - b) and g m.
        let (mut lift, mut pull) = ([zero; LANES], [zero; LANES]);
        let mut g = [[zero; LANES]; CHANNELS];
        for channel in 0..CHANNELS {
            let b = ground::<T, N>(drawing, channel);
            let m: Lanes<T> = lanes(|i| mean[channel][i] * share[i]);
            let values = lanes(|i| b + (one - clear[i]) * (m[i] - b));
            g[channel] = self.sink.chunk(channel, place, &values);
            if S::BACKWARD {
                let g = &g[channel];
                if Self::OPAQUE {
                    let background = &mut self.scratch.background[channel];
                    *background = lanes(|i| background[i] + g[i] * clear[i]);
                }
                lift = lanes(|i| lift[i] + g[i] * (m[i] - b));
                pull = lanes(|i| pull[i] + g[i] * m[i] * live[i]);
            }
        }
        if !Self::OPAQUE {
            // The mean of ones, whether the guard acts or not.
            let g = self.sink.chunk(CHANNELS, place, &lanes(|i| one - clear[i]));
            lift = lanes(|i| lift[i] + g[i]);
        }
        if !S::BACKWARD {
            return;
        }
        let share: Lanes<T> = lanes(|i| share[i] * (one - clear[i]));
        // Products without one factor are formed of the others: dividing by 1 - p f would be 0 / 0 inside an object.
        let mut above = [one; LANES];
        for at in (0..self.scratch.layers.len()).rev() {
            let (layer, kept) = (self.scratch.layers[at], self.scratch.kept[at]);
            let k = layer.object;
            let (f, colors) = (drawing.confidences[k], self.colors(k, place));
            let sums = &mut self.scratch.objects[k];
            let w = sums.weight;
            let p = kept.coverage;
            let own: Lanes<T> = lanes(|i| share[i] * (w * p[i]));
            let mut tint: Lanes<T> = lanes(|i| -pull[i]);
            let mut pulled = [[zero; LANES]; CHANNELS];
            for channel in 0..CHANNELS {
                let c = &colors[channel];
                tint = lanes(|i| tint[i] + g[channel][i] * c[i]);
                pulled[channel] = lanes(|i| g[channel][i] * own[i]);
                sums.color[channel] = lanes(|i| sums.color[channel][i] + pulled[channel][i]);
            }
            let tint: Lanes<T> = lanes(|i| tint[i] * share[i] * w);
            let others: Lanes<T> = lanes(|i| lift[i] * kept.below[0][i] * above[i]);
            let both: Lanes<T> = lanes(|i| p[i] * (others[i] + T::of(Compositing::SHARPNESS) * tint[i]));
            sums.confidence = lanes(|i| sums.confidence[i] + both[i]);
            above = lanes(|i| above[i] * (one - p[i] * f));
            if let Some(ramp) = sums.ramp {
                self.scratch.pull_ramp(drawing, ramp, place, self.composition.size.width(), &pulled);
            }
            if let Some(chunk) = layer.chunk {
                self.composition.tiles[k].grad[chunk] = lanes(|i| f * others[i] + tint[i]);
            }
        }
    }
}
