//! Every object whole: its coverage, also where others hide it.

use dvp_core::render::ContourRenderer;
use dvp_core::{ImageSize, Scene};

use super::error::ExportError;
use super::png::gray;
use crate::paint::Painter;

/// The largest image of all objects, pixels: what memory is taken for.
const MOST_PIXELS: usize = 1 << 30;

/// The coverage of every object by the edges of the scene, with no regard to opacity, as a gray PNG of 8 bits: tiles of the size
/// of the picture, side by side in the order of painting. Without an object there is one black tile.
///
/// # Errors
/// [`ExportError::TooMany`] if that is more than 2^30 pixels, [`ExportError::Paint`], [`ExportError::Render`],
/// [`ExportError::Png`].
pub fn whole_png(scene: &Scene<f32>, size: ImageSize) -> Result<Vec<u8>, ExportError> {
    let tiles = scene.objects.len().max(1);
    let limit = (MOST_PIXELS / size.pixels()).min(u32::MAX as usize / size.width());
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
    let (width, drawing) = (tiles * size.width(), Painter::default().draw(scene)?);
    let mut pixels = vec![0_u8; width * size.height()];
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    renderer.visit_coverage(&drawing, size, &mut Default::default(), |object, pixel, coverage| {
        let (row, column) = (pixel / size.width(), pixel % size.width());
        let start = row * width + object * size.width() + column;
        for (pixel, &coverage) in pixels[start..].iter_mut().zip(coverage) {
            *pixel = byte(coverage);
        }
    })?;
    let [width, height] = [width, size.height()].map(|side| u32::try_from(side).unwrap_or(u32::MAX));
    gray(width, height, pixels)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [0, 255] before")]
fn byte(coverage: f32) -> u8 {
    (coverage.clamp(0.0, 1.0) * 255.0).round() as u8
}
