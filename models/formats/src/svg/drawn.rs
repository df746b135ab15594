//! The objects that are seen, each as an element with its colors.

use dvp_core::render::Compositing;
use dvp_core::scene::ColorRamp;
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES, Shape as _, ShapeError};
use dvp_core::{Object, Pose, Real, Scene};
use dvp_fit::Bank;

use super::element::{Element, element_of, needs_rings, polygons};
use super::number::{KNOWN, hex, rounded, short};
use super::overlap::Body;
use super::ramp::definition;

/// Decimals of opacities.
const OPACITY: usize = 3;

/// An object to be written.
pub(super) struct Drawn {
    pub(super) id: String,
    title: String,
    element: Element,
    /// What it covers, under `blend`.
    pub(super) body: Body,
    /// Its color, that of a ramp on the mean.
    pub(super) color: [f64; 3],
    /// What a ramp is defined as, if one paints it.
    ramp: Option<String>,
    /// Rounded, above 0.
    pub(super) confidence: f64,
}

/// The objects of a scene that are seen; `unit` is pixels per scene unit, `numbers` are those in the objects' ids.
///
/// # Errors
/// [`ShapeError`] if the numbers of an object describe no shape.
pub(super) fn drawn<T: Real>(
    scene: &Scene<T>,
    unit: f64,
    bank: Option<&Bank<T>>,
    numbers: &[u32],
) -> Result<Vec<Drawn>, ShapeError> {
    let reach = scene.edge.half_coverage().as_f64().max(0.0) * unit;
    let harmonics = scene.objects.iter().map(|object| object.efd_rows().len()).max().unwrap_or(0);
    let basis = OutlineBasis::new(REFERENCE_VERTICES, harmonics.max(1))?;
    let mut drawn = Vec::new();
    for (object, number) in scene.objects.iter().zip(numbers) {
        let confidence = rounded(object.confidence.as_f64(), OPACITY);
        if confidence <= 0.0 || object.pose.scale == T::zero() {
            continue;
        }
        let known = object.shape.prototype().and_then(|prototype| bank?.prototypes.get(prototype));
        let name = known.map_or(object.shape.kind(), |(name, _)| name);
        let object = in_pixels(object, unit);
        let needs_rings = scene.compositing == Compositing::Blend || needs_rings(&object.shape, reach);
        let rings = if needs_rings { polygons(&object, &basis)? } else { Vec::new() };
        let element = element_of(&object, &rings, reach)?;
        let ramp = object.paint.ramp().map(|ramp| {
            let posed = ColorRamp { kind: ramp.kind.posed(&object.pose), stops: ramp.stops.clone() };
            definition(&format!("ramp-{number}"), &posed, element.turn)
        });
        drawn.push(Drawn {
            id: format!("object-{number}"),
            ramp,
            title: format!("{} {}", name.replace('_', " "), hex(object.color())),
            element,
            color: object.color(),
            confidence,
            body: Body { rings, reach },
        });
    }
    Ok(drawn)
}

/// The object with one pixel as its unit.
fn in_pixels<T: Real>(object: &Object<T>, unit: f64) -> Object<f64> {
    let Pose { translation, scale, rotation } = object.pose;
    Object {
        shape: object.shape.cast(),
        pose: Pose {
            translation: translation.map(|v| v.as_f64() * unit),
            scale: scale.as_f64() * unit,
            rotation: rotation.as_f64(),
        },
        paint: object.paint.cast(),
        confidence: object.confidence.as_f64(),
    }
}

impl Drawn {
    /// Appends the element in its own color.
    pub(super) fn write(&self, text: &mut String) {
        text.extend(self.ramp.as_deref());
        self.write_with(&format!("{}{}", self.colors(&self.paint()), self.opacity()), text);
        text.push('\n');
    }

    /// Appends the element in a group that has the color, so that the element can be drawn again in another one.
    pub(super) fn write_group(&self, text: &mut String) {
        text.extend(self.ramp.as_deref());
        text.extend(["<g", &self.colors(&self.paint()), &self.opacity(), ">"]);
        self.write_with("", text);
        text.push_str("</g>\n");
    }

    /// The element once more, in another color.
    pub(super) fn again(&self, color: &str) -> String {
        format!("<use href=\"#{}\"{}/>", self.id, self.colors(color))
    }

    /// Its color, or the name of its ramp.
    fn paint(&self) -> String {
        match self.ramp {
            Some(_) => format!("url(#{})", self.id.replace("object", "ramp")),
            None => hex(self.color),
        }
    }

    fn write_with(&self, paint: &str, text: &mut String) {
        let Element { tag, geometry, .. } = &self.element;
        text.extend(["<", tag, " id=\"", &self.id, "\"", geometry]);
        if self.is_fattened() {
            let width = short(2.0 * self.body.reach, KNOWN);
            text.extend([" stroke-width=\"", &width, "\" stroke-linejoin=\"round\""]);
        }
        text.extend([paint, "><title>", &escaped(&self.title), "</title></", tag, ">"]);
    }

    /// Whether a pen along its outline fattens it; strokes are wider instead.
    fn is_fattened(&self) -> bool {
        self.body.reach > 0.0 && !self.element.is_stroke
    }

    fn colors(&self, color: &str) -> String {
        let fill = if self.element.is_stroke { String::new() } else { format!(" fill=\"{color}\"") };
        let has_pen = self.element.is_stroke || self.is_fattened();
        let stroke = if has_pen { format!(" stroke=\"{color}\"") } else { String::new() };
        fill + &stroke
    }

    fn opacity(&self) -> String {
        if self.confidence < 1.0 { format!(" opacity=\"{}\"", short(self.confidence, OPACITY)) } else { String::new() }
    }
}

/// Text as XML has it, which allows hardly any control characters.
fn escaped(text: &str) -> String {
    let text: String = text.chars().filter(|c| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}')).collect();
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
