//! Faces that lie edge to edge: what is behind both shows through along their seam.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::vec::Vec;

use dvp_core::image::distance;

use super::junction::Votes;
use crate::boundary::Ring;
use crate::partition::{BEHIND, Color, OUTSIDE, Partition};
use crate::tuning;

/// What seams tell.
#[derive(Debug, Default)]
pub(super) struct EdgeToEdge {
    /// Pairs of faces, either way round, of which neither goes on behind the other.
    pub(super) pairs: BTreeSet<(u32, u32)>,
    /// Which of two was painted last, by what it covers of the seam.
    pub(super) votes: Votes,
}

/// What the boundary between two faces shows, in steps.
#[derive(Default)]
struct Boundary {
    /// By what shows through: that is one thing all along a seam.
    seams: [usize; BEHIND],
    mixed: usize,
    steps: usize,
    /// Steps where either of both faces was painted last.
    in_front: [usize; 2],
}

impl Boundary {
    /// Whether both faces lie edge to edge, by what is seen of it.
    fn is_seam(&self) -> bool {
        let most = self.seams.into_iter().max().unwrap_or_default();
        most >= tuning::LEAST_SEAM && most as f64 > tuning::SEAM_SHARE * self.steps as f64
    }

    /// Whether that cannot be told: few steps, or hardly any that show a mixture, as along the pixel grid.
    fn is_unknown(&self) -> bool {
        self.steps < tuning::LEAST_SEAM || (self.mixed as f64) < tuning::SEAM_LEAST_MIXED * self.steps as f64
    }
}

impl EdgeToEdge {
    /// What lies edge to edge has seams along most of the boundary. Where that cannot be told it is as elsewhere, if both faces have seams
    /// with others.
    pub(super) fn of(partition: &Partition, rings: &[Vec<Ring>]) -> Self {
        if partition.seams.is_empty() {
            return Self::default();
        }
        let mut boundaries: BTreeMap<(u32, u32), Boundary> = BTreeMap::new();
        let steps = rings.iter().flatten().flat_map(|ring| &ring.steps);
        // Every boundary has two faces: seen from the first of them.
        for step in steps.filter(|step| step.other != OUTSIDE && step.inner < step.other) {
            let boundary = boundaries.entry((step.inner, step.other)).or_default();
            let sides = step.crack.sides().map(|[x, y]| y * partition.size[0] + x);
            boundary.mixed += usize::from(sides.iter().any(|&i| partition.shares[i] < tuning::PURE_SHARE));
            boundary.steps += 1;
            let Some(seam) = sides.into_iter().find_map(|i| partition.seam(i)) else { continue };
            boundary.seams[seam.behind as usize] += 1;
            let [inner, other] = [step.inner, step.other].map(|face| away(partition, face, seam.front));
            boundary.in_front[usize::from(other < inner)] += 1;
        }
        let of = |is: fn(&Boundary) -> bool| {
            boundaries.iter().filter(move |(_, boundary)| is(boundary)).map(|(&pair, _)| pair)
        };
        let seamed: Vec<(u32, u32)> = of(Boundary::is_seam).collect();
        let beside: BTreeSet<u32> = seamed.iter().flat_map(|&(a, b)| [a, b]).collect();
        let unknown = of(Boundary::is_unknown).filter(|(a, b)| beside.contains(a) && beside.contains(b));
        let pairs = seamed.iter().copied().chain(unknown).flat_map(|(a, b)| [(a, b), (b, a)]).collect();
        let mut votes = Votes::new();
        for &(a, b) in &seamed {
            let counts = boundaries[&(a, b)].in_front.map(|count| count as f64);
            for (pair, count) in [(a, b), (b, a)].into_iter().zip(counts) {
                if count > tuning::SEAM_SHARE * (counts[0] + counts[1]) {
                    votes.insert(pair, tuning::MOST_VOTE);
                }
            }
        }
        Self { pairs, votes }
    }
}

/// How far a face's color is from another one.
fn away(partition: &Partition, face: u32, color: Color) -> f64 {
    distance(partition.color(face), color)
}
