//! Versions 1 and 2, and from there to version 3: objects are descriptors, turned by an angle or a pair, before a background.
//!
//! Version 2 names the law of the edge. Published data sets have no version, which is version 1.

use serde::Deserialize;

use super::super::error::{FormatError, Place};
use super::{CompositingJson, EdgeJson, ObjectJson, SceneJson, ShapeJson, VERSION};

/// A scene of version 1 or 2.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EarlierScene {
    #[serde(default, rename = "version")]
    _version: u64,
    id: Option<u64>,
    width: Option<usize>,
    height: Option<usize>,
    background: [f64; 3],
    objects: Vec<EarlierObject>,
    edge: Option<EdgeJson>,
    #[serde(default)]
    compositing: CompositingJson,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EarlierObject {
    translation: [f64; 2],
    scale: f64,
    /// Radians; this or `rotation_vec`.
    rotation: Option<f64>,
    /// (sine, cosine) of the rotation, of any length but 0; this or `rotation`.
    rotation_vec: Option<[f64; 2]>,
    color: [f64; 3],
    #[serde(default = "one")]
    confidence: f64,
    prototype: Option<usize>,
    /// `prototype` under its name in published data sets.
    shape: Option<usize>,
    symmetry: Option<usize>,
    efd: Option<Vec<[f64; 4]>>,
}

fn one() -> f64 {
    1.0
}

impl EarlierScene {
    /// The same in version 3.
    ///
    /// # Errors
    /// [`FormatError::Field`] if an object is turned in no way or in two, has two prototypes, or no shape.
    pub(super) fn into_scene_json(self, place: &Place) -> Result<SceneJson, FormatError> {
        let Self { _version, id, width, height, background, objects, edge, compositing } = self;
        let objects = objects.into_iter().enumerate().map(|(k, object)| {
            object.into_object_json().map_err(|(name, problem)| FormatError::Field {
                place: place.clone(),
                field: format!("objects[{k}].{name}"),
                problem: problem.to_owned(),
            })
        });
        Ok(SceneJson {
            version: VERSION,
            id,
            width,
            height,
            background: Some(background),
            matte: None,
            objects: objects.collect::<Result<_, _>>()?,
            edge,
            compositing,
            known: None,
        })
    }
}

impl EarlierObject {
    /// The same in version 3, or the field that is wrong, and how.
    fn into_object_json(self) -> Result<ObjectJson, (&'static str, &'static str)> {
        let rotation = match (self.rotation, self.rotation_vec) {
            (Some(angle), None) => angle,
            (None, Some([sine, cosine])) if sine.hypot(cosine) > 0.0 => sine.atan2(cosine),
            (None, Some(_)) => return Err(("rotation_vec", "is [0, 0], which is no direction")),
            _ => return Err(("rotation", "is needed: either `rotation` or `rotation_vec`")),
        };
        let prototype = match (self.prototype, self.shape) {
            (Some(_), Some(_)) => return Err(("shape", "is the old name of `prototype`; keep one")),
            (index, None) | (None, index) => index,
        };
        let symmetry = self.symmetry;
        let shape = match (prototype, self.efd) {
            (Some(prototype), efd) => ShapeJson::Prototype { prototype, efd, symmetry },
            (None, Some(efd)) => ShapeJson::Efd { efd, symmetry },
            (None, None) => return Err(("efd", "is missing, and there is no `prototype` to take it from")),
        };
        let Self { translation, scale, color, confidence, .. } = self;
        Ok(ObjectJson { shape, translation, scale, rotation, color, ramp: None, confidence, known: None })
    }
}
