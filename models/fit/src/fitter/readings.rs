//! Which reading of a picture wins: clean, or freed from noise or from what compression left.
//!
//! A clean picture pays for an estimate of its noise and for counting its soft pixels. Others are read as the estimate says;
//! where both a clean reading and one freed from noise are possible, the shorter description wins, at one noise level.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::render::{Compositing, EdgeLaw, EdgeProfile};
use dvp_core::{ImageView, Real};
use dvp_trace::noise::noise_level;

use super::run::{Run, has_fractions, visible_error};
use super::{DIRECT_PIXELS, FitScratch, Fitter};
use crate::block_code::BlockCode;
use crate::colors::{is_rounded, round_color};
use crate::segment::{EdgeKind, NoisyOptions, SegmentOptions};
use crate::tuning::{
    CODED_CLEARLY_SHORTER, CODED_NOISE, COMPRESSED_BLUR_PX, COMPRESSED_NOISE, MANY_REGIONS, MISSED_SHARE,
    NOT_FLAT_SHARE, QUIET_NOISE,
};
use crate::{Fit, FitError, StopReason};

impl<T: Real> Fitter<T> {
    /// Fits the readings that the picture may need; the best one wins.
    pub(super) fn best_reading(
        &self,
        image: ImageView<'_, T>,
        scratch: &mut FitScratch<T>,
    ) -> Result<Fit<T>, FitError> {
        let most_regions = self.options.max_objects.saturating_add(1);
        let noise = noise_level(&image, &mut scratch.differences);
        let mut fit = if noise >= T::of(QUIET_NOISE) {
            let boundary = self.options.prices.boundary;
            let options = NoisyOptions { noise, compressed: false, most_regions, boundary };
            let readable = scratch.segmentation.read_noisy(&image, options);
            self.fit_reading(image, readable, scratch)?
        } else {
            let readable = scratch.segmentation.read(&image, &SegmentOptions::default());
            let sharpened = readable && scratch.segmentation.is_sharpened();
            if readable && !sharpened && scratch.segmentation.is_clean() {
                self.fit_reading(image, true, scratch)?
            } else {
                self.or_compressed(image, sharpened, most_regions, scratch)?
            }
        };
        if fit.scene.objects.is_empty()
            && noise < T::of(QUIET_NOISE)
            && let Some(fit) = self.or_faint(image, &fit, scratch)?
        {
            return Ok(fit);
        }
        if fit.unexplained > NOT_FLAT_SHARE {
            fit.stop = StopReason::NotFlat;
        }
        Ok(fit)
    }

    /// A fit freed from what compression or a filter that sharpens left, or one of the picture as it is. The clean reading
    /// must be the last one.
    fn or_compressed(
        &self,
        image: ImageView<'_, T>,
        sharpened: bool,
        most_regions: usize,
        scratch: &mut FitScratch<T>,
    ) -> Result<Fit<T>, FitError> {
        scratch.code = BlockCode::of(&image);
        let regions = scratch.segmentation.region_count();
        let options = NoisyOptions {
            noise: T::of(COMPRESSED_NOISE),
            compressed: true,
            most_regions,
            boundary: self.options.prices.boundary,
        };
        let readable = scratch.segmentation.read_noisy(&image, options);
        let mut freed = self.fit_reading(image, readable, scratch)?;
        if is_of_another_kind(&freed, scratch) {
            return Ok(freed);
        }
        if scratch.code.is_some() {
            // Faint objects are averaged away with the rest; the coder tells whether they are there.
            let options = NoisyOptions { noise: T::of(CODED_NOISE), ..options };
            let readable = scratch.segmentation.read_noisy(&image, options);
            let finer = self.fit_reading(image, readable, scratch)?;
            if finer.bits < freed.bits {
                freed = finer;
            }
        }
        if scratch.code.is_some() || sharpened || regions > MANY_REGIONS {
            return Ok(freed);
        }
        let readable = scratch.segmentation.read(&image, &SegmentOptions::default());
        let clean = self.fit_reading(image, readable, scratch)?;
        // At the lower level the clean reading's own description would count every trace of compression.
        let bits = self.bits_at(image, &clean, freed.noise, scratch)?;
        Ok(if bits <= freed.bits { clean } else { freed })
    }

    /// Fits the regions last read; the edges and the way objects overlap that describe them best.
    pub(super) fn fit_reading(
        &self,
        image: ImageView<'_, T>,
        readable: bool,
        scratch: &mut FitScratch<T>,
    ) -> Result<Fit<T>, FitError> {
        if !readable {
            let edge = self.options.edge.unwrap_or_else(EdgeProfile::reference);
            let compositing = self.options.compositing.unwrap_or_default();
            let run = Run { fitter: self, image, kind: EdgeKind::of(edge), edge, compositing, scratch };
            let found = run.nothing();
            return run.finish(found);
        }
        scratch.segmentation.interpret(Compositing::Blend);
        let evidence = scratch.segmentation.evidence();
        let direct = if evidence.direct < DIRECT_PIXELS {
            Vec::new()
        } else {
            scratch.segmentation.direct_pixels(image.size().width())
        };
        let kinds = self.edge_kinds(image, scratch);
        // In doubt several readings are fitted; the shortest description wins.
        let mut best: Option<Fit<T>> = None;
        for EdgeReading { kind, only_if_missed } in kinds {
            if only_if_missed && best.as_ref().is_some_and(|best| best.unexplained < MISSED_SHARE) {
                continue;
            }
            let (compositing, second) = self.compositings(evidence, &kind);
            for compositing in [Some(compositing), second].into_iter().flatten() {
                let fit = self.fit_with(image, kind, compositing, scratch)?;
                // Objects that hide one another cannot pass for ones that mix.
                let off = scratch.residual.count_off(&direct, visible_error(scratch.segmentation.noise()));
                let is_of_another_kind = is_of_another_kind(&fit, scratch);
                best = Some(match best {
                    Some(best) => self.shorter(image, best, fit, scratch)?,
                    None => fit,
                });
                if is_of_another_kind {
                    return best.ok_or(FitError::Setting { what: "edge", must: "known" });
                }
                if 2 * off < direct.len() {
                    break;
                }
            }
        }
        best.ok_or(FitError::Setting { what: "edge", must: "known" })
    }

    /// The kinds of edges that the picture may have, the likeliest first.
    fn edge_kinds(&self, image: ImageView<'_, T>, scratch: &FitScratch<T>) -> Vec<EdgeReading<T>> {
        let reading = |kind| EdgeReading { kind, only_if_missed: false };
        if let Some(edge) = self.options.edge {
            return vec![reading(EdgeKind::of(edge))];
        }
        let (unit, edges) = (T::of_usize(image.size().unit_px()), scratch.segmentation.edges(&image));
        let reference = EdgeKind::Profile(EdgeProfile::reference());
        let (kind, other) = edges.kinds(unit);
        if scratch.segmentation.is_compressed() && !is_blur(&kind, unit) {
            // Compression spreads edges itself: the softness measured is not that of the drawing.
            return vec![reading(EdgeKind::Area), reading(reference)];
        }
        let mut kinds = vec![reading(kind)];
        if kind == reference {
            kinds.extend(other.map(reading));
        } else if scratch.segmentation.is_noisy() {
            // Noise hides what tells the edges apart.
            kinds.push(reading(reference));
        } else {
            kinds.extend(other.map(reading));
            if other.is_none() && edges.may_be_reference(unit) {
                // Edges along the grid show few coverages. No outline fits under the wrong kind.
                kinds.push(EdgeReading { kind: reference, only_if_missed: true });
            }
        }
        kinds
    }

    /// The fit of shorter description. Fractions of a step of color lie up to half a step off every flat pixel of a rounded
    /// image: those of one fit must not speak against it. What a coder spreads looks most like area coverage, whatever it was: this
    /// must be clearly shorter than the renderer's own edges.
    fn shorter(
        &self,
        image: ImageView<'_, T>,
        one: Fit<T>,
        other: Fit<T>,
        scratch: &mut FitScratch<T>,
    ) -> Result<Fit<T>, FitError> {
        let spread = scratch.code.is_some()
            && [&one, &other].map(|fit| fit.scene.edge.law) == [EdgeLaw::Area, EdgeLaw::SquaredDistance];
        let clearly = if spread { CODED_CLEARLY_SHORTER } else { 1.0 };
        let rounded = is_rounded(scratch.segmentation.region_colors().flatten());
        let mut bits = |fit: &Fit<T>| {
            if !rounded || !has_fractions(fit.scene.edge, fit.scene.compositing) {
                return Ok(fit.bits);
            }
            let mut plain = fit.clone();
            let colors = plain.scene.objects.iter_mut().flat_map(|object| object.paint.colors_mut());
            colors.chain([&mut plain.scene.background]).for_each(round_color);
            self.bits_at(image, &plain, fit.noise, scratch)
        };
        Ok(if bits(&one)? <= clearly * bits(&other)? { one } else { other })
    }

    /// Description length of a fit, at another noise level than its own.
    pub(super) fn bits_at(
        &self,
        image: ImageView<'_, T>,
        fit: &Fit<T>,
        noise: T,
        scratch: &mut FitScratch<T>,
    ) -> Result<f64, FitError> {
        let (edge, compositing) = (fit.scene.edge, fit.scene.compositing);
        let mut run = Run { fitter: self, image, kind: EdgeKind::of(edge), edge, compositing, scratch };
        run.bits_of(&fit.scene, noise)
    }
}

/// A kind of edges to read a picture with.
struct EdgeReading<T> {
    kind: EdgeKind<T>,
    /// Whether it is tried only where the fit before leaves something unexplained.
    only_if_missed: bool,
}

/// Whether a picture is none of flat objects, however its edges and overlaps are read: many regions, and what they leave is much.
fn is_of_another_kind<T: Real>(fit: &Fit<T>, scratch: &FitScratch<T>) -> bool {
    fit.unexplained > NOT_FLAT_SHARE && scratch.segmentation.region_count() > MANY_REGIONS
}

/// Whether edges are softer than compression alone makes them.
fn is_blur<T: Real>(kind: &EdgeKind<T>, unit_px: T) -> bool {
    // Sigma is that of twice the distance.
    let most = T::of(2.0 * COMPRESSED_BLUR_PX);
    matches!(kind, EdgeKind::Profile(edge) if edge.law == EdgeLaw::Distance && edge.sigma * unit_px > most)
}
