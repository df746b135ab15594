//! Every object whole: its coverage, also where others hide it.

use dvp_core::render::ContourRenderer;
use dvp_core::shape::REFERENCE_VERTICES;
use dvp_core::{ImageSize, Scene};
use dvp_fit::paint::drawing_of;

use super::ExportError;
use crate::format::{encode_gray8, to_byte};

/// The largest image of all objects, pixels: every thread may take memory for one.
const MOST_PIXELS: usize = 1 << 28;

/// The coverage of every object by the edges of the scene, with no regard to opacity: objects x height x width, [0, 1].
///
/// # Errors
/// As [`whole_png`].
pub fn whole_coverage(scene: &Scene<f32>, size: ImageSize) -> Result<Vec<f32>, ExportError> {
    tiles_of(scene, size)?;
    let drawing = drawing_of(scene, size, REFERENCE_VERTICES).map_err(ExportError::Draw)?;
    let mut values = vec![0.0_f32; scene.objects.len() * size.pixels()];
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    renderer.visit_coverage(&drawing, size, &mut Default::default(), |object, pixel, coverage| {
        for (value, &coverage) in values[object * size.pixels() + pixel..].iter_mut().zip(coverage) {
            *value = coverage;
        }
    })?;
    Ok(values)
}

/// The number of tiles of the size of the picture, at least one.
fn tiles_of(scene: &Scene<f32>, size: ImageSize) -> Result<usize, ExportError> {
    let tiles = scene.objects.len().max(1);
    let limit = MOST_PIXELS / size.pixels();
    if tiles > limit {
        let remedy = "keep fewer with --max-objects, or scale the picture down";
        return Err(ExportError::TooMany {
            file: "an image of whole objects",
            what: "of them",
            count: tiles,
            limit,
            remedy,
        });
    }
    Ok(tiles)
}

/// The coverage of every object by the edges of the scene, with no regard to opacity, as a gray PNG of 8 bits: tiles of the size
/// of the picture, side by side in the order of painting. Without an object there is one black tile.
///
/// # Errors
/// [`ExportError::TooMany`] if that is more than 2^28 pixels, [`ExportError::Draw`], [`ExportError::Render`],
/// [`ExportError::Png`].
pub fn whole_png(scene: &Scene<f32>, size: ImageSize) -> Result<Vec<u8>, ExportError> {
    let tiles = tiles_of(scene, size)?;
    let all = ImageSize::new(tiles * size.width(), size.height())?;
    let drawing = drawing_of(scene, size, REFERENCE_VERTICES).map_err(ExportError::Draw)?;
    let mut pixels = vec![0_u8; all.pixels()];
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    renderer.visit_coverage(&drawing, size, &mut Default::default(), |object, pixel, coverage| {
        let (row, column) = (pixel / size.width(), pixel % size.width());
        let start = row * all.width() + object * size.width() + column;
        for (pixel, &coverage) in pixels[start..].iter_mut().zip(coverage) {
            *pixel = to_byte(coverage);
        }
    })?;
    Ok(encode_gray8(&pixels, all)?)
}
