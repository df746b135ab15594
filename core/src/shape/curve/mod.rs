//! Boundaries made of exact pieces: lines, circular arcs, ellipses and cubics, and everything that is worked out piece by
//! piece whatever kind of shape they bound.
//!
//! In: the pieces of a shape's rings, [`Boundary`]. Out: polygons with their vjp, measures, descriptors.
//!
//! | file | forward | backward |
//! |---|---|---|
//! | `flatten` | boundary to polygons that keep its area, [`Boundary::flatten`] | `flatten_vjp` |
//! | `arc` | the vertices of a circular arc between fixed ends | `arc_vjp` |
//! | `direction` | where a piece points at its ends | `direction_vjp` |
//! | `measure` | lengths, points, boxes | |
//! | `moments` | area, centroid, second moments | |
//! | `efd` | descriptors of a ring, without sampling | |
//! | `element` | boundaries for drawing programs, and as paths | |
//! | `cubic` | where a cubic is cut, and its vertices or those of a parallel | `cubic_vjp` |
//!
//! *Why polygons need care*: vertices on a curve make a polygon inside of it. A circle drawn that way is too small by a
//! share of (2 pi / n)^2 / 12, and a fit answers with a radius that is too large. So vertices stand outside of the curve by as
//! much as the edges lie inside.

mod arc;
mod arc_vjp;
mod cubic;
mod cubic_vjp;
mod direction;
mod direction_vjp;
mod efd;
mod element;
mod flatten;
mod flatten_vjp;
mod measure;
mod moments;
#[cfg(test)]
mod tests;

use alloc::vec::Vec;

use super::FillRule;
use crate::geometry::Vec2;
use crate::real::Real;

pub use element::PathElement;
pub use moments::{Axes, Moments};

pub(super) use arc::{CutArc, edges, edges_of_length, stand_out, sweep};
pub(super) use arc_vjp::stand_out_slope;
pub(super) use cubic::{CubicVertex, cut, derivatives, is_turn_too_wide, push};
pub(super) use direction::End;
pub(super) use flatten_vjp::conjugate;

/// Most edges that the polygon of one piece has, whatever the tolerance: a circle of radius 2900 px at 0.01 px.
pub(super) const MOST_EDGES: usize = 1024;

/// A stretch of a boundary. It ends where the next one of its ring starts; an ellipse is a ring of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Piece<T> {
    /// A straight line.
    Line {
        /// Where it starts.
        from: Vec2<T>,
        /// Where it ends.
        to: Vec2<T>,
    },
    /// A circular arc.
    Arc {
        /// Where it starts.
        from: Vec2<T>,
        /// Where it ends.
        to: Vec2<T>,
        /// tan(sweep / 4), the sweep in radians and positive if the arc turns from +x to +y: 0 for a straight line, 1 for a
        /// half circle.
        bulge: T,
    },
    /// A whole ellipse: center + `axes[0]` cos t + `axes[1]` sin t.
    Ellipse {
        /// Its middle.
        center: Vec2<T>,
        /// From the middle to the points at t = 0 and a quarter turn later, at right angles to each other.
        axes: [Vec2<T>; 2],
    },
    /// A cubic Bézier curve: start, two control points, end.
    Cubic([Vec2<T>; 4]),
}

/// Gradient of a scalar with respect to the numbers of a [`Piece`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PieceGrad<T> {
    /// Of a line and an arc: start and end. Of an ellipse: center and axes. Of a cubic: its four points. The rest is 0.
    pub points: [Vec2<T>; 4],
    /// Of an arc's bulge.
    pub bulge: T,
}

/// The exact boundary of a shape: closed rings of pieces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Boundary<T> {
    /// The pieces of all rings.
    pub pieces: Vec<Piece<T>>,
    /// Where each ring but the first starts, rising; empty for one ring.
    pub breaks: Vec<usize>,
    /// What the rings fill.
    pub fill: FillRule,
}

impl<T: Real> Boundary<T> {
    /// What is appended to the pieces from here on belongs to another ring.
    pub fn start_ring(&mut self) {
        let first = self.pieces.len();
        if first > 0 && self.breaks.last() != Some(&first) {
            self.breaks.push(first);
        }
    }

    /// The rings, each as its pieces; none where breaks fall or pass the end.
    pub fn rings(&self) -> impl Iterator<Item = &[Piece<T>]> + Clone {
        let starts = core::iter::once(0).chain(self.breaks.iter().copied());
        let ends = self.breaks.iter().copied().chain(core::iter::once(self.pieces.len()));
        starts.zip(ends).filter_map(|(start, end)| self.pieces.get(start..end)).filter(|ring| !ring.is_empty())
    }

    /// Appends the closed polygon through `corners` as a ring.
    pub fn push_polygon(&mut self, corners: &[Vec2<T>]) {
        self.start_ring();
        let ends = corners.iter().skip(1).chain(corners.first());
        self.pieces.extend(corners.iter().zip(ends).map(|(&from, &to)| Piece::Line { from, to }));
    }
}

impl<T: Real> Piece<T> {
    /// Where it starts.
    #[must_use]
    pub fn from(&self) -> Vec2<T> {
        match *self {
            Self::Line { from, .. } | Self::Arc { from, .. } => from,
            Self::Ellipse { center, axes } => center + axes[0],
            Self::Cubic(points) => points[0],
        }
    }

    /// Where it ends.
    #[must_use]
    pub fn to(&self) -> Vec2<T> {
        match *self {
            Self::Line { to, .. } | Self::Arc { to, .. } => to,
            Self::Ellipse { center, axes } => center + axes[0],
            Self::Cubic(points) => points[3],
        }
    }
}

impl<T: Real> Piece<T> {
    /// The same in another precision.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Piece<U> {
        let point = |point: Vec2<T>| Vec2::new(U::of(point.x.as_f64()), U::of(point.y.as_f64()));
        match *self {
            Self::Line { from, to } => Piece::Line { from: point(from), to: point(to) },
            Self::Arc { from, to, bulge } => {
                Piece::Arc { from: point(from), to: point(to), bulge: U::of(bulge.as_f64()) }
            }
            Self::Ellipse { center, axes } => Piece::Ellipse { center: point(center), axes: axes.map(point) },
            Self::Cubic(points) => Piece::Cubic(points.map(point)),
        }
    }
}

impl<T: Real> core::ops::AddAssign for PieceGrad<T> {
    fn add_assign(&mut self, other: Self) {
        self.points.iter_mut().zip(other.points).for_each(|(sum, value)| *sum += value);
        self.bulge += other.bulge;
    }
}
