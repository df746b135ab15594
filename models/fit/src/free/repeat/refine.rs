//! A symmetry moved to where what it carries agrees best with what is seen.

use dvp_core::{Real, Vec2};

use super::motion::{Symmetry, axis_normal};
use super::{AGREES_PX, POINTS, Seen};

/// How well what agrees ties a center down, at least: mean squared move of the carried points across the outline for one of
/// the center, in its weakest direction.
const LEAST_TIED: f64 = 0.1;
/// Refinements of a center or an axis.
const STEPS: usize = 3;

impl<T: Real> Seen<'_, T> {
    /// The symmetry with its center, or its axis, moved to where carried points agree best; none if it is not tied down.
    pub(super) fn refined(&self, symmetry: Symmetry<T>) -> Option<Symmetry<T>> {
        let mut symmetry = symmetry;
        let mirror = matches!(symmetry, Symmetry::Mirror { .. });
        for step in 0..STEPS {
            let reach = T::of(AGREES_PX) * if step == 0 { T::of(2.0) } else { T::one() };
            let center = symmetry.center();
            let mut normal_equations = [T::zero(); 3];
            let mut gradient = [T::zero(); 2];
            let mut count = T::zero();
            for motion in symmetry.motions() {
                for i in (0..POINTS).step_by(2).filter(|&i| self.shows[i]) {
                    let at = motion.point(self.points[i].into());
                    let Some((distance, n, _)) = self.nearest(at).filter(|near| near.0.abs() < reach) else { continue };
                    // n (1 - m): how the distance grows as the center moves. A mirror moves across its axis and turns.
                    let [right, down] = [Vec2::new(T::one(), T::zero()), Vec2::new(T::zero(), T::one())];
                    let pull = n - Vec2::new(n.dot(motion.direction(right)), n.dot(motion.direction(down)));
                    let row = if mirror {
                        let arm = at - Vec2::from(center);
                        [pull.dot(axis_normal(&motion)), arm.cross(n) / self.extent()]
                    } else {
                        pull.to_array()
                    };
                    normal_equations[0] += row[0] * row[0];
                    normal_equations[1] += row[0] * row[1];
                    normal_equations[2] += row[1] * row[1];
                    gradient[0] += row[0] * distance;
                    gradient[1] += row[1] * distance;
                    count += T::one();
                }
            }
            let [a, b, c] = normal_equations.map(|v| v / count.max(T::one()));
            let half = T::of(0.5);
            let weakest = half * (a + c) - (half * half * (a - c) * (a - c) + b * b).sqrt();
            let least = if mirror { T::of(LEAST_TIED * 0.1) } else { T::of(LEAST_TIED) };
            if count < T::of(4.0) || weakest < least {
                return None;
            }
            let determinant = a * c - b * b;
            let [p, q] = gradient.map(|v| -v / count);
            let step = [(c * p - b * q) / determinant, (a * q - b * p) / determinant];
            symmetry = if mirror {
                let across = axis_normal(symmetry.motions().first()?);
                symmetry.moved([step[0] * across.x, step[0] * across.y, step[1] / self.extent()])
            } else {
                symmetry.moved([step[0], step[1], T::zero()])
            };
        }
        Some(symmetry)
    }

    /// About a quarter of the contour.
    fn extent(&self) -> T {
        self.spacing * T::of_usize(POINTS / 4)
    }
}
