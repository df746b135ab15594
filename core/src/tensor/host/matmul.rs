//! Products of matrices: rows of the result are sums of rows of the second factor, four at a time.

use alloc::vec;
use alloc::vec::Vec;

use crate::real::Real;
use crate::simd::{Kernel, dispatch};

/// Columns of the second factor worked on at a time, so that its rows stay in the first cache: 512 columns of 64 rows of
/// f32 are 128 KiB.
const COLUMNS: usize = 512;
/// Rows of the second factor worked on at a time.
const DEPTH: usize = 64;

/// batch x m x k times batch x k x n.
pub(super) fn batched<T: Real>(a: &[T], b: &[T], [batch, m, k, n]: [usize; 4]) -> Vec<T> {
    let mut c = vec![T::zero(); batch * m * n];
    for item in 0..batch {
        let (a, b) = (&a[item * m * k..][..m * k], &b[item * k * n..][..k * n]);
        dispatch(Product { a, b, c: &mut c[item * m * n..][..m * n], k, n });
    }
    c
}

struct Product<'a, T> {
    a: &'a [T],
    b: &'a [T],
    c: &'a mut [T],
    k: usize,
    n: usize,
}

impl<T: Real> Product<'_, T> {
    #[inline(always)]
    fn add<const FUSED: bool>(self) {
        let Self { a, b, c, k, n } = self;
        for first in (0..n).step_by(COLUMNS) {
            let columns = first..(first + COLUMNS).min(n);
            for top in (0..k).step_by(DEPTH) {
                let depth = top..(top + DEPTH).min(k);
                for (a, c) in a.chunks_exact(k).zip(c.chunks_exact_mut(n)) {
                    add_row::<T, FUSED>(&a[depth.clone()], &b[top * n..], &mut c[columns.clone()], first, n);
                }
            }
        }
    }
}

/// Adds to `c` the rows of `b`, from column `first` on, each times its number in `a`.
#[inline(always)]
fn add_row<T: Real, const FUSED: bool>(a: &[T], b: &[T], c: &mut [T], first: usize, n: usize) {
    let (fours, rest) = a.as_chunks::<4>();
    let row = |index: usize| &b[index * n + first..][..c_len(n, first)];
    for (index, &[a0, a1, a2, a3]) in fours.iter().enumerate() {
        let [b0, b1, b2, b3] = [row(4 * index), row(4 * index + 1), row(4 * index + 2), row(4 * index + 3)];
        for ((((c, &b0), &b1), &b2), &b3) in c.iter_mut().zip(b0).zip(b1).zip(b2).zip(b3) {
            let near = b1.times_plus::<FUSED>(a1, b0.times_plus::<FUSED>(a0, *c));
            *c = b3.times_plus::<FUSED>(a3, b2.times_plus::<FUSED>(a2, near));
        }
    }
    for (index, &a) in rest.iter().enumerate() {
        for (c, &b) in c.iter_mut().zip(row(4 * fours.len() + index)) {
            *c = b.times_plus::<FUSED>(a, *c);
        }
    }
}

/// Columns from `first` on that are worked on together.
#[inline(always)]
fn c_len(n: usize, first: usize) -> usize {
    (n - first).min(COLUMNS)
}

impl<T: Real> Kernel for Product<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.add::<false>();
    }

    #[inline(always)]
    fn run_fused(self) {
        self.add::<true>();
    }
}
