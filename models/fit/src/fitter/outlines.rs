//! Outlines of unknown shapes, held against the picture together.
//!
//! Samples are read one pixel and one pair of regions at a time: where another outline passes they are off by more than noise, and
//! harmonics are paid for what is no shape. Here every soft pixel is held against the mixture of all objects that reach it, and what
//! it is off by is told to each of their outlines as a distance. Colors stand; how many harmonics pay is asked once more.

use alloc::vec::Vec;

use dvp_core::geometry::Bounds;
use dvp_core::render::Compositing;
use dvp_core::scene::{Layer, PixelProfile};
use dvp_core::shape::REFERENCE_VERTICES;
use dvp_core::{Efd, ImageView, Object, Real, simd};

use super::run::{Found, Run};
use crate::free::basis::Basis;
use crate::free::choose::{ChooseScratch, choose};
use crate::free::foot::{EdgeLanes, foot};
use crate::free::grow::hold_outside;
use crate::free::outline::FreeOutline;
use crate::free::outline_fit::{OutlineScratch, OutlineSettings, refine};
use crate::price::misfit_bits;
use crate::segment::{EdgeKind, EdgeSample};

/// Memory of the refinement.
#[derive(Clone, Debug, Default)]
pub(super) struct TogetherScratch<T> {
    drawn: Vec<DrawnOutline<T>>,
    soft: Vec<usize>,
    samples: Vec<EdgeSample<T>>,
    layers: Vec<Layer<T>>,
    shares: Vec<T>,
    slopes: Vec<[T; 3]>,
    outline: OutlineScratch<T>,
    choose: ChooseScratch<T>,
}

/// An object as the pixels near its outline see it.
#[derive(Clone, Debug)]
struct DrawnOutline<T> {
    outline: FreeOutline<T>,
    vertices: Vec<[T; 2]>,
    lanes: EdgeLanes<T>,
    /// Low and high corner of what it may cover (px).
    reach: [[T; 2]; 2],
    /// As it covers a pixel, but for how much of it.
    layer: Layer<T>,
}

impl<T: Real> DrawnOutline<T> {
    fn of(object: &Object<T>, unit: T) -> Self {
        let pose = object.pose;
        let mut efd = Efd::new(object.efd_rows().to_vec());
        efd.rotate_scale(pose.rotation, pose.scale * unit);
        let outline = FreeOutline { center: pose.translation.map(|v| v * unit), rows: efd.rows().to_vec() };
        let layer = Layer::new(object.color(), T::zero(), object.confidence);
        Self { outline, layer, vertices: Vec::new(), lanes: EdgeLanes::default(), reach: [[T::zero(); 2]; 2] }
    }

    /// Takes the vertices of the outline; pixels up to `reach_px` beyond them are covered.
    fn place(&mut self, basis: &Basis<T>, reach_px: T) {
        self.outline.write_vertices(basis, REFERENCE_VERTICES, &mut self.vertices);
        self.lanes.set(&self.vertices);
        if let Some(Bounds { min, max }) = Bounds::of_vertices(&self.vertices) {
            self.reach = [[min.x - reach_px, min.y - reach_px], [max.x + reach_px, max.y + reach_px]];
        }
    }

    fn may_cover(&self, point: [T; 2]) -> bool {
        let [low, high] = self.reach;
        (0..2).all(|c| point[c] > low[c] && point[c] < high[c])
    }
}

impl<T: Real> Run<'_, T> {
    /// Moves outlines to where the mixture of all objects explains the soft pixels, and leaves them the harmonics that pay there.
    ///
    /// Those of a part of a union or of what goes on behind another object stay: most of what is seen says nothing of them.
    pub(super) fn refine_together(&mut self, parts: &mut Found<T>) {
        let EdgeKind::Profile(edge) = self.kind else { return };
        let (unit, size, noise) = (self.unit_px(), self.image.size(), self.noise());
        let profile = edge.in_pixels(unit);
        let reach = profile.px(profile.cut.max(T::zero()));
        let mut scratch = core::mem::take(&mut self.scratch.together);
        let TogetherScratch { drawn, soft, .. } = &mut scratch;
        drawn.clear();
        drawn.extend(parts.objects.iter().map(|part| DrawnOutline::of(&part.object, unit)));
        drawn.iter_mut().for_each(|one| one.place(&self.fitter.basis, reach));
        soft.clear();
        soft.extend((0..).zip(self.scratch.segmentation.labels()).filter(|&(_, &label)| label == 0).map(|(i, _)| i));
        for k in 0..parts.objects.len() {
            let segment = parts.objects[k].segment;
            let shared = parts.objects.iter().filter(|part| part.segment == segment).count() > 1;
            if shared || u32::try_from(segment).is_ok_and(|object| self.scratch.segmentation.may_go_on(object)) {
                continue;
            }
            self.read_together(parts.background, &profile, k, &mut scratch);
            let TogetherScratch { drawn, samples, .. } = &mut scratch;
            if self.scratch.segmentation.segments()[segment].border > 0 {
                let [width, height] = [size.width(), size.height()].map(T::of_usize);
                hold_outside(&drawn[k].vertices[1..], width, height, samples);
            }
            let settings = OutlineSettings { max_steps: 1, ..OutlineSettings::settled(noise) };
            let outline = self.outline_together(k, &settings, &mut scratch);
            let Some((pose, efd)) = outline.posed(unit) else { continue };
            scratch.drawn[k].outline = outline;
            scratch.drawn[k].place(&self.fitter.basis, reach);
            let object = &mut parts.objects[k].object;
            *object = Object::of_efd(pose, object.color(), object.confidence, efd, None);
        }
        self.scratch.together = scratch;
    }

    /// Outline `k` as the samples have it: with the harmonics that pay if that shortens the description, else with those that it has.
    fn outline_together(
        &self,
        k: usize,
        settings: &OutlineSettings<T>,
        scratch: &mut TogetherScratch<T>,
    ) -> FreeOutline<T> {
        let basis = &self.fitter.basis;
        let price = |harmonics| T::of(self.fitter.options.prices.equal_bits(harmonics));
        let TogetherScratch { drawn, samples, outline: memory, choose: own, .. } = scratch;
        let mut outline = drawn[k].outline.clone();
        let harmonics = outline.rows.len();
        if harmonics == 1 {
            let cost = refine(&mut outline, samples, basis, REFERENCE_VERTICES, settings, memory);
            if cost * misfit_bits() < price(1) {
                return outline;
            }
        }
        let mut all = outline.clone();
        all.rows.resize(self.fitter.options.max_harmonics.max(harmonics), [T::zero(); 4]);
        let chosen = choose(&all, samples, basis, REFERENCE_VERTICES, settings, price, (&mut *memory, own));
        if let Some(mut chosen) = chosen {
            let cost = refine(&mut chosen.outline, samples, basis, REFERENCE_VERTICES, settings, memory);
            if price(chosen.outline.rows.len()) + cost * misfit_bits() < price(harmonics) + chosen.missed {
                return chosen.outline;
            }
        }
        refine(&mut outline, samples, basis, REFERENCE_VERTICES, settings, memory);
        outline
    }

    /// Fills the samples with what the soft pixels say of outline `k` if all others are where they are drawn.
    fn read_together(&self, background: [T; 3], profile: &PixelProfile<T>, k: usize, scratch: &mut TogetherScratch<T>) {
        let (image, compositing) = (&self.image, self.compositing);
        simd::dispatch(Read { image, compositing, background, profile, k, scratch });
    }
}

/// The arguments of [`Run::read_together`], compiled per instruction set.
struct Read<'a, T: Real> {
    image: &'a ImageView<'a, T>,
    compositing: Compositing,
    background: [T; 3],
    profile: &'a PixelProfile<T>,
    k: usize,
    scratch: &'a mut TogetherScratch<T>,
}

impl<T: Real> simd::Kernel for Read<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { image, compositing, background, profile, k, scratch } = self;
        let TogetherScratch { drawn, soft, samples, layers, shares, slopes, .. } = scratch;
        let (width, half) = (image.size().width(), T::of(0.5));
        let distance = |one: &DrawnOutline<T>, point| foot(&one.vertices, &one.lanes, point).distance;
        samples.clear();
        for &index in &*soft {
            let point = [index % width, index / width].map(|v| T::of_usize(v) + half);
            if !drawn[k].may_cover(point) {
                continue;
            }
            let own = distance(&drawn[k], point);
            let (coverage, change) = profile.coverage(own);
            if change.abs() < T::of(LEAST_CHANGE) {
                continue;
            }
            layers.clear();
            let mut at = 0;
            for (j, one) in drawn.iter().enumerate() {
                if j == k {
                    at = layers.len();
                    layers.push(Layer { coverage, ..one.layer });
                } else if one.may_cover(point) {
                    let coverage = profile.coverage(distance(one, point)).0;
                    layers.push(Layer { coverage, ..one.layer });
                }
            }
            shares.resize(layers.len(), T::zero());
            slopes.resize(layers.len(), [T::zero(); 3]);
            let to_background = compositing.shares(layers, shares);
            compositing.slopes(background, layers, slopes);
            // The outline moves by the distance that brings the three channels nearest to the pixel.
            let target = image.pixel(index);
            let (mut square, mut pull) = (T::zero(), T::zero());
            for c in 0..3 {
                let own_colors = layers.iter().zip(&*shares).map(|(layer, &share)| layer.color[c] * share);
                let shown = own_colors.sum::<T>() + background[c] * to_background;
                let slope = slopes[at][c] * change;
                square += slope * slope;
                pull += slope * (shown - target[c]);
            }
            let weight = square.sqrt();
            if weight > T::of(LEAST_CHANGE) {
                samples.push(EdgeSample { point, distance: own - pull / square, weight });
            }
        }
    }
}

/// A pixel that changes less than this per px of the outline tells nothing of it.
const LEAST_CHANGE: f64 = 1e-3;
