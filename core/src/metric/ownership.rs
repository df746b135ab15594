//! Which pixels the objects of a scene own.

use alloc::vec::Vec;

use super::MetricError;
use crate::dims::ImageSize;
use crate::real::Real;
use crate::render::tile::{CoverageModel, TileRenderer, TileScratch};
use crate::scene::{Compositing, Drawing, Scene};

/// Objects fainter than this are not seen: two steps of an 8-bit picture at full contrast.
const FAINTEST: f64 = 0.01;

/// When an object owns a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum OwnershipRule {
    /// The reference's: its fattened outline reaches the pixel, however faintly, and its confidence rounds to 1. Where two
    /// objects do, the pixel is in the union but is nobody's.
    Reached,
    /// What is seen: it covers at least half of the pixel, and its confidence, which is its opacity, is at least 0.01. The
    /// mask ends at the visible edge, not in the foot of the ramp, so that soft edges do not outweigh small objects. The
    /// [`Compositing`] says who owns what several cover.
    Seen(Compositing),
}

/// The pixels that the objects of a scene own.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Ownership {
    /// Per pixel, whether any object owns it.
    owned: Vec<bool>,
    /// Per pixel, 1 + the object that alone owns it, else 0.
    index: Vec<u32>,
    /// Objects that are there.
    objects: usize,
}

impl Ownership {
    /// Replaces the content by the reference's rule, from planes of coverage; keeps the memory.
    ///
    /// *Dimensions*: `coverage` objects x pixels, above 0 where the fattened outline reaches; `confidences` objects.
    ///
    /// # Errors
    /// [`MetricError::Length`] if `coverage` does not fit.
    pub fn fill<T: Real>(&mut self, pixels: usize, coverage: &[T], confidences: &[T]) -> Result<(), MetricError> {
        let objects = confidences.len();
        if objects.checked_mul(pixels) != Some(coverage.len()) {
            let expected = objects.saturating_mul(pixels);
            return Err(MetricError::Length { what: "coverage", expected, len: coverage.len() });
        }
        self.clear(pixels);
        for ((plane, &confidence), label) in coverage.chunks_exact(pixels.max(1)).zip(confidences).zip(1..) {
            if is_confident(confidence) {
                self.share(label, 0, plane, |coverage| coverage > T::zero());
            }
        }
        self.objects = confidences.iter().filter(|&&confidence| is_confident(confidence)).count();
        Ok(())
    }

    /// Replaces the content by what the objects of a drawing own by `rule`, with the coverage of `renderer`; keeps the
    /// memory, and takes none that grows with the number of objects.
    ///
    /// # Errors
    /// [`MetricError::Render`] if the renderer refuses the drawing.
    #[inline(never)]
    pub fn fill_drawing<T: Real, C: CoverageModel<T>>(
        &mut self,
        rule: OwnershipRule,
        renderer: &TileRenderer<C>,
        drawing: &Drawing<T>,
        size: ImageSize,
        scratch: &mut TileScratch<T, C::Record>,
    ) -> Result<(), MetricError> {
        self.clear(size.pixels());
        let (half, faintest) = (T::of(0.5), T::of(FAINTEST));
        let confidences = &drawing.confidences;
        // The last object that covered half a pixel, and how many did.
        let (mut last, mut seen) = (None, 0);
        renderer.visit_coverage(drawing, size, scratch, |object, pixel, coverage| {
            let label = u32::try_from(object + 1).unwrap_or(u32::MAX);
            let confidence = confidences[object];
            match rule {
                OwnershipRule::Reached if is_confident(confidence) => {
                    self.share(label, pixel, coverage, |coverage| coverage > T::zero());
                }
                OwnershipRule::Seen(compositing) if confidence >= faintest => {
                    if last != Some(object) && coverage.iter().any(|&coverage| coverage >= half) {
                        (last, seen) = (Some(object), seen + 1);
                    }
                    match compositing {
                        Compositing::Blend => self.share(label, pixel, coverage, |coverage| coverage >= half),
                        Compositing::Over => self.hide(label, pixel, coverage, half),
                    }
                }
                _ => {}
            }
        })?;
        self.objects = match rule {
            OwnershipRule::Reached => confidences.iter().filter(|&&confidence| is_confident(confidence)).count(),
            OwnershipRule::Seen(Compositing::Blend) => seen,
            OwnershipRule::Seen(Compositing::Over) => distinct(&self.index),
        };
        Ok(())
    }

    /// Replaces the content by a label map: pixels of equal labels belong to one object, 0 is the background.
    pub fn fill_labels(&mut self, labels: &[u32]) {
        self.index.clear();
        self.index.extend_from_slice(labels);
        self.owned.clear();
        self.owned.extend(labels.iter().map(|&label| label > 0));
        self.objects = distinct(labels);
    }

    /// Number of pixels.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.owned.len()
    }

    /// Per pixel, 1 + the object that alone owns it (or its label); 0 for the background and for pixels of several objects.
    #[must_use]
    pub fn index(&self) -> &[u32] {
        &self.index
    }

    /// Per pixel, whether any object owns it.
    pub fn union(&self) -> impl ExactSizeIterator<Item = bool> {
        self.owned.iter().copied()
    }

    /// Number of objects that are there: by [`OwnershipRule::Reached`] those whose confidence rounds to 1, in view or not;
    /// else those that are seen in at least one pixel, of a `blend` alone or mixed with others.
    #[must_use]
    pub fn objects(&self) -> usize {
        self.objects
    }

    fn clear(&mut self, pixels: usize) {
        self.owned.clear();
        self.owned.resize(pixels, false);
        self.index.clear();
        self.index.resize(pixels, 0);
    }

    /// What an object has from `pixel` on belongs to it where nobody had it before, else to nobody.
    fn share<T: Real>(&mut self, label: u32, pixel: usize, coverage: &[T], has: impl Fn(T) -> bool) {
        let pixels = self.owned[pixel..].iter_mut().zip(&mut self.index[pixel..]);
        for ((owned, index), _) in pixels.zip(coverage).filter(|(_, coverage)| has(**coverage)) {
            *index = if *owned { 0 } else { label };
            *owned = true;
        }
    }

    /// What an object covers from `pixel` on by at least half belongs to it, whoever had it before.
    fn hide<T: Real>(&mut self, label: u32, pixel: usize, coverage: &[T], half: T) {
        let pixels = self.owned[pixel..].iter_mut().zip(&mut self.index[pixel..]);
        for ((owned, index), _) in pixels.zip(coverage).filter(|(_, coverage)| **coverage >= half) {
            (*owned, *index) = (true, label);
        }
    }
}

/// Number of objects whose confidence rounds to 1.
#[must_use]
pub fn visible_object_count<T: Real>(scene: &Scene<T>) -> usize {
    scene.objects.iter().filter(|object| is_confident(object.confidence)).count()
}

/// Whether a confidence rounds to 1; 1/2 rounds to the even 0, as in the reference.
fn is_confident<T: Real>(confidence: T) -> bool {
    confidence > T::of(0.5)
}

/// Number of different labels above 0.
fn distinct(labels: &[u32]) -> usize {
    // One entry per run along the rows: far fewer than pixels.
    let mut runs: Vec<u32> = labels.chunk_by(|a, b| a == b).map(|run| run[0]).filter(|&label| label > 0).collect();
    runs.sort_unstable();
    runs.dedup();
    runs.len()
}
