//! Upright boxes around points.

use super::Vec2;
use crate::real::Real;

/// The smallest upright box around some points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds<T> {
    /// Least x and least y.
    pub min: Vec2<T>,
    /// Greatest x and greatest y.
    pub max: Vec2<T>,
}

impl<T: Real> Bounds<T> {
    /// The box around `points`; none if there are none.
    #[must_use]
    pub fn of(points: impl IntoIterator<Item = Vec2<T>>) -> Option<Self> {
        let mut points = points.into_iter();
        let first = points.next()?;
        let mut bounds = Self { min: first, max: first };
        points.for_each(|point| bounds.include(point));
        Some(bounds)
    }

    /// The box around the vertices of an outline; none if there are none.
    #[must_use]
    pub fn of_vertices(vertices: &[[T; 2]]) -> Option<Self> {
        Self::of(vertices.iter().map(|&vertex| Vec2::from(vertex)))
    }

    /// Whether two boxes, one of them grown by `margin` on every side, have a point in common; boxes that touch have one.
    #[must_use]
    pub fn meets(&self, other: &Self, margin: T) -> bool {
        self.min.x <= other.max.x + margin
            && other.min.x <= self.max.x + margin
            && self.min.y <= other.max.y + margin
            && other.min.y <= self.max.y + margin
    }

    /// Grows the box until `point` is inside.
    pub fn include(&mut self, point: Vec2<T>) {
        self.min = Vec2::new(self.min.x.min(point.x), self.min.y.min(point.y));
        self.max = Vec2::new(self.max.x.max(point.x), self.max.y.max(point.y));
    }

    /// Width and height.
    #[must_use]
    pub fn size(&self) -> Vec2<T> {
        self.max - self.min
    }

    /// The middle of the box.
    #[must_use]
    pub fn center(&self) -> Vec2<T> {
        self.min.lerp(self.max, T::of(0.5))
    }
}
