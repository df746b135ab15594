//! The noise level of a picture, before anything else is known about it.

use alloc::vec::Vec;

use dvp_core::{ImageView, Real};

/// Differences looked at in all; they give the level within about 2 %.
const MOST_DIFFERENCES: usize = 12_288;
/// Median of the absolute value of a normal variable of standard deviation 1.
const NORMAL_MEDIAN: f64 = 0.6745;

/// Standard deviation of the noise of a channel, from the median of second differences (a - b - c + d) / 2 over blocks of
/// 2 x 2 pixels.
///
/// Flat pixels and slopes cancel, and edges are outvoted as long as they take less than half of the picture: that of a
/// picture without noise is 0. Noise that only stands beside edges (of compression) is not seen.
pub(crate) fn noise_level<T: Real>(image: &ImageView<'_, T>, differences: &mut Vec<T>) -> T {
    let (width, height) = (image.size().width(), image.size().height());
    let (columns, rows) = (width / 2, height / 2);
    differences.clear();
    let row_stride = (3 * columns * rows).div_ceil(MOST_DIFFERENCES).clamp(1, rows.max(1));
    let column_stride = (3 * columns * rows.div_ceil(row_stride)).div_ceil(MOST_DIFFERENCES).max(1);
    let half = T::of(0.5);
    for channel in (0..3).map(|c| image.channel(c)) {
        for row in (0..rows).step_by(row_stride) {
            let lines = &channel[2 * row * width..(2 * row + 2) * width];
            let (above, below) = lines.split_at(width);
            for (a, b) in above.chunks_exact(2).zip(below.chunks_exact(2)).step_by(column_stride) {
                differences.push((half * ((a[0] - a[1]) - (b[0] - b[1]))).abs());
            }
        }
    }
    if differences.is_empty() {
        return T::zero();
    }
    let middle = differences.len() / 2;
    let order = |a: &T, b: &T| a.partial_cmp(b).unwrap_or(core::cmp::Ordering::Equal);
    let median = *differences.select_nth_unstable_by(middle, order).1;
    spread_ties(differences, median) / T::of(NORMAL_MEDIAN)
}

/// The median as if equal values, of a picture of few bits, were spread evenly around theirs.
fn spread_ties<T: Real>(differences: &[T], median: T) -> T {
    let tie = T::of(1e-5);
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
