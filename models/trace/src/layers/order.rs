//! The order in which faces are painted, from back to front.

use alloc::vec;
use alloc::vec::Vec;

use super::junction::{Votes, votes};
use crate::boundary::Ring;
use crate::partition::{OUTSIDE, Partition};
use crate::tuning;

/// Faces from back to front, the background first.
#[derive(Clone, Debug)]
pub(super) struct Order {
    pub(super) faces: Vec<u32>,
    /// Place of every face in `faces`.
    pub(super) rank: Vec<usize>,
}

impl Order {
    pub(super) fn of(partition: &Partition, rings: &[Vec<Ring>], background: u32, clear: bool) -> Self {
        let mut votes = votes(rings);
        add_enclosures(partition, rings, background, clear, &mut votes);
        let n = partition.faces.len();
        // What lies in front of each face, and behind how much each face must lie that is not placed yet.
        let mut in_front: Vec<Vec<(u32, f64)>> = vec![Vec::new(); n];
        let mut held = vec![0.0; n];
        for (&(front, behind), &bits) in &votes {
            let net = bits - votes.get(&(behind, front)).copied().unwrap_or(0.0);
            if net > 0.0 {
                in_front[behind as usize].push((front, net));
                held[front as usize] += net;
            }
        }
        let mut order = Self { faces: Vec::with_capacity(n), rank: vec![usize::MAX; n] };
        let mut next = Some(background);
        while let Some(face) = next {
            order.rank[face as usize] = order.faces.len();
            order.faces.push(face);
            for &(front, bits) in &in_front[face as usize] {
                held[front as usize] -= bits;
            }
            let open = (0..n).filter(|&face| order.rank[face] == usize::MAX);
            // Larger faces first where nothing else decides.
            let key = |face: &usize| (held[*face].max(0.0), core::cmp::Reverse(partition.faces[*face].area));
            next = open.min_by(|a, b| key(a).0.total_cmp(&key(b).0).then(key(a).1.cmp(&key(b).1))).map(|face| face as u32);
        }
        order
    }
}

/// A face with one neighbor only lies on it. What has the color of the background is a hole in what is around it, for sure if nothing is
/// painted there (`clear`).
fn add_enclosures(partition: &Partition, rings: &[Vec<Ring>], background: u32, clear: bool, votes: &mut Votes) {
    let back = partition.faces[background as usize].color;
    for (face, rings) in rings.iter().enumerate() {
        let steps = rings.iter().take(1).flat_map(|ring| &ring.steps);
        let mut neighbors: Vec<u32> = steps.map(|step| step.other).filter(|&other| other != OUTSIDE).collect();
        neighbors.sort_unstable();
        neighbors.dedup();
        if partition.faces[face].color == back {
            let bits = if clear { f64::MAX.sqrt() } else { tuning::ENCLOSED_VOTE };
            for neighbor in neighbors {
                *votes.entry((neighbor, face as u32)).or_default() += bits;
            }
        } else if let [neighbor] = neighbors[..] {
            *votes.entry((face as u32, neighbor)).or_default() += tuning::ENCLOSED_VOTE;
        }
    }
}
