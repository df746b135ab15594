//! What samples ask of a pose: the robust mean of what they miss, and the normal equations of the four parameters.

use alloc::vec::Vec;

use dvp_core::{Real, simd};

use super::field::{Distances, OutlineField};
use super::gauss_newton::{Frame, PosePx};
use crate::segment::EdgeSample;

/// Samples looked at together.
const LANES: usize = 16;

/// Samples side by side, for poses to be compared with.
#[derive(Clone, Debug)]
pub(crate) struct SampleLanes<T> {
    blocks: Vec<Block<T>>,
}

#[derive(Clone, Copy, Debug)]
struct Block<T> {
    /// Columns and rows (px).
    points: [[T; LANES]; 2],
    /// Px.
    distances: [T; LANES],
    /// How much each counts; 0 where there is none.
    weights: [T; LANES],
}

impl<T: Real> SampleLanes<T> {
    /// Every `stride`-th sample, `weighted` by its squared slope (final) or all alike (search).
    pub(crate) fn new(samples: &[EdgeSample<T>], stride: usize, weighted: bool) -> Self {
        let zero = [T::zero(); LANES];
        let empty = Block { points: [zero; 2], distances: zero, weights: zero };
        let stride = stride.max(1);
        let blocks = samples.chunks(LANES * stride).map(|chunk| {
            let mut block = empty;
            for (i, sample) in chunk.iter().step_by(stride).enumerate() {
                (block.points[0][i], block.points[1][i]) = (sample.point[0], sample.point[1]);
                block.distances[i] = sample.distance;
                block.weights[i] = if weighted { sample.weight * sample.weight } else { T::one() };
            }
            block
        });
        Self { blocks: blocks.collect() }
    }
}

/// How residuals count.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Robustness<T> {
    /// Residual (px) at which a sample loses most of its say (Geman-McClure).
    pub(crate) width_px: T,
    /// Whether distances are right to first order about the cells of the field (search), or exact.
    pub(crate) rough: bool,
}

/// Normal equations of one pose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Normal<T> {
    pub(crate) hessian: [[T; 4]; 4],
    pub(crate) gradient: [T; 4],
    /// Robust mean of squared residuals (px^2), at most the squared width.
    pub(crate) cost: T,
}

impl<T: Real> PosePx<T> {
    /// Residuals of the samples, robustly summed into a mean; no derivatives.
    pub(crate) fn cost(&self, field: &OutlineField<T>, samples: &SampleLanes<T>, robustness: Robustness<T>) -> T {
        simd::dispatch(Cost(Comparison { frame: Frame::new(self), field, samples, robustness }))
    }

    /// Normal equations at this pose in (x, y, log scale, rotation).
    pub(crate) fn normal(
        &self,
        field: &OutlineField<T>,
        samples: &SampleLanes<T>,
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
        samples: &SampleLanes<T>,
        robustness: Robustness<T>,
        inverse_squared_width: impl Fn(T) -> T,
    ) -> Normal<T> {
        let comparison = Comparison { frame: Frame::new(self), field, samples, robustness };
        simd::dispatch(Equations(comparison, inverse_squared_width))
    }
}

/// Samples, and the outline they are compared with.
struct Comparison<'a, T> {
    frame: Frame<T>,
    field: &'a OutlineField<T>,
    samples: &'a SampleLanes<T>,
    robustness: Robustness<T>,
}

/// What some samples miss the outline by.
struct Residuals<T> {
    /// In the unit frame of the outline.
    points: [[T; LANES]; 2],
    distances: Distances<T, LANES>,
    /// Px.
    residual: [T; LANES],
    squared: [T; LANES],
}

impl<T: Real> Comparison<'_, T> {
    #[inline(always)]
    fn residuals(&self, block: &Block<T>) -> Residuals<T> {
        let points = self.frame.to_units(&block.points);
        let distances = if self.robustness.rough { self.field.rough(&points) } else { self.field.exact(&points) };
        let scale = self.frame.scale;
        let residual: [T; LANES] = simd::lanes(|i| scale * distances.distance[i] - block.distances[i]);
        let squared = simd::lanes(|i| residual[i] * residual[i]);
        Residuals { points, distances, residual, squared }
    }
}

/// Makes the cost alone.
struct Cost<'a, T>(Comparison<'a, T>);

impl<T: Real> simd::Kernel for Cost<'_, T> {
    type Output = T;

    #[inline(always)]
    fn run(self) -> T {
        let width = self.0.robustness.width_px;
        let (one, inverse) = (T::one(), T::one() / (width * width));
        let (mut cost, mut total) = ([T::zero(); LANES], [T::zero(); LANES]);
        for block in &self.0.samples.blocks {
            let Residuals { squared, .. } = self.0.residuals(block);
            let base = &block.weights;
            cost = simd::lanes(|i| cost[i] + base[i] * squared[i] / (one + squared[i] * inverse));
            total = simd::lanes(|i| total[i] + base[i]);
        }
        mean(cost, total)
    }
}

/// Makes the normal equations.
struct Equations<'a, T, W>(Comparison<'a, T>, W);

impl<T: Real, W: Fn(T) -> T> simd::Kernel for Equations<'_, T, W> {
    type Output = Normal<T>;

    #[inline(always)]
    fn run(self) -> Normal<T> {
        let Self(comparison, inverse_squared_width) = self;
        let frame = comparison.frame;
        let (zero, one) = (T::zero(), T::one());
        let (mut cost, mut total) = ([zero; LANES], [zero; LANES]);
        let (mut gradient, mut hessian) = ([[zero; LANES]; 4], [[zero; LANES]; 10]);
        for block in &comparison.samples.blocks {
            let Residuals { points: [x, y], distances, residual, squared } = comparison.residuals(block);
            let base = &block.weights;
            let Distances { distance, gradient: [nx, ny] } = distances;
            let inverse: [T; LANES] = simd::lanes(|i| inverse_squared_width(residual[i]));
            let falloff: [T; LANES] = simd::lanes(|i| one / (one + squared[i] * inverse[i]));
            cost = simd::lanes(|i| cost[i] + base[i] * squared[i] * falloff[i]);
            total = simd::lanes(|i| total[i] + base[i]);
            let weight: [T; LANES] = simd::lanes(|i| base[i] * falloff[i] * falloff[i]);
            let rows: [[T; LANES]; 4] = [
                simd::lanes(|i| frame.sin * ny[i] - frame.cos * nx[i]),
                simd::lanes(|i| -(frame.sin * nx[i] + frame.cos * ny[i])),
                simd::lanes(|i| frame.scale * (distance[i] - nx[i] * x[i] - ny[i] * y[i])),
                simd::lanes(|i| frame.scale * (nx[i] * y[i] - ny[i] * x[i])),
            ];
            let mut entry = 0;
            for a in 0..4 {
                let scaled: [T; LANES] = simd::lanes(|i| weight[i] * rows[a][i]);
                gradient[a] = simd::lanes(|i| gradient[a][i] + scaled[i] * residual[i]);
                for b in 0..=a {
                    hessian[entry] = simd::lanes(|i| hessian[entry][i] + scaled[i] * rows[b][i]);
                    entry += 1;
                }
            }
        }
        let mut normal = Normal { hessian: [[zero; 4]; 4], gradient: [zero; 4], cost: mean(cost, total) };
        let mut entry = 0;
        for a in 0..4 {
            normal.gradient[a] = simd::total(gradient[a]);
            for b in 0..=a {
                let value = simd::total(hessian[entry]);
                (normal.hessian[a][b], normal.hessian[b][a]) = (value, value);
                entry += 1;
            }
        }
        normal
    }
}

/// The weighted mean; infinite without samples.
#[inline(always)]
fn mean<T: Real>(cost: [T; LANES], total: [T; LANES]) -> T {
    let total = simd::total(total);
    if total > T::zero() { simd::total(cost) / total } else { T::infinity() }
}
