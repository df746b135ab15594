//! Large pictures with wide edges: every k-th pixel tells all that they show.
//!
//! An edge of many pixels takes the time of as many: each is a mixture that lines and faces may explain, of every two colors of the picture. Of fifty
//! things in 4096 x 4096 pixels with edges of ten it was several seconds, of forty more than half a minute.

#[cfg(test)]
mod tests;

use dvp_core::ImageView;
use dvp_trace::Known;

use super::{PictureScratch, drawing_or_segments};
use crate::fitter::subsample::Subsampling;
use crate::{Fit, FitError, Fitter};

/// The fit of the pixels that tell a large picture with wide edges, as one of the picture; none if it takes all of them, or if the shapes or how objects
/// mix are known: then segments take the pixels that they need.
pub(super) fn fit(
    fitter: &Fitter<f32>,
    image: ImageView<'_, f32>,
    known: &Known,
    scratch: &mut PictureScratch,
) -> Result<Option<Fit<f32>>, FitError> {
    let options = fitter.options();
    let is_asked = options.bank.is_none() && options.compositing.is_none();
    let Some(taken) = is_asked.then(|| Subsampling::of(&image)).flatten() else { return Ok(None) };
    let small = taken.image(&image);
    let fit = drawing_or_segments(fitter, small.view(), known, scratch)?;
    let (_, seen) = fitter.misses(&fit, &small.view(), &mut scratch.fit)?;
    let fit = taken.restore(fit);
    let (loss, missed) = fitter.misses(&fit, &image, &mut scratch.fit)?;
    // Small things among wide edges may lie between the pixels that were taken.
    Ok(taken.holds(seen, missed).then_some(Fit { loss, ..fit }))
}
