//! Turns and reflections that may be symmetries: those that carry one seen stretch onto another.

use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::geometry::{Similarity, Vec2};

use super::motion::Symmetry;
use super::{POINTS, Seen};

/// Symmetry orders looked for.
const ORDERS: core::ops::RangeInclusive<usize> = 2..=8;
/// Least share of the points that one stretch carried onto another has.
const LEAST_RUN: f64 = 0.1;

impl<T: Real> Seen<'_, T> {
    /// Turns that carry some stretch onto another, highest orders first, with one center per angle.
    pub(super) fn turns(&self) -> Vec<Symmetry<T>> {
        let mut out = Vec::new();
        for order in ORDERS.rev() {
            let mut best = (T::of(LEAST_RUN) * T::of_usize(POINTS), None);
            let step = T::of(core::f64::consts::TAU) / T::of_usize(order);
            for multiple in 1..=order / 2 {
                let motion = Similarity::turn_about(Vec2::default(), step * T::of_usize(multiple));
                let carried: Vec<[T; 2]> =
                    self.points.iter().map(|&point| motion.point(point.into()).to_array()).collect();
                for shift in 1..POINTS {
                    self.runs(
                        |i| (i + shift) % POINTS,
                        &carried,
                        |count, mean, spread| {
                            let merit = count / (T::one() + T::of(4.0) * spread / self.slack());
                            if merit > best.0 {
                                // The turn about a center shifts by (1 - turn) center.
                                let shifted = Similarity { translation: mean.into(), ..motion };
                                let center = shifted.fixed_point().map(Vec2::to_array);
                                best = (merit, center.map(|center| Symmetry::Turn { order, center }));
                            }
                        },
                    );
                }
            }
            out.extend(best.1);
        }
        out
    }

    /// The reflection that carries the longest stretch onto another.
    pub(super) fn mirrors(&self) -> Option<Symmetry<T>> {
        let mut best = (T::of(LEAST_RUN) * T::of_usize(POINTS), None);
        let middle = [0, 1].map(|c| self.points.iter().map(|p| p[c]).sum::<T>() / T::of_usize(POINTS));
        for sum in 0..POINTS {
            let partner = |i: usize| (POINTS + sum - i) % POINTS;
            // The direction across the axis is that from any point to its partner.
            let (mut xx, mut xy, mut yy) = (T::zero(), T::zero(), T::zero());
            for i in (0..POINTS).filter(|&i| self.shows[i] && self.shows[partner(i)]) {
                let (p, q) = (self.points[i], self.points[partner(i)]);
                let [x, y] = [q[0] - p[0], q[1] - p[1]];
                xx += x * x;
                xy += x * y;
                yy += y * y;
            }
            // Twice the angle of the axis: a right angle from the main direction.
            let angle = (xy + xy).atan2(xx - yy) + T::of(core::f64::consts::PI);
            let motion = Similarity::reflection(Vec2::default(), angle * T::of(0.5));
            let carried: Vec<[T; 2]> = self.points.iter().map(|&point| motion.point(point.into()).to_array()).collect();
            self.runs(partner, &carried, |count, mean, spread| {
                let merit = count / (T::one() + T::of(4.0) * spread / self.slack());
                if merit > best.0 {
                    // Half way from the middle of what is seen to its image.
                    let image = motion.point(middle.into()).to_array();
                    let center = [0, 1].map(|c| (middle[c] + image[c] + mean[c]) * T::of(0.5));
                    best = (merit, Some(Symmetry::Mirror { angle, center }));
                }
            });
        }
        best.1
    }

    /// Squared distance (px^2) between points that may be the same: they are as far apart as points are laid.
    fn slack(&self) -> T {
        T::of(0.25) + self.spacing * self.spacing * T::of(0.1)
    }

    /// Calls `found` with length, mean and spread of the way from `carried` points to partners, over each run of seen points
    /// with seen partners.
    fn runs(&self, partner: impl Fn(usize) -> usize, carried: &[[T; 2]], mut found: impl FnMut(T, [T; 2], T)) {
        let mut sums = [T::zero(); 4];
        let mut finish = |sums: &mut [T; 4]| {
            let [count, x, y, squares] = *sums;
            if count > T::of(LEAST_RUN) * T::of_usize(POINTS) {
                let mean = [x / count, y / count];
                found(count, mean, squares / count - mean[0] * mean[0] - mean[1] * mean[1]);
            }
            *sums = [T::zero(); 4];
        };
        // Runs start after a point that is not seen, so that none is cut in two.
        let start = self.shows.iter().position(|shows| !shows).unwrap_or(0);
        for i in (0..POINTS).map(|i| (i + start) % POINTS) {
            let j = partner(i);
            if !self.shows[i] || !self.shows[j] {
                finish(&mut sums);
                continue;
            }
            let (p, q) = (carried[i], self.points[j]);
            let [x, y] = [q[0] - p[0], q[1] - p[1]];
            for (sum, value) in sums.iter_mut().zip([T::one(), x, y, x * x + y * y]) {
                *sum += value;
            }
        }
        finish(&mut sums);
    }
}
