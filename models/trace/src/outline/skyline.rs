//! Symmetric equations in which each number meets few others: rows are kept from their first entry on.

use alloc::vec;
use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// The lower triangle of a symmetric matrix, or of its Cholesky factor.
#[derive(Debug)]
pub(crate) struct Skyline {
    /// First column of each row.
    first: Vec<usize>,
    /// Where each row starts in the entries, less its first column.
    start: Vec<usize>,
    entries: Vec<f64>,
}

impl Clone for Skyline {
    fn clone(&self) -> Self {
        Self { first: self.first.clone(), start: self.start.clone(), entries: self.entries.clone() }
    }

    /// Into the room that is there: least squares need a factor in every step.
    fn clone_from(&mut self, other: &Self) {
        self.first.clone_from(&other.first);
        self.start.clone_from(&other.start);
        self.entries.clone_from(&other.entries);
    }
}

impl Skyline {
    /// Zeros, each row from its column in `first` (at most its own number) on.
    pub(crate) fn new(first: Vec<usize>) -> Self {
        let mut start = Vec::with_capacity(first.len());
        let mut count = 0;
        for (row, &column) in first.iter().enumerate() {
            start.push(count);
            count += row + 1 - column;
        }
        Self { first, start, entries: vec![0.0; count] }
    }

    fn row(&self, row: usize) -> &[f64] {
        &self.entries[self.start[row]..][..row + 1 - self.first[row]]
    }

    /// Adds the products of sparse `slopes` with each other, times `weight`.
    pub(crate) fn add_outer(&mut self, slopes: &[(usize, f64)], weight: f64) {
        for &(row, slope) in slopes {
            let (first, start) = (self.first[row], self.start[row]);
            for &(column, other) in slopes.iter().filter(|&&(column, _)| column <= row) {
                self.entries[start + column - first] += weight * slope * other;
            }
        }
    }

    /// Zeros again.
    pub(crate) fn clear(&mut self) {
        self.entries.fill(0.0);
    }

    /// The entries where the rows and columns `places`, rising, meet: the lower triangle, zeros beyond.
    pub(crate) fn block<const N: usize>(&self, places: &[usize; N]) -> [[f64; N]; N] {
        let mut block = [[0.0; N]; N];
        for (k, (&row, entries)) in places.iter().zip(&mut block).enumerate() {
            for (&column, entry) in places[..=k].iter().zip(entries) {
                *entry = self.entries[self.start[row] + column - self.first[row]];
            }
        }
        block
    }

    /// Puts entries where [`Self::block`] has them from.
    pub(crate) fn set_block<const N: usize>(&mut self, places: &[usize; N], block: &[[f64; N]; N]) {
        for (k, (&row, entries)) in places.iter().zip(block).enumerate() {
            for (&column, &entry) in places[..=k].iter().zip(entries) {
                self.entries[self.start[row] + column - self.first[row]] = entry;
            }
        }
    }

    /// The Cholesky factor of this matrix with its diagonal multiplied by 1 + `damping` and `ridge` added; none if it is not
    /// positive.
    pub(crate) fn factor(&self, damping: f64, ridge: f64) -> Option<Self> {
        let mut factor = self.clone();
        factor.factorize(damping, ridge)?;
        Some(factor)
    }

    /// The same in place; what is left is of no use where there is none.
    pub(crate) fn factorize(&mut self, damping: f64, ridge: f64) -> Option<()> {
        for row in 0..self.first.len() {
            let (done, rest) = self.entries.split_at_mut(self.start[row]);
            let row_first = self.first[row];
            let entries = &mut rest[..row + 1 - row_first];
            for column in row_first..row {
                let first = self.first[column].max(row_first);
                let other = &done[self.start[column] + first - self.first[column]..][..column - first];
                let sum = dot(&entries[first - row_first..column - row_first], other);
                let diagonal = done[self.start[column] + column - self.first[column]];
                entries[column - row_first] = (entries[column - row_first] - sum) / diagonal;
            }
            let sum = dot(&entries[..row - row_first], &entries[..row - row_first]);
            let value = entries[row - row_first] * (1.0 + damping) + ridge - sum;
            entries[row - row_first] = (value > 0.0 && value.is_finite()).then(|| value.sqrt())?;
        }
        Some(())
    }

    /// Of a factor: the solution of L x = `right`, in place.
    pub(crate) fn solve_lower(&self, right: &mut [f64]) {
        // As long as the right side is 0 the solution is.
        for row in right.iter().position(|&value| value != 0.0).unwrap_or(right.len())..right.len() {
            let (first, entries) = (self.first[row], self.row(row));
            let sum = dot(&entries[..row - first], &right[first..row]);
            right[row] = (right[row] - sum) / entries[row - first];
        }
    }

    /// Of a factor: the solution of L L^T x = `right`, in place.
    pub(crate) fn solve(&self, right: &mut [f64]) {
        self.solve_lower(right);
        for row in (0..right.len()).rev() {
            let (first, entries) = (self.first[row], self.row(row));
            let value = right[row] / entries[row - first];
            right[row] = value;
            for (other, entry) in right[first..row].iter_mut().zip(entries) {
                *other -= entry * value;
            }
        }
    }

    /// Of a factor: its diagonal.
    pub(crate) fn diagonal(&self) -> impl Iterator<Item = f64> {
        (0..self.first.len()).map(|row| self.row(row)[row - self.first[row]])
    }
}

/// The sum of products of numbers in the same places.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    // Four sums side by side: each addition of a single one would wait for the one before.
    let mut sums = [0.0; 4];
    for (a, b) in a.iter().zip(b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}
