//! Vertices moved along their normals until the polygon lies at the sampled distances.
//!
//! The fast fit of an unknown outline: one unknown per vertex, and nothing can slide along the outline; where normals run together it
//! may cross itself (`loops`). With 63 vertices at equal distances, center and harmonics 1 to 31 are their discrete Fourier transform.

use alloc::vec::Vec;

use dvp_core::{Real, simd};

use super::basis::Basis;
use super::foot::{EdgeLanes, foot};
use super::outline_fit::{FreeOutline, outlying};
use crate::cholesky::{factor, packed, solve};
use crate::segment::EdgeSample;
use crate::tuning::VERTEX_COUPLING;

/// Memory of [`move_vertices`].
#[derive(Clone, Debug, Default)]
pub(crate) struct PolygonScratch<T> {
    lanes: EdgeLanes<T>,
    normals: Vec<[T; 2]>,
    matrix: Vec<T>,
    gradient: Vec<T>,
}

/// Moves `vertices` (closed: the last repeats the first); `width_px` is the residual at which a sample loses most of its
/// say. Returns the robust sum of squared residuals before the last step, in units of `pixel_noise`.
pub(crate) fn move_vertices<T: Real>(
    vertices: &mut [[T; 2]],
    samples: &[EdgeSample<T>],
    width_px: T,
    pixel_noise: T,
    steps: usize,
    scratch: &mut PolygonScratch<T>,
) -> T {
    simd::dispatch(Move { vertices, samples, width_px, pixel_noise, steps, scratch })
}

struct Move<'a, T> {
    vertices: &'a mut [[T; 2]],
    samples: &'a [EdgeSample<T>],
    width_px: T,
    pixel_noise: T,
    steps: usize,
    scratch: &'a mut PolygonScratch<T>,
}

impl<T: Real> simd::Kernel for Move<'_, T> {
    type Output = T;

    #[inline(always)]
    fn run(mut self) -> T {
        let mut cost = T::zero();
        for _ in 0..self.steps {
            cost = self.assemble();
            if !self.step() {
                break;
            }
        }
        cost
    }
}

impl<T: Real> Move<'_, T> {
    #[inline(always)]
    fn assemble(&mut self) -> T {
        let n = self.vertices.len() - 1;
        let PolygonScratch { lanes, normals, matrix, gradient } = &mut *self.scratch;
        lanes.set(self.vertices);
        normals.clear();
        for i in 0..n {
            let (a, b) = (self.vertices[(i + n - 1) % n], self.vertices[i + 1]);
            let (x, y) = (b[0] - a[0], b[1] - a[1]);
            let length = (x * x + y * y).sqrt().max(T::of(1e-6));
            normals.push([y * lanes.orientation / length, -x * lanes.orientation / length]);
        }
        matrix.clear();
        matrix.resize(packed(n, 0), T::zero());
        gradient.clear();
        gradient.resize(n, T::zero());
        let width = self.width_px * self.width_px;
        let noise = T::one() / (self.pixel_noise * self.pixel_noise);
        let (mut cost, mut total) = (T::zero(), T::zero());
        for sample in self.samples {
            let foot = foot(self.vertices, lanes, sample.point);
            let residual = foot.distance - sample.distance;
            let squared = residual * residual;
            let base = sample.weight * sample.weight * noise;
            let falloff = outlying(squared, base, width);
            cost += base * squared * falloff;
            let weight = base * falloff * falloff;
            total += weight;
            let (i, j) = (foot.edge, if foot.edge + 1 == n { 0 } else { foot.edge + 1 });
            let along = |k: usize| foot.direction[0] * normals[k][0] + foot.direction[1] * normals[k][1];
            let (p, q) = (-(T::one() - foot.share) * along(i), -foot.share * along(j));
            gradient[i] += weight * p * residual;
            gradient[j] += weight * q * residual;
            matrix[packed(i, i)] += weight * p * p;
            matrix[packed(j, j)] += weight * q * q;
            matrix[packed(i.max(j), i.min(j))] += weight * p * q;
        }
        let coupling = T::of(VERTEX_COUPLING) * total / T::of_usize(n) + T::of(1e-3);
        for i in 0..n {
            let j = if i + 1 == n { 0 } else { i + 1 };
            matrix[packed(i, i)] += T::of(2.01) * coupling;
            matrix[packed(i.max(j), i.min(j))] -= coupling;
        }
        cost
    }

    #[inline(always)]
    fn step(&mut self) -> bool {
        let n = self.vertices.len() - 1;
        let PolygonScratch { normals, matrix, gradient, .. } = &mut *self.scratch;
        if !factor(matrix, n) {
            return false;
        }
        solve(matrix, n, gradient);
        let limit = T::one() + T::one();
        for i in 0..n {
            let step = gradient[i].max(-limit).min(limit);
            for (v, &normal) in self.vertices[i].iter_mut().zip(&normals[i]) {
                *v -= step * normal;
            }
        }
        self.vertices[n] = self.vertices[0];
        true
    }
}

/// Center and the first `harmonics` harmonics of a closed polygon with vertices at equal parameters.
pub(crate) fn transform<T: Real>(vertices: &[[T; 2]], basis: &Basis<T>, harmonics: usize) -> FreeOutline<T> {
    let n = vertices.len() - 1;
    let mut outline = FreeOutline { center: [T::zero(); 2], rows: alloc::vec![[T::zero(); 4]; harmonics] };
    let scale = T::one() / T::of_usize(n);
    for (i, &[x, y]) in vertices[..n].iter().enumerate() {
        outline.center[0] += x * scale;
        outline.center[1] += y * scale;
        let row = basis.row(i, harmonics);
        for (pair, coefficients) in row[1..].chunks_exact(2).zip(&mut outline.rows) {
            let (cos, sin) = (pair[0] * (scale + scale), pair[1] * (scale + scale));
            coefficients[0] += x * cos;
            coefficients[1] += x * sin;
            coefficients[2] += y * cos;
            coefficients[3] += y * sin;
        }
    }
    outline
}
