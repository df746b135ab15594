//! Scenes against what was drawn, in the columns of the paper and of the field's benchmarks.
//!
//! In: a picture, the scene that was found in it and, where known, the scene or the label map that it was drawn from. Out: a
//! [`Score`], and of many pictures their [`Totals`]. Measures as core implements them.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | [`score`], [`score_pixels`]: one picture |
//! | `totals.rs` | [`Totals`]: means of many |
//! | `objects.rs`, `object_totals.rs` | [`score_objects`]: objects against objects, and over many pictures |
//! | `classes.rs` | [`Confusion`]: true and found classes |
//! | `components.rs` | [`connected_components`]: what the simplest program finds |
//!
//! Proved by `tests/command`, which runs `dvp evaluate`.

mod classes;
mod components;
mod object_totals;
mod objects;
#[cfg(test)]
mod tests;
mod totals;

pub use classes::Confusion;
pub use components::connected_components;
pub use object_totals::ObjectTotals;
pub use objects::{ObjectScore, Parts, Share, score_objects};
pub use totals::{Failure, Row, Totals};

use dvp_core::loss::{ImagePair, Loss, LossError, Ssim, SsimScratch};
use dvp_core::matching::MatchingError;
use dvp_core::metric::{MaskOverlap, MetricError, Ownership, OwnershipRule, RandIndexScratch, adjusted_rand_index};
use dvp_core::render::{Compositing, ContourRenderer, PixelLoss, Renderer};
use dvp_core::{ImageSize, ImageView, Scene};

use crate::paint::{PaintError, Painter};

/// Why a scene was not scored.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ScoreError {
    /// The scene could not be painted.
    #[error(transparent)]
    Paint(#[from] PaintError),
    /// The images could not be compared: their sizes differ, or a value is not finite.
    #[error(transparent)]
    Compare(#[from] LossError),
    /// The pixels of objects could not be told or compared.
    #[error(transparent)]
    Metric(#[from] MetricError),
    /// Objects could not be matched.
    #[error(transparent)]
    Matching(#[from] MatchingError),
}

/// The scores of one image.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Score {
    /// Mean absolute error over pixels and channels.
    pub mae: f64,
    /// Mean squared error over pixels and channels.
    pub mse: f64,
    /// Structural similarity; 1 for equal images.
    pub ssim: f64,
    /// Where the true scene or a label map is known.
    pub masks: Option<MaskScore>,
    /// Processor time of the prediction, where it was made here.
    pub cpu_ms: Option<f64>,
}

/// Scores of which pixels belong to which object.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct MaskScore {
    /// Of the union masks.
    pub overlap: MaskOverlap,
    /// Adjusted Rand index; 1 if both divide the pixels alike.
    pub ari: f64,
    /// Objects of the truth that own a pixel.
    pub true_objects: usize,
    /// Objects of the prediction that own a pixel.
    pub found_objects: usize,
}

/// Memory of one thread, kept from image to image.
#[derive(Debug, Default)]
pub struct Scratch {
    ssim: SsimScratch<f32>,
    rand_index: RandIndexScratch,
    render: Render,
    found: Ownership,
    truth: Ownership,
}

/// Scores the scene that is painted, and that of the objects that count: `[found, there]`.
///
/// # Errors
/// [`ScoreError`]; of labels that are not one per pixel [`ScoreError::Metric`].
pub fn score(
    painter: &Painter,
    image: ImageView<'_, f32>,
    known: Option<&Truth<'_>>,
    [found, there]: [&Scene<f32>; 2],
    scratch: &mut Scratch,
) -> Result<Score, ScoreError> {
    let painted = painter.paint(found, image.size())?;
    let mut score = score_images(painted.view(), image, scratch)?;
    score.masks = known.map(|known| score_masks(painter, known, there, image.size(), scratch)).transpose()?;
    Ok(score)
}

/// Scores a reconstruction and the object that each of its pixels shows, of a method that draws no scene. Objects of a true scene
/// that blends own what they reach, as in [`score`]; those that were found what `labels` says, 0 for the background.
///
/// # Errors
/// As [`score`]; [`ScoreError::Compare`] if the images differ in size.
pub fn score_pixels(
    painter: &Painter,
    image: ImageView<'_, f32>,
    known: Option<&Truth<'_>>,
    (painted, labels): (ImageView<'_, f32>, &[u32]),
    scratch: &mut Scratch,
) -> Result<Score, ScoreError> {
    let mut score = score_images(painted, image, scratch)?;
    score.masks = known.map(|known| score_labels(painter, known, labels, image.size(), scratch)).transpose()?;
    Ok(score)
}

/// Compares images of one size.
fn score_images(
    painted: ImageView<'_, f32>,
    target: ImageView<'_, f32>,
    scratch: &mut Scratch,
) -> Result<Score, ScoreError> {
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
#[derive(Clone, Copy, Debug)]
pub enum Truth<'a> {
    /// The scene that was painted.
    Scene(&'a Scene<f32>),
    /// One label per pixel, row by row; 0 for the background.
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
) -> Result<MaskScore, ScoreError> {
    let Scratch { rand_index, render, found: found_owned, truth: truly_owned, .. } = scratch;
    own_truly(painter, truth, size, render, truly_owned)?;
    let rule = match *truth {
        Truth::Scene(truth) if truth.compositing == Compositing::Blend => OwnershipRule::Reached,
        _ => OwnershipRule::Seen(found.compositing),
    };
    own(painter, found, rule, size, render, found_owned)?;
    compare(found_owned, truly_owned, rand_index)
}

/// Compares the pixels that labels give to objects.
fn score_labels(
    painter: &Painter,
    truth: &Truth<'_>,
    labels: &[u32],
    size: ImageSize,
    scratch: &mut Scratch,
) -> Result<MaskScore, ScoreError> {
    let Scratch { rand_index, render, found: found_owned, truth: truly_owned, .. } = scratch;
    own_truly(painter, truth, size, render, truly_owned)?;
    found_owned.fill_labels(labels);
    compare(found_owned, truly_owned, rand_index)
}

type Render = <ContourRenderer<f32> as Renderer<f32>>::Scratch;

/// What the objects of a scene own, by the visible edge, whatever renderer painted it.
fn own(
    painter: &Painter,
    scene: &Scene<f32>,
    rule: OwnershipRule,
    size: ImageSize,
    render: &mut Render,
    owned: &mut Ownership,
) -> Result<(), ScoreError> {
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    Ok(owned.fill_drawing(rule, &renderer, &painter.draw(scene, size)?, size, render)?)
}

fn own_truly(
    painter: &Painter,
    truth: &Truth<'_>,
    size: ImageSize,
    render: &mut Render,
    owned: &mut Ownership,
) -> Result<(), ScoreError> {
    match *truth {
        Truth::Scene(truth) if truth.compositing == Compositing::Blend => {
            own(painter, truth, OwnershipRule::Reached, size, render, owned)
        }
        Truth::Scene(truth) => own(painter, truth, OwnershipRule::Seen(truth.compositing), size, render, owned),
        Truth::Labels(labels) => {
            owned.fill_labels(labels);
            Ok(())
        }
    }
}

fn compare(found: &Ownership, truth: &Ownership, rand_index: &mut RandIndexScratch) -> Result<MaskScore, ScoreError> {
    let mut overlap = MaskOverlap::default();
    overlap.add(found.union(), truth.union());
    Ok(MaskScore {
        overlap,
        ari: adjusted_rand_index(found.index(), truth.index(), rand_index)?,
        true_objects: truth.objects(),
        found_objects: found.objects(),
    })
}
