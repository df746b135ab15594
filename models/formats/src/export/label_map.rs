//! Label maps: which object is seen in each pixel.

use dvp_core::metric::{Ownership, OwnershipRule};
use dvp_core::render::{Compositing, ContourRenderer};
use dvp_core::shape::REFERENCE_VERTICES;
use dvp_core::{ImageSize, Scene};
use dvp_fit::paint::drawing_of;

use super::error::ExportError;

/// The object that is seen in each pixel, row by row: 0 for the background, else its number in `numbers`, which has one per object.
///
/// An object is seen where it covers at least half of a pixel, by the edges of the scene, and no later object does, whatever
/// the opacity of that: what `dvp evaluate` compares with for scenes that hide. Where the objects of a scene that
/// `blend`s overlap they are all seen; the pixel goes to the last one.
///
/// # Errors
/// [`ExportError::Draw`] and [`ExportError::Owners`] if the scene cannot be drawn.
pub fn label_map(scene: &Scene<f32>, numbers: &[u32], size: ImageSize) -> Result<Vec<u32>, ExportError> {
    let drawing = drawing_of(scene, size, REFERENCE_VERTICES).map_err(ExportError::Draw)?;
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    let mut owners = Ownership::default();
    let rule = OwnershipRule::Seen(Compositing::Over);
    owners.fill_drawing(rule, &renderer, &drawing, size, &mut Default::default())?;
    let number = |&index: &u32| (index as usize).checked_sub(1).and_then(|k| numbers.get(k)).copied();
    Ok(owners.index().iter().map(|index| number(index).unwrap_or(0)).collect())
}
