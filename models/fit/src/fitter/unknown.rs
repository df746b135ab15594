//! Objects of unknown shape: an outline each, with as few harmonics as explain its samples.

use alloc::vec::Vec;

use dvp_core::scene::Pose;
use dvp_core::shape::REFERENCE_VERTICES;
use dvp_core::{Efd, Object, Real};

use super::run::{Found, FoundObject, Run};
use crate::free::grow::{Grown, grow, hold_outside};
use crate::free::start::{shrink, trace};
use crate::{FitError, StopReason};

impl<T: Real> Run<'_, T> {
    /// Fits an outline to every segment.
    pub(super) fn unknown_shapes(&mut self) -> Result<Found<T>, FitError> {
        let background = self.scratch.segmentation.background();
        let mut found = Found { background, objects: Vec::new(), steps: 0, stop: StopReason::Converged };
        for segment in 0..self.scratch.segmentation.segments().len() {
            let Some(grown) = self.outline_of(segment) else { continue };
            found.steps += grown.steps;
            // A first harmonic of size 0 has no pose: such an outline encloses nothing.
            if let Ok(normal) = Efd::new(grown.outline.rows).normalize() {
                let unit = self.unit_px();
                let object = Object {
                    pose: Pose {
                        translation: grown.outline.center.map(|v| v / unit),
                        scale: normal.scale / unit,
                        rotation: normal.rotation,
                    },
                    color: self.scratch.segmentation.segments()[segment].color,
                    confidence: T::one(),
                    efd: normal.efd,
                    prototype: None,
                };
                found.objects.push(FoundObject { object, segment, twin: None });
            }
        }
        Ok(found)
    }

    fn outline_of(&mut self, segment: usize) -> Option<Grown<T>> {
        let size = self.image.size();
        let half_coverage_px = self.edge.offset.max(T::zero()).sqrt() * self.unit_px() * T::of(0.5);
        let scratch = &mut *self.scratch;
        let part = &scratch.segmentation.segments()[segment];
        let object = u32::try_from(segment).ok()?;
        let contour = trace(part, object, &scratch.segmentation, size, &mut scratch.start)?;
        let contour = shrink(&contour, half_coverage_px);
        scratch.samples.clear();
        scratch.samples.extend_from_slice(&part.samples);
        if part.border > 0 {
            hold_outside(&contour, T::of_usize(size.width()), T::of_usize(size.height()), &mut scratch.samples);
        }
        let most = self.fitter.options.max_harmonics;
        grow(&contour, &scratch.samples, &self.fitter.basis, REFERENCE_VERTICES, most, &mut scratch.free)
    }
}
