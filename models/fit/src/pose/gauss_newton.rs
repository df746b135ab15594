//! Gauss-Newton on the four parameters of a pose: the outline shall lie at the sampled distances.

use dvp_core::geometry::{Similarity, Vec2};
use dvp_core::{Pose, Real, simd};

use super::equations::{Normal, Robustness, SampleLanes};
use super::field::OutlineField;

/// A step that gains less than this share of the cost is the last one: where distances are exact, and where more steps with
/// exact ones follow.
pub(crate) const LEAST_GAIN: f64 = 1e-4;
const ROUGH_GAIN: f64 = 1e-2;

/// A pose in pixels: v' = e^log_scale R(rotation) v + translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PosePx<T> {
    pub(crate) translation: [T; 2],
    pub(crate) log_scale: T,
    pub(crate) rotation: T,
}

/// What is left of an angle beyond whole periods, from minus half of one to half of one.
pub(crate) fn wrapped<T: Real>(angle: T, period: T) -> T {
    angle - period * (angle / period).round()
}

impl<T: Real> PosePx<T> {
    /// Leaves everything where it is.
    pub(crate) fn identity() -> Self {
        Self { translation: [T::zero(); 2], log_scale: T::zero(), rotation: T::zero() }
    }

    /// As a map of the plane in pixels.
    pub(crate) fn similarity(&self) -> Similarity<T> {
        let turn = Vec2::from_angle(self.rotation) * self.log_scale.exp();
        Similarity { turn, translation: self.translation.into(), reflected: false }
    }

    /// The pose in scene units, of which one has `unit_px` pixels.
    pub(crate) fn in_scene(&self, unit_px: T) -> Pose<T> {
        let translation = self.translation.map(|v| v / unit_px);
        Pose { translation, scale: self.log_scale.exp() / unit_px, rotation: self.rotation }
    }

    /// Damped Gauss-Newton steps; returns the pose, its cost and the steps taken.
    pub(crate) fn refine(
        self,
        field: &OutlineField<T>,
        samples: &SampleLanes<T>,
        robustness: Robustness<T>,
        max_steps: usize,
    ) -> (Self, T, usize) {
        let least_gain = T::of(if robustness.rough { ROUGH_GAIN } else { LEAST_GAIN });
        self.descend(max_steps, least_gain, |pose| pose.normal(field, samples, robustness))
    }

    /// Damped Gauss-Newton steps on any normal equations of a pose; returns as [`Self::refine`].
    #[inline(always)]
    pub(crate) fn descend(
        self,
        max_steps: usize,
        least_gain: T,
        normal_at: impl Fn(&Self) -> Normal<T>,
    ) -> (Self, T, usize) {
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
                let done = gain <= least_gain * normal.cost;
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

    /// As [`Self::to_unit`], for several points: their columns, their rows.
    #[inline(always)]
    pub(crate) fn to_units<const N: usize>(self, points: &[[T; N]; 2]) -> [[T; N]; 2] {
        let x: [T; N] = simd::lanes(|i| (points[0][i] - self.translation[0]) * self.inverse_scale);
        let y: [T; N] = simd::lanes(|i| (points[1][i] - self.translation[1]) * self.inverse_scale);
        [simd::lanes(|i| self.cos * x[i] + self.sin * y[i]), simd::lanes(|i| self.cos * y[i] - self.sin * x[i])]
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
