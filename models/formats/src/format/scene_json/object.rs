//! An object as it stands in a file: the numbers of its shape beside its own.

use core::fmt;

use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::{Map, Value};

use super::known::ObjectKnownJson;
use super::ramp::RampJson;
use super::shape::ShapeJson;
use super::strict::present;

/// An object as it stands in a file. What moves, turns or changes nothing is left out.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ObjectJson {
    /// What it encloses: `kind` and the numbers of that kind, beside the fields here.
    #[serde(flatten)]
    pub shape: ShapeJson,
    /// Where the origin of the shape stands, scene units (the shorter image side is 1, the upper left corner 0), y down.
    #[serde(skip_serializing_if = "is_no_translation")]
    pub translation: [f64; 2],
    /// Scene units per unit of the shape; above 0.
    #[serde(skip_serializing_if = "is_one")]
    pub scale: f64,
    /// Radians, from +x to +y.
    #[serde(skip_serializing_if = "is_zero")]
    pub rotation: f64,
    /// RGB, [0, 1]; beside a ramp the mean of its stops, for readers that want one color.
    pub color: [f64; 3],
    /// What paints instead of the one color.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ramp: Option<RampJson>,
    /// Probability of being there, and opacity; [0, 1].
    #[serde(skip_serializing_if = "is_one")]
    pub confidence: f64,
    /// What the fit that found the object knows of its numbers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub known: Option<ObjectKnownJson>,
}

/// The fields of [`ObjectJson`] that every kind has.
#[derive(Deserialize)]
struct Placed {
    #[serde(default)]
    translation: [f64; 2],
    #[serde(default = "one")]
    scale: f64,
    #[serde(default)]
    rotation: f64,
    color: [f64; 3],
    #[serde(default, deserialize_with = "present")]
    ramp: Option<RampJson>,
    #[serde(default = "one")]
    confidence: f64,
    #[serde(default, deserialize_with = "present")]
    known: Option<ObjectKnownJson>,
}

/// The names of the fields of [`Placed`].
const PLACED: [&str; 7] = ["translation", "scale", "rotation", "color", "ramp", "confidence", "known"];

impl<'de> Deserialize<'de> for ObjectJson {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(Fields)
    }
}

/// Reads the fields of an object and deals them out: serde cannot refuse unknown fields of flattened structures.
struct Fields;

impl<'de> Visitor<'de> for Fields {
    type Value = ObjectJson;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<ObjectJson, A::Error> {
        let (mut placed, mut shape) = (Map::new(), Map::new());
        while let Some(name) = map.next_key::<String>()? {
            let fields = if PLACED.contains(&name.as_str()) { &mut placed } else { &mut shape };
            if fields.contains_key(&name) {
                return Err(A::Error::custom(format_args!("duplicate field `{name}`")));
            }
            fields.insert(name, map.next_value()?);
        }
        let shape = ShapeJson::deserialize(Value::Object(shape)).map_err(A::Error::custom)?;
        let placed = Placed::deserialize(Value::Object(placed)).map_err(A::Error::custom)?;
        let Placed { translation, scale, rotation, color, ramp, confidence, known } = placed;
        Ok(ObjectJson { shape, translation, scale, rotation, color, ramp, confidence, known })
    }
}

fn one() -> f64 {
    1.0
}

/// 0, but not -0, which would come back as 0.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
pub(super) fn is_zero(value: &f64) -> bool {
    value.to_bits() == 0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_one(value: &f64) -> bool {
    value.to_bits() == 1.0_f64.to_bits()
}

fn is_no_translation(translation: &[f64; 2]) -> bool {
    translation.iter().all(is_zero)
}
