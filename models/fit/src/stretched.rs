//! Pictures at another contrast than their own, and the way back.

use dvp_core::{Image, ImageView, Real};

use crate::Fit;

/// A picture with its values stretched.
#[derive(Debug)]
pub(crate) struct Stretched<T> {
    /// The picture.
    pub(crate) image: Image<T>,
    /// How many times as far apart its values are.
    pub(crate) gain: T,
    /// Values of the channels that became the `base`.
    lowest: [T; 3],
    base: T,
}

impl<T: Real> Stretched<T> {
    /// The picture with the values `lowest` at `base`, and differences `gain` times as large.
    pub(crate) fn new(image: &ImageView<'_, T>, lowest: [T; 3], base: T, gain: T) -> Self {
        let mut stretched = Image::zeros(image.size());
        let planes = stretched.data_mut().chunks_exact_mut(image.size().pixels());
        for (c, plane) in planes.enumerate() {
            let values = plane.iter_mut().zip(image.channel(c));
            values.for_each(|(out, &value)| *out = base + (value - lowest[c]) * gain);
        }
        Self { image: stretched, gain, lowest, base }
    }

    /// A fit of it as one of the picture as it was.
    pub(crate) fn undo(&self, mut fit: Fit<T>) -> Fit<T> {
        let colors = fit.scene.objects.iter_mut().flat_map(|object| object.paint.colors_mut());
        for color in colors.chain([&mut fit.scene.background]) {
            *color = core::array::from_fn(|c| self.lowest[c] + (color[c] - self.base) / self.gain);
        }
        fit.loss /= self.gain;
        fit.noise /= self.gain;
        fit
    }
}
