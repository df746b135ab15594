//! Pictures with color ramps: read as if each were of one color, and painted with them.

mod shown;
#[cfg(test)]
mod tests;

use alloc::vec;

use dvp_core::scene::ColorRamp;
use dvp_core::{ImageSize, ImageView, Paint, Scene};
use dvp_trace::ramps::{Leveled, LeveledRamp};

use super::most::moved;
use super::of_painted;
use super::openings::sheet;
use crate::paint::Canvas;
use crate::{Fit, FitError};

/// How far the color of an object may be from the one that stands for a ramp: that of edges is a mean, and colors that stand for ramps are much
/// further apart.
const NEAR: f32 = 0.02;

/// Mean error that is not seen, of 1: two steps of 256.
pub(super) const AS_NEAR: f32 = 2.0 / 255.0;

/// The fit of a leveled picture with what was leveled, held against the picture as it is.
pub(super) fn with_ramps(
    fit: Fit<f32>,
    leveled: &Leveled,
    image: ImageView<'_, f32>,
    canvas: &mut Canvas<f32>,
) -> Result<Fit<f32>, FitError> {
    let ramp_of = |color: [f32; 3]| {
        leveled.ramps.iter().find(|ramp| ramp.color.iter().zip(color).all(|(a, b)| (a - b).abs() < NEAR))
    };
    let mut fit = fit;
    if !fit.scene.transparent && ramp_of(fit.scene.background).is_some() {
        put_under(&mut fit, image.size());
    }
    let mut scene = fit.scene;
    for object in &mut scene.objects {
        let Some(LeveledRamp { ramp, .. }) = ramp_of(object.color()) else { continue };
        if let Some(inverse) = object.pose.inverse() {
            object.paint = Paint::Ramp(ColorRamp { kind: ramp.kind.posed(&inverse), stops: ramp.stops.clone() });
        }
    }
    let (mut painted, mut drawing) = canvas.paint(&scene, image.size())?;
    if shown::recolor(&mut scene, (&drawing, painted), &leveled.image.view(), &image)? {
        (painted, drawing) = canvas.paint(&scene, image.size())?;
    }
    let painted = of_painted(&scene, &drawing, painted, image)?;
    let Fit { bits, stop, steps, noise, covariance, expected_iou, ambiguity, .. } = fit;
    Ok(Fit { bits, stop, steps, noise, covariance, expected_iou, ambiguity, ..painted })
}

/// Makes the background a thing as large as the picture, the first one: a background has one color, and what has more is a thing.
pub(super) fn put_under(fit: &mut Fit<f32>, size: ImageSize) {
    let sheet = Scene { objects: vec![sheet(fit.scene.background.map(f64::from), size)], ..Scene::empty([0.0; 3]) };
    fit.scene.objects.splice(0..0, sheet.cast().objects);
    if !fit.covariance.is_empty() {
        fit.covariance.insert(0, [f32::NAN; 25]);
    }
    if !fit.expected_iou.is_empty() {
        fit.expected_iou.insert(0, f32::NAN);
    }
    fit.ambiguity = fit.ambiguity.iter().filter_map(|ambiguity| moved(ambiguity, |object| Some(object + 1))).collect();
}

/// The nearer of a fit with ramps and one without; where that is not seen, the one with ramps if it has fewer things.
pub(super) fn better(with: Fit<f32>, without: Fit<f32>) -> Fit<f32> {
    let is_fewer = with.scene.objects.len() < without.scene.objects.len();
    let is_taken = with.loss - without.loss < if is_fewer { AS_NEAR } else { 0.0 };
    if is_taken { with } else { without }
}
