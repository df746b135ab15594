//! Every kind of shape behind one trait, and the enum of all of them that scenes hold.

use alloc::vec::Vec;

use super::{Efd, Flattening, Outline, OutlineBasis, ShapeError};
use crate::real::Real;

/// A shape and its numbers.
///
/// The numbers are lengths and coordinates in the frame of the shape, which a [`Pose`](crate::Pose) carries to scene
/// units: with the pose that leaves every point where it is, they are scene units themselves.
pub trait Shape<T: Real> {
    /// The name of the kind, as files have it.
    fn kind(&self) -> &'static str;

    /// How many numbers change the shape.
    fn number_count(&self) -> usize;

    /// Appends the numbers, in the order that the docs of the kind give.
    fn numbers(&self, numbers: &mut Vec<T>);

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

    /// Appends the rings to `outline`.
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

/// Descriptors that are those of a bank's prototype.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prototype<T> {
    /// Index into the bank.
    pub index: usize,
    /// Its descriptors, or a mixture of the bank's that is nearest to it.
    pub efd: Efd<T>,
}

/// A shape of any kind.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum AnyShape<T> {
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
        }
    }

    /// The descriptors that the shape is made of, to write to.
    #[must_use]
    pub fn efd_mut(&mut self) -> Option<&mut Efd<T>> {
        match self {
            Self::Efd(efd) | Self::Prototype(Prototype { efd, .. }) => Some(efd),
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
            Self::Efd(efd) => AnyShape::Efd(efd.cast()),
            Self::Prototype(Prototype { index, efd }) => {
                AnyShape::Prototype(Prototype { index: *index, efd: efd.cast() })
            }
        }
    }

    fn of_kind(&self) -> &dyn Shape<T> {
        match self {
            Self::Efd(efd) => efd,
            Self::Prototype(prototype) => prototype,
        }
    }

    fn of_kind_mut(&mut self) -> &mut dyn Shape<T> {
        match self {
            Self::Efd(efd) => efd,
            Self::Prototype(prototype) => prototype,
        }
    }
}

impl<T> From<Efd<T>> for AnyShape<T> {
    fn from(efd: Efd<T>) -> Self {
        Self::Efd(efd)
    }
}

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
}

/// The numbers are a_1, b_1, c_1, d_1, a_2, ...
impl<T: Real> Shape<T> for Efd<T> {
    fn kind(&self) -> &'static str {
        "efd"
    }

    fn number_count(&self) -> usize {
        4 * self.harmonic_count()
    }

    fn numbers(&self, numbers: &mut Vec<T>) {
        numbers.extend_from_slice(self.rows().as_flattened());
    }

    fn set_numbers(&mut self, numbers: &[T]) -> Result<(), ShapeError> {
        check_numbers(self.number_count(), numbers)?;
        self.rows_mut().as_flattened_mut().copy_from_slice(numbers);
        Ok(())
    }

    fn pose_freedom(&self) -> PoseFreedom {
        PoseFreedom { translation: true, scale: false, rotation: false }
    }

    fn flatten(&self, how: &Flattening<'_, T>, outline: &mut Outline<T>) -> Result<(), ShapeError> {
        outline.start_ring();
        let first = outline.vertices.len();
        outline.vertices.resize(first + how.basis.vertex_count(), [T::zero(); 2]);
        how.basis.outline(self.rows(), &mut outline.vertices[first..])
    }

    fn flatten_vjp(
        &self,
        how: &Flattening<'_, T>,
        grad_vertices: &[[T; 2]],
        grad_numbers: &mut [T],
    ) -> Result<(), ShapeError> {
        check_length("gradient of the numbers", self.number_count(), grad_numbers.len())?;
        OutlineBasis::outline_vjp(how.basis, grad_vertices, grad_numbers.as_chunks_mut().0)
    }
}

/// The numbers are those of the descriptors; fits take them as given and move the pose.
impl<T: Real> Shape<T> for Prototype<T> {
    fn kind(&self) -> &'static str {
        "prototype"
    }

    fn number_count(&self) -> usize {
        self.efd.number_count()
    }

    fn numbers(&self, numbers: &mut Vec<T>) {
        self.efd.numbers(numbers);
    }

    fn set_numbers(&mut self, numbers: &[T]) -> Result<(), ShapeError> {
        self.efd.set_numbers(numbers)
    }

    fn pose_freedom(&self) -> PoseFreedom {
        PoseFreedom { translation: true, scale: true, rotation: true }
    }

    fn is_given(&self) -> bool {
        true
    }

    fn flatten(&self, how: &Flattening<'_, T>, outline: &mut Outline<T>) -> Result<(), ShapeError> {
        self.efd.flatten(how, outline)
    }

    fn flatten_vjp(
        &self,
        how: &Flattening<'_, T>,
        grad_vertices: &[[T; 2]],
        grad_numbers: &mut [T],
    ) -> Result<(), ShapeError> {
        self.efd.flatten_vjp(how, grad_vertices, grad_numbers)
    }
}

/// Refuses a wrong number of numbers and numbers that are not finite.
pub(super) fn check_numbers<T: Real>(expected: usize, numbers: &[T]) -> Result<(), ShapeError> {
    check_length("numbers of the shape", expected, numbers.len())?;
    match numbers.iter().position(|number| !number.is_finite()) {
        Some(index) => Err(ShapeError::NotFinite { index }),
        None => Ok(()),
    }
}

/// Refuses a wrong length.
pub(super) fn check_length(what: &'static str, expected: usize, len: usize) -> Result<(), ShapeError> {
    if len == expected { Ok(()) } else { Err(ShapeError::Length { what, expected, len }) }
}
