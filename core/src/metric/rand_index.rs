//! The adjusted Rand index of two labelings of the same pixels.

use alloc::vec::Vec;

use super::MetricError;

/// Pairs of labels that are counted before equal ones are brought together.
const FIRST_PAIRS: usize = 1 << 12;

/// Memory of [`adjusted_rand_index`].
#[derive(Clone, Debug, Default)]
pub struct RandIndexScratch {
    /// Pairs of labels with a number of pixels; by the end sorted, each pair once.
    pairs: Vec<([u32; 2], u64)>,
    /// Number of pixels per label of one side.
    sides: Vec<(u32, u64)>,
}

/// The agreement of two labelings on which pairs of pixels belong together, corrected for chance: 1 if they are equal up
/// to names, 0 on average for independent ones, at least -1/2. All labels count, the background's 0 included. Two
/// labelings that are both one segment, or both all different, agree: 1.
///
/// *Memory*: by the number of pairs of labels that occur together, not by the labels' values.
///
/// *Source*: L. Hubert and P. Arabie, Comparing partitions, Journal of Classification 2 (1985).
///
/// # Errors
/// [`MetricError::Length`] if the labelings differ in length.
pub fn adjusted_rand_index(a: &[u32], b: &[u32], scratch: &mut RandIndexScratch) -> Result<f64, MetricError> {
    if a.len() != b.len() {
        return Err(MetricError::Length { what: "second labeling", expected: a.len(), len: b.len() });
    }
    let RandIndexScratch { pairs, sides } = scratch;
    pairs.clear();
    let mut limit = FIRST_PAIRS;
    for (&a, &b) in a.iter().zip(b) {
        match pairs.last_mut() {
            // Neighbors mostly agree.
            Some((last, count)) if *last == [a, b] => *count += 1,
            _ => {
                if pairs.len() == limit {
                    merge(pairs);
                    limit = FIRST_PAIRS.max(2 * pairs.len());
                }
                pairs.push(([a, b], 1));
            }
        }
    }
    merge(pairs);
    let together = equal_pairs(pairs);
    let [in_a, in_b] = [0, 1].map(|side| {
        sides.clear();
        sides.extend(pairs.iter().map(|(labels, count)| (labels[side], *count)));
        merge(sides);
        equal_pairs(sides)
    });
    let all = pixel_pairs(pairs.iter().map(|(_, count)| count).sum());
    let expected = if all > 0.0 { in_a * in_b / all } else { 0.0 };
    let most = f64::midpoint(in_a, in_b);
    // Both sides one segment, or all pixels apart: there is nothing to correct, and they agree.
    Ok(if most <= expected { 1.0 } else { (together - expected) / (most - expected) })
}

/// Sorts, and adds up what has equal labels.
fn merge<L: Copy + Ord>(counts: &mut Vec<(L, u64)>) {
    counts.sort_unstable_by_key(|(label, _)| *label);
    counts.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        kept.1 += if same { next.1 } else { 0 };
        same
    });
}

/// Number of pairs of pixels with equal labels.
fn equal_pairs<L>(counts: &[(L, u64)]) -> f64 {
    counts.iter().map(|(_, count)| pixel_pairs(*count)).sum()
}

/// Number of pairs of `count` pixels.
#[expect(clippy::cast_precision_loss, reason = "an image has at most 2^28 pixels, so pairs are below 2^56")]
fn pixel_pairs(count: u64) -> f64 {
    (count * count.saturating_sub(1) / 2) as f64
}
