//! The way back of [`Piece::direction`].

use super::direction::{End, half_turn};
use super::flatten_vjp::conjugate;
use super::{Piece, PieceGrad};
use crate::geometry::Vec2;
use crate::real::Real;

impl<T: Real> Piece<T> {
    /// Adds the gradient of `grad` x direction; nothing if there is none.
    pub(crate) fn direction_vjp(&self, end: End, grad: Vec2<T>, grad_piece: &mut PieceGrad<T>) {
        let Some((vector, [from, to])) = self.leading(end) else { return };
        let Some(direction) = vector.normalized() else { return };
        let mut grad_direction = grad;
        if let Self::Arc { bulge, .. } = *self {
            let turn = half_turn(bulge, end);
            // Half the sweep is 2 atan(bulge).
            let grad_angle = grad.dot(direction.turned(turn).perp());
            grad_piece.bulge += end.sign::<T>() * grad_angle * T::of(2.0) / (T::one() + bulge * bulge);
            grad_direction = grad.turned(conjugate(turn));
        }
        let grad_vector = (grad_direction - direction * direction.dot(grad_direction)) / vector.length();
        grad_piece.points[from] += -grad_vector;
        grad_piece.points[to] += grad_vector;
    }
}
