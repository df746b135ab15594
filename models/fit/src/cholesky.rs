//! Cholesky on a packed lower triangle.

use dvp_core::Real;

/// Index of (row, column), column <= row, in a packed lower triangle.
#[inline(always)]
pub(crate) const fn packed(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

/// Overwrites the packed symmetric `matrix` by its Cholesky factor; false if it is not positive definite.
#[inline(always)]
pub(crate) fn factor<T: Real>(matrix: &mut [T], n: usize) -> bool {
    for i in 0..n {
        let (done, rest) = matrix.split_at_mut(packed(i, 0));
        let row = &mut rest[..=i];
        for j in 0..i {
            let above = &done[packed(j, 0)..packed(j, j)];
            let dot = dot(&row[..j], above);
            row[j] = (row[j] - dot) / done[packed(j, j)];
        }
        let pivot = row[i] - dot(&row[..i], &row[..i]);
        if pivot.is_nan() || pivot <= T::epsilon() * T::of(1e-3) {
            return false;
        }
        row[i] = pivot.sqrt();
    }
    true
}

/// Solves L L^T x = b in place, `factor`ed matrix.
#[inline(always)]
pub(crate) fn solve<T: Real>(factor: &[T], n: usize, b: &mut [T]) {
    for i in 0..n {
        let row = &factor[packed(i, 0)..=packed(i, i)];
        b[i] = (b[i] - dot(&row[..i], &b[..i])) / row[i];
    }
    for i in (0..n).rev() {
        let row = &factor[packed(i, 0)..=packed(i, i)];
        let x = b[i] / row[i];
        b[i] = x;
        for (target, &l) in b[..i].iter_mut().zip(&row[..i]) {
            *target -= l * x;
        }
    }
}

/// Sum of products in eight lanes, so that it vectorizes.
#[inline(always)]
fn dot<T: Real>(a: &[T], b: &[T]) -> T {
    let mut lanes = [T::zero(); 8];
    let (a8, b8) = (a.chunks_exact(8), b.chunks_exact(8));
    let tail: T = a8.remainder().iter().zip(b8.remainder()).map(|(&x, &y)| x * y).sum();
    for (x, y) in a8.zip(b8) {
        for lane in 0..8 {
            lanes[lane] += x[lane] * y[lane];
        }
    }
    lanes.into_iter().sum::<T>() + tail
}
