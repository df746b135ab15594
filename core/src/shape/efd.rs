//! Outlines from elliptic Fourier descriptors, through a table of cosines and sines made once.

use alloc::vec::Vec;

use num_traits::Float;

use super::ShapeError;
use crate::real::Real;

/// Vertices per block of the table: one AVX-512 register of f32, two of AVX2, two of f64.
pub(super) const LANES: usize = 8;

/// Cosines and sines of the harmonics 1..=N at the parameters t_i = i / (K - 1), i = 0..K: both end points are there, so
/// that the last vertex repeats the first.
///
/// Since cos(2 pi n (1 - t)) = cos(2 pi n t) and sin(2 pi n (1 - t)) = -sin(2 pi n t), the table holds the first half of
/// the vertices; the second half is their mirror, which halves memory and arithmetic.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlineBasis<T> {
    vertex_count: usize,
    harmonic_count: usize,
    /// Entry `block * harmonic_count + n - 1`: cosines, then sines, of harmonic n at the [`LANES`] vertices of the block;
    /// zero past the middle of the outline.
    pub(super) table: Vec<[[T; LANES]; 2]>,
}

impl<T: Real> OutlineBasis<T> {
    /// A table for outlines of `vertex_count` vertices, the repeated one counted, and up to `harmonic_count` harmonics.
    ///
    /// # Errors
    /// [`ShapeError::TooFewPoints`] below 4 vertices (3 distinct ones), [`ShapeError::Zero`] without a harmonic.
    pub fn new(vertex_count: usize, harmonic_count: usize) -> Result<Self, ShapeError> {
        if vertex_count < 4 {
            return Err(ShapeError::TooFewPoints { len: vertex_count.saturating_sub(1) });
        }
        if harmonic_count == 0 {
            return Err(ShapeError::Zero { what: "harmonic_count" });
        }
        let half = vertex_count.div_ceil(2);
        let edges = vertex_count - 1;
        let mut table = Vec::with_capacity(half.div_ceil(LANES) * harmonic_count);
        for first in (0..half).step_by(LANES) {
            for n in 1..=harmonic_count {
                let mut entry = [[T::zero(); LANES]; 2];
                let [cosines, sines] = &mut entry;
                let lanes = cosines.iter_mut().zip(sines).take(half - first);
                for (lane, (cos, sin)) in lanes.enumerate() {
                    // Reduced as integers: the angle of a high harmonic loses no digits.
                    let turn = (n % edges) * (first + lane) % edges;
                    let angle = core::f64::consts::TAU * T::of_usize(turn).as_f64() / T::of_usize(edges).as_f64();
                    *cos = T::of(Float::cos(angle));
                    // At half a turn the sine is 0, not the sine of the rounded pi: the middle vertex is its own mirror.
                    *sin = if 2 * turn == edges { T::zero() } else { T::of(Float::sin(angle)) };
                }
                table.push(entry);
            }
        }
        Ok(Self { vertex_count, harmonic_count, table })
    }

    /// Vertices per outline, K, the repeated one counted.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// Most harmonics an outline may have, N.
    #[must_use]
    pub fn harmonic_count(&self) -> usize {
        self.harmonic_count
    }

    /// Writes the outline of the descriptors `rows` (a_n, b_n, c_n, d_n), n from 1.
    ///
    /// *Dimensions*: at most N rows, exactly K vertices. *Derivative*: [`Self::outline_vjp`]. Allocates nothing.
    ///
    /// # Errors
    /// [`ShapeError::TooManyHarmonics`] above N rows, [`ShapeError::Length`] if there are not K vertices.
    #[inline]
    pub fn outline(&self, rows: &[[T; 4]], vertices: &mut [[T; 2]]) -> Result<(), ShapeError> {
        self.check(rows.len(), vertices.len())?;
        let half = self.vertex_count.div_ceil(2);
        let last = self.vertex_count - 1;
        for (block, entries) in self.table.chunks_exact(self.harmonic_count).enumerate() {
            let zero = [T::zero(); LANES];
            let (mut x_even, mut x_odd, mut y_even, mut y_odd) = (zero, zero, zero, zero);
            for ([cos, sin], &[a, b, c, d]) in entries.iter().zip(rows) {
                for lane in 0..LANES {
                    x_even[lane] += a * cos[lane];
                    x_odd[lane] += b * sin[lane];
                    y_even[lane] += c * cos[lane];
                    y_odd[lane] += d * sin[lane];
                }
            }
            let first = block * LANES;
            for lane in 0..LANES.min(half - first) {
                vertices[last - first - lane] = [x_even[lane] - x_odd[lane], y_even[lane] - y_odd[lane]];
                vertices[first + lane] = [x_even[lane] + x_odd[lane], y_even[lane] + y_odd[lane]];
            }
        }
        Ok(())
    }

    pub(super) fn check(&self, harmonic_count: usize, vertex_count: usize) -> Result<(), ShapeError> {
        if harmonic_count > self.harmonic_count {
            return Err(ShapeError::TooManyHarmonics { harmonic_count, limit: self.harmonic_count });
        }
        if vertex_count != self.vertex_count {
            return Err(ShapeError::Length { what: "outline", expected: self.vertex_count, len: vertex_count });
        }
        Ok(())
    }
}
