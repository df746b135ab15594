//! Fewer objects than a drawing has.

use alloc::vec;

use dvp_core::ImageView;
use dvp_core::loss::{ImagePair, Loss as _};
use dvp_core::render::PixelLoss;

use crate::paint::Canvas;
use crate::{Ambiguity, Fit, FitError};

/// The `most` objects of a fit without which most of the picture would be unexplained; a fit with no more stays as it is.
pub(super) fn at_most(
    fit: Fit<f32>,
    most: usize,
    image: ImageView<'_, f32>,
    canvas: &mut Canvas<f32>,
) -> Result<Fit<f32>, FitError> {
    let (count, ranking) = (fit.scene.objects.len(), fit.ranking());
    if count <= most || ranking.len() != count {
        return Ok(fit);
    }
    let mut is_kept = vec![false; count];
    for k in ranking.into_iter().take(most) {
        is_kept[k] = true;
    }
    let kept = |k: usize| is_kept.get(k).copied().unwrap_or(false);
    // Where the kept ones stand afterwards.
    let place = |k: usize| kept(k).then(|| is_kept[..k].iter().filter(|&&is_kept| is_kept).count());
    let ambiguity = fit.ambiguity.iter().filter_map(|ambiguity| moved(ambiguity, place)).collect();
    let covariance = fit.covariance.iter().enumerate().filter(|&(k, _)| kept(k)).map(|(_, block)| *block).collect();
    let expected_iou = fit.expected_iou.iter().enumerate().filter(|&(k, _)| kept(k)).map(|(_, &iou)| iou).collect();
    let mut scene = fit.scene;
    scene.objects = scene.objects.into_iter().enumerate().filter(|&(k, _)| kept(k)).map(|(_, object)| object).collect();
    let (painted, drawing) = canvas.paint(&scene, image.size())?;
    let loss = PixelLoss::Mae.value(ImagePair::new(painted.view(), image)?, &mut ())?;
    let left = Fit::of_painted(scene, &drawing, &image, painted.data());
    Ok(Fit { loss, stop: fit.stop, steps: fit.steps, bits: f64::NAN, covariance, expected_iou, ambiguity, ..left })
}

/// An ambiguity of an object that stands elsewhere; none if the object, or the one that it is about, is gone.
pub(super) fn moved(ambiguity: &Ambiguity, place: impl Fn(usize) -> Option<usize>) -> Option<Ambiguity> {
    let mut moved = ambiguity.clone();
    match &mut moved {
        Ambiguity::Merged { object, other, .. } => (*object, *other) = (place(*object)?, place(*other)?),
        Ambiguity::Symmetry { object, .. }
        | Ambiguity::Cropped { object, .. }
        | Ambiguity::Hidden { object, .. }
        | Ambiguity::Twin { object, .. } => *object = place(*object)?,
    }
    Some(moved)
}
