//! All of one color at one depth, where that is the shorter description: what is of one color in several places is one thing that is seen
//! between others more often than not.

use alloc::collections::BTreeMap;
use alloc::vec;
use alloc::vec::Vec;

use dvp_core::sort;

use super::join;
use super::settle::Search;
use crate::tuning;

/// Most colors that are tried one over the other: each is exchanged with its neighbors, so that the time grows with their square.
const MOST_STACKED: usize = 6;

/// An order of painting.
struct Stack {
    faces: Vec<u32>,
    /// Bits of all that is painted.
    bits: f64,
    /// What can be seen against it, bits.
    against: f64,
}

impl Stack {
    fn price(&self) -> f64 {
        self.bits + self.against
    }
}

impl Search<'_, '_> {
    /// Paints all of one color at one depth, and nothing in the color of the background, if that is shorter; pieces of what is seen in several
    /// places are then no lines of a pen.
    pub(super) fn stack(&mut self) {
        let back = self.color(self.completion.background);
        let mut places: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (place, &face) in self.order.iter().enumerate().filter(|&(_, &face)| self.color(face) != back) {
            places.entry(self.color(face)).or_default().push(place);
        }
        if places.len() > MOST_STACKED || places.len() == self.order.len() || self.completion.is_spent() {
            return;
        }
        let before = self.total();
        let pens = self.completion.pens.clone();
        for &face in places.values().filter(|places| places.len() > 1).flatten().map(|&place| &self.order[place]) {
            self.completion.pens[face as usize] = None;
        }
        self.completion.known.borrow_mut().clear();
        let best = self.best_stack(&places);
        if before.is_finite() && best.price() < before - tuning::LEAST_SAVED {
            (self.order, self.total) = (best.faces, Some(best.bits));
        } else {
            self.completion.pens = pens;
            self.completion.known.borrow_mut().clear();
        }
        self.completion.paint(&self.order);
    }

    /// Colors by the middle of their places, neighbors exchanged as long as that is shorter.
    fn best_stack(&mut self, places: &BTreeMap<usize, Vec<usize>>) -> Stack {
        let middle = |color: &usize| places[color].iter().sum::<usize>() as f64 / places[color].len() as f64;
        let mut colors: Vec<usize> = places.keys().copied().collect();
        sort::ascending(&mut colors, middle);
        let mut best = self.stacked(&colors);
        loop {
            let mut is_better = false;
            for k in 1..colors.len() {
                let mut other = colors.clone();
                other.swap(k - 1, k);
                let tried = self.stacked(&other);
                if tried.price() < best.price() {
                    (best, colors, is_better) = (tried, other, true);
                }
            }
            if !is_better {
                return best;
            }
        }
    }

    /// The faces of some colors, one color after the other.
    fn stacked(&mut self, colors: &[usize]) -> Stack {
        let mut faces = self.order.clone();
        faces.retain(|&face| colors.contains(&self.color(face)));
        faces.sort_by_key(|&face| colors.iter().position(|&color| color == self.color(face)));
        self.completion.paint(&faces);
        let bits = join::total(self.completion);
        Stack { bits, against: self.against(&faces), faces }
    }

    /// What can be seen against a new order, bits: of what touches and lies the other way round. What is custom moves with its colors.
    fn against(&self, new: &[u32]) -> f64 {
        let ranks = |order: &[u32]| {
            let mut rank = vec![0; self.completion.rank.len()];
            order.iter().enumerate().for_each(|(place, &face)| rank[face as usize] = place + 1);
            rank
        };
        let (old, rank) = (ranks(&self.order), ranks(new));
        let mut bits = 0.0;
        for &front in new {
            for &behind in &self.completion.neighbors[front as usize] {
                let [a, b] = [front, behind].map(|face| face as usize);
                if rank[b] > 0 && rank[a] > rank[b] && old[a] < old[b] {
                    bits += self.completion.order.net_seen(behind, front);
                }
            }
        }
        bits
    }

    fn color(&self, face: u32) -> usize {
        self.completion.partition.faces[face as usize].color
    }
}
