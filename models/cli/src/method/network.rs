//! Networks, read from a file or built in.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use dvp_net::propose::{BUILT_IN, Proposer};

/// The network of a file as `dvp train` writes it, or the one that is built in.
///
/// # Errors
/// If the file cannot be read or is no such network.
pub fn load(file: Option<&Path>) -> Result<Proposer> {
    let Some(file) = file else {
        return Proposer::from_bytes(BUILT_IN).context("the network that is built in");
    };
    let named = || file.display().to_string();
    let bytes = fs::read(file).with_context(|| format!("{} cannot be read", file.display()))?;
    Proposer::from_bytes(&bytes).with_context(named)
}
