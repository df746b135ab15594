//! The text of an SVG file.

use dvp_core::render::{Compositing, EdgeLaw, EdgeProfile};
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES, ShapeError};
use dvp_core::{ImageSize, Object, Real, Scene};

use super::overlap::{Body, shared_regions};
use super::path::{path_data, short};

/// How far a path may stray from the outline, pixels.
const TOLERANCE_PX: f64 = 0.2;
/// Below it an object is drawn translucent instead of mixed; below its complement not at all.
const SURE: f64 = 0.99;

/// Standard deviation of the Gaussian nearest to a logistic, over its sigma.
const GAUSSIAN: f64 = 1.702;
/// Variance of the blur (px^2) that anti-aliasing by area is.
const AREA_VARIANCE: f64 = 1.0 / 12.0;
/// Less blur than this (px) is left to anti-aliasing.
const LEAST_BLUR_PX: f64 = 0.3;

/// What the text needs of an object.
struct Shape {
    id: String,
    /// The unit outline, as renderers paint it.
    outline: Vec<[f64; 2]>,
    center: [f64; 2],
    scale: f64,
    rotation: f64,
    color: [f64; 3],
    confidence: f64,
}

/// The SVG text of a scene: a background and one path per object, pixels as user units.
///
/// # Errors
/// None for scenes that came from files or fits; [`ShapeError`] is handed on.
pub fn to_svg<T: Real>(scene: &Scene<T>, size: ImageSize) -> Result<String, ShapeError> {
    let unit = T::of_usize(size.unit_px()).as_f64();
    let [width, height] = [size.width(), size.height()].map(|n| T::of_usize(n).as_f64());
    let reach = scene.edge.half_coverage().as_f64().max(0.0) * unit;
    let basis = OutlineBasis::new(REFERENCE_VERTICES, scene.harmonic_count().max(1))?;
    let mut shapes = Vec::new();
    for (k, object) in scene.objects.iter().enumerate() {
        shapes.push(Shape::of(k, object, unit, &basis)?);
    }
    shapes.retain(Shape::is_seen);
    let background = hex(scene.background.map(T::as_f64));
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n\
         <rect id=\"background\" width=\"{width}\" height=\"{height}\" fill=\"{background}\"/>\n"
    );
    let deviation = blur_px(&scene.edge, unit);
    if let Some(deviation) = deviation {
        text.push_str(&blurring(deviation, [width, height], &background));
    }
    for shape in &shapes {
        text.push_str(&shape.element(reach));
    }
    if scene.compositing == Compositing::Blend {
        text.push_str(&mixtures(&shapes, reach, [width, height]));
    }
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

/// The start of a blurred group. The background is in it once more, beyond the border, so that nothing fades out there.
fn blurring(deviation: f64, [width, height]: [f64; 2], background: &str) -> String {
    let margin = (3.0 * deviation).ceil();
    let place = format!(
        "x=\"-{margin}\" y=\"-{margin}\" width=\"{}\" height=\"{}\"",
        width + 2.0 * margin,
        height + 2.0 * margin
    );
    format!(
        "<filter id=\"blur\" filterUnits=\"userSpaceOnUse\" {place} color-interpolation-filters=\"sRGB\">\
         <feGaussianBlur stdDeviation=\"{}\"/></filter>\n\
         <g filter=\"url(#blur)\">\n<rect {place} fill=\"{background}\"/>\n",
        short(deviation, 3.0)
    )
}

impl Shape {
    fn of<T: Real>(k: usize, object: &Object<T>, unit: f64, basis: &OutlineBasis<T>) -> Result<Self, ShapeError> {
        let mut outline = vec![[T::zero(); 2]; basis.vertex_count()];
        basis.outline(object.shape.descriptors()?.rows(), &mut outline)?;
        Ok(Self {
            id: format!("object-{k}"),
            outline: outline.into_iter().map(|vertex| vertex.map(T::as_f64)).collect(),
            center: object.pose.translation.map(|v| v.as_f64() * unit),
            scale: object.pose.scale.as_f64() * unit,
            rotation: object.pose.rotation.as_f64(),
            color: object.color().map(T::as_f64),
            confidence: object.confidence.as_f64(),
        })
    }

    fn is_seen(&self) -> bool {
        self.confidence > 1.0 - SURE && self.scale > 0.0
    }

    /// The color stands on the group, so that `<use>` can draw the path in another one.
    fn element(&self, reach: f64) -> String {
        let color = hex(self.color);
        let stroke = if reach > 0.0 {
            let wide = short(2.0 * reach / self.scale, 5.0);
            format!(" stroke-width=\"{wide}\" stroke-linejoin=\"round\"")
        } else {
            " stroke=\"none\"".to_owned()
        };
        let opacity = if self.confidence < SURE {
            format!(" opacity=\"{}\"", short(self.confidence, 3.0))
        } else {
            String::new()
        };
        format!(
            "<g fill=\"{color}\" stroke=\"{color}\"{opacity}><path id=\"{}\" transform=\"translate({} {}) rotate({}) scale({})\" \
             fill-rule=\"evenodd\"{stroke} d=\"{}\"/></g>\n",
            self.id,
            short(self.center[0], 3.0),
            short(self.center[1], 3.0),
            short(self.rotation.to_degrees(), 3.0),
            short(self.scale, 3.0),
            path_data(&self.outline, TOLERANCE_PX / self.scale),
        )
    }

    fn body(&self, reach: f64) -> Body {
        let (sin, cos) = self.rotation.sin_cos();
        let vertices = self.outline.iter().map(|vertex| {
            let [x, y] = vertex.map(|v| v * self.scale);
            [self.center[0] + cos * x - sin * y, self.center[1] + sin * x + cos * y]
        });
        Body { vertices: vertices.collect(), reach }
    }
}

/// The common parts of sure objects, larger sets later, in the mean of their colors.
fn mixtures(shapes: &[Shape], reach: f64, size: [f64; 2]) -> String {
    let sure: Vec<&Shape> = shapes.iter().filter(|shape| shape.confidence >= SURE).collect();
    let bodies: Vec<Body> = sure.iter().map(|shape| shape.body(reach)).collect();
    let regions = shared_regions(&bodies, size[0], size[1]);
    let mut text = String::new();
    // The last of a set is drawn, the others mask it.
    let mut masking: Vec<usize> = regions.iter().flat_map(|set| &set[..set.len() - 1]).copied().collect();
    masking.sort_unstable();
    masking.dedup();
    for k in masking {
        let id = &sure[k].id;
        text.push_str(&format!(
            "<mask id=\"in-{id}\" maskUnits=\"userSpaceOnUse\" x=\"0\" y=\"0\" width=\"{}\" height=\"{}\">\
             <use href=\"#{id}\" fill=\"#fff\" stroke=\"#fff\"/></mask>\n",
            size[0], size[1]
        ));
    }
    for set in &regions {
        let mut count = 0.0;
        let mut mean = [0.0; 3];
        for &k in set {
            count += 1.0;
            for (mean, color) in mean.iter_mut().zip(sure[k].color) {
                *mean += (color - *mean) / count;
            }
        }
        let (last, masks) = (&sure[set[set.len() - 1]].id, &set[..set.len() - 1]);
        let color = hex(mean);
        text.extend(masks.iter().map(|&k| format!("<g mask=\"url(#in-{})\">", sure[k].id)));
        text.push_str(&format!("<use href=\"#{last}\" fill=\"{color}\" stroke=\"{color}\"/>"));
        text.push_str(&"</g>".repeat(masks.len()));
        text.push('\n');
    }
    text
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [0, 255] before")]
fn hex(color: [f64; 3]) -> String {
    let [r, g, b] = color.map(|v| (v.clamp(0.0, 1.0) * 255.0).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}
