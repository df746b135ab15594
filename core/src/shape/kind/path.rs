//! Paths of lines, circular arcs and cubics.

use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use super::{PoseFreedom, Shape, check_finite, check_length, check_numbers};
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::curve::{Boundary, Piece, PieceGrad};
use crate::shape::{FillRule, Flattening, Outline, ShapeError};

/// What rings of lines, arcs and cubics fill; open ones are closed by a straight line.
///
/// The numbers are, ring by ring, its points and then what else its segments have.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Path<T> {
    /// The rings.
    pub rings: Vec<PathRing<T>>,
    /// What they fill.
    pub fill: FillRule,
}

/// A closed ring, or an open line, of segments.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathRing<T> {
    /// Where the segments meet: segment k leads from point k to point k + 1.
    pub points: Vec<[T; 2]>,
    /// As many as points in a closed ring, whose last segment leads back to the first point; one less in an open one.
    pub segments: Vec<Segment<T>>,
}

/// How a path leads from one point to the next.
///
/// The smooth ones leave in the direction in which the segment before them arrives; the first of a closed ring in that of
/// the last. A segment without length passes on the direction of the one before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Segment<T> {
    /// Straight.
    Line,
    /// Along a circle.
    Arc {
        /// tan(sweep / 4), the sweep in radians and positive if the arc turns from +x to +y: 0 for a straight line, 1 for a
        /// half circle.
        bulge: T,
    },
    /// Along the circle that continues the direction.
    SmoothArc,
    /// A cubic Bézier curve.
    Cubic {
        /// Its two control points.
        controls: [[T; 2]; 2],
    },
    /// A cubic Bézier curve that continues the direction.
    SmoothCubic {
        /// Distance of the first control point from the start.
        handle: T,
        /// The second control point.
        control: [T; 2],
    },
}

impl<T> Segment<T> {
    /// Its numbers, beside the points that it joins.
    fn numbers(&self) -> impl Iterator<Item = &T> {
        let (first, rest): (Option<&T>, &[T]) = match self {
            Self::Line | Self::SmoothArc => (None, &[]),
            Self::Arc { bulge } => (Some(bulge), &[]),
            Self::Cubic { controls } => (None, controls.as_flattened()),
            Self::SmoothCubic { handle, control } => (Some(handle), control),
        };
        first.into_iter().chain(rest)
    }

    fn numbers_mut(&mut self) -> impl Iterator<Item = &mut T> {
        let (first, rest): (Option<&mut T>, &mut [T]) = match self {
            Self::Line | Self::SmoothArc => (None, &mut []),
            Self::Arc { bulge } => (Some(bulge), &mut []),
            Self::Cubic { controls } => (None, controls.as_flattened_mut()),
            Self::SmoothCubic { handle, control } => (Some(handle), control),
        };
        first.into_iter().chain(rest)
    }

    /// Whether it continues the direction of the one before it.
    pub(super) fn is_smooth(&self) -> bool {
        matches!(self, Self::SmoothArc | Self::SmoothCubic { .. })
    }

    fn number_names(&self) -> &'static [&'static str] {
        match self {
            Self::Line | Self::SmoothArc => &[],
            Self::Arc { .. } => &["bulge"],
            Self::Cubic { .. } => &["controls[0][0]", "controls[0][1]", "controls[1][0]", "controls[1][1]"],
            Self::SmoothCubic { .. } => &["handle", "control[0]", "control[1]"],
        }
    }

    /// How many numbers it has, beside the points that it joins.
    #[must_use]
    pub fn number_count(&self) -> usize {
        self.number_names().len()
    }
}

impl<T: Real> PathRing<T> {
    /// The closed polygon through `points`.
    #[must_use]
    pub fn polygon(points: Vec<[T; 2]>) -> Self {
        let segments = vec![Segment::Line; points.len()];
        Self { points, segments }
    }

    /// The open line through `points`.
    #[must_use]
    pub fn polyline(points: Vec<[T; 2]>) -> Self {
        let segments = vec![Segment::Line; points.len().saturating_sub(1)];
        Self { points, segments }
    }

    /// Whether the last segment leads back to the first point.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.segments.len() == self.points.len()
    }

    /// How many numbers it has.
    #[must_use]
    pub fn number_count(&self) -> usize {
        2 * self.points.len() + self.segments.iter().map(Segment::number_count).sum::<usize>()
    }

    pub(in crate::shape) fn numbers(&self) -> impl Iterator<Item = &T> {
        self.points.as_flattened().iter().chain(self.segments.iter().flat_map(Segment::numbers))
    }

    pub(in crate::shape) fn numbers_mut(&mut self) -> impl Iterator<Item = &mut T> {
        let segments = self.segments.iter_mut().flat_map(Segment::numbers_mut);
        self.points.as_flattened_mut().iter_mut().chain(segments)
    }

    pub(in crate::shape) fn number_names(&self) -> impl Iterator<Item = String> {
        let points = (0..self.points.len()).flat_map(|k| [0, 1].map(|axis| format!("points[{k}][{axis}]")));
        let segments = self.segments.iter().enumerate();
        let segments = segments
            .flat_map(|(k, segment)| segment.number_names().iter().map(move |name| format!("segments[{k}].{name}")));
        points.chain(segments)
    }
}

impl<T: Real> Path<T> {
    /// A path that fills what lies inside of an odd number of rings.
    ///
    /// # Errors
    /// [`ShapeError::Length`] if a ring has neither as many segments as points nor one less, [`ShapeError::NoDirection`] if
    /// there is none for a smooth segment to continue, [`ShapeError::NotFinite`].
    pub fn new(rings: Vec<PathRing<T>>) -> Result<Self, ShapeError> {
        let path = Self { rings, fill: FillRule::EvenOdd };
        path.boundary()?;
        Ok(path)
    }

    /// Adds the gradient of the numbers, given that of the pieces of the boundary.
    pub(in crate::shape) fn boundary_vjp(
        &self,
        grads: &[PieceGrad<T>],
        grad_numbers: &mut [T],
    ) -> Result<(), ShapeError> {
        let (mut grads, mut grad_numbers) = (grads, grad_numbers);
        for ring in &self.rings {
            // The straight line that closes an open ring has no numbers of its own.
            let (own, rest) = grads.split_at(ring.points.len().min(grads.len()));
            let (numbers, others) = grad_numbers.split_at_mut(ring.number_count());
            ring.pieces_vjp(own, numbers)?;
            (grads, grad_numbers) = (rest, others);
        }
        Ok(())
    }
}

impl<T: Real> Shape<T> for Path<T> {
    fn kind(&self) -> &'static str {
        "path"
    }

    fn number_count(&self) -> usize {
        self.rings.iter().map(PathRing::number_count).sum()
    }

    fn numbers(&self, numbers: &mut Vec<T>) {
        numbers.extend(self.rings.iter().flat_map(PathRing::numbers));
    }

    fn number_names(&self) -> Vec<String> {
        let rings = self.rings.iter().enumerate();
        rings.flat_map(|(i, ring)| ring.number_names().map(move |name| format!("rings[{i}].{name}"))).collect()
    }

    fn set_numbers(&mut self, numbers: &[T]) -> Result<(), ShapeError> {
        check_numbers(self.number_count(), numbers)?;
        self.rings.iter_mut().flat_map(PathRing::numbers_mut).zip(numbers).for_each(|(place, &number)| *place = number);
        Ok(())
    }

    fn pose_freedom(&self) -> PoseFreedom {
        PoseFreedom::NONE
    }

    fn flatten(&self, how: &Flattening<'_, T>, outline: &mut Outline<T>) -> Result<(), ShapeError> {
        self.boundary()?.flatten(how.tolerance, outline)
    }

    fn flatten_vjp(
        &self,
        how: &Flattening<'_, T>,
        grad_vertices: &[[T; 2]],
        grad_numbers: &mut [T],
    ) -> Result<(), ShapeError> {
        check_length("gradient of the numbers", self.number_count(), grad_numbers.len())?;
        self.boundary_vjp(&self.boundary()?.flatten_vjp(how.tolerance, grad_vertices)?, grad_numbers)
    }

    fn boundary(&self) -> Result<Boundary<T>, ShapeError> {
        check_finite(self.rings.iter().flat_map(PathRing::numbers))?;
        let mut boundary = Boundary { fill: self.fill, ..Boundary::default() };
        for ring in &self.rings {
            boundary.start_ring();
            ring.pieces(&mut boundary.pieces)?;
            if let (false, Some(&start), Some(&end)) = (ring.is_closed(), ring.points.first(), ring.points.last()) {
                boundary.pieces.push(Piece::Line { from: Vec2::from(end), to: Vec2::from(start) });
            }
        }
        Ok(boundary)
    }

    fn to_path(&self) -> Result<Self, ShapeError> {
        Ok(self.clone())
    }
}
