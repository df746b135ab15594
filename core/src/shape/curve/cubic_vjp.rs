//! The way back of [`CubicVertex::place`].

use super::cubic::{CubicVertex, derivatives, weights};
use crate::geometry::Vec2;
use crate::real::Real;

impl<T: Real> CubicVertex<T> {
    /// Adds the gradient of `grad` x vertex with respect to the points of the cubic to `grad_points`; returns that with
    /// respect to the distance.
    pub(crate) fn place_vjp(&self, points: &[Vec2<T>; 4], grad: Vec2<T>, grad_points: &mut [Vec2<T>; 4]) -> T {
        let [_, first, second] = derivatives(points, self.t);
        let (mut grad_first, mut grad_second) = (Vec2::default(), Vec2::default());
        let mut grad_distance = T::zero();
        if let Some(direction) = first.normalized() {
            let speed = first.length();
            let turning = first.cross(second) / (speed * speed);
            let parallel = speed - self.distance * turning;
            let out = self.distance - self.push * parallel * turning;
            let grad_out = grad.dot(direction.perp());
            grad_distance = grad_out * (T::one() + self.push * turning * turning);
            // The normal: direction turned by a quarter, of unit length whatever the speed.
            let grad_direction = -grad.perp() * out;
            grad_first += (grad_direction - direction * direction.dot(grad_direction)) / speed;
            let grad_turning = -grad_out * self.push * (parallel - self.distance * turning);
            let grad_cross = grad_turning / (speed * speed);
            let grad_speed = -grad_out * self.push * turning - T::of(2.0) * grad_turning * turning / speed;
            grad_first += direction * grad_speed - second.perp() * grad_cross;
            grad_second += first.perp() * grad_cross;
        }
        let [for_point, for_first, for_second] = weights(self.t);
        for (k, grad_point) in grad_points.iter_mut().enumerate() {
            *grad_point += grad * for_point[k] + grad_first * for_first[k] + grad_second * for_second[k];
        }
        grad_distance
    }
}
