//! What a rendering leaves unexplained.

use alloc::vec::Vec;
use core::cell::Cell;
use core::ops::Range;

use dvp_core::{ImageSize, ImageView, Real, simd};
use dvp_trace::noise::noise_level;

use crate::segment::PIXEL_NOISE;

/// A rectangle of pixels inside an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PixelBox {
    /// First column and row.
    pub(crate) low: [usize; 2],
    /// Last column and row, plus 1.
    pub(crate) high: [usize; 2],
}

impl PixelBox {
    pub(crate) fn width(&self) -> usize {
        self.high[0] - self.low[0]
    }

    pub(crate) fn height(&self) -> usize {
        self.high[1] - self.low[1]
    }

    pub(crate) fn pixels(&self) -> usize {
        self.width() * self.height()
    }

    pub(crate) fn meets(&self, other: &Self) -> bool {
        (0..2).all(|c| self.low[c] < other.high[c] && other.low[c] < self.high[c])
    }

    /// The indices of each row, in an image of `width` columns.
    pub(crate) fn rows(self, width: usize) -> impl Iterator<Item = Range<usize>> {
        (self.low[1]..self.high[1]).map(move |row| row * width + self.low[0]..row * width + self.high[0])
    }
}

/// Largest channel difference per pixel between an image and a rendering.
#[derive(Clone, Debug, Default)]
pub(crate) struct Residual<T> {
    largest: Vec<T>,
    width: usize,
    /// Bits of each row under the noise last asked for; NaN where the row has changed since.
    bits: Vec<Cell<f64>>,
    noise: Cell<f64>,
}

impl<T: Real> Residual<T> {
    /// Compares; returns the mean absolute error.
    pub(crate) fn measure(&mut self, image: &ImageView<'_, T>, rendered: &[T]) -> T {
        let pixels = image.size().pixels();
        self.largest.resize(pixels, T::zero());
        self.width = image.size().width();
        self.bits.clear();
        self.bits.resize(image.size().height(), Cell::new(f64::NAN));
        simd::dispatch(Measure { image, rendered, largest: &mut self.largest }) / T::of_usize(3 * pixels)
    }

    /// Compares in a window; elsewhere the last comparison stands.
    pub(crate) fn measure_window(&mut self, image: &ImageView<'_, T>, rendered: &[T], window: PixelBox) {
        let plane = image.size().pixels();
        let channels: [(&[T], &[T]); 3] =
            core::array::from_fn(|c| (image.channel(c), &rendered[c * plane..(c + 1) * plane]));
        for line in window.rows(self.width) {
            for at in line {
                let [r, g, b] = channels.map(|(image, rendered)| (image[at] - rendered[at]).abs());
                self.largest[at] = r.max(g).max(b);
            }
        }
        self.bits[window.low[1]..window.high[1]].iter().for_each(|row| row.set(f64::NAN));
    }

    /// Bits of what is unexplained: half the squared largest channel difference of each pixel in units of `noise`,
    /// capped at 24 (a pixel may be written down as it is).
    pub(crate) fn bits(&self, noise: T) -> f64 {
        let scale = T::of(0.5 * core::f64::consts::LOG2_E) / (noise * noise);
        if self.noise.replace(noise.as_f64()).to_bits() != noise.as_f64().to_bits() {
            self.bits.iter().for_each(|row| row.set(f64::NAN));
        }
        simd::dispatch(Bits { largest: &self.largest, width: self.width.max(1), scale, rows: &self.bits })
    }

    /// Pixels with a larger difference in some channel.
    pub(crate) fn count_all_above(&self, threshold: T) -> usize {
        self.largest.iter().filter(|&&largest| largest > threshold).count()
    }

    /// Share of the variance of `image` that neither `rendered` nor noise of standard deviation `noise` explains, [0, 1], and
    /// that variance, noise excepted, as a sum of squares over all values.
    pub(crate) fn unexplained(image: &ImageView<'_, T>, rendered: &[T], noise: T) -> (f64, f64) {
        let pixels = image.size().pixels();
        let (mut missed, mut total) = (0.0, 0.0);
        for channel in 0..3 {
            let values = image.channel(channel);
            let drawn = &rendered[channel * pixels..(channel + 1) * pixels];
            // About a value of the picture, so that little cancels: most pictures are mostly background.
            let origin = values.first().copied().unwrap_or_else(T::zero);
            let [squares, spread, sum] = simd::dispatch(Squares { values, drawn, origin });
            missed += squares;
            total += spread - sum * sum / T::of_usize(pixels).as_f64();
        }
        let expected = (noise * noise).as_f64() * T::of_usize(3 * pixels).as_f64();
        let (missed, total) = ((missed - expected).max(0.0), total - expected);
        (if total > missed { missed / total } else { f64::from(u8::from(missed > 0.0)) }, total)
    }

    /// How many of `pixels` are off by more than `threshold`.
    pub(crate) fn count_off(&self, pixels: &[usize], threshold: T) -> usize {
        pixels.iter().filter(|&&index| self.largest.get(index).is_some_and(|&off| off > threshold)).count()
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

/// What a rendering of any origin leaves of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Unexplained<T> {
    /// Share of the picture's variance that neither the rendering nor noise explains, [0, 1].
    pub share: f64,
    /// Standard deviation of a channel that was taken for noise: at least the rounding of 8 bits.
    pub noise: T,
    /// The picture's variance without that noise, as a sum of squares over all values.
    pub variance: f64,
    /// Bits of what is left at that noise: half the squared largest channel difference of each pixel in units of the noise, in
    /// base 2, at most 24 per pixel.
    pub bits: f64,
}

impl<T: Real> Unexplained<T> {
    /// Compares `painted` (planar, as long as the image's data) with the image, whose noise is estimated.
    #[must_use]
    #[inline(never)]
    pub fn of(image: &ImageView<'_, T>, painted: &[T]) -> Self {
        let without_bits = Self::without_bits(image, painted);
        let mut residual = Residual::default();
        residual.measure(image, painted);
        Self { bits: residual.bits(without_bits.noise), ..without_bits }
    }

    /// The same for those who ask for no bits, which take as long again: NaN.
    pub(crate) fn without_bits(image: &ImageView<'_, T>, painted: &[T]) -> Self {
        let noise = noise_level(image, &mut Vec::new()).max(T::of(PIXEL_NOISE));
        let (share, variance) = Residual::unexplained(image, painted, noise);
        Self { share, noise, variance, bits: f64::NAN }
    }
}

/// Fills the rows that are NaN, and sums all.
struct Bits<'a, T> {
    largest: &'a [T],
    width: usize,
    scale: T,
    rows: &'a [Cell<f64>],
}

impl<T: Real> simd::Kernel for Bits<'_, T> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let of_pixel = |off: T| (off * off * self.scale).min(T::of(24.0));
        let mut total = 0.0;
        for (row, line) in self.rows.iter().zip(self.largest.chunks_exact(self.width)) {
            if row.get().is_nan() {
                let mut sums = [T::zero(); LANES];
                let (parts, rest) = line.as_chunks::<LANES>();
                for part in parts {
                    for i in 0..LANES {
                        sums[i] += of_pixel(part[i]);
                    }
                }
                let rest: T = rest.iter().map(|&off| of_pixel(off)).sum();
                row.set((sums.into_iter().sum::<T>() + rest).as_f64());
            }
            total += row.get();
        }
        total
    }
}

/// Sums of squared differences from a rendering, of those from an origin, and of the latter as they are.
struct Squares<'a, T> {
    values: &'a [T],
    drawn: &'a [T],
    origin: T,
}

/// Values summed in single precision: sums over large pictures would lose what they add.
const BLOCK: usize = 1024;

impl<T: Real> simd::Kernel for Squares<'_, T> {
    type Output = [f64; 3];

    #[inline(always)]
    fn run(self) -> [f64; 3] {
        let mut out = [0.0; 3];
        for (values, drawn) in self.values.chunks(BLOCK).zip(self.drawn.chunks(BLOCK)) {
            let mut sums = [[T::zero(); LANES]; 3];
            for (values, drawn) in values.chunks(LANES).zip(drawn.chunks(LANES)) {
                if let (Ok(values), Ok(drawn)) = (<&[T; LANES]>::try_from(values), <&[T; LANES]>::try_from(drawn)) {
                    for i in 0..LANES {
                        let (off, spread) = (values[i] - drawn[i], values[i] - self.origin);
                        sums[0][i] += off * off;
                        sums[1][i] += spread * spread;
                        sums[2][i] += spread;
                    }
                } else {
                    for (&value, &drawn) in values.iter().zip(drawn) {
                        let (off, spread) = (value - drawn, value - self.origin);
                        sums[0][0] += off * off;
                        sums[1][0] += spread * spread;
                        sums[2][0] += spread;
                    }
                }
            }
            for (total, sums) in out.iter_mut().zip(sums) {
                *total += sums.into_iter().sum::<T>().as_f64();
            }
        }
        out
    }
}

/// Sums absolute differences and keeps the largest of the three channels.
struct Measure<'a, T> {
    image: &'a ImageView<'a, T>,
    rendered: &'a [T],
    largest: &'a mut [T],
}

/// Values per step: they vectorize, and the rounding of as many sums stays small.
const LANES: usize = 16;

impl<T: Real> simd::Kernel for Measure<'_, T> {
    type Output = T;

    #[inline(always)]
    fn run(self) -> T {
        let pixels = self.largest.len();
        let [r, g, b] = [0, 1, 2].map(|c| self.image.channel(c).chunks(LANES));
        let [x, y, z] = [0, 1, 2].map(|c| self.rendered[c * pixels..(c + 1) * pixels].chunks(LANES));
        let mut sums = [T::zero(); LANES];
        for ((largest, (r, x)), ((g, y), (b, z))) in
            self.largest.chunks_mut(LANES).zip(r.zip(x)).zip(g.zip(y).zip(b.zip(z)))
        {
            let n = largest.len();
            if let (Ok(largest), [Ok(r), Ok(x), Ok(g), Ok(y), Ok(b), Ok(z)]) =
                (<&mut [T; LANES]>::try_from(&mut *largest), [r, x, g, y, b, z].map(<&[T; LANES]>::try_from))
            {
                for i in 0..LANES {
                    let off = [(r[i] - x[i]).abs(), (g[i] - y[i]).abs(), (b[i] - z[i]).abs()];
                    sums[i] += off[0] + off[1] + off[2];
                    largest[i] = off[0].max(off[1]).max(off[2]);
                }
            } else {
                for i in 0..n {
                    let off = [(r[i] - x[i]).abs(), (g[i] - y[i]).abs(), (b[i] - z[i]).abs()];
                    sums[i] += off[0] + off[1] + off[2];
                    largest[i] = off[0].max(off[1]).max(off[2]);
                }
            }
        }
        sums.into_iter().sum()
    }
}
