//! The pieces of a line that have a length.

use alloc::vec::Vec;

use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::ShapeError;
use crate::shape::curve::{End, Piece, derivatives};
use crate::shape::kind::PathRing;

/// A piece of a line along which the pen goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leg<T> {
    pub(super) piece: Piece<T>,
    /// The segment that it is; beyond the last one for a dot.
    pub(super) segment: usize,
    /// Where it leaves and arrives, of length 1.
    directions: [Vec2<T>; 2],
}

/// A place along a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum At<T> {
    /// An end of a leg.
    End(usize, End),
    /// Within a leg that is a cubic, at a parameter.
    Inside(usize, T),
}

impl<T: Real> At<T> {
    pub(super) fn leg(self) -> usize {
        let (Self::End(leg, _) | Self::Inside(leg, _)) = self;
        leg
    }
}

/// Where the pen is and which way it goes, by a vector of length 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame<T> {
    pub(super) point: Vec2<T>,
    pub(super) direction: Vec2<T>,
}

impl<T: Real> Frame<T> {
    /// To the side to which +x turns to +y.
    pub(super) fn normal(&self) -> Vec2<T> {
        self.direction.perp()
    }
}

impl<T: Real> Leg<T> {
    /// Where the pen is at an end or, within a cubic, at a parameter where its speed is not zero.
    pub(super) fn frame(&self, at: At<T>) -> Frame<T> {
        match (at, self.piece) {
            (At::Inside(_, t), Piece::Cubic(points)) => {
                let [point, first, _] = derivatives(&points, t);
                Frame { point, direction: first.normalized().unwrap_or_default() }
            }
            (At::End(_, End::Start) | At::Inside(..), piece) => {
                Frame { point: piece.from(), direction: self.directions[0] }
            }
            (At::End(_, End::Finish), piece) => Frame { point: piece.to(), direction: self.directions[1] },
        }
    }
}

/// Appends the legs of a line: of a line without length a dot that points to +x. Returns whether it is closed.
pub(super) fn legs_of<T: Real>(ring: &PathRing<T>, legs: &mut Vec<Leg<T>>) -> Result<bool, ShapeError> {
    let mut pieces = Vec::new();
    ring.pieces(&mut pieces)?;
    let first = legs.len();
    for (segment, piece) in pieces.into_iter().enumerate() {
        if let (Some(start), Some(finish)) = (piece.direction(End::Start), piece.direction(End::Finish)) {
            legs.push(Leg { piece, segment, directions: [start, finish] });
        }
    }
    match ring.points.first() {
        Some(&point) if legs.len() == first => {
            let (from, direction) = (Vec2::from(point), Vec2::new(T::one(), T::zero()));
            let piece = Piece::Line { from, to: from };
            legs.push(Leg { piece, segment: usize::MAX, directions: [direction; 2] });
            Ok(false)
        }
        _ => Ok(ring.is_closed()),
    }
}
