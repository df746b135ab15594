//! Masks of objects as an index image.

use crate::real::Real;
use crate::render::RenderError;

/// Index of a pixel that no object owns.
pub const BACKGROUND: u32 = 0;

/// Writes to `index` (one number per pixel) k + 1 for the last object k that covers at least half of the pixel, or
/// [`BACKGROUND`] if there is none: what is seen in painter's order. Objects with a confidence below 1/2 own nothing.
///
/// *Dimensions*: `coverage` objects x height x width, as
/// [`object_coverage`](crate::render::TileRenderer::object_coverage) writes it, of this renderer or any other; `index`
/// height x width.
///
/// # Errors
/// [`RenderError::Length`] if `coverage` does not hold one plane of the length of `index` per confidence.
pub fn object_index<T: Real>(coverage: &[T], confidences: &[T], index: &mut [u32]) -> Result<(), RenderError> {
    let expected = index.len() * confidences.len();
    if coverage.len() != expected {
        return Err(RenderError::Length { what: "coverage", expected, len: coverage.len() });
    }
    index.fill(BACKGROUND);
    if index.is_empty() {
        return Ok(());
    }
    let half = T::of(0.5);
    for ((plane, &confidence), label) in coverage.chunks_exact(index.len()).zip(confidences).zip(BACKGROUND + 1..) {
        if confidence >= half {
            for (index, &coverage) in index.iter_mut().zip(plane) {
                if coverage >= half {
                    *index = label;
                }
            }
        }
    }
    Ok(())
}
