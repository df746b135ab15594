//! What to fit: files, folders and patterns to a list of pictures, each with a name of its own for its results.

use alloc::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};

use crate::command::in_words;
use crate::format::pictures_of;

/// A picture to fit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Input {
    /// The file.
    pub(super) path: PathBuf,
    /// Which image of a NumPy file.
    pub(super) frame: Option<usize>,
    /// Results are called `{stem}.json` and so on; no two inputs share one.
    pub(super) stem: String,
}

impl Input {
    /// The file and, if it holds many images, which of them.
    pub(super) fn name(&self) -> String {
        match self.frame {
            Some(frame) => format!("{}[{frame}]", self.path.display()),
            None => self.path.display().to_string(),
        }
    }
}

/// Pictures, and arguments that led to none.
#[derive(Debug, Default)]
pub(super) struct Found {
    pub(super) paths: Vec<PathBuf>,
    pub(super) failures: Vec<String>,
}

/// Folders to their pictures, patterns to their matches, everything else as it is; no file twice.
pub(super) fn find(arguments: &[PathBuf]) -> Found {
    let mut found = Found::default();
    let mut seen = BTreeSet::new();
    for argument in arguments {
        let paths = paths_of(argument).unwrap_or_else(|error| {
            found.failures.push(in_words(&error));
            Vec::new()
        });
        for path in paths {
            // A file that does not exist stays, to be reported when it is opened.
            if seen.insert(path.canonicalize().unwrap_or_else(|_| path.clone())) {
                found.paths.push(path);
            }
        }
    }
    found
}

fn paths_of(argument: &Path) -> Result<Vec<PathBuf>> {
    let text = argument.to_string_lossy();
    if argument.is_dir() {
        let pictures = pictures_of(argument)?;
        if pictures.is_empty() {
            bail!("{text}: no picture in this folder");
        }
        Ok(pictures)
    } else if !argument.exists() && text.contains(['*', '?', '[']) {
        let matches: Vec<PathBuf> = glob::glob(&text)?.filter_map(Result::ok).filter(|path| !path.is_dir()).collect();
        if matches.is_empty() {
            bail!("{text}: no file matches");
        }
        Ok(matches)
    } else {
        Ok(vec![argument.to_path_buf()])
    }
}

/// Gives every picture a stem: the file's, with the ending where two files share it (`a.png`, `a.jpg`), with a number
/// where that is not enough. The images of NumPy files are numbered, as those of data sets.
pub(super) fn name(pictures: &[(PathBuf, Option<usize>)]) -> Vec<Input> {
    let plain: Vec<String> = pictures
        .iter()
        .map(|(path, frame)| match frame {
            Some(frame) => format!("{frame:05}"),
            None => lossy(path.file_stem()),
        })
        .collect();
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for stem in &plain {
        *counts.entry(stem.to_ascii_lowercase()).or_default() += 1;
    }
    let mut taken = BTreeSet::new();
    let inputs = pictures.iter().zip(&plain).map(|((path, frame), stem)| {
        let shared = counts.get(&stem.to_ascii_lowercase()).is_some_and(|&count| count > 1);
        let first = match (shared, frame) {
            (false, _) => stem.clone(),
            (true, None) => lossy(path.file_name()),
            (true, Some(_)) => format!("{}-{stem}", lossy(path.file_stem())),
        };
        let mut stem = first.clone();
        for number in 2.. {
            // File systems may not tell A from a.
            if taken.insert(stem.to_ascii_lowercase()) {
                break;
            }
            stem = format!("{first}-{number}");
        }
        Input { path: path.clone(), frame: *frame, stem }
    });
    inputs.collect()
}

fn lossy(name: Option<&std::ffi::OsStr>) -> String {
    name.map_or_else(|| "image".to_owned(), |name| name.to_string_lossy().into_owned())
}
