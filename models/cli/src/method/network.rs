//! Networks, read from a file or built in.

use std::fs;
use std::path::Path;

use dvp_net::decompose::Divider;
use dvp_net::error::NetError;
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
    read(path, Proposer::from_bytes)
}

/// The network of a file as `dvp train --model monet` writes it, which finds no scene but divides the picture.
///
/// # Errors
/// [`LoadNetworkError`] if the file cannot be read or is no such network.
pub fn load_divider(path: &Path) -> Result<Divider, LoadNetworkError> {
    read(path, Divider::from_bytes)
}

fn read<N>(path: &Path, of: impl Fn(&[u8]) -> Result<N, NetError>) -> Result<N, LoadNetworkError> {
    let bytes = fs::read(path).map_err(|source| LoadNetworkError::Unreadable { path: path.to_path_buf(), source })?;
    of(&bytes).map_err(|error| LoadNetworkError::File { path: path.to_path_buf(), source: Box::new(error) })
}
