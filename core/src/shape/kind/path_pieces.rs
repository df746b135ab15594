//! From the numbers of a ring to exact pieces: smooth segments take their direction from the one before them.

use alloc::vec::Vec;

use super::path::{PathRing, Segment};
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::ShapeError;
use crate::shape::curve::{End, Piece};

impl<T: Real> PathRing<T> {
    /// Appends the pieces of the segments.
    ///
    /// # Errors
    /// As [`Self::order`].
    pub(in crate::shape) fn pieces(&self, pieces: &mut Vec<Piece<T>>) -> Result<(), ShapeError> {
        let first = pieces.len();
        let (mut before, order) = self.order()?;
        pieces.extend((0..self.segments.len()).map(|k| self.piece(k, before)));
        for k in order {
            let piece = self.piece(k, before);
            before = piece.direction(End::Finish).unwrap_or(before);
            pieces[first + k] = piece;
        }
        Ok(())
    }

    /// An order of the segments in which each comes after the one whose direction it may need, and the direction in which
    /// the one before the first arrives.
    ///
    /// # Errors
    /// [`ShapeError::Length`] if there are neither as many segments as points nor one less, [`ShapeError::NoDirection`] if an open
    /// ring begins with a smooth segment, or smooth segments wait for each other all around a closed one.
    pub(super) fn order(
        &self,
    ) -> Result<(Vec2<T>, impl DoubleEndedIterator<Item = usize> + Clone + use<T>), ShapeError> {
        let (points, count) = (self.points.len(), self.segments.len());
        if count != points && count + 1 != points {
            return Err(ShapeError::Length { what: "segments of a ring", expected: points, len: count });
        }
        let mut settled = None;
        if !self.segments.iter().any(Segment::is_smooth) {
            settled = Some((Vec2::default(), 0));
        } else if self.is_closed() {
            settled = (0..count).find_map(|k| Some((self.settled_arrival(k)?, k + 1)));
        } else if !self.segments[0].is_smooth() {
            settled = Some((Vec2::new(T::one(), T::zero()), 0));
        }
        let (before, first) = settled.ok_or(ShapeError::NoDirection)?;
        Ok((before, (first..count).chain(0..first)))
    }

    /// The direction in which segment `k` arrives, if the one before it has no part in it.
    fn settled_arrival(&self, k: usize) -> Option<Vec2<T>> {
        match self.segments[k] {
            Segment::SmoothArc => None,
            Segment::SmoothCubic { control, .. } => (self.ends(k)[1] - control.into()).normalized(),
            _ => self.piece(k, Vec2::default()).direction(End::Finish),
        }
    }

    /// Where segment `k` starts and ends.
    fn ends(&self, k: usize) -> [Vec2<T>; 2] {
        self.end_points(k).map(|point| self.points[point].into())
    }

    /// The points at which segment `k` starts and ends.
    pub(super) fn end_points(&self, k: usize) -> [usize; 2] {
        [k, if k + 1 < self.points.len() { k + 1 } else { 0 }]
    }

    /// Segment `k`, given the direction in which the one before it arrives.
    pub(super) fn piece(&self, k: usize, before: Vec2<T>) -> Piece<T> {
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
}

/// The bulge of the arc that leaves in the direction `before` and ends a `chord` further: tan(angle / 2), the angle that
/// from `before` to the chord. 0, a straight line back, where the chord points exactly backward and no circle leads there.
fn smooth_bulge<T: Real>(before: Vec2<T>, chord: Vec2<T>) -> T {
    let (cross, divisor) = (before.cross(chord), bulge_divisor(before, chord));
    if divisor > T::zero() { cross / divisor } else { T::zero() }
}

/// The divisor of [`smooth_bulge`], held away from 0.
pub(super) fn bulge_divisor<T: Real>(before: Vec2<T>, chord: Vec2<T>) -> T {
    let length = chord.length();
    (length + before.dot(chord)).max(length * T::of(LEAST_DIVISOR))
}

/// Least divisor of [`smooth_bulge`] per length of the chord: the bulge is at most about 10^3, with a circle that is 250 times
/// as large as the chord, and nothing overflows in f32.
pub(super) const LEAST_DIVISOR: f64 = 1e-6;
