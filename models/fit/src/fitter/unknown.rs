//! Objects of unknown shape: an outline each, with as few harmonics as explain its samples.

use alloc::vec::Vec;

use dvp_core::shape::REFERENCE_VERTICES;
use dvp_core::{Efd, Object, Real};

use super::run::{Found, FoundObject, Run};
use crate::free::grow::{Freedom, GrowSettings, Grown, grow, hold_outside};
use crate::free::start::{shrink, trace};
use crate::pose::search::symmetry_order;
use crate::tuning::{CLEARLY_LESS_LOSS, CODED_ALIKE, FOLDED_PIXELS};
use crate::{Completion, FitError, StopReason};

impl<T: Real> Run<'_, T> {
    /// Fits an outline to every segment.
    pub(super) fn unknown_shapes(&mut self) -> Result<Found<T>, FitError> {
        let background = self.scratch.segmentation.background();
        let mut found = Found { background, objects: Vec::new(), steps: 0, stop: StopReason::Converged };
        for segment in self.painting_order() {
            let segment = segment as usize;
            if let Some((object, steps, completion)) = self.object_of(segment, Freedom::Full) {
                found.steps += steps;
                found.objects.push(FoundObject { object, segment, twin: None, completion });
            }
        }
        self.try_with_less_freedom(&mut found)?;
        // What compression leaves along edges is no evidence of a shared outline.
        if !self.scratch.segmentation.is_compressed() {
            self.split_unknown(&mut found)?;
        }
        Ok(found)
    }

    /// Outlines that visibly miss the image have folded: ones with less freedom compete with them.
    fn try_with_less_freedom(&mut self, found: &mut Found<T>) -> Result<(), FitError> {
        let mut loss = self.compare_found(found)?;
        for at in 0..found.objects.len() {
            let part = &found.objects[at];
            // The first harmonic has size 1; the others of a sane outline do not reach twice as far.
            let center = part.object.pose.translation.map(|v| v * self.unit_px());
            let reach = part.object.pose.scale * self.unit_px() * T::of(2.0);
            if self.missed_pixels(center, reach) <= FOLDED_PIXELS {
                continue;
            }
            let segment = part.segment;
            let mut best = (part.object.clone(), part.completion);
            for freedom in [Freedom::Normals, Freedom::None] {
                if let Some((object, steps, completion)) = self.object_of(segment, freedom) {
                    found.steps += steps;
                    found.objects[at].object = object;
                    let tried = self.compare_found(found)?;
                    if tried < T::of(CLEARLY_LESS_LOSS) * loss {
                        loss = tried;
                        best = (found.objects[at].object.clone(), completion);
                    }
                }
            }
            (found.objects[at].object, found.objects[at].completion) = best;
            loss = self.compare_found(found)?;
        }
        Ok(())
    }

    pub(super) fn compare_found(&mut self, found: &Found<T>) -> Result<T, FitError> {
        self.scene_of(found).draw(&self.fitter.outlines, &mut self.scratch.drawing)?;
        self.compare_drawing()
    }

    /// The object of a segment, the steps it took, and what completes it; none if it encloses nothing.
    fn object_of(&mut self, segment: usize, freedom: Freedom) -> Option<(Object<T>, usize, Completion)> {
        let grown = self.outline_of(segment, freedom)?;
        let completion = completion(&grown.outline.rows);
        let (efd, pose) = grown.outline.normal_form(self.unit_px())?;
        let segment = &self.scratch.segmentation.segments()[segment];
        Some((Object::of_efd(pose, segment.color, segment.confidence, efd, None), grown.steps, completion))
    }

    /// The outline of a segment as traced (px); none if it encloses nothing.
    pub(super) fn contour_of(&mut self, segment: usize) -> Option<Vec<[T; 2]>> {
        let size = self.image.size();
        let half_coverage_px = self.edge.half_coverage().max(T::zero()) * self.unit_px();
        let scratch = &mut *self.scratch;
        let part = &scratch.segmentation.segments()[segment];
        let object = u32::try_from(segment).ok()?;
        let contour = trace(part, object, &scratch.segmentation, size, &mut scratch.start)?;
        Some(shrink(&contour, half_coverage_px))
    }

    /// The outline of a segment; where it is hidden, it goes on the shortest way.
    pub(super) fn outline_of(&mut self, segment: usize, freedom: Freedom) -> Option<Grown<T>> {
        let size = self.image.size();
        let contour = self.contour_of(segment)?;
        let scratch = &mut *self.scratch;
        // Neighbors along an edge of a coded picture are off alike, so that each says less.
        let alike = if scratch.code.is_some() { T::of(CODED_ALIKE) } else { T::one() };
        let noise = alike * scratch.segmentation.noise();
        let part = &scratch.segmentation.segments()[segment];
        scratch.samples.clear();
        scratch.samples.extend_from_slice(&part.samples);
        if part.border > 0 {
            hold_outside(&contour, T::of_usize(size.width()), T::of_usize(size.height()), &mut scratch.samples);
        }
        let basis = &self.fitter.basis;
        let settings = GrowSettings {
            vertex_count: REFERENCE_VERTICES,
            max_harmonics: self.fitter.options.max_harmonics,
            freedom,
            noise,
            prices: self.fitter.options.prices,
        };
        grow(&contour, &scratch.samples, basis, settings, &mut scratch.free)
    }
}

/// What completes an outline where it is hidden: nothing but its harmonics. An ellipse goes on as it must, any other the shortest way.
fn completion<T: Real>(rows: &[[T; 4]]) -> Completion {
    match rows {
        &[row] => Completion::Rotation { order: symmetry_order(&Efd::new(Vec::from([row]))) },
        _ => Completion::Straight,
    }
}
