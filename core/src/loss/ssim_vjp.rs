//! The way back of SSIM: the slopes per window, spread over the pixels of each window.

use super::ImagePair;
use super::ssim::{SSIM_WINDOW, SsimScratch, filter_row, valid};
use crate::real::Real;
use crate::simd::Kernel;

/// Adds `cotangent` times the gradient of the sum of one channel's SSIM to `grad`.
pub(super) struct SsimVjp<'a, T> {
    pub(super) window: &'a [T; SSIM_WINDOW],
    pub(super) pair: ImagePair<'a, T>,
    pub(super) channel: usize,
    pub(super) cotangent: T,
    pub(super) scratch: &'a mut SsimScratch<T>,
    pub(super) grad: &'a mut [T],
}

impl<T: Real> Kernel for SsimVjp<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { window, pair, channel, cotangent, scratch, grad } = self;
        let SsimScratch { row, filtered, slopes } = scratch;
        let width = pair.size().width();
        let (columns, rows) = valid(pair.size());
        let (reach, two) = (SSIM_WINDOW - 1, T::of(2.0));
        // The window is symmetric, so spreading is filtering a row with a border of zeros.
        row.clear();
        row.resize(columns + 2 * reach, T::zero());
        let [from_mean, from_square, from_product, _] = filtered;
        let (a, b) = (pair.image().channel(channel), pair.target().channel(channel));
        let lines = grad.chunks_exact_mut(width).zip(a.chunks_exact(width).zip(b.chunks_exact(width)));
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
                *grad += cotangent * (mean[i] + two * a[i] * square[i] + b[i] * product[i]);
            }
        }
    }
}
