//! Colors that change from place to place: those of a chunk, and the way back from them to the ramp.

use super::{CompositeScratch, Place};
use crate::image::CHANNELS;
use crate::real::Real;
use crate::render::tile::{LANES, Lanes};
use crate::scene::{Between, ColorStop, Drawing, DrawingGrad, RampRows, between, color_at};

/// A ramp of the drawing in pixels, and what is summed up for it.
#[derive(Clone, Copy, Debug)]
pub(super) struct RampSums<T> {
    /// Of a pixel (column, row).
    rows_px: RampRows<T>,
    /// Gradient of the rows.
    grad: [[T; 3]; 2],
}

impl<T: Real> CompositeScratch<T> {
    /// Puts the ramps into pixels, `unit` of them per scene unit, and forgets all sums. Fills in which object has which.
    pub(super) fn reset_ramps(&mut self, drawing: &Drawing<T>, unit: T) {
        let zero = T::zero();
        self.ramps.clear();
        self.stops.clear();
        self.stops.resize(drawing.stops.len(), ColorStop::default());
        for (index, ramp) in drawing.ramps.iter().enumerate() {
            let RampRows { rows, is_radial } = ramp.kind.to_rows();
            // The center of the pixel (0, 0) stands half a pixel from the corner of the image.
            let rows = rows.map(|[a, b, c]| [a / unit, b / unit, c + T::of(0.5) * (a + b) / unit]);
            self.ramps.push(RampSums { rows_px: RampRows { rows, is_radial }, grad: [[zero; 3]; 2] });
            let sums = &mut self.objects[ramp.object];
            (sums.ramp, sums.plain) = (Some(index), false);
        }
    }

    /// The colors of a ramp in a chunk.
    pub(super) fn ramp_colors(
        &self,
        drawing: &Drawing<T>,
        ramp: usize,
        place: Place,
        width: usize,
    ) -> [Lanes<T>; CHANNELS] {
        let stops = &drawing.stops[drawing.ramps[ramp].stops.clone()];
        let (rows, [x, y]) = (&self.ramps[ramp].rows_px, corner(place, width));
        let mut colors = [[T::zero(); LANES]; CHANNELS];
        for i in 0..place.len {
            let color = color_at(stops, rows.offset([x + T::of_usize(i), y]).0);
            for channel in 0..CHANNELS {
                colors[channel][i] = color[channel];
            }
        }
        colors
    }

    /// Sums up what the gradient of a chunk's colors is for their ramp.
    pub(super) fn pull_ramp(
        &mut self,
        drawing: &Drawing<T>,
        ramp: usize,
        place: Place,
        width: usize,
        grad_colors: &[Lanes<T>; CHANNELS],
    ) {
        let range = drawing.ramps[ramp].stops.clone();
        let stops = &drawing.stops[range.clone()];
        let grad_stops = &mut self.stops[range];
        let RampSums { rows_px, grad } = &mut self.ramps[ramp];
        let ([x, y], one) = (corner(place, width), T::one());
        for i in 0..place.len {
            let point = [x + T::of_usize(i), y];
            let (offset, values) = rows_px.offset(point);
            let Between { stop, way } = between(stops, offset);
            let Some((share, length)) = way else {
                if let Some(own) = grad_stops.get_mut(stop) {
                    for channel in 0..CHANNELS {
                        own.color[channel] += grad_colors[channel][i];
                    }
                }
                continue;
            };
            let mut grad_share = T::zero();
            for channel in 0..CHANNELS {
                let g = grad_colors[channel][i];
                grad_stops[stop].color[channel] += g * (one - share);
                grad_stops[stop + 1].color[channel] += g * share;
                grad_share += g * (stops[stop + 1].color[channel] - stops[stop].color[channel]);
            }
            let grad_offset = grad_share / length;
            grad_stops[stop].offset -= grad_offset * (one - share);
            grad_stops[stop + 1].offset -= grad_offset * share;
            // The length of both values has no slope at its center.
            let slopes = match rows_px.is_radial {
                true if offset > T::zero() => values.map(|value| grad_offset * value / offset),
                true => [T::zero(); 2],
                false => [grad_offset, T::zero()],
            };
            for (sums, slope) in grad.iter_mut().zip(slopes) {
                sums[0] += slope * point[0];
                sums[1] += slope * point[1];
                sums[2] += slope;
            }
        }
    }

    /// Adds the gradient of the ramps, `unit` pixels per scene unit.
    pub(super) fn add_ramp_grad(&self, drawing: &Drawing<T>, unit: T, grad: &mut DrawingGrad<T>) {
        for ((ramp, sums), grad_kind) in drawing.ramps.iter().zip(&self.ramps).zip(&mut grad.ramps) {
            let rows = sums.grad.map(|[a, b, c]| [(a + T::of(0.5) * c) / unit, (b + T::of(0.5) * c) / unit, c]);
            ramp.kind.to_rows_vjp(&rows, grad_kind);
        }
        for (sum, own) in grad.stops.iter_mut().zip(&self.stops) {
            sum.offset += own.offset;
            for (sum, &g) in sum.color.iter_mut().zip(&own.color) {
                *sum += g;
            }
        }
    }
}

/// Column and row of the first pixel of a chunk.
fn corner<T: Real>(place: Place, width: usize) -> [T; 2] {
    [T::of_usize(place.start % width), T::of_usize(place.start / width)]
}
