//! Regular polygons and stars around the origin.

use alloc::string::String;
use alloc::vec::Vec;

use super::{PoseFreedom, Shape, check_positive, shape_of_numbers};
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::curve::{Boundary, PieceGrad};
use crate::shape::{Flattening, Outline, ShapeError};

/// Most corners of a regular polygon and points of a star.
pub const MOST_CORNERS: usize = 4096;

/// A polygon of equal sides and angles around the origin, its first corner on +x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegularPolygon<T> {
    /// Number of sides, 3 to [`MOST_CORNERS`].
    pub sides: usize,
    /// From the center to the corners.
    pub radius: T,
}

/// A star around the origin: corners on two circles by turns, its first point on +x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Star<T> {
    /// Number of points, 3 to [`MOST_CORNERS`].
    pub points: usize,
    /// From the center to the points.
    pub radius: T,
    /// From the center to the corners between the points.
    pub inner_radius: T,
}

impl<T: Real> RegularPolygon<T> {
    /// A regular polygon.
    ///
    /// # Errors
    /// [`ShapeError::Corners`], [`ShapeError::NotPositive`].
    pub fn new(sides: usize, radius: T) -> Result<Self, ShapeError> {
        check_corners("sides", sides)?;
        check_positive("radius", radius)?;
        Ok(Self { sides, radius })
    }

    fn boundary(&self) -> Result<Boundary<T>, ShapeError> {
        check_corners("sides", self.sides)?;
        let mut boundary = Boundary::default();
        boundary.push_polygon(&directions(self.sides).map(|direction| direction * self.radius).collect::<Vec<_>>());
        Ok(boundary)
    }

    fn boundary_vjp(&self, grads: &[PieceGrad<T>]) -> [T; 1] {
        [directions(self.sides).zip(grads).map(|(direction, grad)| direction.dot(grad.points[0])).sum()]
    }
}

impl<T: Real> Star<T> {
    /// A star.
    ///
    /// # Errors
    /// [`ShapeError::Corners`], [`ShapeError::NotPositive`].
    pub fn new(points: usize, radius: T, inner_radius: T) -> Result<Self, ShapeError> {
        check_corners("points", points)?;
        check_positive("radius", radius)?;
        check_positive("inner radius", inner_radius)?;
        Ok(Self { points, radius, inner_radius })
    }

    fn boundary(&self) -> Result<Boundary<T>, ShapeError> {
        check_corners("points", self.points)?;
        let mut boundary = Boundary::default();
        let radii = [self.radius, self.inner_radius].into_iter().cycle();
        let corners = directions(2 * self.points).zip(radii).map(|(direction, radius)| direction * radius);
        boundary.push_polygon(&corners.collect::<Vec<_>>());
        Ok(boundary)
    }

    fn boundary_vjp(&self, grads: &[PieceGrad<T>]) -> [T; 2] {
        let mut sums = [T::zero(); 2];
        for (k, (direction, grad)) in directions(2 * self.points).zip(grads).enumerate() {
            sums[k % 2] += direction.dot(grad.points[0]);
        }
        sums
    }
}

/// The directions of `count` corners, the first one +x.
fn directions<T: Real>(count: usize) -> impl Iterator<Item = Vec2<T>> {
    let angle = core::f64::consts::TAU / f64::of_usize(count);
    (0..count).map(move |k| {
        let direction = Vec2::<f64>::from_angle(angle * f64::of_usize(k));
        Vec2::new(T::of(direction.x), T::of(direction.y))
    })
}

fn check_corners(what: &'static str, count: usize) -> Result<(), ShapeError> {
    if (3..=MOST_CORNERS).contains(&count) { Ok(()) } else { Err(ShapeError::Corners { what, count }) }
}

shape_of_numbers!(RegularPolygon, "regular_polygon", RIGID, polygon: "radius" => polygon.radius);
shape_of_numbers!(Star, "star", RIGID, star: "radius" => star.radius, "inner_radius" => star.inner_radius);
