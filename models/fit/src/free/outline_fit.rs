//! Gauss-Newton on center and elliptic Fourier coefficients: the outline shall lie at the sampled distances.
//!
//! Unknown shape, so everything is linear but the choice of the nearest edge: vertices are linear in the coefficients,
//! and the distance of a sample moves with the vertices of its nearest edge. Sliding along the outline changes nothing;
//! the damping keeps the coefficients where they are in those directions.

use alloc::vec::Vec;

use dvp_core::scene::Pose;
use dvp_core::shape::REFERENCE_VERTICES;
use dvp_core::{Efd, Real, simd};

use super::basis::Basis;
use super::foot::{EdgeLanes, foot};
use crate::cholesky::{factor, packed, solve};
use crate::segment::EdgeSample;

/// Least weight of a vertex that samples are near, as a share of the mean weight: less than what holds a cropped outline outside.
const SEEN: f64 = 1e-3;
/// Weight of an unseen vertex where it stands, likewise.
const UNSEEN_HOLD: f64 = 0.02;
/// So many vertices to either side must be unseen as well: between samples that are sparse one may be.
const UNSEEN_AROUND: usize = 2;

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
    edges: EdgeLanes<T>,
    /// Normal equations of the vertices: blocks (xx, xy, yy) of each vertex with itself and with the next one, and the
    /// gradient.
    own: Vec<[T; 3]>,
    next: Vec<[T; 3]>,
    pull: Vec<[T; 2]>,
    /// Whether no sample is near a vertex.
    unseen: Vec<bool>,
    /// Squared residuals in units of the noise.
    pub(super) squares: Vec<T>,
    pub(super) hessian: Vec<T>,
    pub(super) gradient: Vec<T>,
    mix: [Vec<T>; 2],
    tried: FreeOutline<T>,
}

/// What an outline is fitted to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Target<'a, T> {
    pub(crate) samples: &'a [EdgeSample<T>],
    pub(crate) basis: &'a Basis<T>,
    /// Vertices of the outline, the last one the first again.
    pub(crate) vertex_count: usize,
    pub(crate) settings: OutlineSettings<T>,
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
    /// Unknown `i`: x and y of the center, then per harmonic those of its cosine and of its sine, (a, c) and (b, d), so that
    /// the first 2 + 4 n are an outline of n harmonics.
    pub(crate) fn coefficient(&self, i: usize) -> T {
        i.checked_sub(2).map_or_else(|| self.center[i], |i| self.rows[i / 4][of_row(i)])
    }

    /// The same to be changed.
    pub(crate) fn coefficient_mut(&mut self, i: usize) -> &mut T {
        match i.checked_sub(2) {
            None => &mut self.center[i],
            Some(i) => &mut self.rows[i / 4][of_row(i)],
        }
    }

    /// Its shape, and its pose with lengths in units of `unit_px`: turned and scaled so that the long axis of the first harmonic is
    /// 1 along x, and started at the vertex nearest to that axis. A start between two vertices would move them all along the
    /// curve, and a polygon cuts corners elsewhere then than where it was fitted to. None if the first harmonic is 0.
    pub(crate) fn normal_form(&self, unit_px: T) -> Option<(Efd<T>, Pose<T>)> {
        let mut normal = Efd::new(self.rows.clone()).normalize().ok()?;
        let step = T::of(core::f64::consts::TAU / f64::of_usize(REFERENCE_VERTICES - 1));
        normal.efd.shift((normal.phase / step).round() * step - normal.phase);
        let translation = self.center.map(|v| v / unit_px);
        Some((normal.efd, Pose { translation, scale: normal.scale / unit_px, rotation: normal.rotation }))
    }

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

/// Where in (a, b, c, d) an unknown of a row is, which come as (a, c, b, d).
fn of_row(i: usize) -> usize {
    i % 2 * 2 + i / 2 % 2
}

/// Moves `outline` until the samples lie at their distances; returns the robust sum of squared residuals in units of
/// the pixel noise.
pub(crate) fn refine<T: Real>(
    outline: &mut FreeOutline<T>,
    target: &Target<'_, T>,
    scratch: &mut OutlineScratch<T>,
) -> T {
    simd::dispatch(Refine { outline, target, scratch })
}

/// The arguments of [`refine`], compiled per instruction set.
struct Refine<'a, T> {
    outline: &'a mut FreeOutline<T>,
    target: &'a Target<'a, T>,
    scratch: &'a mut OutlineScratch<T>,
}

impl<T: Real> simd::Kernel for Refine<'_, T> {
    type Output = T;

    #[inline(always)]
    fn run(self) -> T {
        steps(self.outline, self.target, self.scratch)
    }
}

#[inline(always)]
fn steps<T: Real>(outline: &mut FreeOutline<T>, target: &Target<'_, T>, scratch: &mut OutlineScratch<T>) -> T {
    let n = 2 + 4 * outline.rows.len();
    let mut cost = gather(outline, target, scratch);
    // Weaker damping lets vertices slide along the outline and fold it.
    let weakest = T::of(1e-3);
    let mut damping = T::of(4e-3);
    for _ in 0..target.settings.max_steps {
        expand(outline, target, scratch);
        damp(&mut scratch.hessian, n, damping);
        if !factor(&mut scratch.hessian, n) {
            damping *= T::of(10.0);
            continue;
        }
        solve(&scratch.hessian, n, &mut scratch.gradient);
        let mut tried = core::mem::take(&mut scratch.tried);
        tried.clone_from(outline);
        for (i, &step) in scratch.gradient.iter().enumerate() {
            *tried.coefficient_mut(i) -= step;
        }
        let next = gather(&tried, target, scratch);
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
            gather(outline, target, scratch);
        }
    }
    cost
}

/// Sums the samples into what they say of the vertices; returns the robust cost.
///
/// A sample moves with the two vertices of its nearest edge, so the normal equations of the vertices are a band, and
/// small; [`expand`] carries them over to the coefficients.
#[inline(always)]
pub(super) fn gather<T: Real>(outline: &FreeOutline<T>, target: &Target<'_, T>, scratch: &mut OutlineScratch<T>) -> T {
    let &Target { samples, basis, vertex_count, ref settings } = target;
    let edges = vertex_count - 1;
    let OutlineScratch { vertices, edges: lanes, own, next, pull, squares, .. } = scratch;
    squares.clear();
    outline.write_vertices(basis, vertex_count, vertices);
    lanes.set(vertices);
    for blocks in [&mut *own, &mut *next] {
        blocks.clear();
        blocks.resize(edges, [T::zero(); 3]);
    }
    pull.clear();
    pull.resize(edges, [T::zero(); 2]);
    let width = settings.width_px * settings.width_px;
    let noise = T::one() / (settings.pixel_noise * settings.pixel_noise);
    let mut cost = T::zero();
    for sample in samples {
        let foot = foot(vertices, lanes, sample.point);
        let residual = foot.distance - sample.distance;
        let squared = residual * residual;
        let base = sample.weight * sample.weight * noise;
        let falloff = outlying(squared, base, width);
        cost += base * squared * falloff;
        squares.push(base * squared);
        let weight = base * falloff * falloff;
        // The distance falls by (1 - u) n and u n as the vertices move.
        let [nx, ny] = foot.direction;
        let outer = [weight * nx * nx, weight * nx * ny, weight * ny * ny];
        let (i, j) = (foot.edge, if foot.edge + 1 == edges { 0 } else { foot.edge + 1 });
        let (p, q) = (T::one() - foot.share, foot.share);
        for c in 0..3 {
            own[i][c] += outer[c] * p * p;
            own[j][c] += outer[c] * q * q;
            next[i][c] += outer[c] * p * q;
        }
        for (c, n) in [nx, ny].into_iter().enumerate() {
            pull[i][c] -= weight * residual * n * p;
            pull[j][c] -= weight * residual * n * q;
        }
    }
    for (k, row) in outline.rows.iter().enumerate().skip(1) {
        let pull = stiffness(k, settings);
        cost += row.iter().map(|&value| pull * value * value).sum::<T>();
    }
    cost
}

/// The say that is left to a sample with a `squared` residual (px), which says `base` of it (one over its variance): half of it at a
/// squared residual of `width`, that of what the outline may be off, and of the sample's own variance together. By the width alone all samples of
/// much noise were outliers, and none told a square from an ellipse.
#[inline(always)]
pub(super) fn outlying<T: Real>(squared: T, base: T, width: T) -> T {
    T::one() / (T::one() + squared * base / (base * width + T::one()))
}

/// Pull of row `k` (harmonic k + 1) towards 0.
#[inline(always)]
fn stiffness<T: Real>(k: usize, settings: &OutlineSettings<T>) -> T {
    let order = T::of_usize(k + 1);
    settings.smoothness * order * order * order * order
}

/// Fills hessian (packed) and gradient of the coefficients from what [`gather`] left.
#[inline(always)]
pub(super) fn expand<T: Real>(outline: &FreeOutline<T>, target: &Target<'_, T>, scratch: &mut OutlineScratch<T>) {
    let &Target { basis, ref settings, .. } = target;
    let harmonics = outline.rows.len();
    let n = 2 + 4 * harmonics;
    let OutlineScratch { hessian, gradient, mix, own, next, pull, unseen, .. } = scratch;
    hessian.clear();
    hessian.resize(packed(n, 0), T::zero());
    gradient.clear();
    gradient.resize(n, T::zero());
    let edges = own.len();
    if harmonics > 1 {
        hold_unseen(own, unseen);
    }
    for i in 0..edges {
        let (before, after) = (if i == 0 { edges - 1 } else { i - 1 }, if i + 1 == edges { 0 } else { i + 1 });
        let (row, row_before, row_after) =
            (basis.row(i, harmonics), basis.row(before, harmonics), basis.row(after, harmonics));
        // The two rows of vertex i of the vertices' equations times the basis, x and y of each unknown side by side.
        for (axis, part) in mix.iter_mut().enumerate() {
            let pair = |block: [T; 3]| [block[axis], block[axis + 1]];
            let (here, back, ahead) = (pair(own[i]), pair(next[before]), pair(next[i]));
            part.resize(2 * row.len(), T::zero());
            for (m, ((&p, &q), &r)) in part.as_chunks_mut().0.iter_mut().zip(row.iter().zip(row_before).zip(row_after))
            {
                *m = [here[0] * p + back[0] * q + ahead[0] * r, here[1] * p + back[1] * q + ahead[1] * r];
            }
        }
        for (k, &value) in row.iter().enumerate() {
            for axis in 0..2 {
                let unknown = 2 * k + axis;
                gradient[unknown] += pull[i][axis] * value;
                let line = &mut hessian[packed(unknown, 0)..=packed(unknown, unknown)];
                for (h, &m) in line.iter_mut().zip(&mix[axis]) {
                    *h += value * m;
                }
            }
        }
    }
    for i in 6..n {
        let pull = stiffness((i - 2) / 4, settings);
        hessian[packed(i, i)] += pull;
        gradient[i] += pull * outline.coefficient(i);
    }
}

/// Damps vertices in the middle of others that no sample is near: nothing else would hold what is hidden of an outline where it was
/// traced, while the rest of it finds its place. An ellipse goes on as it must.
#[inline(always)]
fn hold_unseen<T: Real>(own: &mut [[T; 3]], unseen: &mut Vec<bool>) {
    let weight = |block: &[T; 3]| block[0] + block[2];
    let count = own.len();
    let mean = own.iter().map(weight).sum::<T>() / T::of_usize(count);
    let [seen, hold] = [SEEN, UNSEEN_HOLD].map(|share| T::of(share) * mean);
    unseen.clear();
    unseen.extend(own.iter().map(|block| weight(block) < seen));
    for (i, block) in own.iter_mut().enumerate() {
        if (count + i - UNSEEN_AROUND..=count + i + UNSEEN_AROUND).all(|k| unseen[k % count]) {
            block[0] += hold;
            block[2] += hold;
        }
    }
}

/// Adds `damping` times the mean of the diagonal to it.
#[inline(always)]
pub(crate) fn damp<T: Real>(hessian: &mut [T], n: usize, damping: T) {
    let trace = (0..n).map(|i| hessian[packed(i, i)]).sum::<T>() / T::of_usize(n);
    for i in 0..n {
        hessian[packed(i, i)] += damping * trace;
    }
}
