//! The order of faces that meet, where another one is the shorter description.
//!
//! What lies in front has the boundary between two faces for its own; for what lies behind it costs nothing. The wrong order makes corners
//! where something begins to hide something else.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::vec::Vec;

use super::complete::Completion;
use crate::partition::OUTSIDE;
use crate::tuning;

/// Puts faces before and behind those that they meet as long as that saves bits.
pub(super) fn settle(completion: &mut Completion<'_>) {
    let order = completion.order;
    let net = |front, behind| order.net(front, behind);
    let mut search = Search { known: BTreeMap::new(), completion };
    let mut pairs = search.pairs();
    pairs.retain(|&(a, b)| net(a, b).abs() < tuning::CLEAR_VOTE);
    let mut order = search.completion.painted();
    for _ in 0..tuning::MOST_ROUNDS {
        let mut is_changed = false;
        for &(a, b) in &pairs {
            if search.completion.is_spent() {
                break;
            }
            let place = |face: u32| order.iter().position(|&other| other == face);
            let (Some(at_a), Some(at_b)) = (place(a), place(b)) else { continue };
            let (back, front) = (at_a.min(at_b), at_a.max(at_b));
            let against = net(order[front], order[back]).max(0.0);
            // Either comes to lie just beyond the other.
            for (from, to) in [(back, front), (front, back)] {
                let mut moved = order.clone();
                let face = moved.remove(from);
                moved.insert(to, face);
                let crossed = &order[back..=front];
                let mut touched: Vec<u32> = search.completion.neighbors[face as usize].clone();
                touched.retain(|other| crossed.contains(other));
                touched.push(face);
                let before = search.bits(&touched);
                search.completion.paint(&moved);
                if search.bits(&touched) + against < before - tuning::LEAST_SAVED {
                    order = moved;
                    is_changed = true;
                    break;
                }
                search.completion.paint(&order);
            }
        }
        if !is_changed || search.completion.is_spent() {
            break;
        }
    }
    completion.spent.set(0);
}

struct Search<'a, 'b> {
    completion: &'a mut Completion<'b>,
    /// Bits of a face behind some of its neighbors.
    known: BTreeMap<(u32, Vec<u32>), f64>,
}

impl Search<'_, '_> {
    /// Bits of faces, each painted alone.
    fn bits(&mut self, faces: &[u32]) -> f64 {
        let mut sum = 0.0;
        for &face in faces {
            let rank = self.completion.rank(face);
            let mut front = self.completion.neighbors[face as usize].clone();
            front.retain(|&other| self.completion.rank(other) > rank);
            let completion = &self.completion;
            sum += *self.known.entry((face, front)).or_insert_with(|| completion.outlines(&[face]).bits);
        }
        sum
    }

    /// Painted faces that meet where a third one does.
    fn pairs(&self) -> BTreeSet<(u32, u32)> {
        let is_open = |face: u32| {
            face != OUTSIDE && self.completion.rank(face) > 0 && self.completion.pens[face as usize].is_none()
        };
        let mut pairs = BTreeSet::new();
        for (face, rings) in self.completion.rings.iter().enumerate() {
            for ring in rings {
                let n = ring.steps.len();
                for k in 0..n {
                    let [here, next] = [ring.steps[k].other, ring.steps[(k + 1) % n].other];
                    if here == next || here == OUTSIDE || next == OUTSIDE {
                        continue;
                    }
                    let face = face as u32;
                    for (a, b) in [(face, here), (face, next), (here, next)] {
                        if is_open(a) && is_open(b) {
                            pairs.insert((a.min(b), a.max(b)));
                        }
                    }
                }
            }
        }
        pairs.retain(|&(a, b)| self.completion.neighbors[a as usize].contains(&b));
        pairs
    }
}
