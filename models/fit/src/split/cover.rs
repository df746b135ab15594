//! Sets of parts that together explain the samples.

use alloc::vec::Vec;

use dvp_core::sort;

use super::Part;
use super::partial::Candidate;
use crate::tuning::PART_GAIN;

/// Parts considered.
const MOST_PARTS: usize = 80;
/// Sets of each size that go on to be refined.
const MOST_SETS: usize = 6;

/// Indices of candidates and the samples they explain together.
#[derive(Clone, Debug)]
struct Set {
    members: Vec<usize>,
    explained: Vec<u64>,
    count: usize,
}

/// The most promising sets of two, then of three parts, those that explain most first; `samples` is their number.
pub(super) fn sets<T: Copy>(candidates: &[Candidate<T>], samples: usize) -> Vec<Vec<Part<T>>> {
    let candidates = &candidates[..candidates.len().min(MOST_PARTS)];
    let singles = candidates.iter().enumerate().map(|(i, candidate)| Set {
        members: Vec::from([i]),
        explained: candidate.explained.clone(),
        count: candidate.count,
    });
    let pairs = extended(&singles.collect::<Vec<_>>(), candidates, samples);
    let triples = extended(&pairs, candidates, samples);
    let alone = candidates.first().map_or(0, |candidate| candidate.count);
    let better = |set: &&Set| set.count > alone && worth_a_part(set.count - alone, samples);
    let parts = |set: &Set| set.members.iter().map(|&i| candidates[i].part).collect();
    pairs.iter().chain(&triples).filter(better).map(parts).collect()
}

/// The best sets of one part more.
fn extended<T>(sets: &[Set], candidates: &[Candidate<T>], samples: usize) -> Vec<Set> {
    let mut out: Vec<Set> = Vec::new();
    for set in sets {
        for (i, candidate) in candidates.iter().enumerate().filter(|(i, _)| !set.members.contains(i)) {
            let explained: Vec<u64> = set.explained.iter().zip(&candidate.explained).map(|(a, b)| a | b).collect();
            let count = explained.iter().map(|word| word.count_ones() as usize).sum::<usize>();
            let adds = worth_a_part(count - set.count, samples) && worth_a_part(count - candidate.count, samples);
            let mut members = set.members.clone();
            members.push(i);
            members.sort_unstable();
            if adds && !out.iter().any(|other| other.members == members) {
                out.push(Set { members, explained, count });
            }
        }
        sort::descending(&mut out, |set| set.count as f64);
        out.truncate(MOST_SETS);
    }
    out
}

#[expect(clippy::cast_precision_loss, reason = "an outline has few samples")]
fn worth_a_part(gain: usize, samples: usize) -> bool {
    gain as f64 >= PART_GAIN * samples as f64
}
