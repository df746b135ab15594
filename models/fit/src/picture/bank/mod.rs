//! Pictures whose shapes are known.
//!
//! Where no pixel is mixed, or none was before the picture got noise or went through a coder, the shapes are laid on the pixels one by one
//! ([`Decoder`]); everywhere else edges tell poses better ([`Fitter`]). A picture of few colors to which a drawing of any shapes comes much nearer has
//! other shapes; of one that went through a coder the shorter description tells.

#[cfg(test)]
mod tests;

use dvp_core::ImageView;

use super::drawing::{CLEARLY_WORSE_IN_NOISE, drawn, leaves_doubt, of_painted};
use super::likelier::{is_likelier, is_of_renderer, likelier, shorter};
use super::{Known, PictureScratch};
use crate::paint::Canvas;
use crate::prototypes::{Decoded, Decoder, Undecoded};
use crate::{Bank, Fit, FitError, Fitter, StopReason};

/// Mean absolute error of a scene that paints every pixel in its color: pixels near the outline are not quite of one color.
const RIGHT: f32 = 1e-4;

/// The fit of a picture whose objects have the shapes of `bank`, which are those of `fitter`.
pub(super) fn fit(
    fitter: &Fitter<f32>,
    bank: &Bank<f32>,
    image: ImageView<'_, f32>,
    known: &Known,
    scratch: &mut PictureScratch,
) -> Result<Fit<f32>, FitError> {
    let decoder = match scratch.decoder.take().filter(|decoder| decoder.bank() == bank) {
        Some(decoder) => decoder,
        None => Decoder::new(bank).map_err(FitError::Shape)?,
    };
    let decoded = decoder.decode(&image);
    let found = match decoded {
        Ok(decoded) => of_decoded(decoded, image, &mut scratch.canvas)?,
        Err(Undecoded::NotFlat) => {
            let found = fitter.fit(image, &mut scratch.fit)?;
            let fit = or_unspoiled(found, &decoder, image, known, scratch);
            scratch.decoder = Some(decoder);
            return fit;
        }
        Err(Undecoded::Unexplained) => fitter.fit(image, &mut scratch.fit)?,
    };
    scratch.decoder = Some(decoder);
    if found.loss <= RIGHT {
        return Ok(found);
    }
    // Where edges leave a doubt, shapes that are known tell more than shapes that are not.
    let traced = dvp_trace::trace(&image, known).ok().filter(|traced| !leaves_doubt(traced));
    let Some(traced) = traced else { return Ok(found) };
    let drawn = drawn(traced, image, scratch)?;
    Ok(likelier(found, drawn))
}

/// The fit of segments, or of what the picture was before noise or a coder came, if that had no mixed pixel and is likelier.
#[inline(never)]
fn or_unspoiled(
    found: Fit<f32>,
    decoder: &Decoder<f32>,
    image: ImageView<'_, f32>,
    known: &Known,
    scratch: &mut PictureScratch,
) -> Result<Fit<f32>, FitError> {
    // Every pixel at the edges of the paper's renderer is mixed.
    if is_of_renderer(&found) {
        return Ok(found);
    }
    let flat = dvp_trace::flat(&image, known);
    let decoded = flat.and_then(|flat| decoder.decode(&flat.view()).ok());
    let decoded = decoded.map(|decoded| of_decoded(decoded, image, &mut scratch.canvas)).transpose()?;
    if !known.coded {
        let is_likelier = |decoded: &Fit<f32>| is_likelier(decoded, &found, 1.0, CLEARLY_WORSE_IN_NOISE);
        return Ok(decoded.filter(is_likelier).unwrap_or(found));
    }
    // Of bits other shapes pay for themselves.
    let traced = dvp_trace::trace(&image, known).ok();
    let drawn = traced.map(|traced| drawn(traced, image, scratch)).transpose()?;
    let mut others = decoded.into_iter().chain(drawn);
    others.try_fold(found, |best, other| shorter(best, other, image, &mut scratch.canvas))
}

/// The fit of what was decoded, to the picture as it is.
fn of_decoded(
    Decoded { scene, ambiguity }: Decoded<f32>,
    image: ImageView<'_, f32>,
    canvas: &mut Canvas<f32>,
) -> Result<Fit<f32>, FitError> {
    let (painted, drawing) = canvas.paint(&scene, image.size())?;
    let fit = of_painted(&scene, &drawing, painted, image)?;
    Ok(Fit { stop: StopReason::Converged, ambiguity, ..fit })
}
