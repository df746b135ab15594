//! Where two pieces meet, and where a line ends.

use alloc::vec::Vec;

use super::leg::At;
use super::place::{Source, Turn};
use super::walk::{Side, Walker};
use super::{Cap, Join};
use crate::real::Real;
use crate::shape::curve::{End, edges_of_length};

impl<T: Real> Walker<'_, T> {
    /// The join where the pen arrives at `before` and leaves from `after`; their sides are in the chains already, or come next.
    pub(super) fn corner(&mut self, before: At<T>, after: At<T>) {
        self.corner_joined(before, after, self.join);
    }

    /// As [`Self::corner`], whatever the stroke's joins are.
    pub(super) fn corner_joined(&mut self, before: At<T>, after: At<T>, join: Join<T>) {
        let [arrives, leaves] = [before, after].map(|at| self.frame(at).direction);
        let angle = arrives.cross(leaves).atan2(arrives.dot(leaves));
        if angle.abs() <= T::epsilon().sqrt() {
            return;
        }
        let inner: Side = if angle > T::zero() { 1 } else { -1 };
        let outer = -inner;
        if [before, after].into_iter().all(|at| self.has_room(at, angle)) {
            self.tip(before, after, inner);
        } else {
            self.add_to(inner, Source::Offset { at: before, across: 0, along: 0 });
        }
        match join {
            Join::Bevel => {}
            Join::Round => {
                let count = edges_of_length(self.half * angle.abs(), angle.abs(), self.tolerance);
                for step in 1..count {
                    let turn = Turn::To(after);
                    self.add_to(outer, Source::Round { from: before, side: outer, turn, step, count });
                }
            }
            Join::Miter { limit } => {
                // The tip is half the width / cos(angle / 2) from the corner, and the whole miter the width per that cosine.
                let cos_squared = (T::one() + arrives.dot(leaves)) * T::of(0.5);
                if cos_squared * limit * limit >= T::one() {
                    self.tip(before, after, outer);
                }
            }
        }
    }

    /// Whether a ring may go by way of the tip on the inner side of a corner, where the direction turns by `angle`, instead of the
    /// corner itself. It then leaves out the kite that the strips of two lines have in common, half of which lies on each. Every point
    /// stays covered if no point is in two kites of one line: if they reach no further than the middle of it.
    fn has_room(&self, at: At<T>, angle: T) -> bool {
        let reach = self.half * angle.sin().abs().max((angle * T::of(0.5)).tan().abs());
        self.is_straight(at.leg()) && self.legs[at.leg()].piece.length() >= T::of(2.0) * reach
    }

    /// The vertex where the lines beside two pieces meet, in place of the ends of those that are straight.
    fn tip(&mut self, before: At<T>, after: At<T>, side: Side) {
        let chain = usize::from(side > 0);
        if self.is_straight(before.leg()) {
            self.chains[chain].pop();
        }
        self.has_tip[chain] = true;
        self.add_to(side, Source::Tip { before, after, side });
    }

    /// The vertices around an end of a line, from one side to the other.
    pub(super) fn cap(&mut self, cap: Cap, at: At<T>) -> Vec<usize> {
        let finish = matches!(at, At::End(_, End::Finish));
        // The ring comes along the side -1 and goes back along the side 1.
        let side: Side = if finish { -1 } else { 1 };
        match cap {
            Cap::Butt => Vec::new(),
            Cap::Square => {
                let corner = |across| Source::Offset { at, across, along: -side };
                [corner(side), corner(-side)].map(|source| self.add(source)).to_vec()
            }
            Cap::Round => {
                let angle = T::of(core::f64::consts::PI);
                let count = edges_of_length(self.half * angle, angle, self.tolerance);
                let vertices = (1..count).map(|step| Source::Round { from: at, side, turn: Turn::Half, step, count });
                vertices.collect::<Vec<_>>().into_iter().map(|source| self.add(source)).collect()
            }
        }
    }
}
