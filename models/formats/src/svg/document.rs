//! The text of an SVG file.

use alloc::collections::BTreeSet;

use dvp_core::render::{Compositing, EdgeLaw, EdgeProfile};
use dvp_core::shape::ShapeError;
use dvp_core::{ImageSize, Real, Scene};
use dvp_fit::Bank;

use super::drawn::{Drawn, drawn};
use super::mixture::{Mixture, Mixtures, mixtures};
use super::number::{KNOWN, hex, short};

/// Standard deviation of the Gaussian nearest to a logistic, over its sigma.
const GAUSSIAN: f64 = 1.702;
/// Variance of the blur (px^2) that anti-aliasing by area is.
const AREA_VARIANCE: f64 = 1.0 / 12.0;
/// Less blur than this (px) is left to anti-aliasing.
const LEAST_BLUR_PX: f64 = 0.3;

/// The SVG text of a scene, its user units pixels: one element per object, and a background unless the scene is
/// transparent. Prototypes are titled with their names in `bank`. The ids of the objects are `object-1`, `object-2` and so on,
/// those that are not seen counted too, as tables and label maps number them.
///
/// # Errors
/// [`ShapeError`] if the numbers of an object describe no shape.
pub fn to_svg<T: Real>(scene: &Scene<T>, size: ImageSize, bank: Option<&Bank<T>>) -> Result<String, ShapeError> {
    let numbers: Vec<u32> = (1..).take(scene.objects.len()).collect();
    to_svg_numbered(scene, size, bank, &numbers)
}

/// As [`to_svg`], with the numbers that objects go by elsewhere, such as the labels of a mask: one for each object of the scene,
/// all different. An object with the number 7 has the id `object-7`.
///
/// # Errors
/// [`ShapeError::Length`] unless there are as many numbers as objects; any [`ShapeError`] if the numbers of an object describe no
/// shape.
pub fn to_svg_numbered<T: Real>(
    scene: &Scene<T>,
    size: ImageSize,
    bank: Option<&Bank<T>>,
    numbers: &[u32],
) -> Result<String, ShapeError> {
    let (expected, len) = (scene.objects.len(), numbers.len());
    if expected != len {
        return Err(ShapeError::Length { what: "numbers of objects", expected, len });
    }
    let unit = f64::of_usize(size.unit_px());
    let extent = [size.width(), size.height()].map(f64::of_usize);
    let [width, height] = extent;
    let drawn = drawn(scene, unit, bank, numbers)?;
    let mixtures = match scene.compositing {
        Compositing::Blend => mixtures(scene, &drawn, extent),
        Compositing::Over => Mixtures::default(),
    };
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n"
    );
    let background = (!scene.transparent).then(|| hex(scene.background.map(T::as_f64)));
    if let Some(color) = &background {
        text.push_str(&format!("<rect id=\"background\" width=\"{width}\" height=\"{height}\" fill=\"{color}\"/>\n"));
    }
    let deviation = blur_px(&scene.edge, unit);
    if let Some(deviation) = deviation {
        text.push_str(&blurring(deviation, extent, background.as_deref()));
    }
    if let Some(remark) = &mixtures.remark {
        text.extend(["<!-- ", remark, " -->\n"]);
    }
    let mixed: BTreeSet<usize> = mixtures.parts.iter().flat_map(|mixture| &mixture.objects).copied().collect();
    for (k, object) in drawn.iter().enumerate() {
        if mixed.contains(&k) { object.write_group(&mut text) } else { object.write(&mut text) }
    }
    mix(&drawn, &mixtures.parts, extent, &mut text);
    if deviation.is_some() {
        text.push_str("</g>\n");
    }
    text.push_str("</svg>\n");
    Ok(text)
}

/// Standard deviation (px) of the Gaussian that makes edges as soft as the profile's, beyond the viewer's anti-aliasing; none
/// if that is about soft enough.
fn blur_px<T: Real>(edge: &EdgeProfile<T>, unit: f64) -> Option<f64> {
    if edge.law != EdgeLaw::Distance {
        return None;
    }
    let total = GAUSSIAN / edge.in_pixels(T::of(unit)).sharpness.as_f64();
    let variance = total * total - AREA_VARIANCE;
    (variance > LEAST_BLUR_PX * LEAST_BLUR_PX).then(|| variance.sqrt())
}

/// The start of a blurred group. A background is in it once more, beyond the border, so that nothing fades out there.
fn blurring(deviation: f64, [width, height]: [f64; 2], background: Option<&str>) -> String {
    let margin = (3.0 * deviation).ceil();
    let place = format!(
        "x=\"-{margin}\" y=\"-{margin}\" width=\"{}\" height=\"{}\"",
        width + 2.0 * margin,
        height + 2.0 * margin
    );
    let background = background.map(|color| format!("<rect {place} fill=\"{color}\"/>\n"));
    format!(
        "<filter id=\"blur\" filterUnits=\"userSpaceOnUse\" {place} color-interpolation-filters=\"sRGB\">\
         <feGaussianBlur stdDeviation=\"{}\"/></filter>\n\
         <g filter=\"url(#blur)\">\n{}",
        short(deviation, KNOWN),
        background.unwrap_or_default()
    )
}

/// Draws what objects have in common once more, in the colors of the mixtures: the last object of each, masked by the others.
fn mix(drawn: &[Drawn], mixtures: &[Mixture], [width, height]: [f64; 2], text: &mut String) {
    let mut masking: Vec<usize> = mixtures.iter().flat_map(|mixture| mixture.others()).copied().collect();
    masking.sort_unstable();
    masking.dedup();
    for k in masking {
        let id = &drawn[k].id;
        text.push_str(&format!(
            "<mask id=\"in-{id}\" maskUnits=\"userSpaceOnUse\" x=\"0\" y=\"0\" width=\"{width}\" height=\"{height}\">\
             {}</mask>\n",
            drawn[k].again("#fff")
        ));
    }
    for mixture in mixtures {
        let masks = mixture.others();
        text.extend(masks.iter().map(|&k| format!("<g mask=\"url(#in-{})\">", drawn[k].id)));
        text.push_str(&drawn[mixture.last()].again(&hex(mixture.color)));
        text.push_str(&"</g>".repeat(masks.len()));
        text.push('\n');
    }
}
