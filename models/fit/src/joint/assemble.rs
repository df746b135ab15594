//! Normal equations of poses and colors from the pixels near outlines.

use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::render::Compositing;
use dvp_core::scene::PixelProfile;

use super::{JointProblem, JointScene, PER_OBJECT};
use crate::cholesky::packed;
use crate::pose::gauss_newton::Frame;

/// Every how many rows and columns a pixel away from all outlines is looked at, for the colors.
const INTERIOR_STRIDE: usize = 4;
/// Coverage this close to 1 counts as 1.
const SATURATION: f64 = 1e-4;

/// Memory of the refinement, with the equations in it.
#[derive(Clone, Debug, Default)]
pub(crate) struct JointScratch<T> {
    pub(crate) hessian: Vec<T>,
    pub(crate) gradient: Vec<T>,
    pub(super) damped: Vec<T>,
    pub(super) step: Vec<T>,
    pub(super) tried: JointScene<T>,
    frames: Vec<Frame<T>>,
    /// Per object: first and last column and row (exclusive) it can cover.
    boxes: Vec<[usize; 4]>,
    covers: Vec<Cover<T>>,
    rows: Vec<[T; PER_OBJECT]>,
}

/// An object at a pixel.
#[derive(Clone, Copy, Debug)]
struct Cover<T> {
    object: usize,
    coverage: T,
    /// Derivative of the coverage with respect to x, y, log scale, rotation.
    slope: [T; 4],
    /// Products and weights of compositing: derivative of a channel is `to_color` for the object's own color, and
    /// `to_coverage[c]` for its coverage.
    to_color: T,
    to_coverage: [T; 3],
}

/// The edge profile in pixels.
#[derive(Clone, Copy, Debug)]
struct Band<T> {
    profile: PixelProfile<T>,
    /// Distances (px) beyond which coverage is 1 (inside) and 0 (outside).
    inside: T,
    outside: T,
}

impl<T: Real> JointScratch<T> {
    /// Fills hessian and gradient at `scene`; returns the robust cost.
    pub(crate) fn assemble(&mut self, problem: &JointProblem<'_, T>, scene: &JointScene<T>) -> T {
        let n = scene.objects.len() * PER_OBJECT + 3;
        self.hessian.clear();
        self.hessian.resize(packed(n, 0), T::zero());
        self.gradient.clear();
        self.gradient.resize(n, T::zero());
        let band = Band::new(problem);
        self.place(problem, scene, &band);
        let size = problem.image.size();
        let stride = if problem.coarse { band.stride() } else { 1 };
        let near_weight = T::of_usize(stride * stride);
        let mut cost = T::zero();
        // Each pixel once, by the first object whose band holds it; interiors on a coarse grid for the colors.
        for first in 0..scene.objects.len() {
            let [left, top, right, bottom] = self.boxes[first];
            for row in (top.next_multiple_of(stride)..bottom).step_by(stride) {
                for column in (left.next_multiple_of(stride)..right).step_by(stride) {
                    let interior = row % INTERIOR_STRIDE == 0 && column % INTERIOR_STRIDE == 0;
                    let near = self.near(problem, scene, &band, first, column, row);
                    if !(near || problem.colors && interior && self.inside_box(first, column, row)) {
                        continue;
                    }
                    let earlier = (0..first).any(|k| {
                        self.inside_box(k, column, row) && {
                            (problem.colors && interior) || self.near(problem, scene, &band, k, column, row)
                        }
                    });
                    if earlier {
                        continue;
                    }
                    let weight = if near { near_weight } else { T::of_usize(INTERIOR_STRIDE * INTERIOR_STRIDE) };
                    let index = row * size.width() + column;
                    cost += self.add_pixel(problem, scene, &band, [column, row], index, weight);
                }
            }
        }
        cost
    }

    fn inside_box(&self, object: usize, column: usize, row: usize) -> bool {
        let [left, top, right, bottom] = self.boxes[object];
        column >= left && column < right && row >= top && row < bottom
    }

    /// Frames and boxes of all objects.
    fn place(&mut self, problem: &JointProblem<'_, T>, scene: &JointScene<T>, band: &Band<T>) {
        let size = problem.image.size();
        self.frames.clear();
        self.boxes.clear();
        for object in &scene.objects {
            let frame = Frame::new(&object.pose);
            let field = &problem.shapes[object.shape].field;
            let reach = frame.scale * field.radius + band.outside;
            let bounds = |center: T, extent: usize| {
                let limit = T::of_usize(extent);
                let low = (center - reach).max(T::zero()).min(limit).floor().to_count();
                let high = (center + reach).max(T::zero()).min(limit).ceil().to_count();
                (low, high)
            };
            let (left, right) = bounds(object.pose.translation[0], size.width());
            let (top, bottom) = bounds(object.pose.translation[1], size.height());
            self.frames.push(frame);
            self.boxes.push([left, top, right, bottom]);
        }
    }

    /// Whether the pixel lies in the soft band of the object, by the coarse distance of its grid cell.
    #[inline(always)]
    fn near(
        &self,
        problem: &JointProblem<'_, T>,
        scene: &JointScene<T>,
        band: &Band<T>,
        object: usize,
        column: usize,
        row: usize,
    ) -> bool {
        let half = T::of(0.5);
        let frame = self.frames[object];
        let u = frame.to_unit([T::of_usize(column) + half, T::of_usize(row) + half]);
        let (low, high) = problem.shapes[scene.objects[object].shape].field.distance_bounds(u);
        low * frame.scale < band.outside && high * frame.scale > -band.inside
    }

    fn add_pixel(
        &mut self,
        problem: &JointProblem<'_, T>,
        scene: &JointScene<T>,
        band: &Band<T>,
        [column, row]: [usize; 2],
        index: usize,
        pixel_weight: T,
    ) -> T {
        let half = T::of(0.5);
        let point = [T::of_usize(column) + half, T::of_usize(row) + half];
        self.covers.clear();
        for (k, object) in scene.objects.iter().enumerate() {
            if !self.inside_box(k, column, row) {
                continue;
            }
            let frame = self.frames[k];
            let u = frame.to_unit(point);
            let (distance, normal) = problem.shapes[object.shape].field.distance(u);
            let (coverage, change) = band.profile.coverage(distance * frame.scale);
            if coverage <= T::zero() {
                continue;
            }
            let slope = [
                -(frame.cos * normal[0] - frame.sin * normal[1]) * change,
                -(frame.sin * normal[0] + frame.cos * normal[1]) * change,
                frame.scale * (distance - normal[0] * u[0] - normal[1] * u[1]) * change,
                frame.scale * (normal[0] * u[1] - normal[1] * u[0]) * change,
            ];
            let to_coverage = [T::zero(); 3];
            self.covers.push(Cover { object: k, coverage, slope, to_color: T::zero(), to_coverage });
        }
        let (color, to_background) = composite(problem.compositing, scene, &mut self.covers);
        if !problem.colors {
            self.covers.iter_mut().for_each(|cover| cover.to_color = T::zero());
        }
        let target = problem.image.pixel(index);
        let inverse = T::one() / (problem.width * problem.width);
        let mut cost = T::zero();
        let base = scene.objects.len() * PER_OBJECT;
        for c in 0..3 {
            let residual = color[c] - target[c];
            let falloff = T::one() / (T::one() + residual * residual * inverse);
            cost += pixel_weight * residual * residual * falloff;
            let weight = pixel_weight * falloff * falloff;
            self.rows.clear();
            for cover in &self.covers {
                let mut row = [T::zero(); PER_OBJECT];
                for (value, &slope) in row.iter_mut().zip(&cover.slope) {
                    *value = slope * cover.to_coverage[c];
                }
                row[4 + c] = cover.to_color;
                self.rows.push(row);
            }
            for (a, row_a) in self.covers.iter().zip(&self.rows) {
                let at = a.object * PER_OBJECT;
                for i in (0..4).chain([4 + c]) {
                    let scaled = weight * row_a[i];
                    self.gradient[at + i] += scaled * residual;
                    for (b, row_b) in self.covers.iter().zip(&self.rows) {
                        if b.object > a.object {
                            break;
                        }
                        let start = packed(at + i, b.object * PER_OBJECT);
                        let end = if b.object == a.object { i } else { PER_OBJECT - 1 };
                        for (h, &value) in self.hessian[start..=start + end].iter_mut().zip(row_b) {
                            *h += scaled * value;
                        }
                    }
                }
            }
            if problem.colors {
                let own = base + c;
                self.gradient[own] += weight * to_background * residual;
                self.hessian[packed(own, own)] += weight * to_background * to_background;
                for (cover, row) in self.covers.iter().zip(&self.rows) {
                    let start = packed(own, cover.object * PER_OBJECT);
                    for (h, &value) in self.hessian[start..start + PER_OBJECT].iter_mut().zip(row) {
                        *h += weight * to_background * value;
                    }
                }
            }
        }
        cost
    }
}

/// Color of the pixel and its derivatives; the derivative with respect to the background is returned.
fn composite<T: Real>(compositing: Compositing, scene: &JointScene<T>, covers: &mut [Cover<T>]) -> ([T; 3], T) {
    let one = T::one();
    let background = scene.background;
    let mut clear = one;
    for cover in covers.iter() {
        clear *= one - cover.coverage * scene.objects[cover.object].confidence;
    }
    match compositing {
        Compositing::Blend => {
            let (mut total, mut mean) = (T::zero(), [T::zero(); 3]);
            let importance = |k: usize| ((scene.objects[k].confidence - one) * T::of(10.0)).exp();
            for cover in covers.iter() {
                let weight = cover.coverage * importance(cover.object);
                total += weight;
                for c in 0..3 {
                    mean[c] += weight * scene.objects[cover.object].color[c];
                }
            }
            let total = total.max(T::of(1e-7));
            let mean = mean.map(|value| value / total);
            let alpha = one - clear;
            for at in 0..covers.len() {
                let mut others = one;
                for (j, cover) in covers.iter().enumerate() {
                    if j != at {
                        others *= one - cover.coverage * scene.objects[cover.object].confidence;
                    }
                }
                let object = &scene.objects[covers[at].object];
                let weight = importance(covers[at].object);
                covers[at].to_color = alpha * covers[at].coverage * weight / total;
                for c in 0..3 {
                    covers[at].to_coverage[c] = (mean[c] - background[c]) * object.confidence * others
                        + alpha * weight * (object.color[c] - mean[c]) / total;
                }
            }
            (core::array::from_fn(|c| background[c] + alpha * (mean[c] - background[c])), clear)
        }
        Compositing::Over => {
            let mut color = background;
            for at in 0..covers.len() {
                let object = &scene.objects[covers[at].object];
                let opacity = covers[at].coverage * object.confidence;
                let above = covers[at + 1..].iter().fold(one, |product, cover| {
                    product * (one - cover.coverage * scene.objects[cover.object].confidence)
                });
                covers[at].to_color = opacity * above;
                for c in 0..3 {
                    covers[at].to_coverage[c] = object.confidence * (object.color[c] - color[c]) * above;
                    color[c] += opacity * (object.color[c] - color[c]);
                }
            }
            (color, clear)
        }
    }
}

impl<T: Real> Band<T> {
    fn new(problem: &JointProblem<'_, T>) -> Self {
        let profile = problem.edge.in_pixels(T::of_usize(problem.image.size().unit_px()));
        let inside = profile.px((-profile.full(SATURATION)).max(T::zero()));
        Self { profile, inside, outside: profile.px(profile.cut.max(T::zero())) }
    }

    /// Every how many rows and columns suffice to see the band: at least three to its width, at most those of interiors.
    fn stride(&self) -> usize {
        let band = (self.inside + self.outside) / T::of(3.0);
        if band >= T::of_usize(INTERIOR_STRIDE) { INTERIOR_STRIDE } else { band.to_count().clamp(1, 2) }
    }
}
