//! Which pixels the objects of a scene own.

use alloc::vec::Vec;

use super::MetricError;
use crate::real::Real;
use crate::scene::Scene;

/// Most objects of a scene: labels are bytes, 0 is the background.
pub(super) const MAX_OBJECTS: usize = 255;

/// The pixels that the objects of a scene own: every pixel that the fattened outline of an object reaches, if the
/// object's confidence rounds to 1.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Ownership {
    /// Per pixel, the number of objects that own it, at most 2.
    owners: Vec<u8>,
    /// Per pixel, 1 + the object that alone owns it, else 0.
    index: Vec<u8>,
}

impl Ownership {
    /// Replaces the content; keeps the memory.
    ///
    /// *Dimensions*: `coverage` objects x pixels, above 0 where the fattened outline reaches; `confidences` objects.
    ///
    /// # Errors
    /// [`MetricError::Length`] if `coverage` does not fit, [`MetricError::TooManyObjects`] above 255 objects.
    pub fn fill<T: Real>(&mut self, pixels: usize, coverage: &[T], confidences: &[T]) -> Result<(), MetricError> {
        let objects = confidences.len();
        if objects.checked_mul(pixels) != Some(coverage.len()) {
            let expected = objects.saturating_mul(pixels);
            return Err(MetricError::Length { what: "coverage", expected, len: coverage.len() });
        }
        if objects > MAX_OBJECTS {
            return Err(MetricError::TooManyObjects { len: objects });
        }
        for vec in [&mut self.owners, &mut self.index] {
            vec.clear();
            vec.resize(pixels, 0);
        }
        let planes = coverage.chunks_exact(pixels.max(1)).zip(confidences).zip(1_u8..);
        for ((plane, _), label) in planes.filter(|((_, confidence), _)| is_visible(**confidence)) {
            for ((owners, index), &coverage) in self.owners.iter_mut().zip(&mut self.index).zip(plane) {
                if coverage > T::zero() {
                    *index = if *owners == 0 { label } else { 0 };
                    *owners = (*owners + 1).min(2);
                }
            }
        }
        Ok(())
    }

    /// Number of pixels.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.owners.len()
    }

    /// Per pixel, 1 + the object that alone owns it; 0 for the background and for pixels of several objects.
    #[must_use]
    pub fn index(&self) -> &[u8] {
        &self.index
    }

    /// Per pixel, whether any object owns it.
    pub fn union(&self) -> impl ExactSizeIterator<Item = bool> {
        self.owners.iter().map(|&owners| owners > 0)
    }
}

/// Number of objects whose confidence rounds to 1.
#[must_use]
pub fn visible_object_count<T: Real>(scene: &Scene<T>) -> usize {
    scene.objects.iter().filter(|object| is_visible(object.confidence)).count()
}

/// Whether a confidence rounds to 1; 1/2 rounds to the even 0, as in the reference.
fn is_visible<T: Real>(confidence: T) -> bool {
    confidence > T::of(0.5)
}
