//! What outlines of fewer harmonics would miss, all numbers of harmonics from one factorization.
//!
//! Near an outline, half the cost of a step d is g d + d H d / 2. An outline of n harmonics is one whose coefficients above are
//! 0: there d is given, below it is free. With H = L L^T, unknowns in the order of their harmonics, and u = L^T d + L^-1 g, the
//! cost is |u|^2 and a constant. The free part makes its own u 0, and that of the rest does not depend on it: so the u that all
//! the coefficients at 0 would have tells, summed from the last one down, what each number of harmonics misses.

use alloc::vec::Vec;

use dvp_core::{Real, simd};

use super::outline_fit::{FreeOutline, OutlineScratch, Target, damp, expand, gather};
use crate::cholesky::{factor, packed, solve_lower};

/// Damping as a share of the mean of the diagonal, so that vertices may slide along the outline where harmonics are left out, but not so
/// far that it folds at its corners. With a third of it pictures take a quarter longer on average, with a thirtieth some outlines fold under
/// noise; with three times as much the mean error grows by a hundredth. Measured before traced outlines lost their loops.
pub(super) const DAMPING: f64 = 3e-4;

/// Median of the square of a normal deviate of variance 1.
const MEDIAN_SQUARE: f64 = 0.455;

/// What [`foretell`] finds.
#[derive(Clone, Debug, Default)]
pub(super) struct Forecast<T> {
    /// By number of harmonics, from 0: the cost as [`refine`](super::outline_fit::refine) counts it.
    pub(super) costs: Vec<T>,
    /// Variance of the residuals in units of what it should be.
    pub(super) spread: T,
    forced: Vec<T>,
    step: Vec<T>,
}

/// Foretells what `outline` misses with fewer harmonics; none if nothing can be told. `scratch` keeps the factorization, for
/// [`Forecast::outline`].
pub(super) fn foretell<T: Real>(
    outline: &FreeOutline<T>,
    target: &Target<'_, T>,
    scratch: &mut OutlineScratch<T>,
    forecast: &mut Forecast<T>,
) -> Option<()> {
    simd::dispatch(Foretell { outline, target, scratch, forecast })
}

struct Foretell<'a, T> {
    outline: &'a FreeOutline<T>,
    target: &'a Target<'a, T>,
    scratch: &'a mut OutlineScratch<T>,
    forecast: &'a mut Forecast<T>,
}

impl<T: Real> simd::Kernel for Foretell<'_, T> {
    type Output = Option<()>;

    #[inline(always)]
    fn run(self) -> Option<()> {
        let Self { outline, target, scratch, forecast } = self;
        let cost = gather(outline, target, scratch);
        forecast.spread = spread(&mut scratch.squares, 2 + 4 * outline.rows.len());
        expand(outline, target, scratch);
        let n = scratch.gradient.len();
        damp(&mut scratch.hessian, n, T::of(DAMPING));
        if !factor(&mut scratch.hessian, n) {
            return None;
        }
        solve_lower(&scratch.hessian, n, &mut scratch.gradient);
        let Forecast { costs, forced, .. } = forecast;
        // L^T d of the coefficients at 0.
        forced.clear();
        forced.resize(n, T::zero());
        for i in (0..n).rev() {
            let value = outline.coefficient(i);
            let row = &scratch.hessian[packed(i, 0)..=packed(i, i)];
            for (sum, &l) in forced.iter_mut().zip(row) {
                *sum -= l * value;
            }
        }
        let harmonics = outline.rows.len();
        let mut missed = cost - scratch.gradient.iter().map(|&w| w * w).sum::<T>();
        costs.clear();
        costs.resize(harmonics + 1, missed);
        for h in (0..harmonics).rev() {
            let own = 2 + 4 * h..6 + 4 * h;
            missed +=
                forced[own.clone()].iter().zip(&scratch.gradient[own]).map(|(&f, &w)| (f + w) * (f + w)).sum::<T>();
            costs[h] = missed;
        }
        Some(())
    }
}

/// The variance of residuals by their median `squares`, which a few that are far off do not move, and without what a fit of so many
/// `numbers` takes of it.
fn spread<T: Real>(squares: &mut [T], numbers: usize) -> T {
    let count = squares.len();
    if count <= numbers {
        return T::one();
    }
    let by_size = |a: &T, b: &T| a.partial_cmp(b).unwrap_or(core::cmp::Ordering::Equal);
    let (_, &mut median, _) = squares.select_nth_unstable_by(count / 2, by_size);
    median / T::of(MEDIAN_SQUARE) * T::of_usize(count) / T::of_usize(count - numbers)
}

impl<T: Real> Forecast<T> {
    /// The outline of so many harmonics that is foretold: the free part of its step makes its u 0.
    pub(super) fn outline(
        &mut self,
        from: &FreeOutline<T>,
        harmonics: usize,
        scratch: &OutlineScratch<T>,
    ) -> FreeOutline<T> {
        let (n, all) = (2 + 4 * harmonics, scratch.gradient.len());
        let step = &mut self.step;
        step.clear();
        step.extend(scratch.gradient[..n].iter().map(|&w| -w));
        for i in (0..all).rev() {
            let row = &scratch.hessian[packed(i, 0)..=packed(i, i)];
            let by = if i < n {
                step[i] /= row[i];
                step[i]
            } else {
                -from.coefficient(i)
            };
            let below = i.min(n);
            for (target, &l) in step[..below].iter_mut().zip(row) {
                *target -= l * by;
            }
        }
        let mut outline = FreeOutline { center: from.center, rows: from.rows[..harmonics].to_vec() };
        for (i, &by) in step.iter().enumerate() {
            *outline.coefficient_mut(i) += by;
        }
        outline
    }
}
