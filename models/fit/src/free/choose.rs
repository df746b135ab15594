//! How many harmonics pay, from one linearization at all of them.
//!
//! With center and coefficients in the order of their harmonics, the Cholesky factor L of the normal equations holds those of every
//! cut: the first m numbers alone miss what the y of all numbers after them add up to in squares, where y = L^T x for the best
//! x of all. So one factor tells what every number of harmonics leaves, vertices sliding along the outline as they like, and where
//! its numbers are best.

use alloc::vec::Vec;

use dvp_core::{Real, simd};

use super::basis::Basis;
use super::outline::FreeOutline;
use super::outline_fit::{OutlineScratch, OutlineSettings, WEAKEST_DAMPING, expand, gather};
use crate::cholesky::{factor, packed, solve_lower, solve_upper};
use crate::price::misfit_bits;
use crate::segment::EdgeSample;

/// Memory of [`choose`].
#[derive(Clone, Debug, Default)]
pub(crate) struct ChooseScratch<T> {
    factor: Vec<T>,
    pull: Vec<T>,
    values: Vec<T>,
}

/// What [`choose`] found.
#[derive(Clone, Debug)]
pub(crate) struct Chosen<T> {
    pub(crate) outline: FreeOutline<T>,
    /// Bits that the samples miss of the outline that was asked about.
    pub(crate) missed: T,
}

/// The outline of so many harmonics, at most those of `outline`, that it and what `samples` miss of it are told in the fewest bits;
/// `price` tells those of a number of harmonics. None if the samples tell nothing.
pub(crate) fn choose<T: Real>(
    outline: &FreeOutline<T>,
    samples: &[EdgeSample<T>],
    basis: &Basis<T>,
    vertex_count: usize,
    settings: &OutlineSettings<T>,
    price: impl Fn(usize) -> T,
    (scratch, own): (&mut OutlineScratch<T>, &mut ChooseScratch<T>),
) -> Option<Chosen<T>> {
    simd::dispatch(Choose { outline, samples, basis, vertex_count, settings, price, scratch, own })
}

/// The arguments of [`choose`], compiled per instruction set.
struct Choose<'a, T, P> {
    outline: &'a FreeOutline<T>,
    samples: &'a [EdgeSample<T>],
    basis: &'a Basis<T>,
    vertex_count: usize,
    settings: &'a OutlineSettings<T>,
    price: P,
    scratch: &'a mut OutlineScratch<T>,
    own: &'a mut ChooseScratch<T>,
}

impl<T: Real, P: Fn(usize) -> T> simd::Kernel for Choose<'_, T, P> {
    type Output = Option<Chosen<T>>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Self { outline, samples, basis, vertex_count, settings, price, scratch, own } = self;
        let cost = gather(outline, samples, basis, vertex_count, settings, scratch);
        expand(outline, basis, settings, scratch);
        let harmonics = outline.rows.len();
        let half = 1 + 2 * harmonics;
        let n = 2 * half;
        let trace = (0..n).map(|i| scratch.hessian[packed(i, i)]).sum::<T>() / T::of_usize(n);
        // x and y of the center, then a, b, c, d of each harmonic.
        let place = |i: usize| match i.checked_sub(2) {
            None => i * half,
            Some(i) => 1 + 2 * (i / 4) + i % 2 + if i % 4 < 2 { 0 } else { half },
        };
        let ChooseScratch { factor: lower, pull, values } = own;
        lower.clear();
        pull.clear();
        for i in 0..n {
            let row = place(i);
            pull.push(scratch.gradient[row]);
            lower.extend((0..=i).map(|j| {
                let column = place(j);
                scratch.hessian[packed(row.max(column), row.min(column))]
            }));
            lower[packed(i, i)] += T::of(WEAKEST_DAMPING) * trace;
        }
        if !factor(lower, n) {
            return None;
        }
        solve_lower(lower, n, pull);
        // y = L^T x - L^-1 pull for what the outline is now; the center, which no cut removes, counts from where it is.
        values.clear();
        values.extend(pull.iter().map(|&pull| -pull));
        for (j, &now) in outline.rows.iter().flatten().enumerate() {
            let row = &lower[packed(j + 2, 0)..=packed(j + 2, j + 2)];
            values.iter_mut().zip(row).for_each(|(value, &l)| *value += l * now);
        }
        let mut best = (price(harmonics), harmonics);
        let mut left = T::zero();
        for cut in (1..harmonics).rev() {
            left += values[2 + 4 * cut..][..4].iter().map(|&y| y * y).sum::<T>();
            let bits = price(cut) + left * misfit_bits();
            if bits < best.0 {
                best = (bits, cut);
            }
        }
        let kept = 2 + 4 * best.1;
        values.truncate(kept);
        solve_upper(lower, kept, values);
        let center = [outline.center[0] + values[0], outline.center[1] + values[1]];
        let chosen = FreeOutline { center, rows: values[2..].as_chunks().0.to_vec() };
        Some(Chosen { outline: chosen, missed: cost * misfit_bits() })
    }
}
