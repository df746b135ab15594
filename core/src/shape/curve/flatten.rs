//! From a boundary to polygons.

use alloc::vec::Vec;

use super::arc::{CutArc, circle_edges, circle_radius, edges, sweep};
use super::cubic::{self, cut};
use super::{Boundary, Piece};
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::resolve::resolve;
use crate::shape::{FillRule, Outline, ShapeError};

impl<T: Real> Boundary<T> {
    /// Appends what the rings enclose as polygons that stray at most `tolerance` from them (in the units of the pieces) and enclose the
    /// same area: that of lines, arcs and ellipses to all digits, that of cubics up to the fourth power of the length of an
    /// edge. A piece has at most 1024 edges, whatever the tolerance.
    ///
    /// *Derivative*: [`Self::flatten_vjp`].
    ///
    /// # Errors
    /// [`ShapeError::TooLarge`] if a vertex is not finite; the outline may then hold a part.
    pub fn flatten(&self, tolerance: T, outline: &mut Outline<T>) -> Result<(), ShapeError> {
        if self.fill == FillRule::EvenOdd {
            return self.flatten_rings(tolerance, outline);
        }
        let mut raw = Outline::default();
        self.flatten_rings(tolerance, &mut raw)?;
        resolve(raw.rings(), self.fill)?.append(&raw.vertices, outline);
        Ok(())
    }

    /// As [`Self::flatten`], ring by ring, crossings left as they are.
    pub(super) fn flatten_rings(&self, tolerance: T, outline: &mut Outline<T>) -> Result<(), ShapeError> {
        let mut parameters = Vec::new();
        for ring in self.rings() {
            outline.start_ring();
            let first = outline.vertices.len();
            for piece in ring {
                piece.flatten(tolerance, &mut parameters, &mut outline.vertices);
            }
            if !outline.vertices[first..].as_flattened().iter().all(|value| value.is_finite()) {
                return Err(ShapeError::TooLarge);
            }
        }
        Ok(())
    }
}

impl<T: Real> Piece<T> {
    /// Appends its start and the vertices up to its end, the end left out; `parameters` is memory to work in.
    pub(super) fn flatten(&self, tolerance: T, parameters: &mut Vec<T>, vertices: &mut Vec<[T; 2]>) {
        match *self {
            Self::Line { from, .. } => vertices.push(from.to_array()),
            Self::Arc { from, to, bulge } => {
                let chord = to - from;
                let count = edges(chord.length(), bulge, tolerance);
                let arc = CutArc::new(sweep(bulge), count);
                vertices.push(from.to_array());
                vertices.extend((1..count).map(|k| (from + chord.turned(arc.factor(k))).to_array()));
            }
            Self::Ellipse { center, axes } => {
                vertices
                    .extend(directions(axes, tolerance).map(|d| (center + axes[0] * d.x + axes[1] * d.y).to_array()));
            }
            Self::Cubic(points) => {
                parameters.clear();
                cut(points, tolerance, T::zero(), parameters);
                vertices.push(points[0].to_array());
                let inner = cubic::vertices(&points, parameters, tolerance);
                vertices.extend(inner.map(|vertex| vertex.place(&points).to_array()));
            }
        }
    }
}

/// What the axes of an ellipse are multiplied by to give its vertices: those of a circle of radius 1, outside of it.
/// The ellipse is a linear image of the circle, and areas keep their ratio.
pub(super) fn directions<T: Real>(axes: [Vec2<T>; 2], tolerance: T) -> impl Iterator<Item = Vec2<T>> {
    let count = circle_edges(axes[0].length().max(axes[1].length()), tolerance);
    let angle = T::of(core::f64::consts::TAU) / T::of_usize(count);
    let radius = circle_radius(angle);
    (0..count).map(move |k| Vec2::from_angle(angle * T::of_usize(k)) * radius)
}
