//! Which class every object of a data set has: `classes.json`.

use alloc::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::format::{FormatError, Place, read_text};

/// The file of a data set that holds the classes of its objects.
pub const CLASSES_FILE: &str = "classes.json";

/// The classes of the objects of a data set.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Classes {
    /// Of the layout of this file: 1.
    version: u64,
    /// By the stem of the picture, the class of object 1, 2, ...
    pub objects: BTreeMap<String, Vec<u32>>,
}

impl Classes {
    /// The classes of pictures by their stems.
    #[must_use]
    pub fn new(objects: BTreeMap<String, Vec<u32>>) -> Self {
        Self { version: 1, objects }
    }

    /// Those of a data set; none if its folder holds no such file.
    ///
    /// # Errors
    /// [`FormatError`] if the file cannot be read or is something else.
    pub fn read(folder: &Path) -> Result<Option<Self>, FormatError> {
        let path = folder.join(CLASSES_FILE);
        if !path.is_file() {
            return Ok(None);
        }
        let place = Place::file(&path);
        let refused = |source| FormatError::Json { place: place.clone(), expected: "classes of objects", source };
        let classes: Self = serde_json::from_slice(&read_text(&path)?).map_err(refused)?;
        if classes.version != 1 {
            return Err(FormatError::Version { place, version: classes.version });
        }
        Ok(Some(classes))
    }

    /// The text of the file.
    ///
    /// # Errors
    /// Of the encoder; none is known.
    pub fn to_json(&self) -> serde_json::Result<String> {
        Ok(serde_json::to_string(self)? + "\n")
    }
}
