//! Reference numbers: small ones in `golden_data/`, committed; larger ones in a folder beside the repository, if it is there.

use core::error::Error;
use std::path::Path;

use serde::de::DeserializeOwned;

/// The committed JSON file `golden_data/<name>`.
///
/// # Errors
/// The file is not there or has other fields than `T`.
pub fn committed<T: DeserializeOwned>(name: &str) -> Result<T, Box<dyn Error>> {
    read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("golden_data").join(name))
}

/// The JSON file `shared/<path>` beside the repository; none if that folder does not exist, which is said on stderr.
///
/// # Errors
/// The folder is there, but the file is not or has other fields than `T`.
#[track_caller]
pub fn shared<T: DeserializeOwned>(path: &str) -> Result<Option<T>, Box<dyn Error>> {
    crate::fixture::shared().map(|folder| read(&folder.join(path))).transpose()
}

fn read<T: DeserializeOwned>(path: &Path) -> Result<T, Box<dyn Error>> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    serde_json::from_str(&text).map_err(|error| format!("{}: {error}", path.display()).into())
}
