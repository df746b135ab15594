//! The way back of SSIM: the slopes per window, spread over the pixels of each window.

use super::ssim::{SSIM_WINDOW, SsimScratch, filter_row, padded, reflected};
use crate::dims::ImageSize;
use crate::real::Real;
use crate::simd::Kernel;

/// Leaves `cotangent` times the gradient of the sum of one channel's SSIM in the scratch memory, border included.
pub(super) struct SsimVjp<'a, T> {
    pub(super) window: &'a [T; SSIM_WINDOW],
    pub(super) size: ImageSize,
    pub(super) cotangent: T,
    pub(super) scratch: &'a mut SsimScratch<T>,
}

impl<T: Real> Kernel for SsimVjp<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { window, size, cotangent, scratch } = self;
        let SsimScratch { row, filtered, slopes, padded: planes, grad } = scratch;
        let (width, height) = padded(size);
        let (columns, rows) = (size.width(), size.height());
        grad.resize(width * height, T::zero());
        let (reach, two) = (SSIM_WINDOW - 1, T::of(2.0));
        // The window is symmetric, so spreading is filtering a row with a border of zeros.
        row.clear();
        row.resize(columns + 2 * reach, T::zero());
        let [from_mean, from_square, from_product, _] = filtered;
        let sources = planes[0].chunks_exact(width).zip(planes[1].chunks_exact(width));
        let lines = grad.chunks_exact_mut(width).zip(sources);
        for (r, (grad, (a, b))) in lines.enumerate() {
            let mut spread = [&mut *from_mean, &mut *from_square, &mut *from_product].map(|v| &mut v[..width]);
            for (out, slope) in spread.iter_mut().zip(&*slopes) {
                let middle = &mut row[reach..][..columns];
                middle.fill(T::zero());
                for (k, &weight) in window.iter().enumerate().filter(|(k, _)| *k <= r && r - k < rows) {
                    let line = &slope[(r - k) * columns..][..columns];
                    middle.iter_mut().zip(line).for_each(|(sum, &v)| *sum += weight * v);
                }
                filter_row(window, row, out);
            }
            let [mean, square, product] = spread;
            for (i, grad) in grad.iter_mut().enumerate() {
                *grad = cotangent * (mean[i] + two * a[i] * square[i] + b[i] * product[i]);
            }
        }
    }
}

/// Adds the gradient of a continued channel to that of the channel.
pub(super) fn fold<T: Real>(size: ImageSize, padded_grad: &[T], grad: &mut [T]) {
    for (r, line) in padded_grad.chunks_exact(padded(size).0).enumerate() {
        let target = &mut grad[reflected(r, size.height()) * size.width()..][..size.width()];
        for (c, &value) in line.iter().enumerate() {
            target[reflected(c, size.width())] += value;
        }
    }
}
