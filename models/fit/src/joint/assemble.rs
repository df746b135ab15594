//! Normal equations of poses and colors from the pixels near outlines.

use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::scene::{Compositing, Layer, PixelProfile};

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
    /// Pixels near outlines in the equations.
    pub(crate) near: usize,
    /// Their part of the cost.
    pub(crate) near_cost: T,
    pub(super) damped: Vec<T>,
    pub(super) step: Vec<T>,
    pub(super) tried: JointScene<T>,
    frames: Vec<Frame<T>>,
    /// Per object: first and last column and row (exclusive) it can cover.
    boxes: Vec<[usize; 4]>,
    /// Per object: its weight where objects blend.
    weights: Vec<T>,
    /// The objects at the pixel, and how they mix there.
    covers: Vec<Cover<T>>,
    layers: Vec<Layer<T>>,
    shares: Vec<T>,
    slopes: Vec<[T; 3]>,
}

/// An object at a pixel.
#[derive(Clone, Copy, Debug)]
struct Cover<T> {
    object: usize,
    /// Derivative of the coverage with respect to x, y, log scale, rotation.
    slope: [T; 4],
    /// Derivative of each channel of the pixel with respect to the same channel of the object's color.
    to_color: T,
    /// Derivative of each channel of the pixel with respect to the coverage.
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
        (self.near, self.near_cost) = (0, T::zero());
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
                    let added = self.add_pixel(problem, scene, &band, [column, row], index, weight);
                    cost += added;
                    if near {
                        self.near += 1;
                        self.near_cost += added;
                    }
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
        self.weights.clear();
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
            self.weights.push(Compositing::weight(object.confidence));
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
        self.layers.clear();
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
            self.covers.push(Cover { object: k, slope, to_color: T::zero(), to_coverage: [T::zero(); 3] });
            let (color, confidence, weight) = (object.color, object.confidence, self.weights[k]);
            self.layers.push(Layer { color, coverage, confidence, weight });
        }
        let (color, to_background) = self.mix(problem.compositing, scene.background);
        let target = problem.image.pixel(index);
        let inverse = T::one() / (problem.width * problem.width);
        let mut cost = T::zero();
        let (mut residuals, mut weights) = ([T::zero(); 3], [T::zero(); 3]);
        for c in 0..3 {
            let residual = color[c] - target[c];
            let falloff = T::one() / (T::one() + residual * residual * inverse);
            cost += pixel_weight * residual * residual * falloff;
            residuals[c] = residual;
            weights[c] = pixel_weight * falloff * falloff;
        }
        let over_channels = |a: [T; 3], b: [T; 3]| (0..3).map(|c| weights[c] * a[c] * b[c]).sum::<T>();
        for (k, a) in self.covers.iter().enumerate() {
            let at = a.object * PER_OBJECT;
            // The channels share the slopes of a coverage.
            let pull = over_channels(a.to_coverage, residuals);
            for i in 0..4 {
                self.gradient[at + i] += pull * a.slope[i];
            }
            for b in &self.covers[..=k] {
                let shared = over_channels(a.to_coverage, b.to_coverage);
                for i in 0..4 {
                    let start = packed(at + i, b.object * PER_OBJECT);
                    let end = if b.object == a.object { i } else { 3 };
                    let scaled = shared * a.slope[i];
                    for (h, &slope) in self.hessian[start..=start + end].iter_mut().zip(&b.slope) {
                        *h += scaled * slope;
                    }
                }
            }
        }
        if problem.colors {
            self.add_colors(scene.objects.len() * PER_OBJECT, to_background, residuals, weights);
        }
        cost
    }

    /// Color of the pixel of `layers`, and its derivative with respect to the background; those with respect to the objects go
    /// to `covers`.
    #[inline(always)]
    fn mix(&mut self, compositing: Compositing, background: [T; 3]) -> ([T; 3], T) {
        self.shares.resize(self.layers.len(), T::zero());
        self.slopes.resize(self.layers.len(), [T::zero(); 3]);
        let to_background = compositing.shares(&self.layers, &mut self.shares);
        compositing.slopes(background, &self.layers, &mut self.slopes);
        let mut color = background.map(|value| value * to_background);
        for (((cover, layer), &share), &slope) in
            self.covers.iter_mut().zip(&self.layers).zip(&self.shares).zip(&self.slopes)
        {
            (cover.to_color, cover.to_coverage) = (share, slope);
            for (value, own) in color.iter_mut().zip(layer.color) {
                *value += share * own;
            }
        }
        (color, to_background)
    }

    /// What a pixel says of colors: those of its objects, and that of the background at `base`.
    fn add_colors(&mut self, base: usize, to_background: T, residuals: [T; 3], weights: [T; 3]) {
        for c in 0..3 {
            let own = base + c;
            let scaled = weights[c] * to_background;
            self.gradient[own] += scaled * residuals[c];
            self.hessian[packed(own, own)] += scaled * to_background;
            for (k, a) in self.covers.iter().enumerate() {
                let at = a.object * PER_OBJECT;
                let to_own = weights[c] * a.to_color;
                self.gradient[at + 4 + c] += to_own * residuals[c];
                self.hessian[packed(own, at + 4 + c)] += scaled * a.to_color;
                for i in 0..4 {
                    self.hessian[packed(own, at + i)] += scaled * a.to_coverage[c] * a.slope[i];
                }
                for b in &self.covers[..=k] {
                    let other = b.object * PER_OBJECT;
                    self.hessian[packed(at + 4 + c, other + 4 + c)] += to_own * b.to_color;
                    for i in 0..4 {
                        self.hessian[packed(at + 4 + c, other + i)] += to_own * b.to_coverage[c] * b.slope[i];
                        if b.object != a.object {
                            let crossed = weights[c] * a.to_coverage[c] * a.slope[i] * b.to_color;
                            self.hessian[packed(at + i, other + 4 + c)] += crossed;
                        }
                    }
                }
            }
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
