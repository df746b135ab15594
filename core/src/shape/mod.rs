//! Shapes: elliptic Fourier descriptors and the other models of a unit outline.
//!
//! In: a contour, or parameters of a model. Out: descriptors, their symmetry, unit outlines with their vjp.
//!
//! | file | forward | backward |
//! |---|---|---|
//! | `efd` | descriptors to outline, [`OutlineBasis::outline`] | `efd_vjp` |
//! | `efd_model` | [`EfdModel`], descriptors as a [`ShapeModel`] | same file |
//! | `bank` | weights to a mixture of prototypes, [`PrototypeBank`], [`PrototypeModel`] | same file |
//! | `mdshr` | the built-in bank, [`mdshr_bank`] | |
//! | `kind` | every kind of shape behind one trait, [`Shape`] | same files |
//! | `stroke` | what a pen covers along lines, [`Stroke`] | same folder |
//! | `curve` | boundaries of exact pieces, and what is worked out piece by piece | same folder |
//! | `resolve` | rings that cross to rings that do not | same folder |
//! | `any` | a shape of any kind, [`AnyShape`] | same file |
//! | `outline` | the polygons that renderers paint, [`Outline`], [`Rings`], and how curves become them, [`Flattening`] | |
//! | `fourier` | closed polygon to descriptors, [`Efd::from_contour`] | none: data, not parameters |
//! | `bump` | what arcs and cubics add to the descriptors of their chords | |
//! | `normalize` | descriptors to their normal form, [`Efd::normalize`] | `normalize_vjp` |
//! | `outline_op`, `normalize_op` | any model's outlines, mixtures and normal forms as steps of a batch | same files |
//! | `measure` | area, perimeter, truncation error | |
//! | `symmetry` | which turns map an outline on itself, [`Efd::symmetry`] | |

mod any;
mod bank;
mod bump;
mod curve;
mod efd;
mod efd_model;
mod efd_vjp;
mod fourier;
mod kind;
mod mdshr;
mod measure;
mod normalize;
mod normalize_op;
mod normalize_vjp;
mod outline;
mod outline_op;
mod resolve;
mod stroke;
mod symmetry;
#[cfg(test)]
mod tests;

use alloc::vec;
use alloc::vec::Vec;

use crate::real::Real;

pub use any::AnyShape;
pub use bank::{PrototypeBank, PrototypeModel};
pub use curve::{Axes, Boundary, Moments, PathElement, Piece, PieceGrad};
pub use efd::OutlineBasis;
pub use efd_model::EfdModel;
pub use kind::{
    Circle, Ellipse, MOST_CORNERS, Path, PathRing, Polygon, PoseFreedom, Prototype, Rectangle, RegularPolygon, Segment,
    Shape, Star,
};
pub use mdshr::{MDSHR_NAMES, mdshr_bank};
pub use normalize::Normalized;
pub use normalize_op::NormalizeOp;
pub use outline::{Flattening, OUTLINE_TOLERANCE, Outline, Rings};
pub use outline_op::{MixOp, OutlineOp};
pub use resolve::FillRule;
pub use stroke::{Cap, Join, Stroke};
pub use symmetry::{REFERENCE_SYMMETRY_HARMONICS, REFERENCE_SYMMETRY_THRESHOLD, SYMMETRY_TOLERANCE, Symmetry, gcd};

/// Vertices of an outline in the reference system: 64 parameters t = i / 63, both end points included.
pub const REFERENCE_VERTICES: usize = 64;

/// Elliptic Fourier descriptors: row n - 1 holds (a_n, b_n, c_n, d_n), n from 1, of
/// x(t) = sum a_n cos(2 pi n t) + b_n sin(2 pi n t), y(t) = sum c_n cos(2 pi n t) + d_n sin(2 pi n t).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Efd<T> {
    rows: Vec<[T; 4]>,
}

impl<T: Real> Efd<T> {
    /// Descriptors from rows (a_n, b_n, c_n, d_n).
    #[must_use]
    pub fn new(rows: Vec<[T; 4]>) -> Self {
        Self { rows }
    }

    /// `harmonic_count` rows of zeros.
    #[must_use]
    pub fn zeros(harmonic_count: usize) -> Self {
        Self { rows: vec![[T::zero(); 4]; harmonic_count] }
    }

    /// Number of harmonics, N.
    #[must_use]
    pub fn harmonic_count(&self) -> usize {
        self.rows.len()
    }

    /// Rows (a_n, b_n, c_n, d_n), n from 1.
    #[must_use]
    pub fn rows(&self) -> &[[T; 4]] {
        &self.rows
    }

    /// Rows to write to.
    #[must_use]
    pub fn rows_mut(&mut self) -> &mut [[T; 4]] {
        &mut self.rows
    }

    /// The first `harmonic_count` harmonics, padded with zeros if there are fewer.
    #[must_use]
    pub fn resized(&self, harmonic_count: usize) -> Self {
        let mut rows = self.rows.clone();
        rows.resize(harmonic_count, [T::zero(); 4]);
        Self { rows }
    }

    /// The same in another precision.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Efd<U> {
        Efd { rows: self.rows.iter().map(|row| row.map(|value| U::of(value.as_f64()))).collect() }
    }
}

/// A decoder of unit outlines, for batches of tensors: parameters in, always as many vertices out, and the way back for
/// gradients. One shape with its numbers is a [`Shape`].
pub trait ShapeModel<T: Real> {
    /// Length of the parameter slice.
    fn parameter_count(&self) -> usize;

    /// Number of vertices written by [`Self::outline`].
    fn vertex_count(&self) -> usize;

    /// Writes the closed unit outline; the edge from the last vertex to the first is part of it (of length 0 where the
    /// model repeats its first vertex, as EFD outlines do).
    ///
    /// # Errors
    /// [`ShapeError`] if a slice has the wrong length.
    fn outline(&self, parameters: &[T], vertices: &mut [[T; 2]]) -> Result<(), ShapeError>;

    /// Adds the pulled-back gradient of the parameters to `grad_parameters`.
    ///
    /// # Errors
    /// [`ShapeError`] if a slice has the wrong length.
    fn outline_vjp(
        &self,
        parameters: &[T],
        grad_vertices: &[[T; 2]],
        grad_parameters: &mut [T],
    ) -> Result<(), ShapeError>;

    /// Refuses slices of a wrong length.
    ///
    /// # Errors
    /// [`ShapeError::Length`] that names the slice.
    fn check(&self, parameters: &[T], vertices: &[[T; 2]]) -> Result<(), ShapeError> {
        let lengths = [
            ("parameters", self.parameter_count(), parameters.len()),
            ("outline", self.vertex_count(), vertices.len()),
        ];
        lengths.into_iter().try_for_each(|(what, expected, len)| {
            if len == expected { Ok(()) } else { Err(ShapeError::Length { what, expected, len }) }
        })
    }
}

/// Why a shape step was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ShapeError {
    /// A slice has the wrong length.
    Length {
        /// Which slice.
        what: &'static str,
        /// Expected length.
        expected: usize,
        /// What came.
        len: usize,
    },
    /// Fewer than three distinct points.
    TooFewPoints {
        /// Distinct points found.
        len: usize,
    },
    /// A coordinate or coefficient is NaN or infinite.
    NotFinite {
        /// Where.
        index: usize,
    },
    /// A count that must not be zero is zero.
    Zero {
        /// Which count.
        what: &'static str,
    },
    /// More harmonics than the table of cosines and sines has.
    TooManyHarmonics {
        /// Harmonics of the descriptors.
        harmonic_count: usize,
        /// Harmonics of the table.
        limit: usize,
    },
    /// Coordinates so large that lengths overflow.
    TooLarge,
    /// Descriptors are needed, and the shape is not made of them.
    NoDescriptors {
        /// The kind of the shape.
        kind: &'static str,
    },
    /// A length that must be positive is not, or is not finite.
    NotPositive {
        /// Which length.
        what: &'static str,
    },
    /// A regular polygon or star with too few corners, or too many.
    Corners {
        /// Sides or points.
        what: &'static str,
        /// How many.
        count: usize,
    },
    /// A ring that is not there.
    NoRing {
        /// Which one, from 0.
        ring: usize,
        /// How many there are.
        count: usize,
    },
    /// A smooth segment of a path has nothing before it whose direction it could continue.
    NoDirection,
    /// The first harmonic vanishes, so that there is no size to normalize by.
    Degenerate,
}

impl core::fmt::Display for ShapeError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Length { what, expected, len } => write!(f, "{what} has {len} values, needs {expected}"),
            Self::TooFewPoints { len } => write!(f, "contour has {len} distinct points, needs at least 3"),
            Self::NotFinite { index } => write!(f, "value {index} of the shape is NaN or infinite"),
            Self::Zero { what } => write!(f, "{what} must be at least 1"),
            Self::TooManyHarmonics { harmonic_count, limit } => {
                write!(
                    f,
                    "{harmonic_count} harmonics, but the outline basis has {limit}: make a larger basis or resize the EFD"
                )
            }
            Self::TooLarge => write!(f, "the contour's lengths overflow: scale its coordinates down"),
            Self::NoDescriptors { kind } => {
                write!(f, "a {kind} is not made of descriptors; take those of its outline (`Shape::efd_of_ring`)")
            }
            Self::NotPositive { what } => write!(f, "the {what} must be a positive number"),
            Self::Corners { what, count } => write!(f, "{count} {what}, must be 3 to {MOST_CORNERS}"),
            Self::NoRing { ring, count } => write!(f, "there is no ring {ring}: the shape has {count}, counted from 0"),
            Self::NoDirection => {
                write!(
                    f,
                    "a smooth segment has no direction to continue: begin the ring with a segment that has a corner before it"
                )
            }
            Self::Degenerate => write!(f, "the first harmonic is zero: the shape has no size to normalize by"),
        }
    }
}

impl core::error::Error for ShapeError {}
