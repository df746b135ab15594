//! Networks, read from a file or built in.

use std::fs;
use std::path::Path;

use dvp_net::propose::{BUILT_IN, Proposer};

use super::error::LoadNetworkError;

/// The network of a file as `dvp train` writes it, or the one that is built in.
///
/// # Errors
/// [`LoadNetworkError`] if the file cannot be read or is no such network.
pub fn load(file: Option<&Path>) -> Result<Proposer, LoadNetworkError> {
    let Some(path) = file else {
        return Proposer::from_bytes(BUILT_IN).map_err(|error| LoadNetworkError::BuiltIn(Box::new(error)));
    };
    let bytes = fs::read(path).map_err(|source| LoadNetworkError::Unreadable { path: path.to_path_buf(), source })?;
    Proposer::from_bytes(&bytes)
        .map_err(|error| LoadNetworkError::File { path: path.to_path_buf(), source: Box::new(error) })
}
