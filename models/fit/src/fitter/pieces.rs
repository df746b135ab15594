//! Pieces of one object that another one cuts in two.
//!
//! Two regions of one color that end at the same third object may be one object that goes on behind it. They are if one
//! shape explains both outlines, and its description is shorter than that of two.

use dvp_core::Real;

use super::run::Run;
use crate::price::OBJECT_BITS;
use crate::segment::Border;

/// Channel difference of pieces of one object (two rounding errors of 8 bits).
const SAME_COLOR: f64 = 0.008;

impl<T: Real> Run<'_, T> {
    /// Joins pieces while that makes the description shorter. To be done before the order is decided.
    pub(super) fn join_pieces(&mut self) {
        let count = self.scratch.segmentation.segments().len();
        for first in 0..count {
            let mut second = first + 1;
            while second < count {
                // What was joined may be joined with more; an emptied object is no candidate any longer.
                if let Some(cover) = self.cut_by(first, second)
                    && self.are_one(first, second, cover)
                {
                    second = first;
                }
                second += 1;
            }
        }
    }

    /// The object between two pieces of one color, if it may be in front of both.
    fn cut_by(&self, first: usize, second: usize) -> Option<u32> {
        let segmentation = &self.scratch.segmentation;
        let [a, b] = [first, second].map(|index| &segmentation.segments()[index]);
        let same = (0..3).all(|c| (a.color[c] - b.color[c]).abs() <= T::of(SAME_COLOR));
        if !same || a.pixels == 0 || b.pixels == 0 {
            return None;
        }
        let [p, q] = [first, second].map(|index| u32::try_from(index).unwrap_or(u32::MAX));
        let hides = |border: &Border, object: u32, cover: u32| {
            border.front.is_none_or(|front| front == cover && front != object)
        };
        let beside = |object: u32| {
            let borders = segmentation.borders().iter();
            borders.filter_map(move |border| match border.objects {
                [x, y] if x == object && hides(border, object, y) => Some(y),
                [x, y] if y == object && hides(border, object, x) => Some(x),
                _ => None,
            })
        };
        beside(p).find(|&cover| cover != q && beside(q).any(|other| other == cover))
    }

    /// Whether one shape behind `cover` explains both pieces for fewer bits; they are joined then.
    fn are_one(&mut self, first: usize, second: usize, cover: u32) -> bool {
        let [p, q] = [first, second].map(|index| u32::try_from(index).unwrap_or(u32::MAX));
        let behind = self.part_bits(p) + self.part_bits(q);
        let around = self.bits_if_front(cover, &[p, q]);
        let in_front = self.bits_if_front(p, &[cover]) + self.bits_if_front(q, &[cover]) + self.part_bits(cover);
        let apart = OBJECT_BITS + in_front.min(behind + around);
        // The part between the pieces cannot be described for nothing.
        if around >= apart {
            return false;
        }
        let before = self.scratch.segmentation.join(p, q);
        let joined = self.part_bits(p) + around;
        if joined < apart {
            return true;
        }
        self.scratch.segmentation.part(before);
        false
    }

    /// Bits of an object if it is in front of the others given.
    fn bits_if_front(&mut self, object: u32, behind: &[u32]) -> f64 {
        let mut changed = [None; 2];
        for (slot, &other) in changed.iter_mut().zip(behind) {
            let objects = [object.min(other), object.max(other)];
            let at = self.scratch.segmentation.borders().iter().position(|border| border.objects == objects);
            *slot = at.map(|at| (at, self.scratch.segmentation.borders()[at].front));
            if let Some(at) = at {
                self.scratch.segmentation.set_front(at, Some(object));
            }
        }
        let bits = self.part_bits(object);
        for (at, front) in changed.into_iter().flatten() {
            self.scratch.segmentation.set_front(at, front);
        }
        bits
    }
}
