//! The text of a scene: one JSON object, version 3, unknown fields refused; versions 1 and 2 are read as well.
//!
//! | file | what it holds |
//! |---|---|
//! | `object` | [`ObjectJson`]: a shape, where it stands, its color |
//! | `ramp` | [`RampJson`]: colors that change from place to place |
//! | `shape` | [`ShapeJson`]: the kinds of shapes and their numbers |
//! | `edge` | [`EdgeJson`], [`CompositingJson`] |
//! | `known` | [`SceneKnownJson`], [`ObjectKnownJson`]: what a fit knows of the numbers |
//! | `earlier` | the structure of versions 1 and 2, and from there to version 3 |
//! | `strict` | what serde would take and the schema does not |
//! | `check`, `check_shape`, `check_ramp`, `check_known` | from the structure to a scene with every number checked |
//! | `write` | from a scene to the structure |
//!
//! `models/cli/schema/scene-3.schema.json` says the same as these structures; `tests/property/scene_json.rs` holds the two together.

mod check;
mod check_known;
mod check_ramp;
mod check_shape;
mod earlier;
mod edge;
mod known;
mod object;
mod ramp;
mod shape;
mod strict;
#[cfg(test)]
mod tests;
mod write;

use std::fs::File;
use std::io::Read;
use std::path::Path;

use serde::{Deserialize, Serialize};

use self::earlier::EarlierScene;
use self::strict::{maps_only, present};
use super::error::{FormatError, Place};

pub(super) use check::checked_efd;
pub use edge::{CompositingJson, EdgeJson, EdgeLawJson, edge_cut};
pub use known::{CompletionJson, DeviationsJson, DoubtJson, INVISIBLE, ObjectKnownJson, SceneKnownJson, StopJson};
pub use object::ObjectJson;
pub use ramp::{ColorStopJson, RampJson, RampKindJson};
pub use shape::{CapJson, FillJson, JoinJson, RingJson, SegmentJson, ShapeJson};

/// Longest scene file or line that is read, bytes.
pub const MAX_TEXT: u64 = 64 << 20;
/// The version that is written.
const VERSION: u64 = 3;

/// A scene as it stands in a file. [`SceneJson::to_scene`] checks it.
///
/// `width` and `height` may be missing in data sets: the size of the image beside it. `edge` may be missing: the reference
/// renderer's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields)]
#[non_exhaustive]
pub struct SceneJson {
    /// Of the format: 3, whatever the version of the text was.
    pub version: u64,
    /// Number in a data set; its image is `{id:05}.png`.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub id: Option<u64>,
    /// Columns of the image.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub width: Option<usize>,
    /// Rows of the image.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub height: Option<usize>,
    /// RGB, [0, 1]; `null` where there is nothing behind the objects.
    #[serde(deserialize_with = "Option::deserialize")]
    pub background: Option<[f64; 3]>,
    /// Of a transparent scene, what it is shown on where an image has no alpha: RGB, [0, 1]; white if missing.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub matte: Option<[f64; 3]>,
    /// The objects; under `over` later ones hide earlier ones.
    pub objects: Vec<ObjectJson>,
    /// How coverage falls off at an outline.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub edge: Option<EdgeJson>,
    /// How overlapping objects mix.
    #[serde(default)]
    pub compositing: CompositingJson,
    /// What the fit that found the scene knows of it as a whole.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub known: Option<SceneKnownJson>,
}

maps_only!(SceneJson);

/// The version of a text, whatever else it holds.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Self")]
struct VersionOnly {
    #[serde(default = "version_one")]
    version: u64,
}

maps_only!(VersionOnly);

fn version_one() -> u64 {
    1
}

impl SceneJson {
    /// Reads one JSON text of any version; the numbers are not yet checked.
    ///
    /// # Errors
    /// [`FormatError::Json`] for a text that is no scene, [`FormatError::Version`] for a later format,
    /// [`FormatError::Field`] for a text of version 1 or 2 with fields that do not go together.
    pub fn parse(text: &[u8], place: &Place) -> Result<Self, FormatError> {
        let refused = |source| FormatError::Json { place: place.clone(), expected: "a scene", source };
        // First: texts of another version have other fields.
        match serde_json::from_slice::<VersionOnly>(text).map_err(refused)?.version {
            1 | 2 => serde_json::from_slice::<EarlierScene>(text).map_err(refused)?.into_scene_json(place),
            VERSION => serde_json::from_slice(text).map_err(refused),
            version => Err(FormatError::Version { place: place.clone(), version }),
        }
    }

    /// The text of one line, without the line end.
    ///
    /// # Errors
    /// [`FormatError::Json`] if a number is not finite.
    pub fn to_line(&self, place: &Place) -> Result<String, FormatError> {
        let refused = |source| FormatError::Json { place: place.clone(), expected: "a scene", source };
        let line = serde_json::to_string(self).map_err(refused)?;
        // A number that is not finite is written as null, which no reader takes for a number.
        serde_json::from_str::<Self>(&line).map_err(refused)?;
        Ok(line)
    }
}

/// Reads a scene file; the numbers are not yet checked.
///
/// # Errors
/// [`FormatError`] if the file cannot be read, is too long or is no scene.
pub fn read_scene(path: &Path) -> Result<SceneJson, FormatError> {
    let text = read_text(path)?;
    SceneJson::parse(&text, &Place::file(path))
}

/// A whole file of at most 64 MiB.
///
/// # Errors
/// [`FormatError::Read`], [`FormatError::TooLong`].
pub fn read_text(path: &Path) -> Result<Vec<u8>, FormatError> {
    let refused = |source| FormatError::Read { path: path.to_path_buf(), source };
    let mut text = Vec::new();
    File::open(path).map_err(refused)?.take(MAX_TEXT + 1).read_to_end(&mut text).map_err(refused)?;
    if text.len() as u64 > MAX_TEXT {
        return Err(FormatError::TooLong { place: Place::file(path), limit: MAX_TEXT });
    }
    Ok(text)
}
