//! The steps of a fit that known and unknown shapes share.

use alloc::vec::Vec;

use dvp_core::contour::contains;
use dvp_core::render::contour::ContourRenderer;
use dvp_core::render::{Compositing, EdgeLaw, EdgeProfile};
use dvp_core::shape::REFERENCE_VERTICES;
use dvp_core::{ImageView, Object, Real, Scene};

use super::{FitScratch, Fitter, symmetry_order};
use crate::colors::{MAX_COVERAGE_VALUES, is_rounded, refine_colors};
use crate::doubt::{covariance, visible_share};
use crate::price::scene_bits;
use crate::residual::Residual;
use crate::segment::EdgeKind;
use crate::{Ambiguity, Fit, FitError, StopReason};

/// One image being fitted.
pub(super) struct Run<'a, T: Real> {
    pub(super) fitter: &'a Fitter<T>,
    pub(super) image: ImageView<'a, T>,
    pub(super) kind: EdgeKind<T>,
    /// The profile that renders this kind.
    pub(super) edge: EdgeProfile<T>,
    pub(super) compositing: Compositing,
    pub(super) care: Care,
    pub(super) scratch: &'a mut FitScratch<T>,
}

/// How much time objects are worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Care {
    /// They are objects: which is in front is decided, doubtful ones must pay, folded outlines are done again.
    Full,
    /// They are segments of a picture that is not flat: one outline each.
    Segments,
}

/// Objects as found, before the last touches.
#[derive(Debug)]
pub(super) struct Found<T> {
    pub(super) background: [T; 3],
    pub(super) objects: Vec<FoundObject<T>>,
    pub(super) steps: usize,
    pub(super) stop: StopReason,
}

/// An object and where it came from.
#[derive(Clone, Debug)]
pub(super) struct FoundObject<T> {
    pub(super) object: Object<T>,
    /// Index of its segment.
    pub(super) segment: usize,
    /// The next best prototype and its squared error over that of the chosen one.
    pub(super) twin: Option<(usize, f64)>,
}

/// A rendering that misses a pixel by this much in some channel does so visibly.
const VISIBLE_ERROR: f64 = 0.03;
/// Under noise, this many standard deviations are visible; a picture has about one such pixel in 5000 by chance.
const VISIBLE_NOISE: f64 = 4.0;
/// Residual that is visible at the given noise (standard deviation of a channel).
pub(super) fn visible_error<T: Real>(noise: T) -> T {
    T::of(VISIBLE_ERROR).max(T::of(VISIBLE_NOISE) * noise)
}

/// Objects of fewer flat pixels, or of less contrast, must show that they pay for their description.
const SURE_PIXELS: usize = 12;
const SURE_CONTRAST: f64 = 0.03;
/// Standard deviation of what the outlines of such objects miss.
const ROUGH_NOISE: f64 = 0.015;
/// The same in units of the noise.
const SURE_NOISE: f64 = 10.0;
/// A twin is worth telling if its squared error is below this many times that of the chosen prototype.
const TWIN_RATIO: f64 = 4.0;

impl<T: Real> Run<'_, T> {
    pub(super) fn unit_px(&self) -> T {
        T::of_usize(self.image.size().unit_px())
    }

    /// Standard deviation of a pixel's channel that no object explains.
    pub(super) fn noise(&self) -> T {
        self.scratch.segmentation.noise()
    }

    /// No flat region: the mean color and no object.
    pub(super) fn nothing(&self) -> Found<T> {
        let pixels = T::of_usize(self.image.size().pixels());
        let background = core::array::from_fn(|c| self.image.channel(c).iter().copied().sum::<T>() / pixels);
        Found { background, objects: Vec::new(), steps: 0, stop: StopReason::NotFlat }
    }

    /// Renders the drawing of the scratch and keeps its residual; returns the mean absolute error.
    pub(super) fn compare_drawing(&mut self) -> Result<T, FitError> {
        let FitScratch { drawing, shown, residual, .. } = &mut *self.scratch;
        shown.compare(drawing, &self.image, (self.edge, self.compositing), residual)
    }

    /// Pixels within `reach_px` of a point that the last rendering visibly misses.
    pub(super) fn missed_pixels(&self, center_px: [T; 2], reach_px: T) -> usize {
        self.scratch.residual.count_above(self.image.size(), center_px, reach_px, visible_error(self.noise()))
    }

    /// Cuts to the number of objects allowed, refines colors, drops what does not pay, and adds the doubt.
    pub(super) fn finish(mut self, mut found: Found<T>) -> Result<Fit<T>, FitError> {
        self.keep_the_best(&mut found);
        let mut scene = self.scene_of(&found);
        scene.draw(&self.fitter.outlines, &mut self.scratch.drawing)?;
        self.refine_colors(&mut scene)?;
        scene.draw(&self.fitter.outlines, &mut self.scratch.drawing)?;
        let mut loss = self.compare_drawing()?;
        let mut bits = self.bits(&scene);
        let mut rough_bits = self.rough_bits(&scene);
        let mut drawn = true;
        for at in (0..scene.objects.len()).rev() {
            if self.is_doubtful(&scene, &found.objects[at]) {
                let object = scene.objects.remove(at);
                scene.draw(&self.fitter.outlines, &mut self.scratch.drawing)?;
                let without = (self.compare_drawing()?, self.bits(&scene), self.rough_bits(&scene));
                if without.2 < rough_bits {
                    (loss, bits, rough_bits) = without;
                    found.objects.remove(at);
                    drawn = true;
                } else {
                    scene.objects.insert(at, object);
                    drawn = false;
                }
            }
        }
        let covariance = self.covariances(&scene, &found)?;
        let ambiguity = self.ambiguities(&scene, &found);
        if !drawn {
            // The residual of the scratch is that of the scene found.
            self.compare_drawing()?;
        }
        let noise = self.noise();
        let unexplained = Residual::unexplained(&self.image, self.scratch.shown.pixels(), noise);
        let stop =
            if scene.objects.is_empty() && found.stop != StopReason::NotFlat { StopReason::Empty } else { found.stop };
        Ok(Fit { scene, loss, steps: found.steps, stop, covariance, ambiguity, unexplained, noise, bits })
    }

    pub(super) fn scene_of(&self, found: &Found<T>) -> Scene<T> {
        Scene {
            background: found.background,
            objects: found.objects.iter().map(|part| part.object.clone()).collect(),
            edge: self.edge,
            compositing: self.compositing,
        }
    }

    /// If there are too many objects, keeps those that explain most: flat pixels times squared contrast.
    fn keep_the_best(&self, found: &mut Found<T>) {
        let most = self.fitter.options.max_objects;
        if found.objects.len() <= most {
            return;
        }
        let background = found.background;
        let gain = |part: &FoundObject<T>| {
            let pixels = T::of_usize(self.scratch.segmentation.segments()[part.segment].pixels);
            pixels * (0..3).map(|c| (part.object.color[c] - background[c]).powi(2)).sum::<T>()
        };
        let gains: Vec<T> = found.objects.iter().map(gain).collect();
        let mut ranked: Vec<usize> = (0..gains.len()).collect();
        ranked.sort_by(|&a, &b| gains[b].partial_cmp(&gains[a]).unwrap_or(core::cmp::Ordering::Equal));
        // The order in which they are painted stays.
        let mut at = 0..;
        found.objects.retain(|_| at.next().is_some_and(|index| ranked[..most].contains(&index)));
    }

    /// Gives the colors of a rounded image back their fractions of a step.
    fn refine_colors(&mut self, scene: &mut Scene<T>) -> Result<(), FitError> {
        let scratch = &mut *self.scratch;
        let values = scene.objects.len() * self.image.size().pixels();
        let rounded = is_rounded(scratch.segmentation.region_colors().flatten());
        // Proportions must be known to a part of a step: only where the edge profile is exact.
        let known = self.edge.law == EdgeLaw::SquaredDistance && scene.compositing == Compositing::Blend;
        if !known || !rounded || values > MAX_COVERAGE_VALUES || scene.objects.is_empty() {
            return Ok(());
        }
        scratch.colors.coverage.resize(values, T::zero());
        let renderer = ContourRenderer::new(self.edge, scene.compositing);
        let coverage = &mut scratch.colors.coverage[..values];
        renderer.object_coverage(&scratch.drawing, self.image.size(), scratch.shown.render_scratch(), coverage)?;
        let mut colors: Vec<[T; 3]> = scene.objects.iter().map(|object| object.color).collect();
        colors.push(scene.background);
        let pixels = scratch.segmentation.soft_pixels(self.image.size().width());
        refine_colors(&self.image, pixels, &mut colors, &mut scratch.colors);
        for (object, &color) in scene.objects.iter_mut().zip(&colors) {
            object.color = color;
        }
        scene.background = colors[scene.objects.len()];
        Ok(())
    }

    /// Description length of a scene and of what it leaves, at the given noise.
    pub(super) fn bits_at(&mut self, scene: &Scene<T>, noise: T) -> Result<f64, FitError> {
        scene.draw(&self.fitter.outlines, &mut self.scratch.drawing)?;
        self.compare_drawing()?;
        Ok(scene_bits(scene, self.fitter.prototypes.len()) + self.scratch.residual.bits(noise))
    }

    /// Description length of the scene plus that of the residual last measured.
    fn bits(&self, scene: &Scene<T>) -> f64 {
        scene_bits(scene, self.fitter.prototypes.len()) + self.scratch.residual.bits(self.noise())
    }

    /// As [`Self::bits`], but a pixel that is nearly right counts as explained: outlines of a few pixels are not fitted
    /// as exactly as those of many.
    fn rough_bits(&self, scene: &Scene<T>) -> f64 {
        let noise = self.noise().max(T::of(ROUGH_NOISE));
        scene_bits(scene, self.fitter.prototypes.len()) + self.scratch.residual.bits(noise)
    }

    fn is_doubtful(&self, scene: &Scene<T>, part: &FoundObject<T>) -> bool {
        if self.care == Care::Segments {
            return false;
        }
        let pixels = self.scratch.segmentation.segments()[part.segment].pixels;
        let contrast = (0..3).fold(T::zero(), |most, c| most.max((part.object.color[c] - scene.background[c]).abs()));
        pixels < SURE_PIXELS || contrast < T::of(SURE_CONTRAST).max(T::of(SURE_NOISE) * self.noise())
    }

    fn covariances(&mut self, scene: &Scene<T>, found: &Found<T>) -> Result<Vec<[T; 16]>, FitError> {
        let unit = self.unit_px();
        scene.draw(&self.fitter.outlines, &mut self.scratch.drawing)?;
        let mut out = Vec::with_capacity(scene.objects.len());
        for (k, (object, part)) in scene.objects.iter().zip(&found.objects).enumerate() {
            let scratch = &mut *self.scratch;
            scratch.outline.clear();
            scratch.outline.extend(scratch.drawing.outline(k).iter().map(|v| v.map(|x| x * unit)));
            let center = object.pose.translation.map(|x| x * unit);
            let samples = &scratch.segmentation.segments()[part.segment].samples;
            let noise = scratch.segmentation.noise();
            out.push(covariance(&scratch.outline, center, samples, unit, noise, &mut scratch.lanes));
        }
        Ok(out)
    }

    fn ambiguities(&self, scene: &Scene<T>, found: &Found<T>) -> Vec<Ambiguity> {
        let mut out = Vec::new();
        let unit = self.unit_px();
        for (object, part) in found.objects.iter().enumerate() {
            let order = match part.object.prototype {
                Some(k) => self.fitter.prototypes[k].symmetry,
                None => symmetry_order(&scene.objects[object].efd),
            };
            if order != 1 {
                out.push(Ambiguity::Symmetry { object, order });
            }
            if self.scratch.segmentation.segments()[part.segment].border > 0 {
                let outline: [[T; 2]; REFERENCE_VERTICES] =
                    core::array::from_fn(|i| self.scratch.drawing.outline(object)[i].map(|x| x * unit));
                out.push(Ambiguity::Cropped { object, visible: visible_share(&outline, self.image.size()) });
            }
            out.extend(self.merged(found, object));
            if let Some((prototype, ratio)) = part.twin.filter(|&(_, ratio)| ratio < TWIN_RATIO) {
                out.push(Ambiguity::Twin { object, prototype, ratio });
            }
        }
        out
    }

    /// The doubt about an object that shares its segment with others.
    fn merged(&self, found: &Found<T>, object: usize) -> Option<Ambiguity> {
        let segment = found.objects[object].segment;
        let is_other = |&k: &usize| k != object && found.objects[k].segment == segment;
        let other = (0..found.objects.len()).find(is_other)?;
        let drawing = &self.scratch.drawing;
        let outline = drawing.outline(object);
        let hidden = |&&vertex: &&[T; 2]| {
            (0..found.objects.len()).filter(is_other).any(|k| contains(drawing.outline(k), vertex))
        };
        let visible = T::of_usize(outline.len() - outline.iter().filter(hidden).count());
        Some(Ambiguity::Merged { object, other, visible: (visible / T::of_usize(outline.len().max(1))).as_f64() })
    }
}
