//! Cholesky on a packed lower triangle.

use dvp_core::{Real, simd};

/// Index of (row, column), column <= row, in a packed lower triangle.
#[inline(always)]
pub(crate) const fn packed(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

/// Rows that are factored together: the sums of one wait for one another, those of several do not.
const ROWS: usize = 4;

/// Overwrites the packed symmetric `matrix` by its Cholesky factor; false if it is not positive definite.
#[inline(always)]
pub(crate) fn factor<T: Real>(matrix: &mut [T], n: usize) -> bool {
    for first in (0..n).step_by(ROWS) {
        let is_block = first + ROWS <= n;
        if is_block {
            let (done, rows) = matrix.split_at_mut(packed(first, 0));
            columns_before(done, rows, first);
        }
        for i in first..(first + ROWS).min(n) {
            let (done, rest) = matrix.split_at_mut(packed(i, 0));
            let row = &mut rest[..=i];
            for j in if is_block { first } else { 0 }..i {
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
    }
    true
}

/// The first columns of the rows from `first` on, as many as there are rows before.
#[inline(always)]
fn columns_before<T: Real>(done: &[T], rows: &mut [T], first: usize) {
    let starts: [usize; ROWS] = core::array::from_fn(|r| packed(first + r, 0) - packed(first, 0));
    for j in 0..first {
        let above = &done[packed(j, 0)..=packed(j, j)];
        let dots = dots(starts.map(|start| &rows[start..start + j]), &above[..j]);
        for (start, dot) in starts.into_iter().zip(dots) {
            rows[start + j] = (rows[start + j] - dot) / above[j];
        }
    }
}

/// Solves L L^T x = b in place, `factor`ed matrix.
#[inline(always)]
pub(crate) fn solve<T: Real>(factor: &[T], n: usize, b: &mut [T]) {
    solve_lower(factor, n, b);
    for i in (0..n).rev() {
        let row = &factor[packed(i, 0)..=packed(i, i)];
        let x = b[i] / row[i];
        b[i] = x;
        for (target, &l) in b[..i].iter_mut().zip(&row[..i]) {
            *target -= l * x;
        }
    }
}

/// Solves L x = b in place.
#[inline(always)]
pub(crate) fn solve_lower<T: Real>(factor: &[T], n: usize, b: &mut [T]) {
    for i in 0..n {
        let row = &factor[packed(i, 0)..=packed(i, i)];
        b[i] = (b[i] - dot(&row[..i], &b[..i])) / row[i];
    }
}

/// Sum of products in eight lanes, so that it vectorizes.
#[inline(always)]
fn dot<T: Real>(a: &[T], b: &[T]) -> T {
    let mut lanes = [T::zero(); 8];
    let (a8, b8) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    for (x, y) in a8.0.iter().zip(b8.0) {
        lanes = simd::lanes(|i| lanes[i] + x[i] * y[i]);
    }
    total(lanes, a8.1, b8.1)
}

/// [`dot`] of four with one.
#[inline(always)]
fn dots<T: Real>(a: [&[T]; ROWS], b: &[T]) -> [T; ROWS] {
    let (b8, rest) = b.as_chunks::<8>();
    let a8 = a.map(|a| a.as_chunks::<8>());
    let [a0, a1, a2, a3] = a8.map(|a| &a.0[..b8.len()]);
    let [mut l0, mut l1, mut l2, mut l3] = [[T::zero(); 8]; ROWS];
    for (k, y) in b8.iter().enumerate() {
        l0 = simd::lanes(|i| l0[i] + a0[k][i] * y[i]);
        l1 = simd::lanes(|i| l1[i] + a1[k][i] * y[i]);
        l2 = simd::lanes(|i| l2[i] + a2[k][i] * y[i]);
        l3 = simd::lanes(|i| l3[i] + a3[k][i] * y[i]);
    }
    let lanes = [l0, l1, l2, l3];
    core::array::from_fn(|n| total(lanes[n], a8[n].1, rest))
}

#[inline(always)]
fn total<T: Real>(lanes: [T; 8], a: &[T], b: &[T]) -> T {
    let tail: T = a.iter().zip(b).map(|(&x, &y)| x * y).sum();
    lanes.into_iter().sum::<T>() + tail
}
