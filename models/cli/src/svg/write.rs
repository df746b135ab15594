//! The text of an SVG file.

use dvp_core::render::Compositing;
use dvp_core::{ImageSize, Object, Real, Scene};

use super::overlap::{Body, shared_regions};
use super::path::{Curve, short};

/// How far a path may stray from the outline, pixels.
const TOLERANCE_PX: f64 = 0.05;
/// Below it an object is drawn translucent instead of mixed; below its complement not at all.
const SURE: f64 = 0.99;
/// Points per outline when looking for overlaps.
const OVERLAP_VERTICES: u32 = 64;

/// What the text needs of an object.
struct Shape {
    id: String,
    rows: Vec<[f64; 4]>,
    center: [f64; 2],
    scale: f64,
    rotation: f64,
    color: [f64; 3],
    confidence: f64,
}

/// The SVG text of a scene: a background and one path per object, pixels as user units.
#[must_use]
pub fn to_svg<T: Real>(scene: &Scene<T>, size: ImageSize) -> String {
    let unit = T::of_usize(size.unit_px()).as_f64();
    let [width, height] = [size.width(), size.height()].map(|n| T::of_usize(n).as_f64());
    // d2 = offset in the doubled frame is a distance of sqrt(offset)/2 scene units.
    let reach = scene.edge.offset.as_f64().max(0.0).sqrt() / 2.0 * unit;
    let shapes: Vec<Shape> =
        scene.objects.iter().enumerate().map(|(k, object)| Shape::of(k, object, unit)).filter(Shape::is_seen).collect();
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n\
         <rect id=\"background\" width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
        hex(scene.background.map(T::as_f64))
    );
    for shape in &shapes {
        text.push_str(&shape.element(reach));
    }
    if scene.compositing == Compositing::Blend {
        text.push_str(&mixtures(&shapes, reach, [width, height]));
    }
    text.push_str("</svg>\n");
    text
}

impl Shape {
    fn of<T: Real>(k: usize, object: &Object<T>, unit: f64) -> Self {
        Self {
            id: format!("object-{k}"),
            rows: object.efd.rows().iter().map(|row| row.map(T::as_f64)).collect(),
            center: object.pose.translation.map(|v| v.as_f64() * unit),
            scale: object.pose.scale.as_f64() * unit,
            rotation: object.pose.rotation.as_f64(),
            color: object.color.map(T::as_f64),
            confidence: object.confidence.as_f64(),
        }
    }

    fn is_seen(&self) -> bool {
        self.confidence > 1.0 - SURE && self.scale > 0.0 && !self.rows.is_empty()
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
            Curve { rows: &self.rows }.path_data(TOLERANCE_PX / self.scale),
        )
    }

    fn body(&self, reach: f64) -> Body {
        let (sin, cos) = self.rotation.sin_cos();
        let curve = Curve { rows: &self.rows };
        let vertices = (0..OVERLAP_VERTICES).map(|i| {
            let [x, y] = curve.point(f64::from(i) / f64::from(OVERLAP_VERTICES)).map(|v| v * self.scale);
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
