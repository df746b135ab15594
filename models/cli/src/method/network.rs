//! Networks, read from a file or built in.

use std::fs;
use std::path::Path;

use dvp_net::decompose::Divider;
use dvp_net::error::NetError;
use dvp_net::propose::{BUILT_IN, BUILT_IN_LOOK, LOOKS, Proposer};
use dvp_net::train::LookFile;

use super::error::LoadNetworkError;

/// The network of a file as `dvp train` writes it, or the one that is built in; with the second looks that are built in, where the network
/// knows their shapes.
///
/// # Errors
/// [`LoadNetworkError`] if the file cannot be read or is no such network.
pub fn load(file: Option<&Path>) -> Result<Proposer, LoadNetworkError> {
    load_looking(file, None, None)
}

/// The same with second looks of one's own: the weights of `look`, as `dvp train --model look` writes them; `looks` of them, none
/// if that is 0.
///
/// # Errors
/// As [`load`]; [`LoadNetworkError::File`] if the look is for other shapes than the network.
pub fn load_looking(
    file: Option<&Path>,
    look: Option<&Path>,
    looks: Option<usize>,
) -> Result<Proposer, LoadNetworkError> {
    let built_in = |error| LoadNetworkError::BuiltIn(Box::new(error));
    let network = match file {
        Some(path) => read(path, Proposer::from_bytes)?,
        None => Proposer::from_bytes(BUILT_IN).map_err(built_in)?,
    };
    let times = looks.unwrap_or(LOOKS);
    match look {
        _ if times == 0 => Ok(network),
        Some(path) => read(path, |bytes| network.clone().with_look(&LookFile::from_bytes(bytes)?, times)),
        None => {
            let look = LookFile::from_bytes(BUILT_IN_LOOK).map_err(built_in)?;
            let fits = look.bank().map_err(built_in)? == *network.bank();
            if fits { network.with_look(&look, times).map_err(built_in) } else { Ok(network) }
        }
    }
}

/// The network of a file as `dvp train --model monet` or `slots` writes it, which finds no scene but divides the picture.
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
