//! How well found classes go with true ones.

use alloc::collections::BTreeMap;

use dvp_core::matching::{CostMatrix, Hungarian, MatchingError};

/// Pixels of true classes, by the classes that they were found to be of.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Confusion {
    /// By true and found class; none: of no class, or of no object.
    pixels: BTreeMap<(u32, Option<u32>), u64>,
}

impl Confusion {
    /// Counts pixels.
    pub fn add(&mut self, truth: u32, found: Option<u32>, pixels: u64) {
        *self.pixels.entry((truth, found)).or_default() += pixels;
    }

    /// Adds the counts of another one.
    pub fn merge(&mut self, other: &Self) {
        for (&(truth, found), &pixels) in &other.pixels {
            self.add(truth, found, pixels);
        }
    }

    /// Mean over the true classes of the share of their pixels that were found to be of it. Names of classes mean nothing: each true class
    /// has the found one, and no two the same, so that most pixels are right. None if no class was found, or none is true.
    ///
    /// # Errors
    /// [`MatchingError`], which counts do not bring about.
    pub fn mean_accuracy(&self) -> Result<Option<f64>, MatchingError> {
        let mut truths: Vec<u32> = self.pixels.keys().map(|&(truth, _)| truth).collect();
        truths.dedup();
        let mut found: Vec<u32> = self.pixels.keys().filter_map(|&(_, found)| found).collect();
        found.sort_unstable();
        found.dedup();
        if truths.is_empty() || found.is_empty() {
            return Ok(None);
        }
        let count = |truth, found| self.pixels.get(&(truth, Some(found))).copied().unwrap_or(0) as f64;
        let costs: Vec<f64> =
            truths.iter().flat_map(|&truth| found.iter().map(move |&found| -count(truth, found))).collect();
        let mut solver = Hungarian::default();
        let assigned = solver.solve(CostMatrix::new(truths.len(), found.len(), &costs)?)?;
        let share = |(&truth, column): (&u32, &Option<usize>)| {
            let own = self.pixels.range((truth, None)..=(truth, Some(u32::MAX)));
            let all: u64 = own.map(|(_, &pixels)| pixels).sum();
            column.map_or(0.0, |column| count(truth, found[column]) / all as f64)
        };
        let sum: f64 = truths.iter().zip(&assigned.column_of).map(share).sum();
        Ok(Some(sum / truths.len() as f64))
    }
}
