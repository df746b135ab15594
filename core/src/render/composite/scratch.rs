//! Sums per object, and their way into the gradient of the drawing. There is room for alpha, used or not.

use alloc::vec::Vec;

use super::ramp::RampSums;
use super::{Active, Layer, ground, tint};
use crate::image::{CHANNELS, RGBA_CHANNELS};
use crate::real::Real;
use crate::render::Compositing;
use crate::render::tile::{LANES, Lanes};
use crate::scene::{ColorStop, Drawing, DrawingGrad};
use crate::simd::total;

/// Memory of the pass, kept between calls.
#[derive(Debug)]
pub(in crate::render) struct CompositeScratch<T> {
    pub(super) objects: Vec<Sums<T>>,
    /// Sum of g, over chunks where the background's share is not written out yet (see [`Sums::covered`]), of g x share elsewhere.
    pub(super) background: [Lanes<T>; CHANNELS],
    /// Objects whose window holds the current row.
    pub(super) active: Vec<Active>,
    /// Objects in the current chunk, in painting order.
    pub(super) layers: Vec<Layer>,
    /// What the general formulas keep per layer between their way up and their way down.
    pub(super) kept: Vec<Kept<T>>,
    /// The ramps of the drawing, and the gradient of their stops.
    pub(super) ramps: Vec<RampSums<T>>,
    pub(super) stops: Vec<ColorStop<T>>,
}

/// What is known of an object, and what is summed up for it; g stands for the gradient of a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sums<T> {
    /// exp(10 (f - 1)).
    pub(super) weight: T,
    /// Of one color, and alone in a pixel this is the mean: the guard of the division never acts.
    pub(super) plain: bool,
    /// Which ramp paints it.
    pub(super) ramp: Option<usize>,
    /// Where the object is alone: sum of p g per channel. There pixel = b + p f (c - b), so that the gradient of c is
    /// f x this, that of f is this . (c - b), and that of b is sum g - f x this.
    pub(super) covered: [Lanes<T>; RGBA_CHANNELS],
    /// Elsewhere: the gradient of the color; of a ramp it is not looked at.
    pub(super) color: [Lanes<T>; CHANNELS],
    /// Elsewhere: the gradient of the confidence.
    pub(super) confidence: Lanes<T>,
}

/// Per layer of a chunk.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kept<T> {
    pub(super) coverage: Lanes<T>,
    /// What lies below: the product of 1 - p f of earlier layers (blend), or their color per channel (over).
    pub(super) below: [Lanes<T>; RGBA_CHANNELS],
}

impl<T: Real> Default for CompositeScratch<T> {
    fn default() -> Self {
        Self {
            objects: Vec::new(),
            background: zeros(),
            active: Vec::new(),
            layers: Vec::new(),
            kept: Vec::new(),
            ramps: Vec::new(),
            stops: Vec::new(),
        }
    }
}

impl<T: Real> CompositeScratch<T> {
    /// Forgets all sums and looks up what is known of the objects.
    pub(super) fn reset(&mut self, drawing: &Drawing<T>, compositing: Compositing, smallest_coverage: T) {
        let count = drawing.object_count();
        self.background = zeros();
        self.objects.clear();
        self.objects.extend(drawing.confidences.iter().map(|&f| {
            let weight = Compositing::weight(f);
            Sums {
                weight,
                plain: compositing == Compositing::Over
                    || weight * smallest_coverage >= T::of(Compositing::SMALLEST_WEIGHT),
                ramp: None,
                covered: zeros(),
                color: zeros(),
                confidence: [T::zero(); LANES],
            }
        }));
        self.active.reserve(count);
        self.layers.reserve(count);
        if self.kept.len() < count {
            self.kept.resize(count, Kept { coverage: [T::zero(); LANES], below: zeros() });
        }
    }

    /// Adds the gradient of background, colors, ramps and confidences from a pass over `N` channels of an image with `unit` pixels
    /// per scene unit. Images with alpha have no background.
    pub(in crate::render) fn add_grad<const N: usize>(&self, drawing: &Drawing<T>, unit: T, grad: &mut DrawingGrad<T>) {
        self.add_ramp_grad(drawing, unit, grad);
        for (sum, &own) in grad.background.iter_mut().zip(&self.background) {
            *sum += total(own);
        }
        for (k, sums) in self.objects.iter().enumerate() {
            let (f, color) = (drawing.confidences[k], &drawing.colors[k]);
            grad.confidences[k] += total(sums.confidence);
            for channel in 0..N {
                let covered = total(sums.covered[channel]);
                grad.confidences[k] += (tint(color, channel) - ground::<T, N>(drawing, channel)) * covered;
                if channel < CHANNELS && sums.ramp.is_none() {
                    grad.colors[k][channel] += f * covered + total(sums.color[channel]);
                }
                if N == CHANNELS {
                    grad.background[channel] -= f * covered;
                }
            }
        }
    }
}

fn zeros<T: Real, const N: usize>() -> [Lanes<T>; N] {
    [[T::zero(); LANES]; N]
}
