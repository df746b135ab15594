//! Colors as mixtures of two others.

use crate::real::Real;

/// The most that a channel of two colors differs.
#[must_use]
#[inline]
pub fn distance<T: Real>(a: [T; 3], b: [T; 3]) -> T {
    (a[0] - b[0]).abs().max((a[1] - b[1]).abs()).max((a[2] - b[2]).abs())
}

/// How much of `to` a mixture of `from` and `to` has, by least squares; not clamped, and 0 where both are one color.
#[must_use]
#[inline]
pub fn coverage<T: Real>(pixel: [T; 3], from: [T; 3], to: [T; 3]) -> T {
    let [mut dot, mut square] = [T::zero(); 2];
    for c in 0..3 {
        let difference = to[c] - from[c];
        dot += (pixel[c] - from[c]) * difference;
        square += difference * difference;
    }
    if square > T::zero() { dot / square } else { T::zero() }
}

/// The most that a channel of a pixel differs from `from` with a `share` of `to`, which may be more than all of it.
#[must_use]
#[inline]
pub fn misfit<T: Real>(pixel: [T; 3], from: [T; 3], to: [T; 3], share: T) -> T {
    (0..3).map(|c| (pixel[c] - from[c] - share * (to[c] - from[c])).abs()).fold(T::zero(), T::max)
}

/// How much of `to` a pixel shows over `from`, \[0, 1\], and the most that a channel differs from that mixture.
#[must_use]
#[inline]
pub fn mixture<T: Real>(pixel: [T; 3], from: [T; 3], to: [T; 3]) -> (T, T) {
    let share = coverage(pixel, from, to).max(T::zero()).min(T::one());
    (share, misfit(pixel, from, to, share))
}
