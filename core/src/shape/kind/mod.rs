//! The kinds of shapes, each with its numbers, behind one trait.
//!
//! | file | kind | numbers |
//! |---|---|---|
//! | `ellipse` | [`Circle`], [`Ellipse`] | radii |
//! | `rectangle` | [`Rectangle`] | width, height, corner radius |
//! | `regular` | [`RegularPolygon`], [`Star`] | radii of the corners |
//! | `polygon` | [`Polygon`] | the corners of its rings |
//! | `path` | [`Path`], rings of lines, arcs and cubics | their points, bulges, control points and handles |
//! | `path_pieces` | from these numbers to exact pieces, smooth joins resolved | `path_pieces_vjp` |
//! | `descriptors` | elliptic Fourier descriptors, prototypes | descriptors |
//! | `cast` | every kind in another precision | |
//!
//! Circles, ellipses, rectangles, regular polygons and stars lie around the origin of their frame, first corner or axis along
//! +x: where they stand and how they are turned is the pose's to say.

mod cast;
mod descriptors;
mod ellipse;
mod path;
mod path_pieces;
mod path_pieces_vjp;
mod polygon;
mod rectangle;
mod regular;
#[cfg(test)]
mod tests;

use alloc::string::String;
use alloc::vec::Vec;

use super::curve::{Boundary, Moments};
use super::{Efd, Flattening, Outline, ShapeError};
use crate::geometry::Bounds;
use crate::real::Real;

pub use descriptors::Prototype;
pub use ellipse::{Circle, Ellipse};
pub use path::{Path, PathRing, Segment};
pub use polygon::Polygon;
pub use rectangle::Rectangle;
pub use regular::{MOST_CORNERS, RegularPolygon, Star};

/// A shape and its numbers.
///
/// The numbers are lengths and coordinates in the frame of the shape, which a [`Pose`](crate::Pose) carries to scene
/// units: with the pose that leaves every point where it is, they are scene units themselves.
pub trait Shape<T: Real> {
    /// The name of the kind, as files have it.
    fn kind(&self) -> &'static str;

    /// How many numbers change the shape.
    fn number_count(&self) -> usize;

    /// Appends the numbers, in the order of [`Self::number_names`].
    fn numbers(&self, numbers: &mut Vec<T>);

    /// The name of each number, in the order of [`Self::numbers`]: the path to it from the shape, such as `radius` or
    /// `rings[0].points[2][1]`.
    fn number_names(&self) -> Vec<String>;

    /// Takes over numbers, in the same order.
    ///
    /// # Errors
    /// [`ShapeError::Length`] if there are too few or too many, [`ShapeError::NotFinite`].
    fn set_numbers(&mut self, numbers: &[T]) -> Result<(), ShapeError>;

    /// Which parts of a pose move the shape in a way that its numbers do not.
    fn pose_freedom(&self) -> PoseFreedom;

    /// Whether the numbers are given from outside (those of a bank's prototype), so that fitting a scene leaves them.
    fn is_given(&self) -> bool {
        false
    }

    /// Appends the rings to `outline`: polygons within the tolerance of the boundary that enclose the same area.
    ///
    /// *Derivative*: [`Self::flatten_vjp`].
    ///
    /// # Errors
    /// [`ShapeError`] if the numbers describe no shape; `outline` may then hold a part of it.
    fn flatten(&self, how: &Flattening<'_, T>, outline: &mut Outline<T>) -> Result<(), ShapeError>;

    /// Adds to `grad_numbers` the gradient of sum(`grad_vertices` x vertices), vertices as [`Self::flatten`] writes them
    /// to an empty outline. Numbers of vertices are taken as constant.
    ///
    /// # Errors
    /// [`ShapeError`] as in [`Self::flatten`], and [`ShapeError::Length`] if a slice has the wrong length.
    fn flatten_vjp(
        &self,
        how: &Flattening<'_, T>,
        grad_vertices: &[[T; 2]],
        grad_numbers: &mut [T],
    ) -> Result<(), ShapeError>;

    /// The boundary as exact pieces.
    ///
    /// # Errors
    /// [`ShapeError`] if the numbers describe no shape or are not finite.
    fn boundary(&self) -> Result<Boundary<T>, ShapeError>;

    /// The descriptors of a ring of the boundary, exactly, and its center: [`Boundary::efd`].
    ///
    /// # Errors
    /// As [`Self::boundary`] and [`Boundary::efd`].
    fn efd_of_ring(&self, ring: usize, harmonic_count: usize) -> Result<(Efd<T>, [T; 2]), ShapeError> {
        self.boundary()?.efd(ring, harmonic_count)
    }

    /// The same shape as a path: [`Boundary::to_path`].
    ///
    /// # Errors
    /// As [`Self::boundary`].
    fn to_path(&self) -> Result<Path<T>, ShapeError> {
        Ok(self.boundary()?.to_path())
    }

    /// The area inside: [`Boundary::moments`].
    ///
    /// # Errors
    /// As [`Self::boundary`] and [`Boundary::moments`].
    fn area(&self) -> Result<T, ShapeError> {
        Ok(self.moments()?.area)
    }

    /// The mean position of the inside.
    ///
    /// # Errors
    /// As [`Self::area`].
    fn centroid(&self) -> Result<[T; 2], ShapeError> {
        Ok(self.moments()?.centroid)
    }

    /// Area, centroid and second moments of the inside: [`Boundary::moments`].
    ///
    /// # Errors
    /// As [`Self::area`].
    fn moments(&self) -> Result<Moments<T>, ShapeError> {
        self.boundary()?.moments()
    }

    /// The length of the boundary, of all its rings.
    ///
    /// # Errors
    /// As [`Self::boundary`].
    fn perimeter(&self) -> Result<T, ShapeError> {
        Ok(self.boundary()?.perimeter())
    }

    /// The smallest upright box around the boundary; none if the shape is empty.
    ///
    /// # Errors
    /// As [`Self::boundary`].
    fn bounds(&self) -> Result<Option<Bounds<T>>, ShapeError> {
        Ok(self.boundary()?.bounds())
    }
}

/// Which parts of a pose say something that the numbers of a shape do not: the others are left as they are when a scene
/// is fitted, or there would be two ways to say the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PoseFreedom {
    /// Where it stands.
    pub translation: bool,
    /// How large it is.
    pub scale: bool,
    /// How it is turned.
    pub rotation: bool,
}

impl PoseFreedom {
    /// Of shapes whose numbers say where they stand and how they are turned.
    pub(super) const NONE: Self = Self { translation: false, scale: false, rotation: false };
    /// Of shapes whose numbers, or whose symmetry, say how large they are and how they are turned.
    pub(super) const TRANSLATION: Self = Self { translation: true, scale: false, rotation: false };
    /// Of shapes around the origin whose numbers say how large they are.
    pub(super) const RIGID: Self = Self { translation: true, scale: false, rotation: true };
    /// Of shapes whose numbers are given.
    pub(super) const ALL: Self = Self { translation: true, scale: true, rotation: true };
}

/// Refuses a wrong number of numbers and numbers that are not finite.
pub(super) fn check_numbers<T: Real>(expected: usize, numbers: &[T]) -> Result<(), ShapeError> {
    check_length("numbers of the shape", expected, numbers.len())?;
    check_finite(numbers)
}

/// Refuses numbers that are not finite.
pub(super) fn check_finite<'a, T: Real>(numbers: impl IntoIterator<Item = &'a T>) -> Result<(), ShapeError> {
    match numbers.into_iter().position(|number| !number.is_finite()) {
        Some(index) => Err(ShapeError::NotFinite { index }),
        None => Ok(()),
    }
}

/// Refuses a wrong length.
pub(super) fn check_length(what: &'static str, expected: usize, len: usize) -> Result<(), ShapeError> {
    if len == expected { Ok(()) } else { Err(ShapeError::Length { what, expected, len }) }
}

/// Refuses a length that is not positive and finite.
fn check_positive<T: Real>(what: &'static str, length: T) -> Result<(), ShapeError> {
    if length > T::zero() && length.is_finite() { Ok(()) } else { Err(ShapeError::NotPositive { what }) }
}

/// Implements [`Shape`] for a kind with a fixed list of numbers, that has `boundary` and `boundary_vjp` of its own.
macro_rules! shape_of_numbers {
    ($kind:ident, $name:literal, $freedom:ident, $shape:ident: $($number:literal => $place:expr),+) => {
        impl<T: Real> Shape<T> for $kind<T> {
            fn kind(&self) -> &'static str {
                $name
            }

            fn number_count(&self) -> usize {
                [$($number),+].len()
            }

            fn numbers(&self, numbers: &mut Vec<T>) {
                let $shape = self;
                numbers.extend([$($place),+]);
            }

            fn number_names(&self) -> Vec<String> {
                [$($number),+].map(String::from).to_vec()
            }

            fn set_numbers(&mut self, numbers: &[T]) -> Result<(), ShapeError> {
                super::check_numbers(self.number_count(), numbers)?;
                let ($shape, mut next) = (self, numbers.iter());
                $(if let Some(&number) = next.next() {
                    $place = number;
                })+
                Ok(())
            }

            fn pose_freedom(&self) -> PoseFreedom {
                PoseFreedom::$freedom
            }

            fn flatten(&self, how: &Flattening<'_, T>, outline: &mut Outline<T>) -> Result<(), ShapeError> {
                Shape::boundary(self)?.flatten(how.tolerance, outline)
            }

            fn flatten_vjp(
                &self,
                how: &Flattening<'_, T>,
                grad_vertices: &[[T; 2]],
                grad_numbers: &mut [T],
            ) -> Result<(), ShapeError> {
                super::check_length("gradient of the numbers", self.number_count(), grad_numbers.len())?;
                let grad_pieces = Shape::boundary(self)?.flatten_vjp(how.tolerance, grad_vertices)?;
                let sums = self.boundary_vjp(&grad_pieces);
                grad_numbers.iter_mut().zip(sums).for_each(|(grad, sum)| *grad += sum);
                Ok(())
            }

            fn boundary(&self) -> Result<Boundary<T>, ShapeError> {
                let $shape = self;
                super::check_finite(&[$($place),+])?;
                $kind::boundary(self)
            }
        }
    };
}
use shape_of_numbers;
