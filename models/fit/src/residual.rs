//! What a rendering leaves unexplained.

use alloc::vec::Vec;

use dvp_core::{ImageSize, ImageView, Real};

/// Largest channel difference per pixel between an image and a rendering.
#[derive(Clone, Debug, Default)]
pub(crate) struct Residual<T> {
    largest: Vec<T>,
}

impl<T: Real> Residual<T> {
    /// Compares; returns the mean absolute error.
    pub(crate) fn measure(&mut self, image: &ImageView<'_, T>, rendered: &[T]) -> T {
        let pixels = image.size().pixels();
        self.largest.clear();
        self.largest.resize(pixels, T::zero());
        let mut total = T::zero();
        for c in 0..3 {
            let (target, ours) = (image.channel(c), &rendered[c * pixels..(c + 1) * pixels]);
            // Sixteen sums at a time: they vectorize, and rounding stays small.
            let mut sums = [T::zero(); 16];
            let chunks = self.largest.chunks_mut(16).zip(target.chunks(16)).zip(ours.chunks(16));
            for ((largest, target), ours) in chunks {
                for (((sum, largest), &a), &b) in sums.iter_mut().zip(largest).zip(target).zip(ours) {
                    let off = (a - b).abs();
                    *sum += off;
                    *largest = largest.max(off);
                }
            }
            total += sums.into_iter().sum::<T>();
        }
        total / T::of_usize(3 * pixels)
    }

    /// Bits of what is unexplained: half the squared largest channel difference of each pixel in units of `noise`,
    /// capped at 24 (a pixel may be written down as it is).
    pub(crate) fn bits(&self, noise: T) -> f64 {
        let scale = T::of(0.5 * core::f64::consts::LOG2_E) / (noise * noise);
        self.largest.iter().map(|&off| (off * off * scale).min(T::of(24.0)).as_f64()).sum()
    }

    /// Pixels within `reach` (px, a square) of `center` that are off by more than `threshold`.
    pub(crate) fn count_above(&self, size: ImageSize, center: [T; 2], reach: T, threshold: T) -> usize {
        let bounds = |middle: T, extent: usize| {
            let limit = T::of_usize(extent);
            let low = (middle - reach).max(T::zero()).min(limit).floor().to_count();
            let high = (middle + reach).max(T::zero()).min(limit).ceil().to_count();
            low..high
        };
        let columns = bounds(center[0], size.width());
        let rows = bounds(center[1], size.height());
        rows.map(|row| {
            let line = &self.largest[row * size.width()..(row + 1) * size.width()];
            line[columns.clone()].iter().filter(|&&off| off > threshold).count()
        })
        .sum()
    }
}
