//! The soft pixels of a segmentation that tell how soft edges are: those between the background and one object.

use dvp_core::{ImageView, Real};

use super::EdgeEvidence;
use crate::segment::Segmentation;
use crate::tuning::{EDGE_CONTRAST, EDGE_NOISES};

/// Soft pixels whose neighbors are looked at.
const MEASURED_PIXELS: usize = 320;
/// Multiples of it, without their whole parts, are spread evenly however many there are.
const GOLDEN_SECTION: f64 = 0.618_033_988_749_895;

impl<T: Real> Segmentation<T> {
    /// What the soft pixels between background and objects say about the edges of the image.
    pub(crate) fn edges(&self, image: &ImageView<'_, T>) -> EdgeEvidence<T> {
        let share = (T::of_usize(MEASURED_PIXELS) / T::of_usize(self.transitions.len().max(1))).as_f64();
        let mut turns = 0.0;
        // That of rounding changes nothing.
        let noise = if self.is_noisy() { self.noise } else { T::zero() };
        let mut evidence = EdgeEvidence { noise, ..EdgeEvidence::default() };
        let least_contrast = (T::of(EDGE_NOISES) * noise).max(T::of(EDGE_CONTRAST));
        for transition in &self.transitions {
            if let Some(rim) = self.rim(transition)
                && rim.others == 0
                && rim.contrast > least_contrast
            {
                evidence.count(rim.coverage);
                // By turns of the golden section, so that no row or column of upright edges is left out.
                turns += GOLDEN_SECTION;
                turns -= if turns >= 1.0 { 1.0 } else { 0.0 };
                if turns < share {
                    let colors = transition.pair.map(|i| self.regions[i as usize].color);
                    evidence.measure(image, transition.pixel, colors);
                }
            }
        }
        evidence
    }
}
