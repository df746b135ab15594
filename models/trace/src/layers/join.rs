//! Faces of one color that are one thing behind another, where that is the shorter description.

use alloc::collections::BTreeMap;
use alloc::vec;
use alloc::vec::Vec;

use dvp_core::geometry::DisjointSets;

use super::complete::Completion;
use crate::outline::Outline;
use crate::partition::OUTSIDE;

/// What is painted, from back to front: faces that are one thing, with their outlines (none for what a pen draws).
pub(super) fn groups(completion: &mut Completion<'_>) -> Vec<(Vec<u32>, Vec<Outline>)> {
    let mut groups: Vec<Vec<u32>> = Vec::new();
    for candidates in candidates(completion) {
        if candidates.len() > 1 && join(completion, &candidates) {
            groups.push(candidates);
        } else {
            groups.extend(candidates.into_iter().map(|face| vec![face]));
        }
    }
    let mut painted: Vec<(usize, Vec<u32>, Vec<Outline>)> = Vec::new();
    for group in groups {
        let rank = completion.rank(group[0]);
        if completion.pens[group[0] as usize].is_some() {
            painted.push((rank, group, Vec::new()));
            continue;
        }
        let completed = completion.outlines(&group);
        if completed.agrees || group.len() == 1 {
            painted.push((rank, group, completed.outlines));
        } else {
            painted.extend(group.into_iter().map(|face| (rank, vec![face], completion.outlines(&[face]).outlines)));
        }
    }
    painted.sort_by_key(|&(rank, ..)| rank);
    painted.into_iter().map(|(_, group, outlines)| (group, outlines)).collect()
}

/// Whether faces take fewer bits together than each alone; they have one place in the order then, that of the hindmost.
fn join(completion: &mut Completion<'_>, faces: &[u32]) -> bool {
    let alone: f64 = faces.iter().map(|&face| completion.outlines(&[face]).bits + COLOR_BITS).sum();
    let ranks: Vec<usize> = faces.iter().map(|&face| completion.rank(face)).collect();
    let hindmost = ranks.iter().copied().min().unwrap_or(0);
    for &face in faces {
        completion.rank[face as usize] = hindmost;
    }
    let joined = completion.outlines(faces);
    if joined.agrees && joined.bits + COLOR_BITS < alone {
        return true;
    }
    for (&face, rank) in faces.iter().zip(ranks) {
        completion.rank[face as usize] = rank;
    }
    false
}

/// What a color costs: three numbers of 8 bits.
const COLOR_BITS: f64 = 24.0;

/// Faces that may be one thing: of one color, with a neighbor in common that lies in front of both.
fn candidates(completion: &Completion<'_>) -> Vec<Vec<u32>> {
    let Completion { partition, rings, .. } = completion;
    let mut sets = DisjointSets::default();
    sets.reset(partition.faces.len() as u32);
    let mut behind: BTreeMap<(u32, usize), u32> = BTreeMap::new();
    let mut painted = Vec::new();
    for face in (0..partition.faces.len() as u32).filter(|&face| completion.rank(face) > 0) {
        let color = partition.faces[face as usize].color;
        let steps = rings[face as usize].iter().flat_map(|ring| &ring.steps).filter(|step| step.other != OUTSIDE);
        let mut neighbors: Vec<u32> = steps.map(|step| step.other).collect();
        neighbors.sort_unstable();
        neighbors.dedup();
        let is_in_front = |other: &u32| completion.rank(*other) > completion.rank(face);
        painted.push(face);
        if completion.pens[face as usize].is_some() {
            continue;
        }
        for front in neighbors.into_iter().filter(is_in_front) {
            let first = *behind.entry((front, color)).or_insert(face);
            sets.unite(first, face);
        }
    }
    let mut groups: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for face in painted {
        groups.entry(sets.root(face)).or_default().push(face);
    }
    groups.into_values().collect()
}
