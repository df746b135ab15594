//! Scenes of a published file as a data set.

use alloc::collections::BTreeMap;
use std::path::Path;

use anyhow::{Result, bail};

use super::{Arguments, Preset, stem};
use crate::command::{Console, Outcome};
use crate::format::{FormatError, write_atomic};
use crate::suite::{CLASSES_FILE, Classes, Suite, SuiteScene};

/// Writes the first scenes of `file`.
pub(super) fn run(arguments: &Arguments, file: &Path, console: &mut Console<'_>) -> Result<Outcome> {
    let suite = match arguments.preset {
        Preset::MdsHr => bail!("--from needs the set that the file is of: --preset multi-dsprites, tetrominoes or csr"),
        Preset::MultiDsprites => Suite::MultiDsprites,
        Preset::Tetrominoes => Suite::Tetrominoes,
        Preset::Csr => Suite::Csr,
    };
    if arguments.changes_the_preset() {
        bail!("--from takes pictures as they are: leave the options that change a preset away");
    }
    let classes_file = arguments.out.join(CLASSES_FILE);
    if classes_file.exists() && !arguments.overwrite {
        bail!("{} is already there; choose another --out or add --overwrite", classes_file.display());
    }
    let scenes = suite.read(file, arguments.count)?;
    if scenes.is_empty() {
        return Err(FormatError::Nothing { path: file.to_path_buf(), what: "scene" }.into());
    }
    let mut objects = BTreeMap::new();
    for (index, scene) in scenes.iter().enumerate() {
        for (ending, bytes) in scene.files()? {
            write_atomic(&arguments.out.join(format!("{}.{ending}", stem(index))), &bytes)?;
        }
        let SuiteScene { classes, .. } = scene;
        if !classes.is_empty() {
            objects.insert(stem(index), classes.clone());
        }
    }
    // Last: a folder with this file is a whole data set.
    write_atomic(&classes_file, Classes::new(objects).to_json()?.as_bytes())?;
    writeln!(console.out, "{} images in {}", scenes.len(), arguments.out.display())?;
    Ok(Outcome::Done)
}
