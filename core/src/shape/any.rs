//! A shape of any kind: the enum that scenes hold.

use alloc::string::String;
use alloc::vec::Vec;

use super::curve::Boundary;
use super::kind::{Circle, Ellipse, Path, Polygon, PoseFreedom, Prototype, Rectangle, RegularPolygon, Shape, Star};
use super::{Efd, Flattening, Outline, ShapeError, Stroke};
use crate::real::Real;

/// A shape of any kind.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum AnyShape<T> {
    /// A disk.
    Circle(Circle<T>),
    /// An ellipse.
    Ellipse(Ellipse<T>),
    /// A rectangle, its corners sharp or round.
    Rectangle(Rectangle<T>),
    /// A polygon of equal sides and angles.
    RegularPolygon(RegularPolygon<T>),
    /// A star.
    Star(Star<T>),
    /// Polygons.
    Polygon(Polygon<T>),
    /// Rings of lines, arcs and cubics.
    Path(Path<T>),
    /// Lines drawn by a pen of some width.
    Stroke(Stroke<T>),
    /// Elliptic Fourier descriptors.
    Efd(Efd<T>),
    /// A prototype of a bank.
    Prototype(Prototype<T>),
}

impl<T: Real> AnyShape<T> {
    /// Descriptors, those of a bank's prototype if `prototype` names one.
    #[must_use]
    pub fn of_efd(efd: Efd<T>, prototype: Option<usize>) -> Self {
        match prototype {
            Some(index) => Self::Prototype(Prototype { index, efd }),
            None => Self::Efd(efd),
        }
    }

    /// The descriptors that the shape is made of; none for shapes of other kinds.
    #[must_use]
    pub fn efd(&self) -> Option<&Efd<T>> {
        match self {
            Self::Efd(efd) | Self::Prototype(Prototype { efd, .. }) => Some(efd),
            _ => None,
        }
    }

    /// The descriptors that the shape is made of, to write to.
    #[must_use]
    pub fn efd_mut(&mut self) -> Option<&mut Efd<T>> {
        match self {
            Self::Efd(efd) | Self::Prototype(Prototype { efd, .. }) => Some(efd),
            _ => None,
        }
    }

    /// As [`Self::efd`], for code that knows no other shapes.
    ///
    /// # Errors
    /// [`ShapeError::NoDescriptors`] for shapes of other kinds.
    pub fn descriptors(&self) -> Result<&Efd<T>, ShapeError> {
        self.efd().ok_or_else(|| ShapeError::NoDescriptors { kind: self.kind() })
    }

    /// Index into the bank that the shape was taken from.
    #[must_use]
    pub fn prototype(&self) -> Option<usize> {
        if let Self::Prototype(prototype) = self { Some(prototype.index) } else { None }
    }

    /// The same in another precision.
    #[must_use]
    pub fn cast<U: Real>(&self) -> AnyShape<U> {
        match self {
            Self::Circle(circle) => circle.cast().into(),
            Self::Ellipse(ellipse) => ellipse.cast().into(),
            Self::Rectangle(rectangle) => rectangle.cast().into(),
            Self::RegularPolygon(polygon) => polygon.cast().into(),
            Self::Star(star) => star.cast().into(),
            Self::Polygon(polygon) => polygon.cast().into(),
            Self::Path(path) => path.cast().into(),
            Self::Stroke(stroke) => stroke.cast().into(),
            Self::Efd(efd) => efd.cast().into(),
            Self::Prototype(prototype) => prototype.cast().into(),
        }
    }

    fn of_kind(&self) -> &dyn Shape<T> {
        match self {
            Self::Circle(circle) => circle,
            Self::Ellipse(ellipse) => ellipse,
            Self::Rectangle(rectangle) => rectangle,
            Self::RegularPolygon(polygon) => polygon,
            Self::Star(star) => star,
            Self::Polygon(polygon) => polygon,
            Self::Path(path) => path,
            Self::Stroke(stroke) => stroke,
            Self::Efd(efd) => efd,
            Self::Prototype(prototype) => prototype,
        }
    }

    fn of_kind_mut(&mut self) -> &mut dyn Shape<T> {
        match self {
            Self::Circle(circle) => circle,
            Self::Ellipse(ellipse) => ellipse,
            Self::Rectangle(rectangle) => rectangle,
            Self::RegularPolygon(polygon) => polygon,
            Self::Star(star) => star,
            Self::Polygon(polygon) => polygon,
            Self::Path(path) => path,
            Self::Stroke(stroke) => stroke,
            Self::Efd(efd) => efd,
            Self::Prototype(prototype) => prototype,
        }
    }
}

/// Makes every kind a shape of any kind.
macro_rules! from_kinds {
    ($($kind:ident),+) => {$(
        impl<T> From<$kind<T>> for AnyShape<T> {
            fn from(shape: $kind<T>) -> Self {
                Self::$kind(shape)
            }
        }
    )+};
}
from_kinds!(Circle, Ellipse, Rectangle, RegularPolygon, Star, Polygon, Path, Stroke, Efd, Prototype);

impl<T: Real> Shape<T> for AnyShape<T> {
    fn kind(&self) -> &'static str {
        self.of_kind().kind()
    }

    fn number_count(&self) -> usize {
        self.of_kind().number_count()
    }

    fn numbers(&self, numbers: &mut Vec<T>) {
        self.of_kind().numbers(numbers);
    }

    fn number_names(&self) -> Vec<String> {
        self.of_kind().number_names()
    }

    fn set_numbers(&mut self, numbers: &[T]) -> Result<(), ShapeError> {
        self.of_kind_mut().set_numbers(numbers)
    }

    fn pose_freedom(&self) -> PoseFreedom {
        self.of_kind().pose_freedom()
    }

    fn is_given(&self) -> bool {
        self.of_kind().is_given()
    }

    fn flatten(&self, how: &Flattening<'_, T>, outline: &mut Outline<T>) -> Result<(), ShapeError> {
        self.of_kind().flatten(how, outline)
    }

    fn flatten_vjp(
        &self,
        how: &Flattening<'_, T>,
        grad_vertices: &[[T; 2]],
        grad_numbers: &mut [T],
    ) -> Result<(), ShapeError> {
        self.of_kind().flatten_vjp(how, grad_vertices, grad_numbers)
    }

    fn boundary(&self) -> Result<Boundary<T>, ShapeError> {
        self.of_kind().boundary()
    }

    fn efd_of_ring(&self, ring: usize, harmonic_count: usize) -> Result<(Efd<T>, [T; 2]), ShapeError> {
        self.of_kind().efd_of_ring(ring, harmonic_count)
    }

    fn to_path(&self) -> Result<Path<T>, ShapeError> {
        self.of_kind().to_path()
    }
}
