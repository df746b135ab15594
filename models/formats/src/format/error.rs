//! What can be wrong with a file.

use alloc::boxed::Box;
use core::error::Error;
use core::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// Where a text stands: a file and, in files of many lines, the line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file.
    pub path: PathBuf,
    /// The line, from 1, in files with one record per line.
    pub line: Option<usize>,
}

impl Place {
    /// A whole file.
    #[must_use]
    pub fn file(path: &Path) -> Self {
        Self { path: path.to_path_buf(), line: None }
    }

    /// A line of a file, from 1.
    #[must_use]
    pub fn line(path: &Path, line: usize) -> Self {
        Self { path: path.to_path_buf(), line: Some(line) }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.path.display())?;
        self.line.map_or(Ok(()), |line| write!(f, ", line {line}"))
    }
}

/// Why a file was not read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FormatError {
    /// The system refused to read.
    #[error("{path}: cannot be read: {source}", path = path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The system refused to write; what was there before is unchanged.
    #[error("{path}: cannot be written: {source}; nothing was left behind", path = path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// More bytes than such a file can need.
    #[error("{place}: more than {limit} bytes; is it the right file?")]
    TooLong {
        /// The file or line.
        place: Place,
        /// Most bytes read.
        limit: u64,
    },
    /// Not JSON, or JSON of something else.
    #[error("{place}: not {expected}: {source}")]
    Json {
        /// The file or line.
        place: Place,
        /// What it should have been.
        expected: &'static str,
        /// The parser's reason.
        source: serde_json::Error,
    },
    /// A version that this program does not know.
    #[error("{place}: format version {version}, this program reads versions 1 to 3; use a newer dvp")]
    Version {
        /// The file or line.
        place: Place,
        /// The version found.
        version: u64,
    },
    /// A value that is missing or out of range.
    #[error("{place}: {field} {problem}")]
    Field {
        /// The file or line.
        place: Place,
        /// The field, as a path into the JSON.
        field: String,
        /// What is wrong, and what it must be.
        problem: String,
    },
    /// A shape of a kind that the format has no name for.
    #[error("shapes of kind {kind} cannot be written to a scene file")]
    Kind {
        /// The kind.
        kind: &'static str,
    },
    /// An image file that its decoder refuses.
    #[error("{path}: not a readable image: {source}", path = path.display())]
    Decode {
        /// The file.
        path: PathBuf,
        /// The decoder's reason.
        source: Box<dyn Error + Send + Sync>,
    },
    /// A header that announces more pixels than allowed, or none.
    #[error("{path}: {width} x {height} pixels, must be 1 to {limit}; scale it down or raise --max-pixels", path = path.display())]
    Pixels {
        /// The file.
        path: PathBuf,
        /// Columns announced.
        width: u32,
        /// Rows announced.
        height: u32,
        /// Most pixels allowed.
        limit: usize,
    },
    /// Decoded values that are NaN or infinite (floating-point files).
    #[error("{path}: {source}", path = path.display())]
    Values {
        /// The file.
        path: PathBuf,
        /// Which value.
        source: dvp_core::image::ImageError,
    },
    /// A label map whose pixels are no labels.
    #[error("{path}: pixels of kind {found} are no labels; write gray of 8 or 16 bits (as TIFF also of 32), or a palette", path = path.display())]
    Labels {
        /// The file.
        path: PathBuf,
        /// How its pixels are stored.
        found: String,
    },
    /// A pixel of a label map that is no label.
    #[error("{path}: a pixel is {value}; labels are whole numbers from 0 to 4294967295", path = path.display())]
    Label {
        /// The file.
        path: PathBuf,
        /// What it is.
        value: f64,
    },
    /// The image could not be encoded.
    #[error("the image cannot be encoded as PNG: {source}")]
    Encode {
        /// The encoder's reason.
        source: Box<dyn Error + Send + Sync>,
    },
    /// A folder without anything to read.
    #[error("{path}: no {what} in this folder", path = path.display())]
    Nothing {
        /// The folder.
        path: PathBuf,
        /// What was looked for.
        what: &'static str,
    },
}
