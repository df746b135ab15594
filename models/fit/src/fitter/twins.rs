//! Segments that no single shape explains, split into several objects of one color.

use alloc::vec::Vec;

use dvp_core::Real;

use super::known::Source;
use super::run::Run;
use crate::FitError;
use crate::joint::{JointObject, JointScene};
use crate::price::known_object_bits;
use crate::split::split;

impl<T: Real> Run<'_, T> {
    /// Replaces objects that visibly miss the image by sets of prototypes whose union explains their segments, where that
    /// shortens the description. The rendering of `posed` must be the last one; so it is again afterwards. Returns the loss.
    pub(super) fn split_known(
        &mut self,
        posed: &mut JointScene<T>,
        sources: &mut Vec<Source>,
        mut loss: T,
    ) -> Result<T, FitError> {
        for at in 0..sources.len() {
            let source = sources[at];
            if source.sure || !self.misses_object(posed, at) {
                continue;
            }
            let sets = split(&self.scratch.segmentation.segments()[source.segment], &self.fitter.prototypes);
            let single = posed.objects[at];
            let count = posed.objects.len();
            let mut best = (self.residual_bits(), loss, Vec::from([single]));
            for set in sets {
                let parts = set.parts.iter();
                let objects: Vec<JointObject<T>> =
                    parts.map(|part| JointObject { shape: part.prototype, pose: part.pose, ..single }).collect();
                place(posed, at, count, &objects);
                let loss = self.compare(posed)?;
                let price = known_object_bits(self.fitter.prototypes.len()) * T::of_usize(objects.len() - 1).as_f64();
                let bits = self.residual_bits() + price;
                if bits < best.0 {
                    best = (bits, loss, objects);
                }
            }
            place(posed, at, count, &best.2);
            sources.resize(posed.objects.len(), source);
            loss = self.compare(posed)?;
        }
        Ok(loss)
    }

    fn residual_bits(&self) -> f64 {
        self.scratch.residual.bits(self.noise())
    }
}

/// Puts the first of `objects` in place `at` and the others behind the first `count`.
fn place<T: Real>(posed: &mut JointScene<T>, at: usize, count: usize, objects: &[JointObject<T>]) {
    posed.objects.truncate(count);
    if let Some((first, others)) = objects.split_first() {
        posed.objects[at] = *first;
        posed.objects.extend_from_slice(others);
    }
}
