//! A contour whose hidden stretches are walked along carried ones.

use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::geometry::Similarity;

use super::{AGREES_PX, POINTS, Seen};

impl<T: Real> Seen<'_, T> {
    /// The contour, hidden stretches walked along carried ones; none where that leads to no end.
    pub(super) fn walk(&self, motions: &[Similarity<T>]) -> Option<Vec<[T; 2]>> {
        let start = (0..POINTS).find(|&i| self.shows[i] && !self.shows[(i + POINTS - 1) % POINTS])?;
        let mut out = Vec::with_capacity(2 * POINTS);
        let mut at = start;
        loop {
            out.push(self.points[at]);
            let next = (at + 1) % POINTS;
            if next == start {
                return Some(out);
            }
            if self.shows[next] {
                at = next;
                continue;
            }
            // The next seen point ends the gap.
            let end = (1..=POINTS).map(|i| (at + i) % POINTS).find(|&i| self.shows[i])?;
            self.fill(at, end, motions, &mut out)?;
            if end == start {
                return Some(out);
            }
            at = end;
        }
    }

    /// Walks from one seen point to another along carried stretches.
    fn fill(&self, from: usize, end: usize, motions: &[Similarity<T>], out: &mut Vec<[T; 2]>) -> Option<()> {
        let goal = self.points[end];
        let close = |a: [T; 2], reach: T| (a[0] - goal[0]).hypot(a[1] - goal[1]) < reach;
        let mut here = self.points[from];
        let first = out.len();
        // As long as the whole contour twice over is long enough.
        while out.len() < first + 2 * POINTS {
            let ahead = motions.iter().filter_map(|motion| self.ahead(motion, here));
            let ahead = ahead.max_by_key(|ahead| ahead.length)?;
            for i in 0..ahead.length {
                let source = (ahead.first + if ahead.backward { POINTS - i } else { i }) % POINTS;
                here = ahead.motion.point(self.points[source].into()).to_array();
                // The last step may be one and a half.
                if close(here, self.spacing * T::of(1.2)) {
                    return Some(());
                }
                if !(self.allows)(here) {
                    return None;
                }
                out.push(here);
            }
        }
        None
    }

    /// The stretch that the motion carries to where the point is; none if that is not the contour.
    fn ahead<'b>(&self, motion: &'b Similarity<T>, point: [T; 2]) -> Option<Ahead<'b, T>> {
        let (.., before) =
            self.nearest(motion.inverse()?.point(point.into())).filter(|near| near.0.abs() < T::of(AGREES_PX))?;
        let backward = motion.reflected;
        let first = if backward { before } else { (before + 1) % POINTS };
        let at = |i: usize| (first + if backward { POINTS - i } else { i }) % POINTS;
        let length = (0..POINTS).take_while(|&i| self.shows[at(i)]).count();
        // The first may be the point itself.
        (length > 1).then_some(Ahead { motion, first, length, backward })
    }
}

/// A seen stretch and what carries it.
struct Ahead<'a, T> {
    motion: &'a Similarity<T>,
    first: usize,
    length: usize,
    /// Reflections run the other way.
    backward: bool,
}
