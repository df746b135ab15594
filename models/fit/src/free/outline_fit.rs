//! Gauss-Newton on center and elliptic Fourier coefficients: the outline shall lie at the sampled distances.
//!
//! Unknown shape, so everything is linear but the choice of the nearest edge: vertices are linear in the coefficients,
//! and the distance of a sample moves with the vertices of its nearest edge. Sliding along the outline changes nothing;
//! the damping keeps the coefficients where they are in those directions.

use alloc::vec::Vec;

use dvp_core::{Real, simd};

use super::basis::Basis;
use super::foot::{EdgeLanes, foot};
use crate::cholesky::{factor, packed, solve};
use crate::segment::EdgeSample;

/// Center (px) and rows (a, b, c, d) in px: x = cx + sum a cos + b sin, y = cy + sum c cos + d sin.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct FreeOutline<T> {
    pub(crate) center: [T; 2],
    pub(crate) rows: Vec<[T; 4]>,
}

/// Memory of [`refine`].
#[derive(Clone, Debug, Default)]
pub(crate) struct OutlineScratch<T> {
    vertices: Vec<[T; 2]>,
    hessian: Vec<T>,
    pub(super) gradient: Vec<T>,
    damped: Vec<T>,
    mix: Vec<T>,
    tried: FreeOutline<T>,
    edges: EdgeLanes<T>,
}

/// Settings of one refinement.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OutlineSettings<T> {
    /// Residual (px) at which a sample loses most of its say.
    pub(crate) width_px: T,
    /// Noise of a pixel value: weights of samples are divided by it.
    pub(crate) pixel_noise: T,
    /// Pull of harmonic n towards 0, times n^4: keeps stretches without samples smooth.
    pub(crate) smoothness: T,
    pub(crate) max_steps: usize,
}

impl<T: Real> FreeOutline<T> {
    pub(crate) fn write_vertices(&self, basis: &Basis<T>, vertex_count: usize, vertices: &mut Vec<[T; 2]>) {
        vertices.clear();
        for i in 0..vertex_count {
            let row = basis.row(i, self.rows.len());
            let [mut x, mut y] = self.center;
            for (pair, &[a, b, c, d]) in row[1..].chunks_exact(2).zip(&self.rows) {
                x += a * pair[0] + b * pair[1];
                y += c * pair[0] + d * pair[1];
            }
            vertices.push([x, y]);
        }
    }
}

/// Moves `outline` until the samples lie at their distances; returns the robust sum of squared residuals in units of
/// the pixel noise.
pub(crate) fn refine<T: Real>(
    outline: &mut FreeOutline<T>,
    samples: &[EdgeSample<T>],
    basis: &Basis<T>,
    vertex_count: usize,
    settings: &OutlineSettings<T>,
    scratch: &mut OutlineScratch<T>,
) -> T {
    simd::dispatch(Refine { outline, samples, basis, vertex_count, settings, scratch })
}

/// The arguments of [`refine`], compiled per instruction set.
struct Refine<'a, T> {
    outline: &'a mut FreeOutline<T>,
    samples: &'a [EdgeSample<T>],
    basis: &'a Basis<T>,
    vertex_count: usize,
    settings: &'a OutlineSettings<T>,
    scratch: &'a mut OutlineScratch<T>,
}

impl<T: Real> simd::Kernel for Refine<'_, T> {
    type Output = T;

    #[inline(always)]
    fn run(self) -> T {
        steps(self.outline, self.samples, self.basis, self.vertex_count, self.settings, self.scratch)
    }
}

#[inline(always)]
fn steps<T: Real>(
    outline: &mut FreeOutline<T>,
    samples: &[EdgeSample<T>],
    basis: &Basis<T>,
    vertex_count: usize,
    settings: &OutlineSettings<T>,
    scratch: &mut OutlineScratch<T>,
) -> T {
    let harmonics = outline.rows.len();
    let half = 1 + 2 * harmonics;
    let n = 2 * half;
    let mut cost = assemble(outline, samples, basis, vertex_count, settings, scratch);
    // Weaker damping lets vertices slide along the outline and fold it.
    let weakest = T::of(1e-3);
    let mut damping = T::of(4e-3);
    for _ in 0..settings.max_steps {
        scratch.damped.clear();
        scratch.damped.extend_from_slice(&scratch.hessian);
        let trace = (0..n).map(|i| scratch.hessian[packed(i, i)]).sum::<T>() / T::of_usize(n);
        for i in 0..n {
            scratch.damped[packed(i, i)] += damping * trace;
        }
        if !factor(&mut scratch.damped, n) {
            damping *= T::of(10.0);
            continue;
        }
        let mut step = core::mem::take(&mut scratch.gradient);
        solve(&scratch.damped, n, &mut step);
        let mut tried = core::mem::take(&mut scratch.tried);
        tried.center = [outline.center[0] - step[0], outline.center[1] - step[half]];
        tried.rows.clear();
        tried.rows.extend(outline.rows.iter().enumerate().map(|(k, &[a, b, c, d])| {
            let (x, y) = (1 + 2 * k, half + 1 + 2 * k);
            [a - step[x], b - step[x + 1], c - step[y], d - step[y + 1]]
        }));
        scratch.gradient = step;
        let next = assemble(&tried, samples, basis, vertex_count, settings, scratch);
        let better = next < cost;
        if better {
            core::mem::swap(outline, &mut tried);
        }
        scratch.tried = tried;
        if better {
            let done = cost - next <= T::of(1e-3) * cost;
            cost = next;
            damping = (damping * T::of(0.25)).max(weakest);
            if done {
                break;
            }
        } else {
            damping *= T::of(10.0);
            if damping > T::of(10.0) {
                break;
            }
            cost = assemble(outline, samples, basis, vertex_count, settings, scratch);
        }
    }
    cost
}

/// Fills hessian (packed) and gradient at `outline`; returns the robust cost.
#[inline(always)]
pub(super) fn assemble<T: Real>(
    outline: &FreeOutline<T>,
    samples: &[EdgeSample<T>],
    basis: &Basis<T>,
    vertex_count: usize,
    settings: &OutlineSettings<T>,
    scratch: &mut OutlineScratch<T>,
) -> T {
    let harmonics = outline.rows.len();
    let half = 1 + 2 * harmonics;
    let n = 2 * half;
    let mut vertices = core::mem::take(&mut scratch.vertices);
    outline.write_vertices(basis, vertex_count, &mut vertices);
    scratch.hessian.clear();
    scratch.hessian.resize(packed(n, 0), T::zero());
    scratch.gradient.clear();
    scratch.gradient.resize(n, T::zero());
    scratch.mix.resize(half, T::zero());
    scratch.edges.set(&vertices);
    let inverse = T::one() / (settings.width_px * settings.width_px);
    let noise = T::one() / (settings.pixel_noise * settings.pixel_noise);
    let mut cost = T::zero();
    for sample in samples {
        let foot = foot(&vertices, &mut scratch.edges, sample.point);
        let (at, u, direction) = (foot.edge, foot.share, foot.direction);
        let residual = foot.distance - sample.distance;
        let squared = residual * residual;
        let base = sample.weight * sample.weight * noise;
        let falloff = T::one() / (T::one() + squared * inverse);
        cost += base * squared * falloff;
        let weight = base * falloff * falloff;
        // Row of the Jacobian: -(direction) x mix of the basis rows of the two vertices.
        let (row_a, row_b) = (basis.row(at, harmonics), basis.row(at + 1, harmonics));
        for ((m, &p), &q) in scratch.mix.iter_mut().zip(row_a).zip(row_b) {
            *m = p + u * (q - p);
        }
        let [nx, ny] = direction;
        let pull = -weight * residual;
        let (wxx, wxy, wyy) = (weight * nx * nx, weight * nx * ny, weight * ny * ny);
        for i in 0..half {
            let m = scratch.mix[i];
            scratch.gradient[i] += pull * nx * m;
            scratch.gradient[half + i] += pull * ny * m;
            let (xx, xy, yy) = (wxx * m, wxy * m, wyy * m);
            let row = &mut scratch.hessian[packed(i, 0)..=packed(i, i)];
            for (h, &k) in row.iter_mut().zip(&scratch.mix) {
                *h += xx * k;
            }
            let row = &mut scratch.hessian[packed(half + i, 0)..=packed(half + i, half + i)];
            let (cross, own) = row.split_at_mut(half);
            for (h, &k) in cross.iter_mut().zip(&scratch.mix) {
                *h += xy * k;
            }
            for (h, &k) in own.iter_mut().zip(&scratch.mix) {
                *h += yy * k;
            }
        }
    }
    // Smoothness: sum over harmonics of n^4 |row|^2.
    for (k, row) in outline.rows.iter().enumerate().skip(1) {
        let order = T::of_usize(k + 1);
        let pull = settings.smoothness * order * order * order * order;
        for (c, &value) in row.iter().enumerate() {
            let i = if c < 2 { 1 + 2 * k + c } else { half + 1 + 2 * k + c - 2 };
            scratch.hessian[packed(i, i)] += pull;
            scratch.gradient[i] += pull * value;
            cost += pull * value * value;
        }
    }
    scratch.vertices = vertices;
    cost
}
