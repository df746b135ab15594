//! Outlines from elliptic Fourier descriptors, through a table of cosines and sines made once.

use alloc::vec::Vec;

use num_traits::Float;

use super::ShapeError;
use crate::real::Real;
use crate::simd::{Kernel, dispatch, lanes};

/// Numbers side by side in the tables: one AVX-512 register of f64, half of one of f32.
pub(super) const LANES: usize = 8;

/// Cosines, then sines, of [`LANES`] angles.
type Entry<T> = [[T; LANES]; 2];

/// Cosines and sines of the harmonics 1..=N at the parameters t_i = i / (K - 1), i = 0..K: both end points are there, so
/// that the last vertex repeats the first.
///
/// Since cos(2 pi n (1 - t)) = cos(2 pi n t) and sin(2 pi n (1 - t)) = -sin(2 pi n t), the tables hold the first half of
/// the vertices; the second half is their mirror, which halves memory and arithmetic.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlineBasis<T> {
    vertex_count: usize,
    harmonic_count: usize,
    /// The way forward, lanes of vertices: entry `block * harmonic_count + n - 1` holds harmonic n at the vertices
    /// `block * LANES..`, zero past the middle of the outline.
    by_vertex: Vec<Entry<T>>,
    /// The way back, lanes of harmonics: entry `group * half + i` holds the harmonics `group * LANES + 1..` at vertex i,
    /// zero past the last harmonic. A second table, so that neither way adds across lanes.
    pub(super) by_harmonic: Vec<Entry<T>>,
}

impl<T: Real> OutlineBasis<T> {
    /// A table for outlines of `vertex_count` vertices, the repeated one counted, and up to `harmonic_count` harmonics.
    ///
    /// # Errors
    /// [`ShapeError::TooFewPoints`] below 4 vertices (3 distinct ones), [`ShapeError::Zero`] without a harmonic.
    #[inline(never)]
    pub fn new(vertex_count: usize, harmonic_count: usize) -> Result<Self, ShapeError> {
        if vertex_count < 4 {
            return Err(ShapeError::TooFewPoints { len: vertex_count.saturating_sub(1) });
        }
        if harmonic_count == 0 {
            return Err(ShapeError::Zero { what: "harmonic_count" });
        }
        let half = vertex_count.div_ceil(2);
        let edges = vertex_count - 1;
        let waves: Vec<[f64; 2]> = (0..edges).map(|turn| wave(turn, edges)).collect();
        // The angle of harmonic n at vertex i, reduced as integers: that of a high harmonic loses no digits.
        let at = |n: usize, i: usize| waves[(n % edges) * i % edges];
        let mut by_vertex = Vec::with_capacity(half.div_ceil(LANES) * harmonic_count);
        for first in (0..half).step_by(LANES) {
            by_vertex.extend((1..=harmonic_count).map(|n| entry(half - first, |lane| at(n, first + lane))));
        }
        let mut by_harmonic = Vec::with_capacity(harmonic_count.div_ceil(LANES) * half);
        for first in (1..=harmonic_count).step_by(LANES) {
            by_harmonic.extend((0..half).map(|i| entry(harmonic_count + 1 - first, |lane| at(first + lane, i))));
        }
        Ok(Self { vertex_count, harmonic_count, by_vertex, by_harmonic })
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
    #[inline(never)]
    pub fn outline(&self, rows: &[[T; 4]], vertices: &mut [[T; 2]]) -> Result<(), ShapeError> {
        self.check(rows.len(), vertices.len())?;
        dispatch(Trace { basis: self, rows, vertices });
        Ok(())
    }

    #[inline(always)]
    fn trace<const FUSED: bool>(&self, rows: &[[T; 4]], vertices: &mut [[T; 2]]) {
        let half = self.half();
        let last = self.vertex_count - 1;
        for (block, entries) in self.by_vertex.chunks_exact(self.harmonic_count).enumerate() {
            let zero = [T::zero(); LANES];
            let (mut x_even, mut x_odd, mut y_even, mut y_odd) = (zero, zero, zero, zero);
            for ([cos, sin], &[a, b, c, d]) in entries.iter().zip(rows) {
                x_even = lanes(|i| cos[i].times_plus::<FUSED>(a, x_even[i]));
                x_odd = lanes(|i| sin[i].times_plus::<FUSED>(b, x_odd[i]));
                y_even = lanes(|i| cos[i].times_plus::<FUSED>(c, y_even[i]));
                y_odd = lanes(|i| sin[i].times_plus::<FUSED>(d, y_odd[i]));
            }
            let first = block * LANES;
            for lane in 0..LANES.min(half - first) {
                vertices[last - first - lane] = [x_even[lane] - x_odd[lane], y_even[lane] - y_odd[lane]];
                vertices[first + lane] = [x_even[lane] + x_odd[lane], y_even[lane] + y_odd[lane]];
            }
        }
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

    /// Vertices in the tables: half of them, the middle one included.
    pub(super) fn half(&self) -> usize {
        self.vertex_count.div_ceil(2)
    }
}

/// The kernel of [`OutlineBasis::outline`].
struct Trace<'a, T> {
    basis: &'a OutlineBasis<T>,
    rows: &'a [[T; 4]],
    vertices: &'a mut [[T; 2]],
}

impl<T: Real> Kernel for Trace<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.basis.trace::<false>(self.rows, self.vertices);
    }

    #[inline(always)]
    fn run_fused(self) {
        self.basis.trace::<true>(self.rows, self.vertices);
    }
}

/// An entry of the cosine and sine of each of the first `count` lanes, zero in the others.
fn entry<T: Real>(count: usize, lane: impl Fn(usize) -> [f64; 2]) -> Entry<T> {
    let mut waves = [[T::zero(); 2]; LANES];
    for (i, wave) in waves.iter_mut().enumerate().take(count) {
        *wave = lane(i).map(T::of);
    }
    [waves.map(|[cos, _]| cos), waves.map(|[_, sin]| sin)]
}

/// Cosine and sine of `turn` / `edges` of a full turn.
fn wave(turn: usize, edges: usize) -> [f64; 2] {
    let (sin, cos) = Float::sin_cos(core::f64::consts::TAU * f64::of_usize(turn) / f64::of_usize(edges));
    // At half a turn the sine is 0, not the sine of the rounded pi: the middle vertex is its own mirror.
    [cos, if 2 * turn == edges { 0.0 } else { sin }]
}
