//! From the numbers of a ring to exact pieces: smooth segments take their direction from the one before them.

use alloc::vec::Vec;

use super::path::{PathRing, Segment};
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::ShapeError;
use crate::shape::curve::{Piece, sweep};

impl<T: Real> PathRing<T> {
    /// Appends the pieces of the segments.
    ///
    /// # Errors
    /// As [`Self::order`].
    pub(in crate::shape) fn pieces(&self, pieces: &mut Vec<Piece<T>>) -> Result<(), ShapeError> {
        let first = pieces.len();
        let (mut before, order) = self.order()?;
        pieces.extend(self.points.iter().take(self.segments.len()).map(|&point| {
            let from = Vec2::from(point);
            Piece::Line { from, to: from }
        }));
        for k in order {
            pieces[first + k] = self.piece(k, before);
            before = self.arrival(k, before);
        }
        Ok(())
    }

    /// An order of the segments in which each comes after the one whose direction it may need, and the direction in which
    /// the one before the first arrives.
    ///
    /// # Errors
    /// [`ShapeError::Length`] if there are neither as many segments as points nor one less, [`ShapeError::NoDirection`] if an open
    /// ring begins with a smooth segment, or smooth arcs wait for each other all around a closed one.
    pub(super) fn order(
        &self,
    ) -> Result<(Vec2<T>, impl DoubleEndedIterator<Item = usize> + Clone + use<T>), ShapeError> {
        let (points, count) = (self.points.len(), self.segments.len());
        if count != points && count + 1 != points {
            return Err(ShapeError::Length { what: "segments of a ring", expected: points, len: count });
        }
        let is_smooth = |k: usize| matches!(self.segments[k], Segment::SmoothArc | Segment::SmoothCubic { .. });
        if !self.is_closed() {
            if count > 0 && is_smooth(0) {
                return Err(ShapeError::NoDirection);
            }
            return Ok((Vec2::default(), (0..count).chain(0..0)));
        }
        let settled = self.segments.iter().position(|segment| *segment != Segment::SmoothArc);
        match settled {
            Some(k) => Ok((self.arrival(k, Vec2::default()), (k + 1..count).chain(0..k + 1))),
            None if count == 0 => Ok((Vec2::default(), (0..0).chain(0..0))),
            None => Err(ShapeError::NoDirection),
        }
    }

    /// Where segment `k` starts and ends.
    pub(super) fn ends(&self, k: usize) -> [Vec2<T>; 2] {
        let next = if k + 1 < self.points.len() { k + 1 } else { 0 };
        [self.points[k], self.points[next]].map(Vec2::from)
    }

    fn piece(&self, k: usize, before: Vec2<T>) -> Piece<T> {
        let [from, to] = self.ends(k);
        match self.segments[k] {
            Segment::Line => Piece::Line { from, to },
            Segment::Arc { bulge } => Piece::Arc { from, to, bulge },
            Segment::SmoothArc => Piece::Arc { from, to, bulge: smooth_bulge(before, to - from) },
            Segment::Cubic { controls } => Piece::Cubic([from, controls[0].into(), controls[1].into(), to]),
            Segment::SmoothCubic { handle, control } => {
                Piece::Cubic([from, from + before * handle, control.into(), to])
            }
        }
    }

    /// The direction in which segment `k` arrives, given that of the one before it.
    pub(super) fn arrival(&self, k: usize, before: Vec2<T>) -> Vec2<T> {
        let direction = self.arriving(k);
        match self.segments[k] {
            Segment::Arc { bulge } => direction.turned(Vec2::from_angle(sweep(bulge) * T::of(0.5))),
            // The directions at both ends of an arc are mirror images.
            Segment::SmoothArc => direction * (T::of(2.0) * before.dot(direction)) - before,
            _ => direction,
        }
    }

    /// The vectors whose directions decide in which direction segment `k` arrives; the first that is not zero does.
    pub(super) fn approaches(&self, k: usize) -> [Vec2<T>; 3] {
        let [from, to] = self.ends(k);
        let chord = to - from;
        match self.segments[k] {
            Segment::Cubic { controls: [first, second] } => [to - second.into(), to - first.into(), chord],
            Segment::SmoothCubic { control, .. } => [to - control.into(), chord, chord],
            _ => [chord; 3],
        }
    }

    /// The direction of the first of [`Self::approaches`] that is not zero; +x if all are.
    pub(super) fn arriving(&self, k: usize) -> Vec2<T> {
        let direction = self.approaches(k).into_iter().find_map(Vec2::normalized);
        direction.unwrap_or(Vec2::new(T::one(), T::zero()))
    }
}

/// The bulge of the arc that leaves in the direction `before` and ends a `chord` further: tan(angle / 2), the angle that
/// from `before` to the chord. 0, a straight line back, where the chord points exactly backward and no circle leads there.
fn smooth_bulge<T: Real>(before: Vec2<T>, chord: Vec2<T>) -> T {
    let (cross, sum) = (before.cross(chord), bulge_divisor(before, chord));
    if sum > T::zero() { cross / sum } else { T::zero() }
}

/// The divisor of [`smooth_bulge`], held away from 0.
pub(super) fn bulge_divisor<T: Real>(before: Vec2<T>, chord: Vec2<T>) -> T {
    let length = chord.length();
    (length + before.dot(chord)).max(length * T::of(LEAST_DIVISOR))
}

/// Least divisor of [`smooth_bulge`] per length of the chord: the bulge is at most about 10^3, with a circle that is 250 times
/// as large as the chord, and nothing overflows in f32.
pub(super) const LEAST_DIVISOR: f64 = 1e-6;
