//! Pictures of cameras: noise that grows with the light, and light that is uneven, taken out before and put back.

#[cfg(test)]
mod tests;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::render::{Compositing, EdgeLaw};
use dvp_core::scene::{ColorRamp, ColorStop, RampKind};
use dvp_core::{Drawing, ImageView, Paint, Real as _};
use dvp_trace::noise::{self, Evened};
use dvp_trace::ramps::Light;

use super::likelier::is_of_renderer;
use super::ramps::{AS_NEAR, better, put_under};
use super::{PictureScratch, of_painted};
use crate::paint::Canvas;
use crate::tuning::UNEXPLAINED_SHARE;
use crate::{Fit, FitError};

/// The fit of a picture with even noise as one of the picture before: its loss is of that, and poses are as uncertain as the noise between the colors
/// on both sides of their edges makes them.
#[inline(never)]
pub(super) fn with_noise(
    fit: Fit<f32>,
    evened: &Evened,
    image: ImageView<'_, f32>,
    canvas: &mut Canvas<f32>,
) -> Result<Fit<f32>, FitError> {
    let (painted, drawing) = canvas.paint(&fit.scene, image.size())?;
    let Fit { loss, .. } = of_painted(&fit.scene, &drawing, painted, image)?;
    let mut fit = Fit { loss, ..fit };
    for (object, covariance) in fit.scene.objects.iter().zip(&mut fit.covariance) {
        let channels = object.color().into_iter().zip(fit.scene.background);
        let variance = channels.map(|(a, b)| evened.law.variance(f64::from(0.5 * (a + b)))).sum::<f64>() / 3.0;
        let times = f32::of(variance / (evened.level * evened.level));
        covariance.iter_mut().for_each(|value| *value *= times);
    }
    Ok(fit)
}

/// A fit, or that of the picture in even light (`read`) if its light is uneven and that is better.
#[inline(never)]
pub(super) fn or_in_light(
    fit: Fit<f32>,
    image: ImageView<'_, f32>,
    scratch: &mut PictureScratch,
    read: impl FnOnce(ImageView<'_, f32>, &mut PictureScratch) -> Result<Fit<f32>, FitError>,
) -> Result<Fit<f32>, FitError> {
    // What was read as it is has none: drawings, and what the paper's renderer has painted.
    let is_clean = fit.noise <= f32::of(noise::ROUNDED);
    let is_drawing = is_clean && fit.scene.edge.law == EdgeLaw::Area;
    let is_near = if is_clean { fit.loss <= AS_NEAR } else { fit.unexplained <= UNEXPLAINED_SHARE };
    let is_read = is_near && (is_drawing || is_of_renderer(&fit));
    let light = if is_read { None } else { Light::of(&image, f64::from(fit.noise)) };
    let Some(light) = light else { return Ok(fit) };
    let lit = read(light.image.view(), scratch)?;
    Ok(better(with_light(lit, &light, image, &mut scratch.canvas)?, fit))
}

/// The fit of a picture in even light, painted in the light of the picture.
#[inline(never)]
fn with_light(
    mut fit: Fit<f32>,
    light: &Light,
    image: ImageView<'_, f32>,
    canvas: &mut Canvas<f32>,
) -> Result<Fit<f32>, FitError> {
    let size = image.size();
    let (_, drawing) = canvas.paint(&fit.scene, size)?;
    let least = AS_NEAR.max(fit.noise);
    for (k, object) in fit.scene.objects.iter_mut().enumerate() {
        let Some(inverse) = object.pose.inverse() else { continue };
        let Some(ramp) = seen(light, object.color(), outline(&drawing, k), f64::of_usize(size.unit_px())) else {
            continue;
        };
        let [low, high] = [0, 1].map(|k| ramp.stops[k].color);
        // A thing has no more colors than can be told.
        object.paint = if low.iter().zip(high).any(|(low, high)| (low - high).abs() > least) {
            Paint::Ramp(ColorRamp { kind: ramp.kind.posed(&inverse), ..ramp })
        } else {
            Paint::Flat(core::array::from_fn(|c| 0.5 * (low[c] + high[c])))
        };
    }
    if !fit.scene.transparent {
        // What is blended would be with the background too.
        fit.scene.compositing = Compositing::Over;
        put_under(&mut fit, size);
        let sheet = &mut fit.scene.objects[0];
        if let Some(inverse) = sheet.pose.inverse() {
            sheet.paint =
                Paint::Ramp(ColorRamp { kind: light.ramp.kind.posed(&inverse), stops: light.ramp.stops.clone() });
        }
    }
    let (painted, drawing) = canvas.paint(&fit.scene, size)?;
    let painted = of_painted(&fit.scene, &drawing, painted, image)?;
    let Fit { bits, stop, steps, noise, covariance, expected_iou, ambiguity, .. } = fit;
    Ok(Fit { bits, stop, steps, noise, covariance, expected_iou, ambiguity, ..painted })
}

/// The vertices of an object.
fn outline(drawing: &Drawing<f32>, object: usize) -> &[[f32; 2]] {
    &drawing.vertices[drawing.starts[object]..drawing.starts[object + 1]]
}

/// What is seen of something of one color in even light: a ramp between its ends along the way in which light grows in its middle; none of nothing.
#[inline(never)]
fn seen(light: &Light, color: [f32; 3], outline: &[[f32; 2]], unit: f64) -> Option<ColorRamp<f32>> {
    let ends = |c: usize| {
        let values = outline.iter().map(|vertex| f64::from(vertex[c]));
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
    };
    let [x, y] = [ends(0), ends(1)];
    let middle = [0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1])];
    let slope = light.slope(middle.map(|value| unit * value));
    let length = slope[0].hypot(slope[1]);
    let way = if length > 0.0 { slope.map(|value| value / length) } else { [1.0, 0.0] };
    let along = |vertex: &[f32; 2]| (0..2).map(|c| way[c] * (f64::from(vertex[c]) - middle[c])).sum::<f64>();
    let (low, high) = outline
        .iter()
        .map(along)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    let points = [low, high].map(|by| [0, 1].map(|c| middle[c] + by * way[c]));
    if !points.as_flattened().iter().all(|value| value.is_finite()) {
        return None;
    }
    let stop = |offset: f32, point: [f64; 2]| ColorStop {
        offset,
        color: light
            .seen(color.map(f64::from), point.map(|value| unit * value))
            .map(|value| f32::of(value.clamp(0.0, 1.0))),
    };
    let stops = [stop(0.0, points[0]), stop(1.0, points[1])].into();
    Some(ColorRamp { kind: RampKind::Linear(points.map(|point| point.map(f32::of))), stops })
}
