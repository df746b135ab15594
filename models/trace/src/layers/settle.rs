//! The order of faces that meet, where another one is the shorter description.
//!
//! What lies in front has the boundary between two faces for its own; what lies behind may go on as it likes. The wrong order makes corners
//! where something begins to hide something else, and parts of what is one thing. An order is taken if all that is painted, with its
//! parts joined, is shorter by it, less what junctions say against it.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::vec::Vec;

use super::complete::Completion;
use super::join;
use crate::partition::OUTSIDE;
use crate::tuning;

/// Puts faces before and behind those that they meet as long as that saves bits.
pub(super) fn settle(completion: &mut Completion<'_>) {
    let order = completion.painted();
    completion.paint(&order);
    completion.is_searching = true;
    let mut search = Search { known: BTreeMap::new(), order, total: None, completion };
    let mut pairs = search.pairs();
    pairs.retain(|&(a, b)| search.completion.order.net(a, b).abs() < tuning::CLEAR_VOTE);
    for _ in 0..tuning::MOST_ROUNDS {
        let mut is_changed = search.exchange(&pairs);
        is_changed |= search.fill();
        is_changed |= search.open();
        is_changed |= search.close();
        is_changed |= search.unite();
        is_changed |= search.frame();
        if !is_changed || search.completion.is_spent() {
            break;
        }
    }
    search.stack();
    completion.is_searching = false;
    completion.memo.found();
}

/// A search for the order of painting: every move proposes another one, and one rule takes it ([`Search::is_shorter`]).
pub(super) struct Search<'a, 'b> {
    pub(super) completion: &'a mut Completion<'b>,
    /// Faces from back to front, as they are painted.
    pub(super) order: Vec<u32>,
    /// Bits of everything in this order, once asked for.
    pub(super) total: Option<f64>,
    /// Bits of a face behind some of its neighbors.
    known: BTreeMap<(u32, Vec<u32>), f64>,
}

impl Search<'_, '_> {
    /// Takes another order if all that is painted is shorter by it, faces that are `united` by it one thing, by more than what is `against` it, bits.
    fn is_shorter(&mut self, moved: Vec<u32>, united: &[(u32, u32)], against: f64) -> bool {
        if self.completion.is_spent() {
            return false;
        }
        let before = self.total();
        let count = self.completion.united.len();
        self.completion.united.extend(united);
        self.completion.paint(&moved);
        let after = join::total(self.completion);
        // What was not asked for any more is no reason.
        let is_shorter = before.is_finite() && after + against < before - tuning::LEAST_SAVED;
        if is_shorter {
            (self.order, self.total) = (moved, Some(after));
        } else {
            self.completion.united.truncate(count);
        }
        self.completion.paint(&self.order);
        is_shorter
    }

    /// Bits of everything in the present order.
    pub(super) fn total(&mut self) -> f64 {
        *self.total.get_or_insert_with(|| join::total(self.completion))
    }

    /// Where a face is in the present order, as it is painted.
    fn place(&self, face: u32) -> Option<usize> {
        self.completion.rank(face).checked_sub(1)
    }

    /// Puts one of two faces that meet just beyond the other.
    fn exchange(&mut self, pairs: &BTreeSet<(u32, u32)>) -> bool {
        let mut is_changed = false;
        for &(a, b) in pairs {
            if self.completion.is_spent() {
                break;
            }
            let (Some(at_a), Some(at_b)) = (self.place(a), self.place(b)) else { continue };
            let (back, front) = (at_a.min(at_b), at_a.max(at_b));
            let against = self.completion.order.net(self.order[front], self.order[back]).max(0.0);
            for is_raised in [true, false] {
                // The others keep their order, and what is not between both its place.
                let crossed = &self.order[back..=front];
                let mut moved = crossed.to_vec();
                if is_raised {
                    moved.rotate_left(1)
                } else {
                    moved.rotate_right(1)
                }
                let face = if is_raised { crossed[0] } else { moved[0] };
                let mut touched: Vec<u32> = self.completion.neighbors[face as usize].clone();
                touched.retain(|&other| self.place(other).is_some_and(|at| (back..=front).contains(&at)));
                touched.push(face);
                let before = self.bits(&touched);
                self.completion.paint_from(back, &moved);
                let after = self.bits(&touched);
                self.completion.paint_from(back, &self.order[back..=front]);
                // Shorter one by one, and with all that may be one thing behind others.
                if after + against < before - tuning::LEAST_SAVED {
                    let order = [&self.order[..back], &moved, &self.order[front + 1..]].concat();
                    if self.is_shorter(order, &[], against) {
                        is_changed = true;
                        break;
                    }
                }
            }
        }
        is_changed
    }

    /// Takes away what is painted in the color of the background where the rest is shorter with an opening there: of what is seen through
    /// openings that others hide in part, junctions tell little.
    fn open(&mut self) -> bool {
        let mut is_changed = false;
        let open: Vec<u32> =
            self.order.iter().copied().filter(|&face| self.completion.shows_background(face)).collect();
        for face in open {
            let without = self.order.iter().copied().filter(|&other| other != face).collect();
            is_changed |= self.is_shorter(without, &[], 0.0);
        }
        is_changed
    }

    /// Paints what shows the background through more than one thing as one more thing, where it is a figure and that is shorter.
    fn close(&mut self) -> bool {
        let mut is_changed = false;
        for face in self.openings() {
            if self.completion.is_spent() {
                break;
            }
            let mut with = self.order.clone();
            with.push(face);
            self.completion.paint(&with);
            let is_whole = self.completion.outlines(&[face]).is_whole();
            self.completion.paint(&self.order);
            let around = &self.completion.neighbors[face as usize];
            let votes = around.iter().map(|&other| self.completion.order.net(other, face).max(0.0)).sum();
            is_changed |= is_whole && self.is_shorter(with, &[], votes);
        }
        is_changed
    }

    /// Faces of the color of the background that are not painted though what is around them does not all lie on the background; none where
    /// that color is no paint.
    fn openings(&self) -> Vec<u32> {
        let completion = &*self.completion;
        if completion.is_clear {
            return Vec::new();
        }
        let back = completion.background;
        let color = |face: u32| completion.partition.faces[face as usize].color;
        let is_deep = |face: &u32| {
            let around = &completion.neighbors[*face as usize];
            around.len() > 1 || around.iter().any(|other| !completion.neighbors[*other as usize].contains(&back))
        };
        let faces = (0..completion.rank.len() as u32).filter(|&face| face != back && color(face) == color(back));
        faces.filter(|&face| completion.rank(face) == 0).filter(is_deep).collect()
    }

    /// Puts what has openings behind all that is seen in them, where that is shorter: that something is seen through what lies around it is no
    /// more than a custom.
    fn fill(&mut self) -> bool {
        let mut is_changed = false;
        for (face, inner) in self.pierced() {
            let Some(at) = self.place(face) else { continue };
            let Some(to) = inner.iter().map(|&inner| self.place(inner)).min().flatten().filter(|&to| to < at) else {
                continue;
            };
            let mut moved = self.order.clone();
            moved.remove(at);
            moved.insert(to, face);
            let beside = &self.completion.neighbors[face as usize];
            let crossed = self.order[to..at].iter().filter(|other| beside.contains(other));
            let against = crossed.map(|&other| self.completion.order.net(face, other).max(0.0)).sum();
            is_changed |= self.is_shorter(moved, &[], against);
        }
        is_changed
    }

    /// Painted faces with the painted faces along each of their holes, where one of these is painted before.
    fn pierced(&self) -> Vec<(u32, BTreeSet<u32>)> {
        let completion = &*self.completion;
        let mut found = Vec::new();
        for face in completion.painted().into_iter().filter(|&face| completion.pens[face as usize].is_none()) {
            for hole in completion.rings[face as usize].iter().skip(1) {
                let inner: BTreeSet<u32> = hole.steps.iter().map(|step| step.other).collect();
                if inner.iter().all(|&inner| inner != OUTSIDE && completion.rank(inner) > 0)
                    && inner.iter().any(|&inner| completion.rank(inner) < completion.rank(face))
                {
                    found.push((face, inner));
                }
            }
        }
        found
    }

    /// Puts what lies between two faces of one color in front of both where they are shorter as one thing: of what is seen on both sides
    /// of something, and within its openings, no junction need be clear.
    fn unite(&mut self) -> bool {
        let mut is_changed = false;
        for (a, b, between) in self.parted() {
            if self.completion.is_spent() {
                break;
            }
            let (Some(at_a), Some(at_b), Some(at)) = (self.place(a), self.place(b), self.place(between)) else {
                continue;
            };
            // What may be one thing as it is is so without this.
            let are_one =
                join::candidates(self.completion).iter().any(|group| group.contains(&a) && group.contains(&b));
            if at > at_a && at > at_b || are_one {
                continue;
            }
            let mut moved = self.order.clone();
            moved.remove(at);
            moved.insert(at_a.max(at_b), between);
            let crossed = &self.order[at..=at_a.max(at_b)];
            let touched = self.completion.neighbors[between as usize].iter().filter(|other| crossed.contains(other));
            // Custom tells nothing where both are one thing.
            let against = touched.map(|&other| self.completion.order.net_seen(other, between).max(0.0)).sum();
            is_changed |= self.is_shorter(moved, &[(a, b)], against);
        }
        is_changed
    }

    /// Puts faces of one color at the border of the picture in front of everything, where they are shorter as one sheet with an opening.
    fn frame(&mut self) -> bool {
        let mut is_changed = false;
        for faces in self.at_border() {
            let united: Vec<(u32, u32)> = faces.windows(2).map(|pair| (pair[0], pair[1])).collect();
            if united.iter().all(|pair| self.completion.united.contains(pair)) {
                continue;
            }
            let mut moved = self.order.clone();
            moved.retain(|face| !faces.contains(face));
            moved.extend(&faces);
            let net = |other: u32, face: u32| self.completion.order.net(other, face).max(0.0);
            let behind =
                |face: u32| self.completion.neighbors[face as usize].iter().map(move |&other| net(other, face));
            let against = faces.iter().flat_map(|&face| behind(face)).sum();
            is_changed |= self.is_shorter(moved, &united, against);
        }
        is_changed
    }

    /// Several painted faces of one color at the border of the picture, for every color that has such.
    fn at_border(&self) -> Vec<Vec<u32>> {
        let completion = &*self.completion;
        let mut of_color: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
        for face in completion.painted() {
            let mut steps = completion.rings[face as usize].iter().flat_map(|ring| &ring.steps);
            if completion.pen(&[face]).is_none() && steps.any(|step| step.other == OUTSIDE) {
                of_color.entry(completion.partition.faces[face as usize].color).or_default().push(face);
            }
        }
        of_color.into_values().filter(|faces| (2..=tuning::MOST_PAIRED).contains(&faces.len())).collect()
    }

    /// Faces of one color that another one, painted before one of them, lies between: (face, face, between).
    fn parted(&self) -> Vec<(u32, u32, u32)> {
        let completion = &*self.completion;
        let apart = completion.apart();
        let is_open = |face: u32| completion.rank(face) > 0;
        let color = |face: u32| completion.partition.faces[face as usize].color;
        let mut found = Vec::new();
        for between in (0..completion.rank.len() as u32).filter(|&face| is_open(face)) {
            let around = &completion.neighbors[between as usize];
            let goes_on =
                |face: u32| is_open(face) && !apart.contains(&face) && !completion.seamed.contains(&(between, face));
            for (k, &a) in around.iter().enumerate().filter(|&(_, &a)| goes_on(a)) {
                let same = around[..k].iter().copied().filter(|&b| goes_on(b) && color(b) == color(a));
                found.extend(
                    same.filter(|&b| completion.rank(a).max(completion.rank(b)) > completion.rank(between))
                        .map(|b| (a, b, between)),
                );
            }
        }
        found
    }

    /// Bits of faces, each painted alone.
    fn bits(&mut self, faces: &[u32]) -> f64 {
        let mut sum = 0.0;
        for &face in faces {
            let rank = self.completion.rank(face);
            let mut front = self.completion.neighbors[face as usize].clone();
            front.retain(|&other| self.completion.rank(other) > rank);
            let completion = &self.completion;
            let of_face = || match completion.pen(&[face]) {
                Some(pen) => pen.bits + pen.misfit,
                None => completion.outlines(&[face]).bits,
            };
            sum += *self.known.entry((face, front)).or_insert_with(of_face);
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
        let can_hide = |&(a, b): &(u32, u32)| !self.completion.seamed.contains(&(a, b));
        pairs.retain(|pair| self.completion.neighbors[pair.0 as usize].contains(&pair.1) && can_hide(pair));
        pairs
    }
}
