//! The order in which faces are painted, from back to front.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::vec;
use alloc::vec::Vec;

use super::junction::{Passes, Votes, votes};
use crate::boundary::Ring;
use crate::partition::{OUTSIDE, Partition};
use crate::stroke::StrokeFit;
use crate::tuning;

/// Faces from back to front, the background first.
#[derive(Clone, Debug)]
pub(super) struct Order {
    pub(super) faces: Vec<u32>,
    /// Place of every face in `faces`.
    pub(super) rank: Vec<usize>,
    /// Faces that something shows to lie in front of another: (front, behind).
    pub(super) in_front: Passes,
    /// What speaks for it.
    votes: Votes,
    /// What of that can be seen; the rest is custom: how things of these colors, lines, and what others enclose mostly lie.
    seen: Votes,
}

impl Order {
    pub(super) fn of(
        partition: &Partition,
        rings: &[Vec<Ring>],
        background: u32,
        clear: bool,
        pens: &mut [Option<StrokeFit>],
        of_seams: &Votes,
    ) -> Self {
        let (mut seen, mut shown) = votes(rings);
        let mut votes = seen.clone();
        add_colors(partition, rings, &mut votes);
        // Lines end at what lies in front of them as if a pen had ended there: they are things that go on behind it.
        for &(front, behind) in votes.keys() {
            if net(&votes, front, behind) >= 0.5 * tuning::MOST_VOTE {
                pens[behind as usize] = None;
            }
        }
        add_pens(rings, pens, &mut votes);
        let neighbors: Vec<Vec<u32>> = rings.iter().map(|rings| neighbors_along(rings.iter())).collect();
        add_enclosures(partition, (rings, &neighbors), background, clear, &mut votes);
        // The background lies behind everything, whatever was painted last.
        let of_seams = of_seams.iter().filter(|(pair, _)| pair.0 != background);
        for (&pair, bits) in of_seams {
            *votes.entry(pair).or_default() += bits;
            *seen.entry(pair).or_default() += bits;
        }
        let n = partition.faces.len();
        // What lies in front of each face, and behind how much each face must lie that is not placed yet.
        let mut in_front: Vec<Vec<(u32, f64)>> = vec![Vec::new(); n];
        let mut held = vec![0.0; n];
        for &(front, behind) in votes.keys() {
            let net = net(&votes, front, behind);
            if net > 0.0 {
                in_front[behind as usize].push((front, net));
                held[front as usize] += net;
                shown.insert((front, behind));
            }
        }
        // What lies in a hole of a face lies in front of it, whatever fills the hole, or the hole would have to be one.
        for (face, rings) in rings.iter().enumerate() {
            for inner in inside(&neighbors, rings, face as u32) {
                in_front[face].push((inner, tuning::ENCLOSED_VOTE));
                held[inner as usize] += tuning::ENCLOSED_VOTE;
            }
        }
        let mut order = Self { faces: Vec::with_capacity(n), rank: vec![usize::MAX; n], in_front: shown, votes, seen };
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
            next =
                open.min_by(|a, b| key(a).0.total_cmp(&key(b).0).then(key(a).1.cmp(&key(b).1))).map(|face| face as u32);
        }
        order.sink_holes(partition, rings, background);
        order
    }

    /// How much speaks for a face lying in front of another one, bits; negative for the other way.
    pub(super) fn net(&self, front: u32, behind: u32) -> f64 {
        net(&self.votes, front, behind)
    }

    /// How much of that can be seen.
    pub(super) fn net_seen(&self, front: u32, behind: u32) -> f64 {
        net(&self.seen, front, behind)
    }

    /// What shows the background through holes lies as far back as the background itself: what lies between must not cover it either.
    fn sink_holes(&mut self, partition: &Partition, rings: &[Vec<Ring>], background: u32) {
        let color = |face: u32| partition.faces[face as usize].color;
        let back = color(background);
        let is_hole = |face: u32| {
            let is_behind = |other: u32| color(other) == back || self.net(face, other) < 0.5 * tuning::MOST_VOTE;
            color(face) == back && neighbors_along(rings[face as usize].iter()).into_iter().all(is_behind)
        };
        let holes: Vec<u32> = (0..partition.faces.len() as u32).filter(|&face| is_hole(face)).collect();
        for hole in holes {
            self.rank[hole as usize] = 0;
        }
    }
}

/// How much more speaks for the first of two faces lying in front of the second than for the other way.
fn net(votes: &Votes, front: u32, behind: u32) -> f64 {
    let vote = |front, behind| votes.get(&(front, behind)).copied().unwrap_or(0.0);
    vote(front, behind) - vote(behind, front)
}

/// The faces in the holes of a face, but those that touch it.
fn inside(neighbors: &[Vec<u32>], rings: &[Ring], face: u32) -> BTreeSet<u32> {
    let beside = &neighbors[face as usize];
    let mut found = BTreeSet::new();
    let mut ways: Vec<u32> = neighbors_along(rings.iter().skip(1));
    while let Some(way) = ways.pop() {
        let next = neighbors[way as usize].iter().copied().filter(|&next| next != face && !beside.contains(&next));
        ways.extend(next.filter(|&next| found.insert(next)));
    }
    found
}

/// Faces that touch and of which no junction tells lie as others of their colors do: what is of one color is one thing more often than not.
fn add_colors(partition: &Partition, rings: &[Vec<Ring>], votes: &mut Votes) {
    let color = |face: u32| partition.faces[face as usize].color;
    let mut of_colors: BTreeMap<(usize, usize), f64> = BTreeMap::new();
    for (&(front, behind), bits) in votes.iter() {
        *of_colors.entry((color(front), color(behind))).or_default() += bits;
    }
    for face in 0..rings.len() as u32 {
        for other in neighbors_along(rings[face as usize].iter()) {
            let key = (color(face), color(other));
            let net = of_colors.get(&key).unwrap_or(&0.0) - of_colors.get(&(key.1, key.0)).unwrap_or(&0.0);
            if net > 0.0 {
                *votes.entry((face, other)).or_default() += net.min(tuning::COLORS_VOTE);
            }
        }
    }
}

/// Lines are drawn over what is filled.
fn add_pens(rings: &[Vec<Ring>], pens: &[Option<StrokeFit>], votes: &mut Votes) {
    for (face, rings) in rings.iter().enumerate().filter(|&(face, _)| pens[face].is_some()) {
        for neighbor in neighbors_along(rings.iter()) {
            if pens[neighbor as usize].is_none() {
                *votes.entry((face as u32, neighbor)).or_default() += tuning::PEN_VOTE;
            }
        }
    }
}

/// A face with one neighbor only lies on it. What has the color of the background is a hole where all around it lies on the background,
/// or other faces of the same colors do; what has the color of another face beside its only neighbor is that other face, seen through a
/// hole. Both are sure if nothing is painted there (`clear`).
fn add_enclosures(
    partition: &Partition,
    (rings, neighbors): (&[Vec<Ring>], &[Vec<u32>]),
    background: u32,
    clear: bool,
    votes: &mut Votes,
) {
    let outer: Vec<Vec<u32>> = rings.iter().map(|rings| neighbors_along(rings.iter().take(1))).collect();
    let back = partition.faces[background as usize].color;
    let is_back = |face: u32| partition.faces[face as usize].color == back;
    let mut on_back = vec![false; partition.palette.len()];
    for &face in &neighbors[background as usize] {
        on_back[partition.faces[face as usize].color] = true;
    }
    for face in 0..rings.len() {
        let around = &outer[face];
        let lies_on_back = |other: &u32| on_back[partition.faces[*other as usize].color];
        let shows = |other: &u32| {
            // What lies on it, too, may be another thing of the same color: both eyes of a face.
            let shows = |next: &u32| {
                let is_same = partition.faces[*next as usize].color == partition.faces[face].color;
                is_same && *next as usize != face && outer[*next as usize] != [*other]
            };
            neighbors[*other as usize].iter().any(shows)
        };
        let is_hole = if is_back(face as u32) {
            clear || around.len() > 1 || around.iter().all(lies_on_back)
        } else {
            // What shows the background has nothing to be seen through it.
            around.len() == 1 && around.iter().all(|&other| !is_back(other)) && around.iter().all(shows)
        };
        if is_hole {
            let bits = match is_back(face as u32) {
                true if clear => 1e9,
                true => tuning::MOST_VOTE,
                false => tuning::ENCLOSED_VOTE,
            };
            for &neighbor in around {
                *votes.entry((neighbor, face as u32)).or_default() += bits;
            }
        } else if let [neighbor] = around[..] {
            *votes.entry((face as u32, neighbor)).or_default() += tuning::ENCLOSED_VOTE;
        }
    }
}

/// The faces along rings.
fn neighbors_along<'a>(rings: impl Iterator<Item = &'a Ring>) -> Vec<u32> {
    let mut all: Vec<u32> =
        rings.flat_map(|ring| &ring.steps).map(|step| step.other).filter(|&other| other != OUTSIDE).collect();
    all.sort_unstable();
    all.dedup();
    all
}
