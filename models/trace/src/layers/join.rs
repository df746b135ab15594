//! Faces of one color that are one thing behind another, where that is the shorter description.

use alloc::collections::BTreeMap;
use alloc::vec;
use alloc::vec::Vec;

use dvp_core::geometry::DisjointSets;

use super::complete::{Completed, Completion};
use crate::outline::Outline;
use crate::partition::OUTSIDE;
use crate::tuning;

/// What is painted, from back to front: faces that are one thing, with their outlines (none for what a pen draws).
pub(super) fn groups(completion: &mut Completion<'_>) -> Vec<(Vec<u32>, Vec<Outline>)> {
    let mut groups: Vec<Group> = Vec::new();
    for candidates in candidates(completion) {
        groups.extend(join(completion, &candidates));
    }
    let mut painted: Vec<(usize, Group)> = Vec::new();
    for group in groups {
        let rank = completion.rank(group.faces[0]);
        // What was joined after this group lies further back than it did: the group may hide it now.
        if completion.holds(&group.faces, &group.completed) {
            painted.push((rank, group));
            continue;
        }
        let again = Group::of(completion, group.faces);
        if again.completed.agrees || again.faces.len() == 1 {
            painted.push((rank, again));
        } else {
            painted.extend(again.faces.iter().map(|&face| (rank, Group::of(completion, vec![face]))));
        }
    }
    painted.sort_by_key(|&(rank, _)| rank);
    painted.into_iter().map(|(_, group)| (group.faces, group.completed.outlines)).collect()
}

/// Faces that are painted together.
struct Group {
    faces: Vec<u32>,
    completed: Completed,
}

impl Group {
    fn of(completion: &Completion<'_>, faces: Vec<u32>) -> Self {
        let is_pen = completion.pens[faces[0] as usize].is_some();
        let completed = if is_pen { Completed::none() } else { completion.outlines(&faces) };
        Self { faces, completed }
    }

    /// Both as one, at the place of the hindmost in the order, with the bits that are saved; none if that is no shorter and nothing tells
    /// that they belong together.
    fn join(&self, other: &Self, completion: &mut Completion<'_>) -> Option<(f64, Self)> {
        let faces: Vec<u32> = self.faces.iter().chain(&other.faces).copied().collect();
        let ranks: Vec<usize> = faces.iter().map(|&face| completion.rank(face)).collect();
        completion.sink(&faces);
        let completed = completion.outlines(&faces);
        for (&face, rank) in faces.iter().zip(ranks) {
            completion.rank[face as usize] = rank;
        }
        let saved = self.completed.bits + other.completed.bits + COLOR_BITS - completed.bits;
        if completed.agrees && saved > 0.0 {
            return Some((saved, Self { faces, completed }));
        }
        // What no outline explains may be one thing all the same.
        let parts = [&self.faces[..], &other.faces];
        completion.is_related(parts).then(|| (0.0, Self { completed: self.completed.with(&other.completed), faces }))
    }
}

/// The first faces of two groups; what joining them saves, bits, and the group that they make, if they make one.
type Pair = (u32, u32, Option<(f64, Group)>);

/// The faces of `candidates` in groups: again and again those two become one that save most by it.
fn join(completion: &mut Completion<'_>, candidates: &[u32]) -> Vec<Group> {
    let mut groups: Vec<Group> = candidates.iter().map(|&face| Group::of(completion, vec![face])).collect();
    if groups.len() > tuning::MOST_PAIRED {
        return together(completion, groups);
    }
    // What was found for two groups holds as long as both are there.
    let mut pairs: Vec<Pair> = Vec::new();
    loop {
        for a in 0..groups.len() {
            for b in 0..a {
                let key = (groups[a].faces[0], groups[b].faces[0]);
                if !pairs.iter().any(|&(first, second, _)| (first, second) == key) {
                    let joined = groups[a].join(&groups[b], completion);
                    pairs.push((key.0, key.1, joined));
                }
            }
        }
        let saved = |pair: &Pair| pair.2.as_ref().map_or(-1.0, |&(saved, _)| saved);
        let best = (0..pairs.len()).max_by(|&a, &b| saved(&pairs[a]).total_cmp(&saved(&pairs[b])));
        let Some((a, b, Some((_, joined)))) = best.map(|best| pairs.swap_remove(best)) else { return groups };
        completion.sink(&joined.faces);
        let is_part = |face: u32| face == a || face == b;
        pairs.retain(|&(first, second, _)| !is_part(first) && !is_part(second));
        groups.retain(|group| !is_part(group.faces[0]));
        groups.push(joined);
    }
}

/// Many groups as one if that is shorter; else as they are.
fn together(completion: &mut Completion<'_>, groups: Vec<Group>) -> Vec<Group> {
    let faces: Vec<u32> = groups.iter().flat_map(|group| &group.faces).copied().collect();
    let alone: f64 = groups.iter().map(|group| group.completed.bits + COLOR_BITS).sum();
    let ranks: Vec<usize> = faces.iter().map(|&face| completion.rank(face)).collect();
    completion.sink(&faces);
    let completed = completion.outlines(&faces);
    if completed.agrees && completed.bits + COLOR_BITS < alone {
        return alloc::vec![Group { faces, completed }];
    }
    for (&face, rank) in faces.iter().zip(ranks) {
        completion.rank[face as usize] = rank;
    }
    groups
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
        // A face without a flat pixel is too small to tell what it is a part of.
        if completion.pens[face as usize].is_some() || partition.faces[face as usize].flat == 0 {
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
