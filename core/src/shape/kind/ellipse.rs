//! Circles and ellipses around the origin.

use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use super::{PoseFreedom, Shape, check_positive, shape_of_numbers};
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::curve::{Boundary, Piece, PieceGrad};
use crate::shape::{Flattening, Outline, ShapeError};

/// A disk around the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle<T> {
    /// From the center to the boundary.
    pub radius: T,
}

/// An ellipse around the origin, its axes along x and y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse<T> {
    /// Half the axis along x, half the axis along y.
    pub radii: [T; 2],
}

impl<T: Real> Circle<T> {
    /// A disk.
    ///
    /// # Errors
    /// [`ShapeError::NotPositive`].
    pub fn new(radius: T) -> Result<Self, ShapeError> {
        check_positive("radius", radius)?;
        Ok(Self { radius })
    }

    fn boundary(&self) -> Result<Boundary<T>, ShapeError> {
        Ellipse { radii: [self.radius; 2] }.boundary()
    }

    fn boundary_vjp(&self, grads: &[PieceGrad<T>]) -> [T; 1] {
        let [x, y] = Ellipse { radii: [self.radius; 2] }.boundary_vjp(grads);
        [x + y]
    }
}

impl<T: Real> Ellipse<T> {
    /// An ellipse.
    ///
    /// # Errors
    /// [`ShapeError::NotPositive`].
    pub fn new(radii: [T; 2]) -> Result<Self, ShapeError> {
        radii.into_iter().try_for_each(|radius| check_positive("radius", radius))?;
        Ok(Self { radii })
    }

    fn boundary(&self) -> Result<Boundary<T>, ShapeError> {
        let zero = T::zero();
        let axes = [Vec2::new(self.radii[0], zero), Vec2::new(zero, self.radii[1])];
        Ok(Boundary { pieces: vec![Piece::Ellipse { center: Vec2::default(), axes }], ..Boundary::default() })
    }

    fn boundary_vjp(&self, grads: &[PieceGrad<T>]) -> [T; 2] {
        grads.iter().fold([T::zero(); 2], |[x, y], grad| [x + grad.points[1].x, y + grad.points[2].y])
    }
}

shape_of_numbers!(Circle, "circle", TRANSLATION, circle: "radius" => circle.radius);
shape_of_numbers!(Ellipse, "ellipse", RIGID, ellipse: "radii[0]" => ellipse.radii[0], "radii[1]" => ellipse.radii[1]);
