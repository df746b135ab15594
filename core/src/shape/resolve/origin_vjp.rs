//! The way back of [`Origin::place`].

use super::Origin;
use crate::geometry::Vec2;
use crate::real::Real;

impl<T: Real> Origin<T> {
    /// Adds the gradient of `grad` x vertex with respect to the vertices that came in.
    pub(in crate::shape) fn place_vjp(&self, vertices: &[[T; 2]], grad: Vec2<T>, grad_vertices: &mut [[T; 2]]) {
        let mut add = |vertex: usize, grad: Vec2<T>| {
            let [x, y] = &mut grad_vertices[vertex];
            *x += grad.x;
            *y += grad.y;
        };
        match *self {
            Self::Vertex(vertex) => add(vertex, grad),
            Self::Crossing(edges) => {
                let points = edges.map(|edge| edge.map(|vertex| Vec2::from(vertices[vertex])));
                let grads = line_crossing_vjp(points, grad);
                edges.as_flattened().iter().zip(grads).for_each(|(&vertex, grad)| add(vertex, grad));
            }
            Self::Along { edge: [from, to], share } => {
                add(from, grad * (T::one() - share));
                add(to, grad * share);
            }
        }
    }
}

/// The gradient of `grad` x crossing with respect to the four points, line by line.
pub(in crate::shape) fn line_crossing_vjp<T: Real>([[a, b], [c, d]]: [[Vec2<T>; 2]; 2], grad: Vec2<T>) -> [Vec2<T>; 4] {
    let (along, other, offset) = (b - a, d - c, c - a);
    let divisor = along.cross(other);
    let share = offset.cross(other) / divisor;
    // crossing = a + along share, share = offset x other / (along x other).
    let grad_share = grad.dot(along) / divisor;
    let grad_along = grad * share + other.perp() * (grad_share * share);
    let grad_offset = -other.perp() * grad_share;
    let grad_other = (offset - along * share).perp() * grad_share;
    [grad - grad_along - grad_offset, grad_along, grad_offset - grad_other, grad_other]
}
