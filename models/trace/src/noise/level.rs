//! The noise level of a picture, before anything else is known about it.

use alloc::vec::Vec;

use dvp_core::sort::median;
use dvp_core::{ImageView, Real, simd};

/// Differences looked at in all; they give the level within about 2 %.
const MOST_DIFFERENCES: usize = 12_288;
/// Blocks without black and white that tell the level within about 10 %.
const ENOUGH: usize = 64;
/// Noise over what the median difference tells of it where it is cut off at its mean, by the 15 of 16 blocks that black or white shows in.
const ALL_CUT_OFF: f64 = 1.897;
/// Where a smaller share of the blocks is without black and white, all noise is cut off: half a standard deviation off it is .23.
const FEW_WHOLE: f64 = 0.125;
/// Noise over what is left of it where it is cut off at its mean: 1 / sqrt(1/2 - 1/(2 pi)).
const MOST_CUT_OFF: f64 = 1.713;
/// Median of the absolute value of a normal variable of standard deviation 1.
pub(super) const NORMAL_MEDIAN: f64 = 0.6745;
/// Differences up to this far apart are equal: a small part of a step of 16 bits.
pub(super) const TIE: f64 = 1e-5;

/// Standard deviation of the noise of a channel, from the median of second differences (a - b - c + d) / 2 over blocks of
/// 2 x 2 pixels.
///
/// Flat pixels and slopes cancel, and edges are outvoted as long as they take less than half of the picture: that of a
/// picture without noise is 0. Black and white cut noise off: blocks that have neither tell more, if there are enough of
/// them. Noise that only stands beside edges (of compression) is not seen.
#[must_use]
#[inline(never)]
pub fn noise_level<T: Real>(image: &ImageView<'_, T>, differences: &mut Vec<T>) -> T {
    let (width, height) = (image.size().width(), image.size().height());
    let (columns, rows) = (width / 2, height / 2);
    differences.clear();
    let row_stride = (3 * columns * rows).div_ceil(MOST_DIFFERENCES).clamp(1, rows.max(1));
    let column_stride = (3 * columns * rows.div_ceil(row_stride)).div_ceil(MOST_DIFFERENCES).max(1);
    let equal = simd::dispatch(Differences { image, rows, row_stride, column_stride, differences });
    // The usual picture: the median needs no search.
    if 2 * equal > differences.len() {
        return T::zero();
    }
    let of_all = middle(differences);
    let all = differences.len();
    differences.clear();
    for channel in [0, 1, 2].map(|c| image.channel(c)) {
        for row in (0..rows).step_by(row_stride) {
            let (above, below) = channel[2 * row * width..(2 * row + 2) * width].split_at(width);
            let blocks = above.chunks_exact(2).zip(below.chunks_exact(2)).step_by(column_stride);
            let whole = blocks.filter(|(a, b)| a.iter().chain(*b).all(|&value| value > T::zero() && value < T::one()));
            differences.extend(whole.map(|(a, b)| second_difference(a, b)));
        }
    }
    if T::of_usize(differences.len()) < T::of(FEW_WHOLE) * T::of_usize(all) {
        return T::of(ALL_CUT_OFF / NORMAL_MEDIAN) * of_all;
    }
    let of_whole = if differences.len() >= ENOUGH { middle(differences) } else { T::zero() };
    of_all.max(of_whole.min(T::of(MOST_CUT_OFF) * of_all)) / T::of(NORMAL_MEDIAN)
}

/// The median of differences.
pub(super) fn middle<T: Real>(differences: &mut [T]) -> T {
    median(differences).map_or(T::zero(), |median| spread_ties(differences, median))
}

#[inline(always)]
pub(super) fn second_difference<T: Real>(a: &[T], b: &[T]) -> T {
    (T::of(0.5) * ((a[0] - a[1]) - (b[0] - b[1]))).abs()
}

/// The kernel that fills `differences` with the second differences of every so many blocks of 2 x 2 pixels; its output is how
/// many of them are 0.
struct Differences<'a, T> {
    image: &'a ImageView<'a, T>,
    rows: usize,
    row_stride: usize,
    column_stride: usize,
    differences: &'a mut Vec<T>,
}

impl<T: Real> simd::Kernel for Differences<'_, T> {
    type Output = usize;

    #[inline(always)]
    fn run(self) -> usize {
        let width = self.image.size().width();
        let tie = T::of(TIE);
        for channel in [0, 1, 2].map(|c| self.image.channel(c)) {
            for row in (0..self.rows).step_by(self.row_stride) {
                let lines = &channel[2 * row * width..(2 * row + 2) * width];
                let (above, below) = lines.split_at(width);
                let start = self.differences.len();
                self.differences.resize(start + (width / 2).div_ceil(self.column_stride), T::zero());
                let line = &mut self.differences[start..];
                if self.column_stride == 1 {
                    for ((out, a), b) in line.iter_mut().zip(above.chunks_exact(2)).zip(below.chunks_exact(2)) {
                        *out = second_difference(a, b);
                    }
                } else {
                    let step = 2 * self.column_stride;
                    for ((out, a), b) in line.iter_mut().zip(above.chunks(step)).zip(below.chunks(step)) {
                        *out = second_difference(a, b);
                    }
                }
            }
        }
        self.differences.iter().map(|&value| usize::from(value <= tie)).sum()
    }
}

/// The median as if equal values, of a picture of few bits, were spread evenly around theirs.
fn spread_ties<T: Real>(differences: &[T], median: T) -> T {
    let tie = T::of(TIE);
    let (mut below, mut equal, mut next) = (0_usize, 0_usize, T::infinity());
    for &value in differences {
        if value < median - tie {
            below += 1;
        } else if value <= median + tie {
            equal += 1;
        } else {
            next = next.min(value);
        }
    }
    if median <= tie || !next.is_finite() || equal == 0 {
        return median;
    }
    let half = T::of(0.5);
    let share = (half * T::of_usize(differences.len()) - T::of_usize(below)) / T::of_usize(equal);
    median + (next - median) * (share - half)
}
