//! Straight segments, and the point of one that is nearest to a given point.

use super::Vec2;
use crate::real::Real;

/// A directed segment, with what the nearest point needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineSegment<T> {
    /// Where it starts.
    pub from: Vec2<T>,
    /// From its start to its end.
    pub along: Vec2<T>,
    /// 1 / length^2; 0 for a segment without length, whose nearest point is its start.
    pub inverse_squared: T,
}

/// The point of a segment nearest to a given point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest<T> {
    /// Its position along the segment, [0, 1].
    pub share: T,
    /// From it to the given point.
    pub offset: Vec2<T>,
}

impl<T: Real> LineSegment<T> {
    /// The segment between two points. Lengths whose square is no normal number count as 0.
    #[inline(always)]
    #[must_use]
    pub fn new(from: Vec2<T>, to: Vec2<T>) -> Self {
        let along = to - from;
        let squared = along.length_squared();
        let inverse_squared = if squared > T::min_positive_value() { T::one() / squared } else { T::zero() };
        Self { from, along, inverse_squared }
    }

    /// The nearest point. The derivative of the distance is the direction of `offset`; `share` needs none, for the
    /// distance is at its minimum over it or it is at an end.
    #[inline(always)]
    #[must_use]
    pub fn nearest(&self, point: Vec2<T>) -> Nearest<T> {
        let (zero, one) = (T::zero(), T::one());
        let arm = point - self.from;
        // Comparisons rather than `min` and `max`: they become single instructions in loops over lanes.
        let share = arm.dot(self.along) * self.inverse_squared;
        let share = if share > zero { share } else { zero };
        let share = if share < one { share } else { one };
        Nearest { share, offset: arm - self.along * share }
    }

    /// The segments of a polygon, closed by the one from its last vertex to its first.
    pub fn closed(vertices: &[[T; 2]]) -> impl Iterator<Item = Self> + Clone {
        let ends = vertices.iter().skip(1).chain(vertices.first());
        vertices.iter().zip(ends).map(|(&from, &to)| Self::new(from.into(), to.into()))
    }
}

impl<T: Real> Nearest<T> {
    /// The squared distance.
    #[inline(always)]
    #[must_use]
    pub fn distance_squared(&self) -> T {
        self.offset.length_squared()
    }

    /// The distance.
    #[inline(always)]
    #[must_use]
    pub fn distance(&self) -> T {
        self.offset.length()
    }
}
