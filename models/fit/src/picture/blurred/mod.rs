//! A drawing with the edges of a blur.

#[cfg(test)]
mod tests;

use core::f64::consts::FRAC_2_SQRT_PI;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::loss::{ImagePair, Loss as _};
use dvp_core::render::{EdgeProfile, PixelLoss};
use dvp_core::{ImageView, Real as _, Scene};

use crate::FitError;
use crate::paint::Canvas;

/// Step of the softness that is looked for, as a share: a softness off by half of it is seen by less than what a blur that is none of Gauss leaves.
const STEP: f32 = 1.05;
/// Most steps, up to a fifth: two pictures had their least at one or two.
const MOST_STEPS: usize = 4;

/// A scene with edges as soft as a blur of some standard deviation (pixels) makes them.
pub(super) fn blurred(scene: &Scene<f32>, blur: f64, unit_px: usize) -> Scene<f32> {
    // Such a profile has the pixel's area in it. The integral of F (1 - F), F the profile, is half the softness of the logistic curve, and the
    // deviation of a blur over the root of pi.
    let softness = FRAC_2_SQRT_PI * (blur * blur + 1.0 / 12.0).sqrt();
    Scene { edge: EdgeProfile::distance(f32::of(softness) / f32::of_usize(unit_px)), ..scene.clone() }
}

/// The same with edges of that softness at which the picture is missed least: windows tell the blur of edges that nothing is near, and no curve of
/// logistic kind is one of Gauss.
pub(super) fn nearest(
    scene: Scene<f32>,
    image: ImageView<'_, f32>,
    canvas: &mut Canvas<f32>,
) -> Result<Scene<f32>, FitError> {
    let mut loss = |edge: EdgeProfile<f32>| -> Result<f32, FitError> {
        let (painted, _) = canvas.paint(&Scene { edge, ..scene.clone() }, image.size())?;
        Ok(PixelLoss::Mae.value(ImagePair::new(painted.view(), image)?, &mut ())?)
    };
    let mut best = (loss(scene.edge)?, scene.edge);
    for factor in [STEP, 1.0 / STEP] {
        let before = best.0;
        for _ in 0..MOST_STEPS {
            let edge = EdgeProfile { sigma: best.1.sigma * factor, ..best.1 };
            let loss = loss(edge)?;
            if loss >= best.0 {
                break;
            }
            best = (loss, edge);
        }
        if best.0 < before {
            break;
        }
    }
    Ok(Scene { edge: best.1, ..scene })
}
