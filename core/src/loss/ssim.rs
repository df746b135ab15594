//! Structural similarity of two images under a Gaussian window.
//!
//! With E the windowed mean, m_a = E(a), v = E(a^2) + E(b^2) - m_a^2 - m_b^2 and c = E(ab) - m_a m_b:
//! SSIM = (2 m_a m_b + C1)(2 c + C2) / ((m_a^2 + m_b^2 + C1)(v + C2)), averaged over channels and over all
//! pixels; the image is continued beyond its border by reflection (the border pixel itself is not repeated). That is what
//! the reference's scores agree with; leaving border pixels out differs by up to 0.03. Only the sum of the two variances is needed, so four planes are filtered, not five.

use alloc::vec::Vec;

use super::ssim_vjp::{SsimVjp, fold};
use super::{ImagePair, Loss, LossError, check_length};
use crate::dims::ImageSize;
use crate::image::CHANNELS;
use crate::real::Real;
use crate::simd::{Kernel, dispatch};

/// Side of the window in pixels.
pub const SSIM_WINDOW: usize = 11;
/// Standard deviation of the window in pixels.
const SIGMA: f64 = 1.5;
/// (0.01 x data range)^2, with data in \[0, 1\].
const C1: f64 = 1e-4;
/// (0.03 x data range)^2.
const C2: f64 = 9e-4;
/// Pixels filtered side by side.
const LANES: usize = 16;

/// 1 - SSIM: window 11 x 11, Gaussian of sigma 1.5, constants 0.01 and 0.03, data range 1.
///
/// *Source*: Wang, Bovik, Sheikh and Simoncelli, Image quality assessment, IEEE TIP 13 (2004); borders as in torchmetrics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ssim<T> {
    window: [T; SSIM_WINDOW],
}

/// Memory of [`Ssim`].
#[derive(Clone, Debug, Default)]
pub struct SsimScratch<T> {
    /// One channel of the image and of the target, continued by half a window on each side.
    pub(super) padded: [Vec<T>; 2],
    /// Gradient of the continued channel of the image.
    pub(super) grad: Vec<T>,
    /// A row of a, b, a^2 + b^2, ab, each in turn.
    pub(super) row: Vec<T>,
    /// The four planes of one channel, filtered along rows.
    pub(super) filtered: [Vec<T>; 4],
    /// Derivatives of the channel's SSIM with respect to m_a, E(a^2) and E(ab); filled for the way back only.
    pub(super) slopes: [Vec<T>; 3],
}

impl<T: Real> Default for Ssim<T> {
    fn default() -> Self {
        let center = T::of_usize(SSIM_WINDOW / 2);
        let mut window = core::array::from_fn(|i| {
            let d = (T::of_usize(i) - center) / T::of(SIGMA);
            (-d * d / T::of(2.0)).exp()
        });
        let sum: T = window.iter().copied().sum();
        window.iter_mut().for_each(|weight| *weight /= sum);
        Self { window }
    }
}

impl<T: Real> Ssim<T> {
    /// The mean structural similarity, at most 1.
    ///
    /// # Errors
    /// [`LossError::SmallerThanWindow`] if a side is below [`SSIM_WINDOW`].
    #[inline(never)]
    pub fn similarity(&self, pair: ImagePair<'_, T>, scratch: &mut SsimScratch<T>) -> Result<T, LossError> {
        check_window(pair.size())?;
        let mut sum = 0.0;
        for channel in 0..CHANNELS {
            scratch.pad(pair, channel);
            sum += dispatch(SsimChannel {
                window: &self.window,
                size: pair.size(),
                slopes: false,
                scratch: &mut *scratch,
            });
        }
        Ok(T::of(sum / CHANNELS as f64))
    }
}

impl<T: Real> Loss<T> for Ssim<T> {
    type Input<'a> = ImagePair<'a, T>;
    /// 3 x height x width.
    type Grad = [T];
    type Scratch = SsimScratch<T>;

    fn value(&self, pair: ImagePair<'_, T>, scratch: &mut SsimScratch<T>) -> Result<T, LossError> {
        Ok(T::one() - self.similarity(pair, scratch)?)
    }

    #[inline(never)]
    fn vjp(
        &self,
        pair: ImagePair<'_, T>,
        cotangent: T,
        scratch: &mut SsimScratch<T>,
        grad: &mut [T],
    ) -> Result<T, LossError> {
        check_length("image gradient", grad, pair.image().data().len())?;
        check_window(pair.size())?;
        let (window, size) = (&self.window, pair.size());
        let cotangent = -cotangent / T::of_usize(CHANNELS * size.pixels());
        let mut sum = 0.0;
        for (channel, grad) in grad.chunks_exact_mut(size.pixels()).enumerate() {
            scratch.pad(pair, channel);
            sum += dispatch(SsimChannel { window, size, slopes: true, scratch: &mut *scratch });
            dispatch(SsimVjp { window, size, cotangent, scratch: &mut *scratch });
            fold(size, &scratch.grad, grad);
        }
        Ok(T::of(1.0 - sum / CHANNELS as f64))
    }
}

fn check_window(size: ImageSize) -> Result<(), LossError> {
    if size.width() < SSIM_WINDOW || size.height() < SSIM_WINDOW {
        return Err(LossError::SmallerThanWindow { size, window: SSIM_WINDOW });
    }
    Ok(())
}

/// Pixels that a window reaches beyond its center.
const REACH: usize = SSIM_WINDOW / 2;

/// Columns and rows of the continued image.
#[inline(always)]
pub(super) fn padded(size: ImageSize) -> (usize, usize) {
    (size.width() + 2 * REACH, size.height() + 2 * REACH)
}

/// The column (or row) that is seen at position `i` of a line continued by reflection.
pub(super) fn reflected(i: usize, len: usize) -> usize {
    let at = i.abs_diff(REACH);
    if at < len { at } else { 2 * (len - 1) - at }
}

impl<T: Real> SsimScratch<T> {
    /// Continues one channel of both images beyond their borders.
    fn pad(&mut self, pair: ImagePair<'_, T>, channel: usize) {
        let size = pair.size();
        let (columns, rows) = padded(size);
        for (plane, image) in self.padded.iter_mut().zip([pair.image(), pair.target()]) {
            plane.resize(columns * rows, T::zero());
            for (r, line) in plane.chunks_exact_mut(columns).enumerate() {
                let source = &image.channel(channel)[reflected(r, size.height()) * size.width()..][..size.width()];
                line[REACH..][..size.width()].copy_from_slice(source);
                for c in (0..REACH).chain(REACH + size.width()..columns) {
                    line[c] = source[reflected(c, size.width())];
                }
            }
        }
    }
}

/// The mean SSIM of one channel and, if asked for, its slopes (not divided by the number of pixels).
struct SsimChannel<'a, T> {
    window: &'a [T; SSIM_WINDOW],
    size: ImageSize,
    slopes: bool,
    scratch: &'a mut SsimScratch<T>,
}

impl<T: Real> Kernel for SsimChannel<'_, T> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let Self { window, size, slopes, scratch } = self;
        let SsimScratch { row, filtered, slopes: slope_planes, padded: planes, .. } = scratch;
        let (width, height) = padded(size);
        let (columns, rows) = (size.width(), size.height());
        row.resize(width, T::zero());
        filtered.iter_mut().for_each(|plane| plane.resize(columns * height, T::zero()));
        let lines = planes[0].chunks_exact(width).zip(planes[1].chunks_exact(width));
        for (r, (a, b)) in lines.enumerate() {
            let [mean_a, mean_b, squares, products] = filtered.each_mut().map(|p| &mut p[r * columns..][..columns]);
            filter_row(window, a, mean_a);
            filter_row(window, b, mean_b);
            row.iter_mut().zip(a.iter().zip(b)).for_each(|(v, (&a, &b))| *v = a * a + b * b);
            filter_row(window, row, squares);
            row.iter_mut().zip(a.iter().zip(b)).for_each(|(v, (&a, &b))| *v = a * b);
            filter_row(window, row, products);
        }
        if slopes {
            slope_planes.iter_mut().for_each(|plane| plane.resize(columns * rows, T::zero()));
        }
        let (mut total, two) = (0.0, T::of(2.0));
        let (c1, c2) = (T::of(C1), T::of(C2));
        for r in 0..rows {
            let mut sums = [T::zero(); LANES];
            for left in (0..columns).step_by(LANES) {
                let lanes = LANES.min(columns - left);
                let [m_a, m_b, squares, products] = filtered
                    .each_ref()
                    .map(|plane| filter_column(window, &plane[r * columns + left..], columns, lanes));
                let mut slope = [[T::zero(); LANES]; 3];
                for lane in 0..LANES {
                    let (m_a, m_b) = (m_a[lane], m_b[lane]);
                    let (means, product) = (m_a * m_a + m_b * m_b, m_a * m_b);
                    let top_1 = two * product + c1;
                    let top_2 = two * (products[lane] - product) + c2;
                    let bottom_1 = means + c1;
                    let bottom_2 = squares[lane] - means + c2;
                    let scale = T::one() / (bottom_1 * bottom_2);
                    let ssim = top_1 * top_2 * scale;
                    sums[lane] += if lane < lanes { ssim } else { T::zero() };
                    slope[1][lane] = -ssim * bottom_1 * scale;
                    slope[2][lane] = two * top_1 * scale;
                    slope[0][lane] = two * scale * (m_b * (top_2 - top_1) - m_a * ssim * (bottom_2 - bottom_1));
                }
                if slopes {
                    for (plane, slope) in slope_planes.iter_mut().zip(&slope) {
                        plane[r * columns + left..][..lanes].copy_from_slice(&slope[..lanes]);
                    }
                }
            }
            total += sums.iter().map(|sum| sum.as_f64()).sum::<f64>();
        }
        total / (columns * rows) as f64
    }
}

/// `out[i]` = sum over k of `window[k] row[i + k]`; `row` is [`SSIM_WINDOW`] - 1 longer than `out`.
#[inline(always)]
pub(super) fn filter_row<T: Real>(window: &[T; SSIM_WINDOW], row: &[T], out: &mut [T]) {
    let (blocks, rest) = out.as_chunks_mut::<LANES>();
    let done = blocks.len() * LANES;
    for (i, block) in blocks.iter_mut().enumerate() {
        let mut sums = [T::zero(); LANES];
        for (k, &weight) in window.iter().enumerate() {
            for (sum, &v) in sums.iter_mut().zip(&row[i * LANES + k..][..LANES]) {
                *sum += weight * v;
            }
        }
        *block = sums;
    }
    for (i, value) in rest.iter_mut().enumerate() {
        *value = window.iter().zip(&row[done + i..]).map(|(&weight, &v)| weight * v).sum();
    }
}

/// [`LANES`] neighboring columns, filtered downwards from the first row of `plane`; `lanes` of them exist.
#[inline(always)]
fn filter_column<T: Real>(window: &[T; SSIM_WINDOW], plane: &[T], stride: usize, lanes: usize) -> [T; LANES] {
    let mut sums = [T::zero(); LANES];
    if lanes == LANES {
        for (k, &weight) in window.iter().enumerate() {
            for (sum, &v) in sums.iter_mut().zip(&plane[k * stride..][..LANES]) {
                *sum += weight * v;
            }
        }
    } else {
        for (k, &weight) in window.iter().enumerate() {
            for (sum, &v) in sums.iter_mut().zip(&plane[k * stride..][..lanes]) {
                *sum += weight * v;
            }
        }
    }
    sums
}
