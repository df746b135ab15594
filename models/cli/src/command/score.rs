//! The scores of one image, by the reference's rules as core implements them.

use anyhow::Result;
use dvp_core::loss::{ImagePair, Loss, Ssim, SsimScratch};
use dvp_core::metric::{MaskOverlap, Ownership, OwnershipRule, RandIndexScratch, adjusted_rand_index};
use dvp_core::render::{Compositing, ContourRenderer, PixelLoss, Renderer};
use dvp_core::{ImageSize, ImageView, Scene};

use crate::method::Memory;
use crate::paint::Painter;

/// The scores of one image.
#[derive(Clone, Copy, Debug)]
pub(super) struct Score {
    pub(super) mae: f64,
    pub(super) mse: f64,
    pub(super) ssim: f64,
    /// Where the true scene or a label map is known.
    pub(super) masks: Option<MaskScore>,
    /// Processor time of the prediction, where it was made here.
    pub(super) cpu_ms: Option<f64>,
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
    render: <ContourRenderer<f32> as Renderer<f32>>::Scratch,
    found: Ownership,
    truth: Ownership,
    pub(super) method: Memory,
}

/// Scores the scene that is painted, and that of the objects that count.
pub(super) fn score(
    painter: &Painter,
    image: ImageView<'_, f32>,
    known: Option<&Truth<'_>>,
    [found, there]: [&Scene<f32>; 2],
    scratch: &mut Scratch,
) -> Result<Score> {
    let painted = painter.paint(found, image.size())?;
    let mut score = score_images(painted.view(), image, scratch)?;
    score.masks = known.map(|known| score_masks(painter, known, there, image.size(), scratch)).transpose()?;
    Ok(score)
}

/// Compares images of one size.
fn score_images(painted: ImageView<'_, f32>, target: ImageView<'_, f32>, scratch: &mut Scratch) -> Result<Score> {
    let pair = ImagePair::new(painted, target)?;
    Ok(Score {
        mae: f64::from(PixelLoss::Mae.value(pair, &mut ())?),
        mse: f64::from(PixelLoss::Mse.value(pair, &mut ())?),
        ssim: f64::from(Ssim::default().similarity(pair, &mut scratch.ssim)?),
        masks: None,
        cpu_ms: None,
    })
}

/// What predicted owners are compared with.
pub(super) enum Truth<'a> {
    /// The scene that was painted.
    Scene(&'a Scene<f32>),
    /// One label per pixel.
    Labels(&'a [u32]),
}

/// Compares the pixels that objects own. The truth decides the rule: the reference's for scenes that `blend`, else what
/// is seen, of the prediction by its own compositing.
fn score_masks(
    painter: &Painter,
    truth: &Truth<'_>,
    found: &Scene<f32>,
    size: ImageSize,
    scratch: &mut Scratch,
) -> Result<MaskScore> {
    let Scratch { rand_index, render, found: found_owned, truth: truly_owned, .. } = scratch;
    let mut own = |scene: &Scene<f32>, rule, owned: &mut Ownership| -> Result<()> {
        // The visible edge, whatever renderer painted it.
        let renderer = ContourRenderer::new(scene.edge, scene.compositing);
        Ok(owned.fill_drawing(rule, &renderer, &painter.draw(scene, size)?, size, render)?)
    };
    let seen = OwnershipRule::Seen(found.compositing);
    let rule = match *truth {
        Truth::Scene(truth) if truth.compositing == Compositing::Blend => {
            own(truth, OwnershipRule::Reached, truly_owned)?;
            OwnershipRule::Reached
        }
        Truth::Scene(truth) => {
            own(truth, OwnershipRule::Seen(truth.compositing), truly_owned)?;
            seen
        }
        Truth::Labels(labels) => {
            truly_owned.fill_labels(labels);
            seen
        }
    };
    own(found, rule, found_owned)?;
    let mut overlap = MaskOverlap::default();
    overlap.add(found_owned.union(), truly_owned.union());
    Ok(MaskScore {
        overlap,
        ari: adjusted_rand_index(found_owned.index(), truly_owned.index(), rand_index)?,
        true_objects: truly_owned.objects(),
        found_objects: found_owned.objects(),
    })
}
