//! The scores of one image, by the reference's rules as core implements them.

use anyhow::Result;
use dvp_core::loss::{ImagePair, Loss, Ssim, SsimScratch};
use dvp_core::metric::{MaskOverlap, Ownership, RandIndexScratch, adjusted_rand_index, visible_object_count};
use dvp_core::render::tile::TileScratch;
use dvp_core::render::{ContourRenderer, PixelLoss};
use dvp_core::{ImageSize, ImageView, Scene};

use crate::paint::Painter;

/// The scores of one image.
#[derive(Clone, Copy, Debug)]
pub(super) struct Score {
    pub(super) mae: f64,
    pub(super) mse: f64,
    pub(super) ssim: f64,
    /// Where the true scene is known.
    pub(super) masks: Option<MaskScore>,
}

/// Scores of which pixels belong to which object.
#[derive(Clone, Copy, Debug)]
pub(super) struct MaskScore {
    /// Of the union masks.
    pub(super) overlap: MaskOverlap,
    pub(super) ari: f64,
    pub(super) true_objects: usize,
    pub(super) found_objects: usize,
}

/// Memory of one thread.
#[derive(Default)]
pub(super) struct Scratch {
    ssim: SsimScratch<f32>,
    rand_index: RandIndexScratch,
    coverage: Vec<f32>,
    found: Ownership,
    truth: Ownership,
}

/// Compares images of one size.
pub(super) fn score_images(
    painted: ImageView<'_, f32>,
    target: ImageView<'_, f32>,
    scratch: &mut Scratch,
) -> Result<Score> {
    let pair = ImagePair::new(painted, target)?;
    Ok(Score {
        mae: f64::from(PixelLoss::Mae.value(pair, &mut ())?),
        mse: f64::from(PixelLoss::Mse.value(pair, &mut ())?),
        ssim: f64::from(Ssim::default().similarity(pair, &mut scratch.ssim)?),
        masks: None,
    })
}

/// Compares the pixels that objects own.
pub(super) fn score_masks(
    painter: &Painter,
    truth: &Scene<f32>,
    found: &Scene<f32>,
    size: ImageSize,
    scratch: &mut Scratch,
) -> Result<MaskScore> {
    own(painter, truth, size, &mut scratch.coverage, &mut scratch.truth)?;
    own(painter, found, size, &mut scratch.coverage, &mut scratch.found)?;
    let mut overlap = MaskOverlap::default();
    overlap.add(scratch.found.union(), scratch.truth.union());
    Ok(MaskScore {
        overlap,
        ari: adjusted_rand_index(scratch.found.index(), scratch.truth.index(), &mut scratch.rand_index)?,
        true_objects: visible_object_count(truth),
        found_objects: visible_object_count(found),
    })
}

/// An object owns what its fattened outline reaches, whatever renderer painted it.
fn own(
    painter: &Painter,
    scene: &Scene<f32>,
    size: ImageSize,
    coverage: &mut Vec<f32>,
    owned: &mut Ownership,
) -> Result<()> {
    let drawing = painter.draw(scene)?;
    coverage.clear();
    coverage.resize(drawing.object_count() * size.pixels(), 0.0);
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    renderer.object_coverage(&drawing, size, &mut TileScratch::default(), coverage)?;
    owned.fill(size.pixels(), coverage, &drawing.confidences)?;
    Ok(())
}
