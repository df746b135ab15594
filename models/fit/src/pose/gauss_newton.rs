//! Gauss-Newton on the four parameters of a pose: the outline shall lie at the sampled distances.

use dvp_core::{Pose, Real};

use super::field::OutlineField;
use crate::segment::EdgeSample;

/// A pose in pixels: v' = e^log_scale R(rotation) v + translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PosePx<T> {
    pub(crate) translation: [T; 2],
    pub(crate) log_scale: T,
    pub(crate) rotation: T,
}

/// How residuals count.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Robustness<T> {
    /// Residual (px) at which a sample loses most of its say (Geman-McClure).
    pub(crate) width_px: T,
    /// Whether samples count by their slope (final) or all alike (search).
    pub(crate) weighted: bool,
    /// Every how many samples one is used.
    pub(crate) stride: usize,
}

/// Normal equations of one pose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Normal<T> {
    pub(crate) hessian: [[T; 4]; 4],
    pub(crate) gradient: [T; 4],
    /// Robust mean of squared residuals (px^2), at most the squared width.
    pub(crate) cost: T,
}

/// What is left of an angle beyond whole periods, from minus half of one to half of one.
pub(crate) fn wrapped<T: Real>(angle: T, period: T) -> T {
    angle - period * (angle / period).round()
}

impl<T: Real> PosePx<T> {
    /// The pose in scene units, of which one has `unit_px` pixels.
    pub(crate) fn in_scene(&self, unit_px: T) -> Pose<T> {
        let translation = self.translation.map(|v| v / unit_px);
        Pose { translation, scale: self.log_scale.exp() / unit_px, rotation: self.rotation }
    }

    /// Residuals of the samples, robustly summed into a mean; no derivatives.
    pub(crate) fn cost(&self, field: &OutlineField<T>, samples: &[EdgeSample<T>], robustness: Robustness<T>) -> T {
        let frame = Frame::new(self);
        let (mut cost, mut total) = (T::zero(), T::zero());
        let inverse = T::one() / (robustness.width_px * robustness.width_px);
        for sample in samples.iter().step_by(robustness.stride.max(1)) {
            let (distance, _) = field.distance(frame.to_unit(sample.point));
            let residual = frame.scale * distance - sample.distance;
            let squared = residual * residual;
            let base = if robustness.weighted { sample.weight * sample.weight } else { T::one() };
            cost += base * squared / (T::one() + squared * inverse);
            total += base;
        }
        if total > T::zero() { cost / total } else { T::infinity() }
    }

    /// Normal equations at this pose in (x, y, log scale, rotation).
    pub(crate) fn normal(
        &self,
        field: &OutlineField<T>,
        samples: &[EdgeSample<T>],
        robustness: Robustness<T>,
    ) -> Normal<T> {
        let inverse = T::one() / (robustness.width_px * robustness.width_px);
        self.normal_by(field, samples, robustness, |_| inverse)
    }

    /// As [`Self::normal`], with the inverse squared width of each residual from `inverse_squared_width`.
    #[inline(always)]
    pub(crate) fn normal_by(
        &self,
        field: &OutlineField<T>,
        samples: &[EdgeSample<T>],
        robustness: Robustness<T>,
        inverse_squared_width: impl Fn(T) -> T,
    ) -> Normal<T> {
        let frame = Frame::new(self);
        let zero = T::zero();
        let mut normal = Normal { hessian: [[zero; 4]; 4], gradient: [zero; 4], cost: T::infinity() };
        let (mut cost, mut total) = (zero, zero);
        for sample in samples.iter().step_by(robustness.stride.max(1)) {
            let u = frame.to_unit(sample.point);
            let (distance, n) = field.distance(u);
            let residual = frame.scale * distance - sample.distance;
            let squared = residual * residual;
            let base = if robustness.weighted { sample.weight * sample.weight } else { T::one() };
            let falloff = T::one() / (T::one() + squared * inverse_squared_width(residual));
            cost += base * squared * falloff;
            total += base;
            let weight = base * falloff * falloff;
            let row = [
                -(frame.cos * n[0] - frame.sin * n[1]),
                -(frame.sin * n[0] + frame.cos * n[1]),
                frame.scale * (distance - n[0] * u[0] - n[1] * u[1]),
                frame.scale * (n[0] * u[1] - n[1] * u[0]),
            ];
            for i in 0..4 {
                let scaled = weight * row[i];
                normal.gradient[i] += scaled * residual;
                for j in 0..=i {
                    normal.hessian[i][j] += scaled * row[j];
                }
            }
        }
        for i in 0..4 {
            for j in 0..i {
                normal.hessian[j][i] = normal.hessian[i][j];
            }
        }
        if total > zero {
            normal.cost = cost / total;
        }
        normal
    }

    /// Damped Gauss-Newton steps; returns the pose, its cost and the steps taken.
    pub(crate) fn refine(
        self,
        field: &OutlineField<T>,
        samples: &[EdgeSample<T>],
        robustness: Robustness<T>,
        max_steps: usize,
    ) -> (Self, T, usize) {
        self.descend(max_steps, |pose| pose.normal(field, samples, robustness))
    }

    /// Damped Gauss-Newton steps on any normal equations of a pose; returns as [`Self::refine`].
    #[inline(always)]
    pub(crate) fn descend(self, max_steps: usize, normal_at: impl Fn(&Self) -> Normal<T>) -> (Self, T, usize) {
        let mut pose = self;
        let mut normal = normal_at(&pose);
        let mut damping = T::of(1e-3);
        for step in 0..max_steps {
            let Some(delta) = solve4(&normal.hessian, &normal.gradient, damping) else {
                damping = damping * T::of(10.0) + T::of(1e-6);
                continue;
            };
            let tried = pose.moved(delta);
            let next = normal_at(&tried);
            if next.cost <= normal.cost {
                let gain = normal.cost - next.cost;
                pose = tried;
                let done = gain <= T::of(1e-4) * normal.cost;
                normal = next;
                damping *= T::of(0.2);
                if done {
                    return (pose, normal.cost, step + 1);
                }
            } else {
                damping *= T::of(10.0);
                if damping > T::of(1e4) {
                    return (pose, normal.cost, step + 1);
                }
            }
        }
        (pose, normal.cost, max_steps)
    }

    fn moved(&self, delta: [T; 4]) -> Self {
        // A step may change the size by a factor of 1.6 at most: a search stays where its start was.
        let half = T::of(0.5);
        Self {
            translation: [self.translation[0] - delta[0], self.translation[1] - delta[1]],
            log_scale: self.log_scale - delta[2].max(-half).min(half),
            rotation: self.rotation - delta[3].max(-half).min(half),
        }
    }
}

/// A pose with its sine, cosine and scale worked out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame<T> {
    translation: [T; 2],
    pub(crate) sin: T,
    pub(crate) cos: T,
    pub(crate) scale: T,
    inverse_scale: T,
}

impl<T: Real> Frame<T> {
    pub(crate) fn new(pose: &PosePx<T>) -> Self {
        let (sin, cos) = pose.rotation.sin_cos();
        let scale = pose.log_scale.exp();
        Self { translation: pose.translation, sin, cos, scale, inverse_scale: T::one() / scale }
    }

    /// From pixels to the unit frame of the outline.
    #[inline(always)]
    pub(crate) fn to_unit(self, point: [T; 2]) -> [T; 2] {
        let x = (point[0] - self.translation[0]) * self.inverse_scale;
        let y = (point[1] - self.translation[1]) * self.inverse_scale;
        [self.cos * x + self.sin * y, self.cos * y - self.sin * x]
    }

    /// From the unit frame of the outline to pixels.
    #[inline(always)]
    pub(crate) fn to_pixels(self, v: [T; 2]) -> [T; 2] {
        let (x, y) = (self.cos * v[0] - self.sin * v[1], self.sin * v[0] + self.cos * v[1]);
        [self.scale * x + self.translation[0], self.scale * y + self.translation[1]]
    }
}

/// Solves (H + damping diag(H)) x = g by Cholesky; none if it is not positive definite.
pub(crate) fn solve4<T: Real>(hessian: &[[T; 4]; 4], gradient: &[T; 4], damping: T) -> Option<[T; 4]> {
    let mut l = [[T::zero(); 4]; 4];
    let mut x = *gradient;
    for i in 0..4 {
        for j in 0..=i {
            let mut sum = hessian[i][j];
            if i == j {
                sum += damping * sum;
            }
            for k in 0..j {
                sum -= l[i][k] * l[j][k];
            }
            if i == j {
                if sum.is_nan() || sum <= T::of(1e-12) {
                    return None;
                }
                l[i][i] = sum.sqrt();
            } else {
                l[i][j] = sum / l[j][j];
            }
        }
        let mut sum = x[i];
        for k in 0..i {
            sum -= l[i][k] * x[k];
        }
        x[i] = sum / l[i][i];
    }
    for i in (0..4).rev() {
        for k in i + 1..4 {
            let below = l[k][i] * x[k];
            x[i] -= below;
        }
        x[i] /= l[i][i];
    }
    Some(x)
}
