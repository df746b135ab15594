//! The adjusted Rand index of two labelings of the same pixels.

use alloc::vec::Vec;

use super::MetricError;

/// Labels are bytes.
const LABELS: usize = 256;

/// Memory of [`adjusted_rand_index`].
#[derive(Clone, Debug, Default)]
pub struct RandIndexScratch {
    /// Number of pixels per pair of labels, and per label of either side.
    table: Vec<u64>,
    rows: Vec<u64>,
    columns: Vec<u64>,
}

/// The agreement of two labelings on which pairs of pixels belong together, corrected for chance: 1 if they are equal up
/// to names, 0 on average for independent ones, at least -1/2. All labels count, the background's 0 included. Two
/// labelings that are both one segment, or both all different, agree: 1.
///
/// *Source*: L. Hubert and P. Arabie, Comparing partitions, Journal of Classification 2 (1985).
///
/// # Errors
/// [`MetricError::Length`] if the labelings differ in length.
pub fn adjusted_rand_index(a: &[u8], b: &[u8], scratch: &mut RandIndexScratch) -> Result<f64, MetricError> {
    if a.len() != b.len() {
        return Err(MetricError::Length { what: "second labeling", expected: a.len(), len: b.len() });
    }
    let RandIndexScratch { table, rows, columns } = scratch;
    let highest = a.iter().chain(b).fold(0, |highest, &label| highest.max(label));
    let side = LABELS.min(usize::from(highest) + 1);
    table.clear();
    table.resize(side * side, 0);
    for vec in [&mut *rows, &mut *columns] {
        vec.clear();
        vec.resize(side, 0);
    }
    for (&a, &b) in a.iter().zip(b) {
        table[usize::from(a) * side + usize::from(b)] += 1;
    }
    for (row, line) in table.chunks_exact(side).enumerate() {
        for (column, &count) in line.iter().enumerate() {
            rows[row] += count;
            columns[column] += count;
        }
    }
    let together = pairs(table);
    let (in_a, in_b) = (pairs(rows), pairs(columns));
    let all = pairs(&[rows.iter().sum()]);
    let expected = if all > 0.0 { in_a * in_b / all } else { 0.0 };
    let most = f64::midpoint(in_a, in_b);
    // Both sides one segment, or all pixels apart: there is nothing to correct, and they agree.
    Ok(if most <= expected { 1.0 } else { (together - expected) / (most - expected) })
}

/// Number of pairs of pixels with equal labels.
#[expect(clippy::cast_precision_loss, reason = "an image has at most 2^28 pixels, so pairs are below 2^56")]
fn pairs(counts: &[u64]) -> f64 {
    counts.iter().map(|&n| n * n.saturating_sub(1) / 2).sum::<u64>() as f64
}
