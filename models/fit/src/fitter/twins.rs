//! Segments that no single shape explains, split into several objects of one color.

use alloc::vec::Vec;

use dvp_core::scene::Pose;
use dvp_core::shape::{REFERENCE_VERTICES, SYMMETRY_TOLERANCE, Symmetry};
use dvp_core::{Object, Real};

use super::known::Source;
use super::run::{Found, FoundObject, Run};
use crate::FitError;
use crate::free::grow::{Freedom, GrowSettings};
use crate::free::outline_fit::FreeOutline;
use crate::joint::{JointObject, JointScene};
use crate::pose::field::OutlineField;
use crate::pose::gauss_newton::{Frame, PosePx};
use crate::pose::search::{Effort, search};
use crate::split::overlap::Overlap;
use crate::split::twins::{Union, misfit, repeats};
use crate::split::waist::{is_convex, is_waisted};
use crate::split::{Explanation, split};
use crate::tuning::{CORNER_NOISE, MISFIT_RATIO, MISFIT_SLACK};

/// After so many outlines with a waist that were no unions, those left are taken as they are: the picture is made of such shapes.
const MOST_FAILURES: usize = 3;

/// Where parts of a union come from, the more reliable first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// Simple shapes posed on parts of the outline.
    Simple,
    /// A motion that takes one part to the other.
    Motion,
}

impl Way {
    const ALL: [Self; 2] = [Self::Simple, Self::Motion];
}

/// An outline that may be that of a union.
#[derive(Clone, Debug)]
struct Waisted<T> {
    contour: Vec<[T; 2]>,
    /// Its signed distance (px).
    field: OutlineField<T>,
    /// Most robust mean squared distance error (px^2) that a union may have.
    most: T,
    /// Bits of its shape as one object.
    shape_bits: f64,
}

impl<T: Real> Run<'_, T> {
    /// Replaces objects that visibly miss the image by sets of prototypes whose union explains their segments, where that
    /// shortens the description. The rendering of `posed` must be the last one; so it is again afterwards. Returns the loss.
    pub(super) fn split_known(
        &mut self,
        posed: &mut JointScene<T>,
        sources: &mut Vec<Source>,
        mut loss: T,
    ) -> Result<T, FitError> {
        let prices = self.fitter.options.prices;
        let (mut at, mut failures) = (0, 0);
        while at < sources.len() && failures < MOST_FAILURES {
            let source = sources[at];
            // Of a cropped object too little shows to tell one from two.
            let cropped = self.scratch.segmentation.segments()[source.segment].border > 0;
            if source.sure || cropped || !self.stands_alone(source.segment) || !self.misses_object(posed, at) {
                at += 1;
                continue;
            }
            let sets = split(&self.scratch.segmentation.segments()[source.segment], &self.fitter.prototypes);
            let single = posed.objects[at];
            let mut placed = 1;
            let noise = self.noise();
            let mut best = (self.scratch.residual.bits(noise), Vec::from([single]));
            for set in sets {
                let parts = set.parts.iter();
                let objects: Vec<JointObject<T>> =
                    parts.map(|part| JointObject { shape: part.prototype, pose: part.pose, ..single }).collect();
                posed.objects.splice(at..at + placed, objects.iter().copied());
                placed = objects.len();
                self.compare(posed)?;
                let price = prices.known_object_bits(self.fitter.prototypes.len()) * f64::of_usize(placed - 1);
                let bits = self.scratch.residual.bits(noise) + price;
                if bits < best.0 {
                    best = (bits, objects);
                }
            }
            posed.objects.splice(at..at + placed, best.1.iter().copied());
            sources.splice(at..=at, best.1.iter().map(|_| source));
            loss = self.compare(posed)?;
            failures += usize::from(best.1.len() == 1);
            at += best.1.len();
        }
        Ok(loss)
    }

    /// Replaces outlines with a waist by two or three of simple shapes, or two of one simpler shape, where that shortens the
    /// description.
    pub(super) fn split_unknown(&mut self, found: &mut Found<T>) -> Result<(), FitError> {
        // What cut corners leave is no evidence of a union.
        let noise = self.noise().max(T::of(CORNER_NOISE));
        let prices = self.fitter.options.prices;
        let (mut at, mut failures) = (0, 0);
        while at < found.objects.len() && failures < MOST_FAILURES {
            let single = found.objects[at].clone();
            let mut placed = 1;
            if let Some(waisted) = self.waisted(&single)? {
                self.compare_found(found)?;
                let mut best = (waisted.shape_bits + self.scratch.residual.bits(noise), Vec::from([single.clone()]));
                for way in Way::ALL {
                    for explanation in self.explanations(&waisted, &single, way) {
                        if explanation.cost > waisted.most {
                            continue;
                        }
                        let Some(objects) = self.placed(&explanation, &single) else { continue };
                        found.objects.splice(at..at + placed, objects.iter().cloned());
                        placed = objects.len();
                        self.compare_found(found)?;
                        let poses = prices.object_bits() * f64::of_usize(placed - 1);
                        let bits = explanation.shape_bits + poses + self.scratch.residual.bits(noise);
                        if bits < best.0 {
                            best = (bits, objects);
                        }
                    }
                    if best.1.len() > 1 {
                        break;
                    }
                }
                let count = best.1.len();
                failures += usize::from(count == 1);
                found.objects.splice(at..at + placed, best.1);
                placed = count;
            }
            at += placed;
        }
        Ok(())
    }

    /// What is known of an object that narrows somewhere, as two that overlap do; none for others.
    fn waisted(&mut self, single: &FoundObject<T>) -> Result<Option<Waisted<T>>, FitError> {
        if !self.stands_alone(single.segment) {
            return Ok(None);
        }
        let mut outline = alloc::vec![[T::zero(); 2]; self.fitter.outlines.vertex_count()];
        self.fitter.outlines.outline(single.object.efd_rows(), &mut outline)?;
        single.object.pose.transform(&mut outline);
        let unit = self.unit_px();
        outline.iter_mut().for_each(|v| *v = v.map(|x| x * unit));
        if !is_waisted(&outline, self.image.size()) {
            return Ok(None);
        }
        let Some(contour) = self.contour_of(single.segment) else { return Ok(None) };
        // Outlines of harmonics ripple beside corners, and bend inward there.
        if is_convex(&contour) {
            return Ok(None);
        }
        let samples = &self.scratch.segmentation.segments()[single.segment].samples;
        let misfit = misfit(&outline, samples, &mut self.scratch.lanes);
        let most = T::of(MISFIT_RATIO) * misfit + T::of(MISFIT_SLACK);
        if self.is_simple(single.segment, most) {
            return Ok(None);
        }
        let Some(field) = OutlineField::new(&contour) else { return Ok(None) };
        let samples = &self.scratch.segmentation.segments()[single.segment].samples;
        // The samples of a sharpened or noisy picture hide what the outline shows.
        let turns = match single.object.shape.descriptors()?.symmetry(T::of(SYMMETRY_TOLERANCE)) {
            Symmetry::Finite(order) => order,
            Symmetry::Continuous => 1,
        };
        let repeats = repeats(&contour, &field, samples).max(turns);
        let shape_bits = self.fitter.options.prices.free_shape_bits(single.object.efd_rows().len(), repeats);
        Ok(Some(Waisted { contour, field, most, shape_bits }))
    }

    /// Outlines that others cover or cross are bent inward there by no union.
    fn stands_alone(&self, segment: usize) -> bool {
        u32::try_from(segment).is_ok_and(|object| self.scratch.segmentation.stands_alone(object))
    }

    /// Whether one simple shape explains a segment.
    fn is_simple(&mut self, segment: usize, most: T) -> bool {
        let scratch = &mut *self.scratch;
        scratch.simple.prepare();
        let (object, size) = (u32::try_from(segment).unwrap_or(u32::MAX), self.image.size());
        let shapes = &scratch.simple.prototypes;
        search(object, shapes, size, &scratch.segmentation, Effort::Usual, &mut scratch.candidates);
        scratch.candidates.first().is_some_and(|best| best.cost <= most)
    }

    fn explanations(&mut self, waisted: &Waisted<T>, single: &FoundObject<T>, way: Way) -> Vec<Explanation<T>> {
        let overlap = self.edge.in_pixels(self.unit_px());
        let scratch = &mut *self.scratch;
        let segment = &scratch.segmentation.segments()[single.segment];
        let union = Union {
            contour: &waisted.contour,
            field: &waisted.field,
            samples: &segment.samples,
            overlap: Overlap(overlap),
            basis: &self.fitter.basis,
            settings: GrowSettings {
                vertex_count: REFERENCE_VERTICES,
                max_harmonics: self.fitter.options.max_harmonics,
                freedom: Freedom::Full,
                noise: scratch.segmentation.noise(),
                prices: self.fitter.options.prices,
            },
        };
        match way {
            Way::Simple => {
                let sets = split(segment, &scratch.simple.prototypes);
                let mut out: Vec<_> = sets.iter().map(|set| set.of_simple_shapes(&scratch.simple)).collect();
                for set in &sets {
                    if let [first, second] = *set.parts
                        && first.prototype == second.prototype
                    {
                        let prototype = &scratch.simple.prototypes[first.prototype];
                        out.extend(union.twins_from([first, second], prototype, &mut scratch.twins));
                    }
                }
                out
            }
            Way::Motion => union.twins(&mut scratch.twins),
        }
    }

    fn placed(&self, explanation: &Explanation<T>, single: &FoundObject<T>) -> Option<Vec<FoundObject<T>>> {
        let unit = self.unit_px();
        let place = |(outline, motion): &(FreeOutline<T>, PosePx<T>)| {
            // The outline stands in the frame of the motion.
            let (efd, own) = outline.normal_form(unit)?;
            let pose = Pose {
                translation: Frame::new(motion).to_pixels(outline.center).map(|v| v / unit),
                scale: motion.log_scale.exp() * own.scale,
                rotation: own.rotation + motion.rotation,
            };
            let object = Object { pose, shape: efd.into(), ..single.object.clone() };
            Some(FoundObject { object, ..single.clone() })
        };
        explanation.members.iter().map(place).collect()
    }
}
