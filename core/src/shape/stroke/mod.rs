//! Strokes: what a pen of some width covers along lines.
//!
//! | file | comes in | goes out |
//! |---|---|---|
//! | `mod.rs` | | [`Stroke`] and its [`Shape`] |
//! | `leg` | the pieces of a line | those that have a length, and where they point |
//! | `walk` | these | rings around what the pen touches, crossing each other |
//! | `along` | one piece | the rings' vertices beside it |
//! | `corner` | two pieces, or one and an end of the line | those of joins and caps |
//! | `place` | a vertex | where it is; the way back is in `place_vjp` |
//!
//! *Why nothing is left out*: the rings around a line are, as sums of directed edges, the outlines of the strips that the pen
//! covers along the pieces, and of the wedges at the outer sides of corners, provided that they go through the corner itself on the inner
//! side. If all of these turn from +x to +y, every point that is covered is wound around at least once, and one that is not
//! never: the nonzero rule is right, however the line crosses itself. Strips turn the other way where the line
//! bends around a center nearer than half the width; these parts are rings of their own, turned around.
//! [`resolve`](super::resolve) then makes rings of it that do not cross.

mod along;
mod corner;
mod leg;
mod place;
mod place_vjp;
#[cfg(test)]
mod tests;
mod walk;

use alloc::format;
use alloc::string::{String, ToString as _};
use alloc::vec::Vec;

use super::curve::{Boundary, PieceGrad};
use super::kind::{PathRing, PoseFreedom, Shape, check_finite, check_length, check_numbers};
use super::resolve::{FillRule, resolve};
use super::{Flattening, Outline, ShapeError};
use crate::geometry::Vec2;
use crate::real::Real;
use walk::{Raw, walk};

/// What a pen covers along open and closed lines, as SVG strokes them.
///
/// The numbers are those of the rings, as of a [`Path`](super::Path), and the width.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke<T> {
    /// The lines, closed or open. One without length is a dot: a disk with round caps, an upright square with square ones, nothing
    /// with butt ones.
    pub rings: Vec<PathRing<T>>,
    /// Width of the pen; its amount counts.
    pub width: T,
    /// How open lines end.
    pub cap: Cap,
    /// How pieces meet at corners.
    pub join: Join<T>,
}

/// How an open line ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Cap {
    /// Where its last point is.
    #[default]
    Butt,
    /// With a half disk around its last point.
    Round,
    /// Half a width further.
    Square,
}

/// How two pieces meet at a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Join<T> {
    /// The outer sides go on until they meet, unless that is further from the corner than the limit.
    Miter {
        /// Most distance from the tip to the inner corner per width; beyond it the join is as [`Self::Bevel`]. SVG's own is 4.
        limit: T,
    },
    /// A sector of a disk around the corner.
    Round,
    /// The outer sides end where the pieces do, and a straight line joins the ends.
    Bevel,
}

impl<T: Real> Default for Join<T> {
    /// SVG's own: a miter with the limit 4.
    fn default() -> Self {
        Self::Miter { limit: T::of(4.0) }
    }
}

impl<T: Real> Stroke<T> {
    /// A stroke.
    ///
    /// # Errors
    /// [`ShapeError::NotPositive`] if the width is not, others as [`Path::new`](super::Path::new).
    pub fn new(rings: Vec<PathRing<T>>, width: T, cap: Cap, join: Join<T>) -> Result<Self, ShapeError> {
        let rings = super::Path::new(rings)?.rings;
        if !(width > T::zero() && width.is_finite()) {
            return Err(ShapeError::NotPositive { what: "width" });
        }
        Ok(Self { rings, width, cap, join })
    }

    /// The same in another precision.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Stroke<U> {
        let join = match self.join {
            Join::Miter { limit } => Join::Miter { limit: U::of(limit.as_f64()) },
            Join::Round => Join::Round,
            Join::Bevel => Join::Bevel,
        };
        Stroke {
            rings: self.rings.iter().map(PathRing::cast).collect(),
            width: U::of(self.width.as_f64()),
            cap: self.cap,
            join,
        }
    }

    /// The rings around what the pen touches, crossing each other.
    fn raw(&self, tolerance: T) -> Result<Raw<T>, ShapeError> {
        check_finite(self.rings.iter().flat_map(PathRing::numbers).chain([&self.width]))?;
        walk(self, tolerance)
    }
}

impl<T: Real> Shape<T> for Stroke<T> {
    fn kind(&self) -> &'static str {
        "stroke"
    }

    fn number_count(&self) -> usize {
        self.rings.iter().map(PathRing::number_count).sum::<usize>() + 1
    }

    fn numbers(&self, numbers: &mut Vec<T>) {
        numbers.extend(self.rings.iter().flat_map(PathRing::numbers));
        numbers.push(self.width);
    }

    fn number_names(&self) -> Vec<String> {
        let rings = self.rings.iter().enumerate();
        let rings = rings.flat_map(|(i, ring)| ring.number_names().map(move |name| format!("rings[{i}].{name}")));
        rings.chain(core::iter::once("width".to_string())).collect()
    }

    fn set_numbers(&mut self, numbers: &[T]) -> Result<(), ShapeError> {
        check_numbers(self.number_count(), numbers)?;
        let places = self.rings.iter_mut().flat_map(PathRing::numbers_mut).chain(core::iter::once(&mut self.width));
        places.zip(numbers).for_each(|(place, &number)| *place = number);
        Ok(())
    }

    fn pose_freedom(&self) -> PoseFreedom {
        PoseFreedom::NONE
    }

    fn flatten(&self, how: &Flattening<'_, T>, outline: &mut Outline<T>) -> Result<(), ShapeError> {
        let raw = self.raw(how.tolerance)?.outline;
        resolve(raw.rings(), FillRule::NonZero)?.append(&raw.vertices, outline);
        Ok(())
    }

    fn flatten_vjp(
        &self,
        how: &Flattening<'_, T>,
        grad_vertices: &[[T; 2]],
        grad_numbers: &mut [T],
    ) -> Result<(), ShapeError> {
        check_length("gradient of the numbers", self.number_count(), grad_numbers.len())?;
        let raw = self.raw(how.tolerance)?;
        let resolved = resolve(raw.outline.rings(), FillRule::NonZero)?;
        let grad_raw = resolved.vjp(&raw.outline.vertices, grad_vertices)?;
        let (grad_legs, grad_half) = raw.vjp(&grad_raw);
        let mut legs = grad_legs.iter().zip(&raw.legs);
        let mut rest = grad_numbers;
        for (ring, &count) in self.rings.iter().zip(&raw.leg_counts) {
            let mut grad_pieces = alloc::vec![PieceGrad::default(); ring.segments.len()];
            let (numbers, others) = rest.split_at_mut(ring.number_count());
            for (grad, leg) in legs.by_ref().take(count) {
                match grad_pieces.get_mut(leg.segment) {
                    Some(sum) => *sum += *grad,
                    // A dot has no piece: its ends are the point.
                    None => {
                        numbers[0] += grad.points[0].x + grad.points[1].x;
                        numbers[1] += grad.points[0].y + grad.points[1].y;
                    }
                }
            }
            ring.pieces_vjp(&grad_pieces, numbers)?;
            rest = others;
        }
        if let [width] = rest {
            *width += grad_half * self.width.signum() * T::of(0.5);
        }
        Ok(())
    }

    /// The polygons of the outline, within a ten-thousandth of the width of it.
    fn boundary(&self) -> Result<Boundary<T>, ShapeError> {
        let raw = self.raw(self.width.abs() * T::of(BOUNDARY_TOLERANCE))?.outline;
        let mut outline = Outline::default();
        resolve(raw.rings(), FillRule::NonZero)?.append(&raw.vertices, &mut outline);
        let mut boundary = Boundary::default();
        for ring in outline.rings().iter() {
            boundary.push_polygon(&ring.iter().map(|&vertex| Vec2::from(vertex)).collect::<Vec<_>>());
        }
        Ok(boundary)
    }
}

/// How far the polygons of a boundary stray from the outline, per width.
const BOUNDARY_TOLERANCE: f64 = 1e-4;
