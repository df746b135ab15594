//! The directions in which pieces leave and arrive.

use super::{Piece, sweep};
use crate::geometry::Vec2;
use crate::real::Real;

/// One of the two ends of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    Start,
    Finish,
}

impl End {
    /// 1 at the finish, -1 at the start.
    pub(super) fn sign<T: Real>(self) -> T {
        if self == Self::Finish { T::one() } else { -T::one() }
    }
}

impl<T: Real> Piece<T> {
    /// The direction of travel at an end, of length 1; none if the piece has no length, and for ellipses. *Derivative*:
    /// [`Self::direction_vjp`].
    pub(crate) fn direction(&self, end: End) -> Option<Vec2<T>> {
        let (vector, _) = self.leading(end)?;
        let direction = vector.normalized()?;
        match *self {
            Self::Arc { bulge, .. } => Some(direction.turned(half_turn(bulge, end))),
            _ => Some(direction),
        }
    }

    /// The vector that has the direction at an end, for an arc its chord, and the two points of the piece between which it runs.
    pub(super) fn leading(&self, end: End) -> Option<(Vec2<T>, [usize; 2])> {
        let vector = match *self {
            Self::Line { from, to } | Self::Arc { from, to, .. } => (to - from, [0, 1]),
            Self::Ellipse { .. } => return None,
            Self::Cubic(points) => {
                // The control point next to the end, or the next one if it coincides with the end.
                let between = match end {
                    End::Start => [[0, 1], [0, 2], [0, 3]],
                    End::Finish => [[2, 3], [1, 3], [0, 3]],
                };
                let vectors = between.map(|[from, to]| (points[to] - points[from], [from, to]));
                vectors.into_iter().find(|(vector, _)| vector.length() > T::zero())?
            }
        };
        Some(vector)
    }
}

/// From the chord of an arc to its direction at an end: half the sweep back, or on.
pub(super) fn half_turn<T: Real>(bulge: T, end: End) -> Vec2<T> {
    Vec2::from_angle(end.sign::<T>() * sweep(bulge) * T::of(0.5))
}
