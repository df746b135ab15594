//! Which numbers are equal: the cheapest classes of sorted values.

use alloc::vec;
use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::sort;

use super::numbers::Number;
use crate::ruler::Ruler;

/// Numbers that are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Class {
    /// Their mean.
    pub(super) value: f64,
    /// The standard deviation of the best of them: equal edges lie alike among the pixels and are off by the same.
    pub(super) sigma: f64,
    /// How many there are.
    pub(super) count: usize,
}

/// The classes of numbers that together cost the fewest bits: each class its value, each number its misfit, and the classes what a
/// Chinese restaurant process of concentration 1 gives them, to which (m - 1)! rows of m numbers lead. Exact: classes are runs of
/// sorted values.
pub(super) fn classes(mut numbers: Vec<Number>, ruler: &Ruler) -> Vec<Class> {
    sort::ascending(&mut numbers, |number| number.value);
    // What the fit of an outline has tied already is one number.
    numbers.dedup_by(|next, kept| {
        let is_same = (next.value - kept.value).abs() < SAME;
        kept.sigma = if is_same { kept.sigma.min(next.sigma) } else { kept.sigma };
        is_same
    });
    let count = numbers.len();
    // Cheapest bits of the first k numbers, and where the last class of them starts.
    let mut best = vec![(f64::INFINITY, 0); count + 1];
    best[0].0 = 0.0;
    for start in 0..count {
        let mut run = Run::default();
        for end in start..count {
            let spread = numbers[end].value - numbers[start].value;
            if spread > REACH * (numbers[start].sigma + numbers[end].sigma) {
                break;
            }
            run.push(numbers[end]);
            let bits = best[start].0 + run.bits(ruler);
            if bits < best[end + 1].0 {
                best[end + 1] = (bits, start);
            }
        }
    }
    let mut classes = Vec::new();
    let mut end = count;
    while end > 0 {
        let start = best[end].1;
        let mut run = Run::default();
        numbers[start..end].iter().for_each(|&number| run.push(number));
        classes.push(Class { value: run.mean(), sigma: run.sigma, count: end - start });
        end = start;
    }
    classes.reverse();
    classes
}

/// Values closer than this are one, pixels: the fits end about as close to what they seek.
const SAME: f64 = 1e-4;

/// Values further apart than this many of their standard deviations together are not equal.
const REACH: f64 = 3.0;

/// Sums over a run of numbers.
struct Run {
    /// Of the weights, of weighted values less the first, of their squares.
    sums: [f64; 3],
    first: f64,
    sigma: f64,
    count: usize,
    /// log2 of (count - 1)!
    rows: f64,
}

impl Default for Run {
    fn default() -> Self {
        Self { sums: [0.0; 3], first: 0.0, sigma: f64::INFINITY, count: 0, rows: 0.0 }
    }
}

impl Run {
    fn push(&mut self, number: Number) {
        if self.count == 0 {
            self.first = number.value;
        } else {
            self.rows += (self.count as f64).log2();
        }
        let (weight, value) = (number.sigma.powi(-2), number.value - self.first);
        self.sums[0] += weight;
        self.sums[1] += weight * value;
        self.sums[2] += weight * value * value;
        self.sigma = self.sigma.min(number.sigma);
        self.count += 1;
    }

    fn mean(&self) -> f64 {
        self.first + self.sums[1] / self.sums[0]
    }

    fn bits(&self, ruler: &Ruler) -> f64 {
        let chi2 = self.sums[2] - self.sums[1] * self.sums[1] / self.sums[0];
        ruler.misfit(chi2.max(0.0)) + ruler.number(self.sums[0].sqrt().recip()) - self.rows
    }
}
