//! The benchmarks of the field: published files to pictures with their truth, and that truth again where scores are made.
//!
//! | suite | published as | pictures |
//! |---|---|---|
//! | Multi-dSprites | gzipped TFRecords of `multi_object_datasets` | 64 x 64, one to five hearts, squares and ellipses, hard edges |
//! | Tetrominoes | the same | 35 x 35, three pieces on black, 17 turned shapes, 6 colors |
//! | CSR, the suites of compositional scene representation | HDF5; here `.npz` of one of its groups | 64 x 64 mostly, squares and triangles with openings |
//!
//! | file | comes in | goes out |
//! |---|---|---|
//! | `multi_object.rs` | TFRecords | [`SuiteScene`]s |
//! | `csr.rs` | `.npz` | [`SuiteScene`]s |
//! | `scene.rs` | a [`SuiteScene`] | the files of a data set |
//! | `classes.rs` | `classes.json` | the classes of the objects of a data set |
//!
//! A data set is a folder whatever it was made of: `STEM.png`, `STEM.labels.png` (which object each pixel shows), `STEM.whole.png`
//! (every object whole, side by side, the first painted first) and `classes.json`. `dvp generate` writes it, `dvp fit` reads the
//! pictures, `dvp evaluate --suite` the truth. Files are tested on ones that the tests write in the same formats.
//!
//! HDF5 is read through `.npz`: the readers in pure Rust that we found are months old and have one author each, the C library would be the
//! only one of the house. One line of Python converts a group:
//! `numpy.savez_compressed("test.npz", **{k: v[()] for k, v in h5py.File("shapes.h5")["test"].items()})`.
//!
//! *Source*: the names and shapes of features are those of the readers at `deepmind/multi_object_datasets` and of the writers at
//! `FudanVI/compositional-scene-representation-toolbox`.

mod classes;
mod csr;
mod multi_object;
mod scene;
#[cfg(test)]
mod tests;

use std::path::Path;

use clap::ValueEnum;

use crate::format::FormatError;

pub use classes::{CLASSES_FILE, Classes};
pub use scene::{SuiteScene, read_whole};

/// The benchmarks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Suite {
    /// Compositional scene representation: shapes with openings that hide one another
    Csr,
    /// Hearts, squares and ellipses with hard edges that hide one another
    MultiDsprites,
    /// Three tetrominoes beside one another
    Tetrominoes,
}

impl Suite {
    /// The first `count` scenes of a published file.
    ///
    /// # Errors
    /// [`FormatError`] with the record that is wrong, and what to do.
    pub fn read(self, path: &Path, count: usize) -> Result<Vec<SuiteScene>, FormatError> {
        match self {
            Self::Csr => csr::read(path, count),
            Self::MultiDsprites => multi_object::read(path, count, multi_object::MULTI_DSPRITES),
            Self::Tetrominoes => multi_object::read(path, count, multi_object::TETROMINOES),
        }
    }

    /// The name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Csr => "CSR",
            Self::MultiDsprites => "Multi-dSprites",
            Self::Tetrominoes => "Tetrominoes",
        }
    }
}
