//! Pieces of one object that another one cuts in two.
//!
//! Two regions of one color that end at the same third object may be one object that goes on behind it. They are if one
//! shape explains both outlines, and its description is shorter than that of two.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Real;

use super::run::Run;
use crate::segment::color::may_be_same;
use crate::tuning::MIXED_ORDER_BITS;

/// Most pieces that are tried together.
const MOST_PIECES: usize = 8;

/// Bits that are known: of an object, in front at the borders that are named. Objects that are joined have others, and so what lies beside them.
type Known = Vec<((u32, Vec<usize>), f64)>;

impl<T: Real> Run<'_, T> {
    /// Joins pieces while that makes the description shorter. To be done before the order is decided.
    #[expect(clippy::cast_possible_truncation, reason = "objects are numbered in u32")]
    pub(super) fn join_pieces(&mut self) {
        let count = self.scratch.segmentation.segments().len() as u32;
        let mut known = Known::new();
        for first in 0..count {
            // All that may belong together, else pairs of it.
            let group = self.pieces_of(first);
            if group.len() < 2 || self.are_one(&group, &mut known) {
                continue;
            }
            for &second in &group[1..] {
                let pair = [first, second];
                if group.len() > 2 && !self.covers_of(&pair, 2).is_empty() {
                    self.are_one(&pair, &mut known);
                }
            }
        }
    }

    /// The object and the later ones of its color that may be its pieces: a third object lies between each of them and
    /// another one.
    #[expect(clippy::cast_possible_truncation, reason = "objects are numbered in u32")]
    fn pieces_of(&self, first: u32) -> Vec<u32> {
        let segments = self.scratch.segmentation.segments();
        let whole = &segments[first as usize];
        let mut group = vec![first];
        if whole.pixels == 0 || self.covers_of(&group, 1).is_empty() {
            return group;
        }
        let same = |other: u32| {
            let part = &segments[other as usize];
            part.pixels > 0 && may_be_same((whole.color, whole.doubt), (part.color, part.doubt))
        };
        let mut open: Vec<u32> = (first + 1..segments.len() as u32).filter(|&other| same(other)).collect();
        while group.len() < MOST_PIECES {
            let covers = self.covers_of(&group, 1);
            let next = open.iter().position(|&other| self.covers_of(&[other], 1).iter().any(|c| covers.contains(c)));
            let Some(at) = next else { break };
            group.push(open.remove(at));
        }
        group
    }

    /// Objects that may be in front of at least `least` of the pieces.
    fn covers_of(&self, pieces: &[u32], least: usize) -> Vec<u32> {
        let mut seen: Vec<(u32, usize)> = Vec::new();
        for border in self.scratch.segmentation.borders() {
            let [a, b] = border.objects;
            for (piece, cover) in [(a, b), (b, a)] {
                if pieces.contains(&piece)
                    && !pieces.contains(&cover)
                    && border.front.is_none_or(|front| front == cover)
                {
                    match seen.iter_mut().find(|(object, _)| *object == cover) {
                        Some((_, count)) => *count += 1,
                        None => seen.push((cover, 1)),
                    }
                }
            }
        }
        seen.into_iter().filter(|&(_, count)| count >= least).map(|(object, _)| object).collect()
    }

    /// Whether one shape that goes on behind what lies between explains all pieces for fewer bits; they are joined then.
    fn are_one(&mut self, pieces: &[u32], known: &mut Known) -> bool {
        let covers = self.covers_of(pieces, 2);
        if covers.is_empty() {
            return false;
        }
        let around = self.bits_around(&covers, pieces, known);
        // Pieces on their own may be behind all covers, in front of all, or each where it fits best.
        let (mut front, mut apart) = (Vec::new(), [0.0; 3]);
        for &piece in pieces {
            let behind = [self.bits_if_front(piece, &[], known), self.bits_around(&covers, &[piece], known)];
            let before = [self.bits_if_front(piece, &covers, known), self.bits_around(&covers, &[], known)];
            apart[0] += behind[0];
            apart[1] += before[0];
            if before[0] + before[1] < behind[0] + behind[1] {
                front.push(piece);
                apart[2] += before[0];
            } else {
                apart[2] += behind[0];
            }
        }
        let behind: Vec<u32> = pieces.iter().copied().filter(|piece| !front.contains(piece)).collect();
        apart[0] += around;
        apart[1] += self.bits_around(&covers, &[], known);
        apart[2] += self.bits_around(&covers, &behind, known) + MIXED_ORDER_BITS;
        let others = f64::from(u32::try_from(pieces.len() - 1).unwrap_or(u32::MAX));
        let apart = self.fitter.options.prices.object_bits() * others + apart.into_iter().fold(f64::INFINITY, f64::min);
        let before = self.scratch.segmentation.join(pieces);
        let joined = self.part_bits(pieces[0]) + around;
        if joined < apart {
            known.clear();
            return true;
        }
        self.scratch.segmentation.part(before);
        false
    }

    /// Bits of the covers if they are in front of the pieces given.
    fn bits_around(&mut self, covers: &[u32], pieces: &[u32], known: &mut Known) -> f64 {
        covers.iter().map(|&cover| self.bits_if_front(cover, pieces, known)).sum()
    }

    /// Bits of an object if it is in front of the others given.
    fn bits_if_front(&mut self, object: u32, behind: &[u32], known: &mut Known) -> f64 {
        let pair = |other: u32| [object.min(other), object.max(other)];
        let borders = self.scratch.segmentation.borders();
        let at = |&other: &u32| borders.iter().position(|border| border.objects == pair(other));
        let mut changed: Vec<usize> = behind.iter().filter_map(at).collect();
        changed.sort_unstable();
        let fronts: Vec<_> = changed.iter().map(|&at| borders[at].front).collect();
        let key = (object, changed);
        if let Some((_, bits)) = known.iter().find(|(of, _)| *of == key) {
            return *bits;
        }
        key.1.iter().for_each(|&at| self.scratch.segmentation.set_front(at, Some(object)));
        let bits = self.part_bits(object);
        key.1.iter().zip(fronts).for_each(|(&at, front)| self.scratch.segmentation.set_front(at, front));
        known.push((key, bits));
        bits
    }
}
