//! Denoising that keeps edges: every pixel becomes the mean of those around whose neighborhoods look alike (non-local
//! means, Buades, Coll and Morel 2005), taken offset by offset, so that it vectorizes.

use alloc::vec::Vec;

use dvp_core::{ImageView, Real, simd};

/// Rows that are done for all offsets before the next ones, so that they stay in the cache.
const STRIP: usize = 32;
/// Neighborhoods are compared over 2 x this + 1 pixels a side.
const PATCH: usize = 1;

/// Settings of [`denoise`].
#[derive(Clone, Copy, Debug)]
pub(super) struct DenoiseSettings<T> {
    /// Pixels up to this far (px, a square) are averaged.
    pub(super) reach: usize,
    /// Mean squared difference of two neighborhoods that noise alone makes.
    pub(super) expected: T,
    /// Surplus of the mean squared difference at which a pixel has no say any more.
    pub(super) limit: T,
}

/// Memory of [`denoise_twice`](super::denoise_twice), kept between pictures.
#[derive(Clone, Debug, Default)]
pub struct DenoiseScratch<T> {
    weights: Vec<T>,
    /// Squared differences of one row, with margins.
    line: Vec<T>,
    /// The same, summed along rows, for the rows of a strip.
    sums: Vec<T>,
    shares: Vec<T>,
}

/// Fills `out` (planar, as the image) with means of `image`, alike being judged by `guide`.
#[inline(never)]
pub(super) fn denoise<T: Real>(
    image: &ImageView<'_, T>,
    guide: &ImageView<'_, T>,
    settings: DenoiseSettings<T>,
    scratch: &mut DenoiseScratch<T>,
    out: &mut Vec<T>,
) {
    let pixels = image.size().pixels();
    out.clear();
    out.extend_from_slice(image.data());
    scratch.weights.clear();
    scratch.weights.resize(pixels, T::one());
    simd::dispatch(Denoise { image, guide, settings, scratch, out });
    for channel in out.chunks_exact_mut(pixels) {
        for (value, &weight) in channel.iter_mut().zip(&scratch.weights) {
            *value /= weight;
        }
    }
}

struct Denoise<'a, T> {
    image: &'a ImageView<'a, T>,
    guide: &'a ImageView<'a, T>,
    settings: DenoiseSettings<T>,
    scratch: &'a mut DenoiseScratch<T>,
    out: &'a mut [T],
}

impl<T: Real> simd::Kernel for Denoise<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(mut self) {
        let (width, height) = (self.image.size().width(), self.image.size().height());
        let reach = self.settings.reach;
        for top in (0..height).step_by(STRIP) {
            // Each pair of pixels once: offsets below, or to the right on the same row.
            for down in 0..=reach.min(height - 1) {
                for across in 0..=2 * reach {
                    // First columns of the pairs, and how many there are.
                    let (left, right) = (reach.saturating_sub(across), across.saturating_sub(reach));
                    if (down > 0 || right > 0) && left.max(right) < width && top + down < height {
                        self.strip(top, down, left, right);
                    }
                }
            }
        }
    }
}

impl<T: Real> Denoise<'_, T> {
    /// Pairs of (x + left, y) and (x + right, y + down) with y in the strip that starts at row `top`.
    #[inline(always)]
    fn strip(&mut self, top: usize, down: usize, left: usize, right: usize) {
        let (width, height) = (self.image.size().width(), self.image.size().height());
        let pixels = width * height;
        let count = width - left.max(right);
        let last = height - down;
        let rows = top..(top + STRIP).min(last);
        let first_sum = top.saturating_sub(PATCH);
        let DenoiseScratch { weights, line, sums, shares } = &mut *self.scratch;
        line.resize((width + 2 * PATCH).max(line.len()), T::zero());
        sums.resize(((STRIP + 2 * PATCH) * width).max(sums.len()), T::zero());
        shares.resize(width.max(shares.len()), T::zero());
        let guide = self.guide.data();
        for y in first_sum..(rows.end + PATCH).min(last) {
            let line = &mut line[..count + 2 * PATCH];
            let inner = &mut line[PATCH..PATCH + count];
            let (from, to) = (y * width + left, (y + down) * width + right);
            let [(a, d), (b, e), (c, f)] = [0, 1, 2].map(|channel| {
                let plane = &guide[channel * pixels..(channel + 1) * pixels];
                (&plane[from..from + count], &plane[to..to + count])
            });
            for i in 0..count {
                let off = [a[i] - d[i], b[i] - e[i], c[i] - f[i]];
                inner[i] = off[0] * off[0] + off[1] * off[1] + off[2] * off[2];
            }
            let (start, end) = (line[PATCH], line[PATCH + count - 1]);
            line[..PATCH].fill(start);
            line[PATCH + count..].fill(end);
            let sums = &mut sums[(y - first_sum) * width..][..count];
            let (a, b, c) = (&line[..count], &line[1..=count], &line[2..count + 2]);
            for i in 0..count {
                sums[i] = a[i] + b[i] + c[i];
            }
        }
        let per_value = T::one() / T::of_usize(3 * (2 * PATCH + 1) * (2 * PATCH + 1));
        let (expected, inverse) = (self.settings.expected, T::one() / self.settings.limit);
        let (zero, one) = (T::zero(), T::one());
        for y in rows {
            let row = |y: usize| &sums[(y.clamp(first_sum, last - 1) - first_sum) * width..][..count];
            let (a, b, c) = (row(y.saturating_sub(1)), row(y), row(y + 1));
            let shares = &mut shares[..count];
            for i in 0..count {
                let surplus = ((a[i] + b[i] + c[i]) * per_value - expected).max(zero);
                let share = (one - surplus * inverse).max(zero);
                shares[i] = share * share;
            }
            let (from, to) = (y * width + left, (y + down) * width + right);
            add(&mut weights[from..from + count], shares);
            add(&mut weights[to..to + count], shares);
            for channel in 0..3 {
                let source = &self.image.channel(channel);
                let target = &mut self.out[channel * pixels..(channel + 1) * pixels];
                add_product(&mut target[from..from + count], shares, &source[to..to + count]);
                add_product(&mut target[to..to + count], shares, &source[from..from + count]);
            }
        }
    }
}

#[inline(always)]
fn add<T: Real>(target: &mut [T], values: &[T]) {
    for (sum, &value) in target.iter_mut().zip(values) {
        *sum += value;
    }
}

#[inline(always)]
fn add_product<T: Real>(target: &mut [T], shares: &[T], values: &[T]) {
    for ((sum, &share), &value) in target.iter_mut().zip(shares).zip(values) {
        *sum += share * value;
    }
}
