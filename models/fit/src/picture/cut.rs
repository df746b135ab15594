//! Pictures that are not flat, such as photographs: cut into regions of one color, which are drawn.

use dvp_core::ImageView;
use dvp_trace::noise::noise_level;
use dvp_trace::regions::regions;
use dvp_trace::trace_regions;

use super::likelier::is_likelier;
use super::{CLEARLY_WORSE, PictureScratch, of_painted};
use crate::tuning::NOT_FLAT_SHARE;
use crate::{Fit, FitError, StopReason};

/// A fit that leaves no more unexplained than flat pictures do, or that of regions, at most `most`, if these are much nearer to the picture, or fewer
/// and nearer.
#[inline(never)]
pub(super) fn or_regions(
    fit: Fit<f32>,
    image: ImageView<'_, f32>,
    most: usize,
    scratch: &mut PictureScratch,
) -> Result<Fit<f32>, FitError> {
    if fit.unexplained <= NOT_FLAT_SHARE {
        return Ok(fit);
    }
    // One of them is the background.
    let noise = f64::from(noise_level(&image, &mut Default::default()));
    let Some(regions) = regions(&image, most.saturating_add(1), noise) else { return Ok(fit) };
    let Ok(traced) = trace_regions(&regions) else { return Ok(fit) };
    let (painted, drawing) = scratch.canvas.paint(&traced.scene, image.size())?;
    let cut = of_painted(&traced.scene, &drawing, painted, image)?;
    let is_taken = is_likelier(&cut, &fit, 1.0, CLEARLY_WORSE) && cut.loss < fit.loss;
    Ok(if is_taken { Fit { bits: traced.bits, stop: StopReason::NotFlat, ..cut } } else { fit })
}
