//! The Fourier basis at the vertices of an outline: a row per vertex, (1, cos t, sin t, cos 2t, sin 2t, ...).

use alloc::vec::Vec;

use dvp_core::Real;

/// Rows of the basis for vertices at t = i / (count - 1), both end points included.
#[derive(Clone, Debug, Default)]
pub(crate) struct Basis<T> {
    width: usize,
    rows: Vec<T>,
}

impl<T: Real> Basis<T> {
    pub(crate) fn new(vertex_count: usize, harmonics: usize) -> Self {
        let width = 1 + 2 * harmonics;
        let mut rows = Vec::with_capacity(vertex_count * width);
        for i in 0..vertex_count {
            rows.push(T::one());
            for n in 1..=harmonics {
                let turn = (n * i) % (vertex_count - 1);
                let angle =
                    core::f64::consts::TAU * T::of_usize(turn).as_f64() / T::of_usize(vertex_count - 1).as_f64();
                let (sin, cos) = num_traits::Float::sin_cos(angle);
                rows.push(T::of(cos));
                rows.push(T::of(sin));
            }
        }
        Self { width, rows }
    }

    /// The row of vertex `i`, cut to `harmonics`.
    #[inline(always)]
    pub(crate) fn row(&self, i: usize, harmonics: usize) -> &[T] {
        &self.rows[i * self.width..i * self.width + 1 + 2 * harmonics]
    }
}
