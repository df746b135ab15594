//! Faces of one color that are one thing behind another, where that is the shorter description.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::vec;
use alloc::vec::Vec;

use dvp_core::geometry::DisjointSets;

use super::complete::{Completed, Completion};
use crate::outline::Outline;
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

    /// Both as one, at the place of the hindmost in the order, with the bits that are saved; none if that is no shorter.
    fn join(&self, other: &Self, completion: &mut Completion<'_>) -> Option<(f64, Self)> {
        let faces: Vec<u32> = self.faces.iter().chain(&other.faces).copied().collect();
        let ranks: Vec<usize> = faces.iter().map(|&face| completion.rank(face)).collect();
        // Two things that are whole by themselves may be of one color; parts of things hardly are.
        let are_whole = self.completed.is_whole() && other.completed.is_whole();
        // What lies between where whole things are and where they go comes to lie in front of them, which may cost more than is saved.
        let crossed = if are_whole { completion.crossed(&faces) } else { BTreeSet::new() };
        let others = |completion: &Completion<'_>| -> f64 {
            crossed.iter().map(|&face| completion.outlines(&[face]).bits).sum()
        };
        let before = others(completion);
        completion.sink(&faces);
        let completed = completion.outlines(&faces);
        let after = others(completion);
        for (&face, rank) in faces.iter().zip(ranks) {
            completion.rank[face as usize] = rank;
        }
        let color = if are_whole { 0.0 } else { COLOR_BITS };
        let apart = self.completed.with(&other.completed);
        let alone = apart.bits + color + before - after;
        // What no outline through both explains is one thing in two outlines.
        let joined = if completed.agrees && completed.bits <= apart.bits { completed } else { apart };
        let saved = alone - joined.bits;
        (saved > tuning::LEAST_SAVED).then_some((saved, Self { faces, completed: joined }))
    }
}

/// The first faces of two groups; what joining them saves, bits, and the group that they make, if they make one.
type Pair = (u32, u32, Option<(f64, Group)>);

/// The faces of `candidates` in groups: again and again those two become one that save most by it.
fn join(completion: &mut Completion<'_>, candidates: &[u32]) -> Vec<Group> {
    let mut groups: Vec<Group> = candidates.iter().map(|&face| Group::of(completion, vec![face])).collect();
    if completion.is_spent() {
        return groups;
    }
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

/// Many groups as one, unless they are things by themselves and no outline through all is shorter.
fn together(completion: &mut Completion<'_>, groups: Vec<Group>) -> Vec<Group> {
    let faces: Vec<u32> = groups.iter().flat_map(|group| &group.faces).copied().collect();
    let apart = groups.iter().fold(Completed::none(), |all, group| all.with(&group.completed));
    let ranks: Vec<usize> = faces.iter().map(|&face| completion.rank(face)).collect();
    completion.sink(&faces);
    let completed = completion.outlines(&faces);
    if completed.agrees && completed.bits < apart.bits - tuning::LEAST_SAVED {
        return vec![Group { faces, completed }];
    }
    if !groups.iter().all(|group| group.completed.is_whole()) {
        return vec![Group { faces, completed: apart }];
    }
    for (&face, rank) in faces.iter().zip(ranks) {
        completion.rank[face as usize] = rank;
    }
    groups
}

/// What a color costs: three numbers of 8 bits.
const COLOR_BITS: f64 = 24.0;

/// Faces that may be one thing: of one color, where a way leads from one to the other behind what is shown to lie in front of both. That it
/// is painted later is not enough: the fields of a chess board are painted in some order, too.
fn candidates(completion: &Completion<'_>) -> Vec<Vec<u32>> {
    let Completion { partition, pens, .. } = completion;
    let mut sets = DisjointSets::default();
    sets.reset(partition.faces.len() as u32);
    let painted = completion.painted();
    let mut reached = vec![false; partition.faces.len()];
    let is_shown = |front: u32, behind: u32| completion.order.in_front.contains(&(front, behind));
    for &face in painted.iter().filter(|&&face| pens[face as usize].is_none()) {
        let (rank, color) = (completion.rank(face), partition.faces[face as usize].color);
        let mut ways = vec![face];
        reached.fill(false);
        while let Some(way) = ways.pop() {
            for &next in &completion.neighbors[way as usize] {
                let is_same = partition.faces[next as usize].color == color && pens[next as usize].is_none();
                // The first and the last that the way leads behind hide what is at its ends.
                let is_hidden = if is_same { is_shown(way, next) } else { way != face || is_shown(next, face) };
                if completion.rank(next) > rank && !reached[next as usize] && is_hidden {
                    reached[next as usize] = true;
                    if is_same {
                        sets.unite(face, next);
                    } else {
                        ways.push(next);
                    }
                }
            }
        }
    }
    let mut groups: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for face in painted {
        groups.entry(sets.root(face)).or_default().push(face);
    }
    groups.into_values().collect()
}
