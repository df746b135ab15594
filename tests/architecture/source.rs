//! The files of the repository.

use std::fs;
use std::path::{Path, PathBuf};

/// The workspace root.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().unwrap()
}

/// A text file of the repository: its path from the root, with slashes, and what it says.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    pub(crate) path: String,
    pub(crate) text: String,
}

/// All text files under `folder` (from the root), without what git ignores; sorted. Fails if there is none.
pub(crate) fn sources(folder: &str) -> Vec<Source> {
    let root = root();
    let mut found = Vec::new();
    walk(&root.join(folder), &mut |path| {
        if let Ok(text) = fs::read_to_string(path) {
            let path = path.strip_prefix(&root).unwrap().to_string_lossy().replace('\\', "/");
            found.push(Source { path, text });
        }
    });
    assert!(!found.is_empty(), "no files under {folder}");
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

/// The same, Rust files only.
pub(crate) fn rust_sources(folder: &str) -> Vec<Source> {
    let mut found = sources(folder);
    found.retain(|source| source.path.ends_with(".rs"));
    assert!(!found.is_empty(), "no Rust files under {folder}");
    found
}

fn walk(folder: &Path, visit: &mut impl FnMut(&Path)) {
    const IGNORED: [&str; 8] = [".git", "target", "out", "corpus", "artifacts", "coverage", "dist", "node_modules"];
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy();
        if IGNORED.contains(&name.as_ref()) {
            continue;
        }
        if path.is_dir() {
            walk(&path, visit);
        } else {
            visit(&path);
        }
    }
}

/// The lines of code with their numbers from 1, without comments (`//` to the end of the line).
pub(crate) fn code_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    (1..).zip(text.lines().map(|line| line.split("//").next().unwrap_or_default()))
}
