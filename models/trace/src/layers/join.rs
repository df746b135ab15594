//! Faces of one color that are one thing behind another, where that is the shorter description.

use alloc::collections::BTreeMap;
use alloc::vec;
use alloc::vec::Vec;

use dvp_core::geometry::DisjointSets;

use super::complete::{Completed, Completion};
use crate::outline::Outline;
use crate::partition::OUTSIDE;

/// What is painted, from back to front: faces that are one thing, with their outlines (none for what a pen draws).
pub(super) fn groups(completion: &Completion<'_>) -> Vec<(Vec<u32>, Vec<Outline>)> {
    let mut painted: Vec<(usize, Vec<u32>, Vec<Outline>)> = Vec::new();
    for candidates in candidates(completion) {
        if completion.pens[candidates[0] as usize].is_some() {
            for face in candidates {
                painted.push((completion.rank(face), vec![face], Vec::new()));
            }
            continue;
        }
        for (group, outlines) in cheapest(completion, candidates) {
            let rank = group.iter().map(|&face| completion.rank(face)).min().unwrap_or(0);
            painted.push((rank, group, outlines));
        }
    }
    painted.sort_by_key(|&(rank, ..)| rank);
    painted.into_iter().map(|(_, group, outlines)| (group, outlines)).collect()
}

/// All of them together, or each alone: what takes fewer bits.
fn cheapest(completion: &Completion<'_>, faces: Vec<u32>) -> Vec<(Vec<u32>, Vec<Outline>)> {
    let alone: Vec<(u32, Completed)> = faces.iter().map(|&face| (face, completion.outlines(&[face]))).collect();
    if faces.len() > 1 {
        // A color of its own each: three numbers of 8 bits.
        let bits: f64 = alone.iter().map(|(_, completed)| completed.bits + 24.0).sum();
        let joined = completion.outlines(&faces);
        if joined.agrees && joined.bits + 24.0 < bits {
            return vec![(faces, joined.outlines)];
        }
    }
    alone.into_iter().map(|(face, completed)| (vec![face], completed.outlines)).collect()
}

/// Faces that may be one thing: of one color, with a neighbor in common that lies in front of both.
fn candidates(completion: &Completion<'_>) -> Vec<Vec<u32>> {
    let Completion { partition, rings, order, .. } = completion;
    let mut sets = DisjointSets::default();
    sets.reset(partition.faces.len() as u32);
    let mut behind: BTreeMap<(u32, usize), u32> = BTreeMap::new();
    let mut painted = Vec::new();
    for face in (0..partition.faces.len() as u32).filter(|&face| !order.is_background(face)) {
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
