//! Pictures that take a small part of the levels of their file, as the 12 bits of a camera do in a file of 16: read as if they took most of them.

#[cfg(test)]
mod tests;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::{Image, ImageView, Paint};

use crate::Fit;

/// Largest range of values that is a small part, of 1: that of 14 bits in a file of 16 is a quarter.
const SMALL: f32 = 0.3;
/// What the darkest and the brightest value become: what noise adds to them is not cut off.
const ENDS: [f32; 2] = [0.05, 0.95];
/// Steps of a file of 8 bits; how far a value may be off one, of a step. Where there are no levels between these, stretching makes steps of them.
const STEPS: f32 = 255.0;
const OFF_STEP: f32 = 0.02;

/// A picture of more contrast.
#[derive(Debug)]
pub(super) struct Stretched {
    /// The picture.
    pub(super) image: Image<f32>,
    /// What has become the first of [`ENDS`].
    low: f32,
    times: f32,
}

impl Stretched {
    /// The picture stretched; none if its values take a large part of [0, 1], or are those of 8 bits.
    #[inline(never)]
    pub(super) fn of(image: &ImageView<'_, f32>) -> Option<Self> {
        let [low, high] = range(image)?;
        let is_step = |value: &f32| (STEPS * value - (STEPS * value).round()).abs() <= OFF_STEP;
        if image.data().iter().all(is_step) {
            return None;
        }
        let times = (ENDS[1] - ENDS[0]) / (high - low);
        let values = image.data().iter().map(|value| ENDS[0] + times * (value - low)).collect();
        Some(Self { image: Image::from_planar(image.size(), values).ok()?, low, times })
    }

    /// A fit of the stretched picture as one of the picture.
    pub(super) fn restored(&self, mut fit: Fit<f32>) -> Fit<f32> {
        let color = |value: f32| (self.low + (value - ENDS[0]) / self.times).clamp(0.0, 1.0);
        fit.scene.background = fit.scene.background.map(color);
        for object in &mut fit.scene.objects {
            if let Paint::Ramp(ramp) = &mut object.paint {
                ramp.stops.iter_mut().for_each(|stop| stop.color = stop.color.map(color));
            } else {
                object.paint = Paint::Flat(object.color().map(color));
            }
        }
        fit.loss /= self.times;
        fit.noise /= self.times;
        fit
    }
}

/// The darkest and the brightest value of two pixels beside one another, since single ones may be a camera's dead ones; none if these are far apart, or one.
fn range(image: &ImageView<'_, f32>) -> Option<[f32; 2]> {
    let width = image.size().width();
    let [mut low, mut high] = [f32::INFINITY, f32::NEG_INFINITY];
    for channel in [0, 1, 2].map(|c| image.channel(c)) {
        let mut above: Option<&[f32]> = None;
        for row in channel.chunks_exact(width) {
            let beside = row.iter().zip(&row[1..]).chain(above.unwrap_or_default().iter().zip(row));
            for (&a, &b) in beside {
                low = low.min(a.max(b));
                high = high.max(a.min(b));
            }
            if high - low > SMALL {
                return None;
            }
            above = Some(row);
        }
    }
    (high > low).then_some([low, high])
}
