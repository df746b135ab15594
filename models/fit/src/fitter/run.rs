//! The steps of a fit that known and unknown shapes share.

use alloc::vec::Vec;

use dvp_core::image::distance;
use dvp_core::render::contour::ContourRenderer;
use dvp_core::render::{Compositing, EdgeLaw, EdgeProfile};
use dvp_core::{ImageView, Object, Real, Scene};

use super::{FitScratch, Fitter};
use crate::colors::{MAX_COVERAGE_VALUES, is_rounded, refine_colors};
use crate::covariance::{Outlined, covariance};
use crate::marginal_gain::{marginal_gains, ranking, squared_errors};
use crate::residual::Residual;
use crate::segment::EdgeKind;
use crate::tuning::{
    MEAN_OF_TWO_COLOR, PLAIN_HARMONICS, ROUGH_NOISE, SURE_CONTRAST, SURE_PIXELS, VISIBLE_ERROR, VISIBLE_NOISE,
};
use crate::{Completion, Fit, FitError, StopReason};

/// One image being fitted.
pub(super) struct Run<'a, T: Real> {
    pub(super) fitter: &'a Fitter<T>,
    pub(super) image: ImageView<'a, T>,
    pub(super) kind: EdgeKind<T>,
    /// The profile that renders this kind.
    pub(super) edge: EdgeProfile<T>,
    pub(super) compositing: Compositing,
    pub(super) scratch: &'a mut FitScratch<T>,
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
    /// What goes on where it is hidden, if it is.
    pub(super) completion: Completion,
}

/// Residual that is visible at the given noise (standard deviation of a channel).
pub(super) fn visible_error<T: Real>(noise: T) -> T {
    T::of(VISIBLE_ERROR).max(T::of(VISIBLE_NOISE) * noise)
}

/// Of the objects that are too many, one in so many goes before the others are judged again.
const ROUND: usize = 4;

/// Whether colors are fitted to a part of a step: proportions must be known as well, so only where the edge profile is exact.
pub(super) fn has_fractions<T: Real>(edge: EdgeProfile<T>, compositing: Compositing) -> bool {
    edge.law == EdgeLaw::SquaredDistance && compositing == Compositing::Blend
}

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
        self.keep_the_best(&mut found)?;
        let mut scene = self.scene_of(&found);
        scene.draw(&self.fitter.outlines, &mut self.scratch.drawing)?;
        self.refine_colors(&mut scene)?;
        scene.draw(&self.fitter.outlines, &mut self.scratch.drawing)?;
        let mut loss = self.compare_drawing()?;
        // A pixel that is nearly right counts as explained.
        let rough = self.noise().max(T::of(ROUGH_NOISE));
        let mut bits = None;
        let mut drawn = true;
        for at in (0..scene.objects.len()).rev() {
            if self.is_doubtful(&scene, &found.objects[at])
                || self.fitter.options.prices.mixed && self.is_mixed(&scene, at)
            {
                let before = match bits {
                    Some(bits) => bits,
                    None => self.bits(&scene, rough),
                };
                let object = scene.objects.remove(at);
                scene.draw(&self.fitter.outlines, &mut self.scratch.drawing)?;
                let without = (self.compare_drawing()?, self.bits(&scene, rough));
                if without.1 < before {
                    (loss, bits) = (without.0, Some(without.1));
                    found.objects.remove(at);
                    drawn = true;
                } else {
                    scene.objects.insert(at, object);
                    bits = Some(before);
                    drawn = false;
                }
            }
        }
        let (covariance, expected_iou) = self.covariances(&scene, &found)?;
        let ambiguity = self.ambiguities(&scene, &found);
        if !drawn {
            // The residual of the scratch is that of the scene found.
            self.compare_drawing()?;
        }
        let noise = self.noise();
        let bits = self.bits(&scene, noise);
        let (unexplained, total) = Residual::unexplained(&self.image, self.scratch.shown.pixels(), noise);
        let marginal_gain = marginal_gains(&self.scratch.drawing, &self.image, self.compositing, total);
        let stop =
            if scene.objects.is_empty() && found.stop != StopReason::NotFlat { StopReason::Empty } else { found.stop };
        Ok(Fit {
            scene,
            loss,
            steps: found.steps,
            stop,
            covariance,
            expected_iou,
            ambiguity,
            unexplained,
            marginal_gain,
            noise,
            bits,
        })
    }

    pub(super) fn scene_of(&self, found: &Found<T>) -> Scene<T> {
        Scene {
            background: found.background,
            transparent: false,
            objects: found.objects.iter().map(|part| part.object.clone()).collect(),
            edge: self.edge,
            compositing: self.compositing,
        }
    }

    /// If there are too many objects, keeps those of the largest marginal gain. It depends on which others there are, so they
    /// go in rounds; the order in which they are painted stays.
    fn keep_the_best(&mut self, found: &mut Found<T>) -> Result<(), FitError> {
        let most = self.fitter.options.max_objects;
        while found.objects.len() > most {
            let excess = found.objects.len() - most;
            self.scene_of(found).draw(&self.fitter.outlines, &mut self.scratch.drawing)?;
            let ranked = ranking(&squared_errors(&self.scratch.drawing, &self.image, self.compositing));
            let mut dropped = ranked[ranked.len() - excess.div_ceil(ROUND)..].to_vec();
            dropped.sort_unstable();
            for at in dropped.into_iter().rev() {
                found.objects.remove(at);
            }
        }
        Ok(())
    }

    /// Gives the colors of a rounded image back their fractions of a step.
    fn refine_colors(&mut self, scene: &mut Scene<T>) -> Result<(), FitError> {
        let scratch = &mut *self.scratch;
        let values = scene.objects.len() * self.image.size().pixels();
        let rounded = is_rounded(scratch.segmentation.region_colors().flatten());
        if !has_fractions(self.edge, scene.compositing)
            || !rounded
            || values > MAX_COVERAGE_VALUES
            || scene.objects.is_empty()
        {
            return Ok(());
        }
        scratch.colors.coverage.resize(values, T::zero());
        let renderer = ContourRenderer::new(self.edge, scene.compositing);
        let coverage = &mut scratch.colors.coverage[..values];
        renderer.object_coverage(&scratch.drawing, self.image.size(), scratch.shown.render_scratch(), coverage)?;
        let mut colors: Vec<[T; 3]> = scene.objects.iter().map(Object::color).collect();
        colors.push(scene.background);
        let pixels = scratch.segmentation.soft_pixels(self.image.size().width());
        refine_colors(&self.image, pixels, &mut colors, &mut scratch.colors);
        for (object, &color) in scene.objects.iter_mut().zip(&colors) {
            object.paint.set_color(color);
        }
        scene.background = colors[scene.objects.len()];
        Ok(())
    }

    /// Renders a scene; returns the length of its description and of what it leaves, at the given noise.
    pub(super) fn bits_of(&mut self, scene: &Scene<T>, noise: T) -> Result<f64, FitError> {
        scene.draw(&self.fitter.outlines, &mut self.scratch.drawing)?;
        self.compare_drawing()?;
        Ok(self.bits(scene, noise))
    }

    /// Description length of the scene plus that of the residual last measured, at the given noise; of a coded picture, of
    /// what its coder cannot have thrown away.
    fn bits(&mut self, scene: &Scene<T>, noise: T) -> f64 {
        let prices = self.fitter.options.prices;
        let spared: f64 = scene.objects.iter().map(|object| self.spared(object)).sum();
        let FitScratch { code, code_bits, shown, residual, .. } = &mut *self.scratch;
        let left = match code {
            Some(code) => code.bits(&self.image, shown.pixels(), code_bits),
            None => residual.bits(noise),
        };
        prices.scene_bits(scene, self.fitter.prototypes.len()) - spared + left
    }

    /// Bits that a plain shape would spare: in a coded picture, fine detail of an outline says how coarse its edge is and
    /// not that there is no object.
    fn spared(&self, object: &Object<T>) -> f64 {
        let fine = object.efd_rows().len().saturating_sub(PLAIN_HARMONICS);
        if self.scratch.code.is_some() && object.prototype().is_none() {
            self.fitter.options.prices.equal_bits(fine)
        } else {
            0.0
        }
    }

    fn is_doubtful(&self, scene: &Scene<T>, part: &FoundObject<T>) -> bool {
        if self.scratch.segmentation.is_noisy() {
            // Its segment may be a piece of another object that noise cut off.
            return true;
        }
        let pixels = self.scratch.segmentation.segments()[part.segment].pixels;
        let contrast = distance(part.object.color(), scene.background);
        pixels < SURE_PIXELS || contrast < T::of(SURE_CONTRAST)
    }

    /// Whether the object has the mean color of two others: where they overlap, objects that blend show it.
    fn is_mixed(&self, scene: &Scene<T>, at: usize) -> bool {
        let own = scene.objects[at].color();
        let others =
            || scene.objects.iter().enumerate().filter(move |(k, _)| *k != at).map(|(_, object)| object.color());
        let mean = |a: [T; 3], b: [T; 3]| core::array::from_fn(|c| T::of(0.5) * (a[c] + b[c]));
        self.compositing == Compositing::Blend
            && others()
                .enumerate()
                .any(|(k, a)| others().skip(k + 1).any(|b| distance(own, mean(a, b)) < T::of(MEAN_OF_TWO_COLOR)))
    }

    /// Standard deviation (px) of what may have blurred the edges: half of what lies between coverages of one standard deviation to either
    /// side. The reference's profile is one that no blur makes.
    fn blur_px(&self) -> T {
        if self.edge.law == EdgeLaw::SquaredDistance {
            return T::zero();
        }
        let profile = self.edge.in_pixels(self.unit_px());
        let [outer, inner] = [0.159, 0.841].map(|coverage| profile.distance(T::of(coverage)));
        T::of(0.5) * (outer - inner)
    }

    fn covariances(&mut self, scene: &Scene<T>, found: &Found<T>) -> Result<(Vec<[T; 25]>, Vec<T>), FitError> {
        let (unit, blur_px) = (self.unit_px(), self.blur_px());
        scene.draw(&self.fitter.outlines, &mut self.scratch.drawing)?;
        let mut out = (Vec::with_capacity(scene.objects.len()), Vec::with_capacity(scene.objects.len()));
        for (k, (object, part)) in scene.objects.iter().zip(&found.objects).enumerate() {
            let scratch = &mut *self.scratch;
            scratch.outline.clear();
            scratch.outline.extend(scratch.drawing.outline(k).iter().map(|v| v.map(|x| x * unit)));
            let center = object.pose.translation.map(|x| x * unit);
            let segment = &scratch.segmentation.segments()[part.segment];
            let object = Outlined {
                outline: &scratch.outline,
                center,
                samples: &segment.samples,
                unit_px: unit,
                pixel_noise: scratch.segmentation.noise(),
                blur_px,
                is_free: object.prototype().is_none() || part.alternative().is_some(),
                area: T::of_usize(segment.pixels),
            };
            let (block, iou) = covariance(&object, &mut scratch.lanes);
            out.0.push(block);
            out.1.push(iou);
        }
        Ok(out)
    }
}
