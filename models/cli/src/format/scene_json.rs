//! The text of a scene: one JSON object, version 1 or 2, unknown fields refused.
//!
//! Version 2 names the law of the edge; scenes in the law of version 1 are still written as version 1.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::error::{FormatError, Place};

/// Longest scene file or line that is read, bytes.
pub(super) const MAX_TEXT: u64 = 64 << 20;

/// A scene as it stands in a file. `SceneJson::to_scene` checks it.
///
/// In data sets `version`, `width`, `height`, `edge` and `compositing` may be missing: version 1, the size of the image
/// beside it, the reference renderer's edge, `blend`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneJson {
    /// Of the format; 1, or 2 where the edge names its law.
    #[serde(default = "version_one")]
    pub version: u64,
    /// Number in a data set; its image is `{id:05}.png`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<u64>,
    /// Columns of the image.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width: Option<usize>,
    /// Rows of the image.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<usize>,
    /// RGB, [0, 1].
    pub background: [f64; 3],
    /// The objects; under `over` later ones hide earlier ones.
    pub objects: Vec<ObjectJson>,
    /// How coverage falls off at an outline.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub edge: Option<EdgeJson>,
    /// How overlapping objects mix.
    #[serde(default)]
    pub compositing: CompositingJson,
}

/// An object as it stands in a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObjectJson {
    /// Center, scene units (the shorter image side is 1), y down.
    pub translation: [f64; 2],
    /// Scene units per unit of the outline; above 0.
    pub scale: f64,
    /// Radians; this or `rotation_vec`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<f64>,
    /// (sine, cosine) of the rotation, of any length but 0; this or `rotation`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation_vec: Option<[f64; 2]>,
    /// RGB, [0, 1].
    pub color: [f64; 3],
    /// Probability of being there, and opacity; [0, 1].
    #[serde(default = "one")]
    pub confidence: f64,
    /// Index into the bank.
    #[serde(default)]
    pub prototype: Option<usize>,
    /// The same under its name in published data sets.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<usize>,
    /// The angle is known modulo 2 pi / symmetry; 0 for a disk. Follows from the shape: written, not read back.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub symmetry: Option<usize>,
    /// Rows (a, b, c, d) of the elliptic Fourier descriptors, n from 1; may be missing where `prototype` names them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub efd: Option<Vec<[f64; 4]>>,
}

/// An edge profile as it stands in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EdgeJson {
    /// What coverage is measured by.
    #[serde(default, skip_serializing_if = "EdgeLawJson::is_squared_distance")]
    pub law: EdgeLawJson,
    /// Where coverage is 1/2: signed squared distance or signed distance, doubled frame (the shorter image side is 2).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset: Option<f64>,
    /// Softness, in the same unit; above 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sigma: Option<f64>,
    /// Beyond it coverage is 0, in the same unit; if missing `offset + 4.21 sigma`, or `offset + 6.91 sigma` in distance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cut: Option<f64>,
}

/// What coverage at an edge is measured by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EdgeLawJson {
    /// Signed squared distance, the reference renderer's; version 1 knows no other.
    #[default]
    SquaredDistance,
    /// Signed distance: blur.
    Distance,
    /// The pixel's area inside the outline; there are no numbers.
    Area,
}

impl EdgeLawJson {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
    fn is_squared_distance(&self) -> bool {
        *self == Self::SquaredDistance
    }
}

/// `blend` or `over`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CompositingJson {
    /// The paper's confidence-weighted mean.
    #[default]
    Blend,
    /// Painter's order.
    Over,
}

fn version_one() -> u64 {
    1
}

fn one() -> f64 {
    1.0
}

impl SceneJson {
    /// Reads one JSON text; the numbers are not yet checked.
    ///
    /// # Errors
    /// [`FormatError::Json`] for a text that is no scene, [`FormatError::Version`] for a later format.
    pub fn parse(text: &[u8], place: &Place) -> Result<Self, FormatError> {
        #[derive(Deserialize)]
        struct VersionOnly {
            version: u64,
        }
        let parsed: Result<Self, _> = serde_json::from_slice(text);
        // A later version may have fields that are unknown here: then the version is the news, not the field.
        let version = match &parsed {
            Ok(scene) => scene.version,
            Err(_) => serde_json::from_slice::<VersionOnly>(text).map_or(1, |v| v.version),
        };
        if !(1..=2).contains(&version) {
            return Err(FormatError::Version { place: place.clone(), version });
        }
        parsed.map_err(|source| FormatError::Json { place: place.clone(), expected: "a scene", source })
    }

    /// The text of one line, without the line end.
    ///
    /// # Errors
    /// [`FormatError::Json`] if a number is not finite.
    pub fn to_line(&self, place: &Place) -> Result<String, FormatError> {
        serde_json::to_string(self).map_err(|source| FormatError::Json {
            place: place.clone(),
            expected: "a scene",
            source,
        })
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

/// A whole file of at most [`MAX_TEXT`] bytes.
pub(crate) fn read_text(path: &Path) -> Result<Vec<u8>, FormatError> {
    let refused = |source| FormatError::Read { path: path.to_path_buf(), source };
    let mut text = Vec::new();
    File::open(path).map_err(refused)?.take(MAX_TEXT + 1).read_to_end(&mut text).map_err(refused)?;
    if text.len() as u64 > MAX_TEXT {
        return Err(FormatError::TooLong { place: Place::file(path), limit: MAX_TEXT });
    }
    Ok(text)
}
