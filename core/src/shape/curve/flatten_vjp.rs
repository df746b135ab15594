//! The way back of [`Boundary::flatten`]: gradients of vertices to gradients of pieces.

use alloc::vec;
use alloc::vec::Vec;

use super::arc::{CutArc, edges, sweep};
use super::cubic::{self, cut};
use super::flatten::directions;
use super::{Boundary, Piece, PieceGrad};
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::resolve::resolve;
use crate::shape::{FillRule, Outline, ShapeError};

impl<T: Real> Boundary<T> {
    /// The gradient of sum(`grad_vertices` x vertices) with respect to every piece, vertices as [`Self::flatten`] writes
    /// them to an empty outline. Exact; the numbers of vertices are taken as constant.
    ///
    /// # Errors
    /// [`ShapeError::Length`] if there is not one gradient per vertex, others as in [`Self::flatten`].
    pub fn flatten_vjp(&self, tolerance: T, grad_vertices: &[[T; 2]]) -> Result<Vec<PieceGrad<T>>, ShapeError> {
        if self.fill == FillRule::EvenOdd {
            return self.flatten_rings_vjp(tolerance, grad_vertices);
        }
        let mut raw = Outline::default();
        self.flatten_rings(tolerance, &mut raw)?;
        let grad_raw = resolve(raw.rings(), self.fill)?.vjp(&raw.vertices, grad_vertices)?;
        self.flatten_rings_vjp(tolerance, &grad_raw)
    }

    fn flatten_rings_vjp(&self, tolerance: T, grad_vertices: &[[T; 2]]) -> Result<Vec<PieceGrad<T>>, ShapeError> {
        let mut grads = vec![PieceGrad::default(); self.pieces.len()];
        let mut parameters = Vec::new();
        let mut rest = grad_vertices.iter().map(|&grad| Vec2::from(grad));
        let mut missing = false;
        for (piece, grad) in self.pieces.iter().zip(&mut grads) {
            missing |= piece.flatten_vjp(tolerance, &mut parameters, &mut rest, grad).is_none();
        }
        if missing || rest.next().is_some() {
            let mut vertices = Vec::new();
            self.pieces.iter().for_each(|piece| piece.flatten(tolerance, &mut parameters, &mut vertices));
            let (expected, len) = (vertices.len(), grad_vertices.len());
            return Err(ShapeError::Length { what: "gradient of the vertices", expected, len });
        }
        Ok(grads)
    }
}

impl<T: Real> Piece<T> {
    /// None if there are too few gradients.
    fn flatten_vjp(
        &self,
        tolerance: T,
        parameters: &mut Vec<T>,
        rest: &mut impl Iterator<Item = Vec2<T>>,
        grad: &mut PieceGrad<T>,
    ) -> Option<()> {
        match *self {
            Self::Line { .. } => grad.points[0] += rest.next()?,
            Self::Arc { from, to, bulge } => {
                grad.points[0] += rest.next()?;
                let chord = to - from;
                let count = edges(chord.length(), bulge, tolerance);
                let arc = CutArc::new(sweep(bulge), count);
                let slopes = arc.slopes();
                let mut grad_sweep = T::zero();
                for k in 1..count {
                    let grad_vertex = rest.next()?;
                    let grad_chord = grad_vertex.turned(conjugate(arc.factor(k)));
                    grad.points[0] += grad_vertex - grad_chord;
                    grad.points[1] += grad_chord;
                    grad_sweep += grad_vertex.dot(chord.turned(arc.factor_slope(k, &slopes)));
                }
                // sweep = 4 atan(bulge).
                grad.bulge += grad_sweep * T::of(4.0) / (T::one() + bulge * bulge);
            }
            Self::Ellipse { axes, .. } => {
                for direction in directions(axes, tolerance) {
                    let grad_vertex = rest.next()?;
                    grad.points[0] += grad_vertex;
                    grad.points[1] += grad_vertex * direction.x;
                    grad.points[2] += grad_vertex * direction.y;
                }
            }
            Self::Cubic(points) => {
                grad.points[0] += rest.next()?;
                parameters.clear();
                cut(points, tolerance, T::zero(), parameters);
                for vertex in cubic::vertices(&points, parameters, tolerance) {
                    vertex.place_vjp(&points, rest.next()?, &mut grad.points);
                }
            }
        }
        Some(())
    }
}

/// The complex conjugate: multiplying by it is the way back of multiplying by the number.
pub(crate) fn conjugate<T: Real>(number: Vec2<T>) -> Vec2<T> {
    Vec2::new(number.x, -number.y)
}
