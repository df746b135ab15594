//! The files of a run, each whole or not at all.
//!
//! | file | holds |
//! |---|---|
//! | `run.json` | the settings; `dvp train --config run.json` runs them again |
//! | `checkpoint-00000500.safetensors` | all that `--resume` needs; the two newest are kept |
//! | `best.safetensors` | the weights with the smallest L_x, or mean absolute error, on the validation images |
//! | `losses.csv`, `losses.svg` | the curves |
//! | `features/` | what a frozen encoder makes of images that come again; may be deleted at any time |
//! | `samples/00000500.png` | validation images over their reconstructions |

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use dvp_net::error::NetError;

use super::curves::Curves;
use crate::command::Console;
use crate::format::write_atomic;

/// Checkpoints that are kept: if the newest is damaged there is one before it.
const KEPT: usize = 2;

/// The folder of a run.
#[derive(Clone, Debug)]
pub(super) struct Store {
    folder: PathBuf,
}

impl Store {
    pub(super) fn new(folder: &Path) -> Self {
        Self { folder: folder.to_path_buf() }
    }

    pub(super) fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Refuses a folder in which a run stands, unless it goes on.
    pub(super) fn check_new(&self) -> Result<()> {
        let file = self.path("run.json");
        if file.exists() {
            bail!("{} is already there; add --resume to go on, or choose another --out", file.display());
        }
        Ok(())
    }

    /// Writes all that a step leaves: the curves, the weights if they are the best so far, and the checkpoint. `file`: their bytes, with
    /// what `--resume` needs or without.
    pub(super) fn keep(
        &self,
        step: u64,
        curves: &Curves,
        improved: bool,
        file: impl Fn(bool) -> Result<Vec<u8>>,
    ) -> Result<()> {
        curves.write(&self.path("losses.csv"), &self.path("losses.svg"))?;
        if improved {
            write_atomic(&self.path("best.safetensors"), &file(false)?)?;
        }
        // Last: a checkpoint stands for all that was written before it.
        self.save(step, &file(true)?)
    }

    /// Writes the checkpoint of a step and removes those that are too old.
    fn save(&self, step: u64, checkpoint: &[u8]) -> Result<()> {
        write_atomic(&self.path(&format!("checkpoint-{step:08}.safetensors")), checkpoint)?;
        for old in self.checkpoints()?.iter().rev().skip(KEPT) {
            fs::remove_file(old).with_context(|| format!("{} cannot be removed", old.display()))?;
        }
        Ok(())
    }

    /// The newest checkpoint that can be read; damaged ones are named.
    pub(super) fn newest<F>(
        &self,
        console: &mut Console<'_>,
        read: impl Fn(&[u8]) -> Result<F, NetError>,
    ) -> Result<F> {
        for path in self.checkpoints()?.iter().rev() {
            let bytes = fs::read(path).with_context(|| format!("{} cannot be read", path.display()))?;
            match read(&bytes) {
                Ok(checkpoint) => return Ok(checkpoint),
                Err(error) => writeln!(console.err, "{}: {error}; the one before it is taken", path.display())?,
            }
        }
        bail!("{}: no checkpoint that can be read; run without --resume in another --out", self.folder.display())
    }

    /// Oldest first.
    fn checkpoints(&self) -> Result<Vec<PathBuf>> {
        let list = fs::read_dir(&self.folder).with_context(|| format!("{} cannot be read", self.folder.display()))?;
        let mut found = Vec::new();
        for entry in list {
            let path = entry?.path();
            let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
            if name.starts_with("checkpoint-") && name.ends_with(".safetensors") {
                found.push(path);
            }
        }
        found.sort();
        Ok(found)
    }
}
