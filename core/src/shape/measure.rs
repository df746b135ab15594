//! Measures of an outline, from its descriptors alone.

use super::Efd;
use crate::real::Real;

impl<T: Real> Efd<T> {
    /// pi sum n (a_n d_n - b_n c_n): the area inside, positive if the outline turns from +x to +y (clockwise on a
    /// screen, where y is down). MDS-HR's shapes turn the other way: negative.
    #[must_use]
    pub fn signed_area(&self) -> T {
        let sum: T = (1..).zip(&self.rows).map(|(n, &[a, b, c, d])| T::of_usize(n) * (a * d - b * c)).sum();
        T::of(core::f64::consts::PI) * sum
    }

    /// The length of the outline: the mean speed at 16 (N + 1) parameters, exact to all digits on smooth outlines, to
    /// about a percent where the speed falls to zero (cusps).
    #[must_use]
    pub fn perimeter(&self) -> T {
        let count = 16 * (self.harmonic_count() + 1);
        let tau = T::of(core::f64::consts::TAU);
        let speeds = (0..count).map(|i| {
            let (sin_1, cos_1) = (tau * T::of_usize(i) / T::of_usize(count)).sin_cos();
            let (mut sin, mut cos) = (sin_1, cos_1);
            let (mut x, mut y) = (T::zero(), T::zero());
            for (n, &[a, b, c, d]) in (1..).zip(&self.rows) {
                let n = T::of_usize(n);
                x += n * (b * cos - a * sin);
                y += n * (d * cos - c * sin);
                (sin, cos) = (sin * cos_1 + cos * sin_1, cos * cos_1 - sin * sin_1);
            }
            x.hypot(y)
        });
        tau * speeds.sum::<T>() / T::of_usize(count)
    }

    /// Root mean square distance between the outline and the outline of its first `harmonic_count` harmonics, point by
    /// point of the parameter; exact, by Parseval's theorem.
    #[must_use]
    pub fn truncation_error(&self, harmonic_count: usize) -> T {
        let tail: T = self.rows.iter().skip(harmonic_count).map(energy).sum();
        tail.sqrt()
    }

    /// The smallest number of harmonics whose [truncation error](Self::truncation_error) is at most `tolerance`.
    #[must_use]
    pub fn harmonics_needed(&self, tolerance: T) -> usize {
        let mut tail = T::zero();
        for (dropped, row) in self.rows.iter().rev().enumerate() {
            tail += energy(row);
            if tail > tolerance * tolerance {
                return self.rows.len() - dropped;
            }
        }
        0
    }
}

/// Mean squared distance from the center of one harmonic's ellipse.
fn energy<T: Real>(row: &[T; 4]) -> T {
    row.iter().map(|&value| value * value).sum::<T>() / T::of(2.0)
}
