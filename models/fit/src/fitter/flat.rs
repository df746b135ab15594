//! The scene that no fit may be worse than: one flat color.

use alloc::vec::Vec;

use dvp_core::image::CHANNELS;
use dvp_core::sort::median;
use dvp_core::{Drawing, ImageView, Real, Scene};

use crate::residual::Unexplained;
use crate::{Fit, Prices, StopReason};

/// A step of 8 bits. Within it rounding may decide which of two colors is nearer to a picture; scenes that are worse by more than
/// that are worse for all to see.
const STEP: f64 = 1.0 / 255.0;

/// `fit`, or one flat color if that has a smaller mean absolute error: the median of each channel, which has the smallest of all
/// colors.
pub(super) fn or_flat<T: Real>(image: &ImageView<'_, T>, fit: Fit<T>, prices: &Prices) -> Fit<T> {
    let step = T::of(STEP);
    // Most fits are better than any flat color can be shown to be.
    if fit.loss <= step {
        return fit;
    }
    let pixels = image.size().pixels();
    let mut values = Vec::with_capacity(pixels);
    let color: [T; CHANNELS] = core::array::from_fn(|channel| {
        values.clear();
        values.extend_from_slice(image.channel(channel));
        median(&mut values).unwrap_or_else(T::zero)
    });
    let errors = |channel: usize| image.channel(channel).iter().map(move |&value| (value - color[channel]).abs());
    let loss = (0..CHANNELS).flat_map(errors).sum::<T>() / T::of_usize(CHANNELS * pixels);
    if fit.loss <= loss + step {
        return fit;
    }
    let scene = Scene { background: color, objects: Vec::new(), ..fit.scene };
    let painted: Vec<T> = color.into_iter().flat_map(|value| core::iter::repeat_n(value, pixels)).collect();
    let left = Unexplained::of(image, &painted).bits;
    let bits = prices.scene_bits(&scene, 0) + left;
    let drawing = Drawing { background: color, ..Drawing::default() };
    let (steps, stop) = (fit.steps, StopReason::NoBetterThanFlat);
    Fit { loss, steps, stop, bits, ..Fit::of_painted(scene, &drawing, image, &painted) }
}
