//! Pictures whose shapes are known.
//!
//! Where no pixel is mixed, the shapes are laid on the pixels one by one ([`Decoder`]); everywhere else edges tell poses better
//! ([`Fitter`]). A picture of few colors to which a drawing of any shapes comes much nearer has other shapes.

use dvp_core::ImageView;
use dvp_core::loss::{ImagePair, Loss as _};
use dvp_core::render::PixelLoss;

use super::{Known, PictureScratch, drawn, leaves_doubt, likelier};
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
    scratch.decoder = Some(decoder);
    let found = match decoded {
        Ok(Decoded { scene, ambiguity }) => {
            let (painted, drawing) = scratch.canvas.paint(&scene, image.size())?;
            let loss = PixelLoss::Mae.value(ImagePair::new(painted.view(), image)?, &mut ())?;
            let fit = Fit::of_painted(scene, &drawing, &image, painted.data());
            Fit { loss, stop: StopReason::Converged, ambiguity, ..fit }
        }
        Err(Undecoded::NotFlat) => return fitter.fit(image, &mut scratch.fit),
        Err(Undecoded::Unexplained) => fitter.fit(image, &mut scratch.fit)?,
    };
    if found.loss <= RIGHT {
        return Ok(found);
    }
    // Where edges leave a doubt, shapes that are known tell more than shapes that are not.
    let traced = dvp_trace::trace(&image, known).ok().filter(|traced| !leaves_doubt(traced));
    let Some(traced) = traced else { return Ok(found) };
    let drawn = drawn(traced, image, scratch)?;
    Ok(likelier(found, drawn))
}
