//! Faces of one color that are one thing behind another, where that is the shorter description.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::rc::Rc;
use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::geometry::{DisjointSets, LineSegment};
use dvp_core::shape::{FillRule, Segment};
use dvp_core::sort;

use super::complete::{Completed, Completion};
use super::raster;
use crate::boundary::Ring;
use crate::outline::{Outline, OutlineShape};
use crate::partition::OUTSIDE;
use crate::tuning;

/// Cracks that are nearer to a side, pixels, are of it: those of a slanted one are up to half the diagonal of a pixel off.
const BESIDE: f64 = 0.75;

/// What is painted, from back to front.
pub(super) fn painted(completion: &mut Completion<'_>) -> Vec<Group> {
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
        painted.push((rank, Group::again(completion, group.faces)));
    }
    sort::ascending(&mut painted, |&(rank, _)| rank as f64);
    painted.into_iter().map(|(_, group)| group).collect()
}

/// Bits of everything that is painted, in the present order.
pub(super) fn total(completion: &mut Completion<'_>) -> f64 {
    let rank = completion.rank.clone();
    let groups = painted(completion);
    completion.rank = rank;
    groups.iter().map(|group| group.completed.bits).sum::<f64>() + groups.len() as f64 * tuning::THING_BITS
}

/// Faces that are painted together, with their outlines (none for what a pen draws).
#[derive(Clone)]
pub(super) struct Group {
    pub(super) faces: Vec<u32>,
    pub(super) completed: Rc<Completed>,
}

impl Group {
    fn of(completion: &Completion<'_>, faces: Vec<u32>) -> Self {
        let completed = match completion.pen(&faces) {
            Some(pen) => Rc::new(Completed { bits: pen.bits + pen.misfit, ..Completed::none() }),
            None => completion.outlines(&faces),
        };
        Self { faces, completed }
    }

    /// What was found to be one thing, where the order is another: in outlines of their own where no outline through all agrees.
    pub(super) fn again(completion: &Completion<'_>, faces: Vec<u32>) -> Self {
        let again = Self::of(completion, faces);
        if again.completed.agrees || again.faces.len() == 1 {
            return again;
        }
        let alone = |&face: &u32| completion.outlines(&[face]);
        let apart = again.faces.iter().map(alone).fold(Completed::none(), |all, part| all.with(&part));
        Self { completed: Rc::new(apart), ..again }
    }

    /// Whether it is a thing as people draw them; what is seen of a few pixels, and a piece of a line, may be a part of anything.
    fn is_whole(&self, completion: &Completion<'_>) -> bool {
        let is_whole = match completion.pen(&self.faces) {
            // What a pen has drawn is whole if its ends are seen.
            Some(_) => {
                let completed = completion.outlines(&self.faces);
                completion.is_whole(&self.faces, &completed, || self.is_all_seen(&completed, completion))
            }
            None => completion.is_whole(&self.faces, &self.completed, || {
                self.completed.is_whole() || self.is_all_seen(&self.completed, completion)
            }),
        };
        is_whole && !self.faces.iter().all(|&face| completion.is_small(face))
    }

    /// Whether it is a polygon of which nothing is hidden: it covers what is seen of it and no more, and nothing in front is beside the whole of any of
    /// its sides. A part of something that is cut off ends where what cuts it begins, in a side of which nothing is seen.
    fn is_all_seen(&self, completed: &Completed, completion: &Completion<'_>) -> bool {
        let outlines = &completed.outlines;
        let is_drawn = |outline: &&Outline| match &outline.shape {
            OutlineShape::Path(ring) => ring.segments.iter().all(|segment| *segment == Segment::Line),
            _ => true,
        };
        let polygons: Vec<Vec<[f64; 2]>> = outlines.iter().filter(is_drawn).filter_map(raster::polygon).collect();
        if polygons.len() < outlines.len() {
            return false;
        }
        let rank = self.faces.iter().map(|&face| completion.rank(face)).min().unwrap_or(0);
        let steps = self.faces.iter().flat_map(|&face| &completion.rings[face as usize]).flat_map(|ring| &ring.steps);
        let is_own = |other: u32| other == OUTSIDE || completion.rank(other) <= rank || self.faces.contains(&other);
        let seen: Vec<Vec2<f64>> =
            steps.filter(|step| is_own(step.other)).map(|step| Ring::middle(step.crack)).collect();
        let is_seen = |from: Vec2<f64>, to: Vec2<f64>| {
            let side = LineSegment::new(from, to);
            // What is beside the ends may be of the next side.
            let is_between = |at: Vec2<f64>| [from, to].iter().all(|&end| (at - end).length() > BESIDE);
            seen.iter().any(|&at| side.nearest(at).distance() < BESIDE && is_between(at))
        };
        let of_lines =
            outlines.iter().zip(&polygons).filter(|(outline, _)| matches!(outline.shape, OutlineShape::Path(_)));
        let all_seen = of_lines.map(|(_, polygon)| polygon).all(|polygon| {
            let next = polygon.iter().cycle().skip(1);
            polygon.iter().zip(next).all(|(&from, &to)| is_seen(from.into(), to.into()))
        });
        all_seen && raster::check(completion.partition, (&polygons, FillRule::EvenOdd), &self.faces, |_| true).is_ok()
    }

    /// Both as one, at the place of the hindmost in the order, with the bits that are saved; none if that is no shorter.
    fn join(&self, other: &Self, completion: &mut Completion<'_>) -> Option<(f64, Self)> {
        let faces: Vec<u32> = self.faces.iter().chain(&other.faces).copied().collect();
        let ranks: Vec<usize> = faces.iter().map(|&face| completion.rank(face)).collect();
        // Two things that are whole by themselves may be of one color; parts of things hardly are.
        let is_whole = self.is_whole(completion);
        let are_whole = is_whole && other.is_whole(completion);
        if are_whole && !is_shown_behind(completion, &self.faces, &other.faces) {
            return None;
        }
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
        // Whole things of one color are many where people draw them, and so is what has a color that many things have: that there is one less is no
        // reason.
        let is_plain = || completion.partition.is_plain(faces[0]);
        let are_many = are_whole || is_plain() && (is_whole || other.is_whole(completion));
        let thing = if are_many { 0.0 } else { tuning::THING_BITS };
        let apart = self.completed.with(&other.completed);
        let alone = apart.bits + thing + before - after;
        // What a pen has drawn and what not are no one thing but as outlines.
        let has_pen = [self, other].iter().any(|group| completion.pen(&group.faces).is_some());
        if has_pen && !completed.agrees {
            return None;
        }
        // What no outline through both explains is one thing in two outlines.
        let joined =
            if has_pen || completed.agrees && completed.bits <= apart.bits { completed } else { Rc::new(apart) };
        let saved = alone - joined.bits;
        (saved > tuning::LEAST_SAVED).then_some((saved, Self { faces, completed: joined }))
    }
}

/// The first faces of two groups; what joining them saves, bits, and the group that they make, if they make one.
type Pair = (u32, u32, Option<(f64, Group)>);

/// The faces of `candidates` in groups: again and again those two become one that save most by it.
fn join(completion: &mut Completion<'_>, candidates: &[u32]) -> Vec<Group> {
    let mut groups: Vec<Group> = candidates.iter().map(|&face| Group::of(completion, vec![face])).collect();
    if groups.len() < 2 || completion.is_spent() {
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
    let are_whole = groups.iter().all(|group| group.is_whole(completion));
    let is_shown = |group: &Group| {
        groups.iter().any(|other| is_shown_behind(completion, &group.faces, &other.faces) && other.faces != group.faces)
    };
    if are_whole && !groups.iter().all(is_shown) {
        return groups;
    }
    let faces: Vec<u32> = groups.iter().flat_map(|group| &group.faces).copied().collect();
    let apart = groups.iter().fold(Completed::none(), |all, group| all.with(&group.completed));
    let ranks: Vec<usize> = faces.iter().map(|&face| completion.rank(face)).collect();
    completion.sink(&faces);
    let completed = completion.outlines(&faces);
    if completed.agrees && completed.bits < apart.bits - tuning::LEAST_SAVED {
        return vec![Group { faces, completed }];
    }
    if !are_whole {
        return vec![Group { faces, completed: Rc::new(apart) }];
    }
    for (&face, rank) in faces.iter().zip(ranks) {
        completion.rank[face as usize] = rank;
    }
    groups
}

/// Faces that may be one thing: of one color, where a way leads from one to the other behind what lies in front of both.
pub(super) fn candidates(completion: &Completion<'_>) -> Vec<Vec<u32>> {
    let mut sets = DisjointSets::default();
    sets.reset(completion.partition.faces.len() as u32);
    let painted = completion.painted();
    let apart = completion.apart();
    for &face in painted.iter().filter(|face| !apart.contains(face)) {
        for other in reached(completion, face, |_, _| true) {
            if !apart.contains(&other) {
                sets.unite(face, other);
            }
        }
    }
    for &(a, b) in &completion.united {
        sets.unite(a, b);
    }
    let mut groups: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for face in painted {
        groups.entry(sets.root(face)).or_default().push(face);
    }
    groups.into_values().collect()
}

/// Whether a way leads from one of some faces to one of others behind what is *shown* to lie in front of both. That it is painted later is
/// not enough for things that are whole by themselves: the fields of a chess board are painted in some order, too.
fn is_shown_behind(completion: &Completion<'_>, faces: &[u32], others: &[u32]) -> bool {
    let is_shown = |front: u32, behind: u32| completion.order.in_front.contains(&(front, behind));
    let leads = |from: &[u32], to: &[u32]| {
        from.iter().any(|&face| reached(completion, face, is_shown).iter().any(|other| to.contains(other)))
    };
    leads(faces, others) || leads(others, faces)
}

/// The faces of the color of `face` that can be reached from it behind what is painted later; the first and the last that the way leads
/// behind hide what is at its ends, by `hides` (front, behind).
fn reached(completion: &Completion<'_>, face: u32, hides: impl Fn(u32, u32) -> bool) -> Vec<u32> {
    let partition = completion.partition;
    let (rank, color) = (completion.rank(face), partition.faces[face as usize].color);
    let mut seen = BTreeSet::new();
    let mut found = Vec::new();
    let mut ways = vec![face];
    while let Some(way) = ways.pop().filter(|_| seen.len() < tuning::MOST_WAYS) {
        for &next in &completion.neighbors[way as usize] {
            let is_same = partition.faces[next as usize].color == color;
            let is_hidden = if is_same { hides(way, next) } else { way != face || hides(next, face) };
            // What is hidden at either end of the way has no seam there.
            let is_beside = (is_same || way == face) && completion.seamed.contains(&(way, next));
            if completion.rank(next) > rank && is_hidden && !is_beside && seen.insert(next) {
                if is_same { found.push(next) } else { ways.push(next) }
            }
        }
    }
    found
}
