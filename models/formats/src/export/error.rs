//! Why something was not exported.

use dvp_core::dims::SizeError;
use dvp_core::metric::MetricError;
use dvp_core::render::RenderError;
use dvp_core::shape::ShapeError;

use crate::format::FormatError;

/// Why something was not exported.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The numbers of an object describe no shape.
    #[error("object {object}: {source}")]
    Shape {
        /// The object, from 1.
        object: usize,
        /// What is wrong with it.
        source: ShapeError,
    },
    /// The outlines could not be drawn.
    #[error("the outlines cannot be drawn: {0}")]
    Draw(ShapeError),
    /// The renderer refused.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The pixels of objects could not be told.
    #[error(transparent)]
    Owners(#[from] MetricError),
    /// More than a file of this kind can hold.
    #[error("{file} can hold {limit} {what} at most, and there are {count}; {remedy}")]
    TooMany {
        /// The file.
        file: &'static str,
        /// Of what there are too many.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// The most of them.
        limit: usize,
        /// What to do.
        remedy: &'static str,
    },
    /// An object has a number that label maps cannot hold.
    #[error("a label map of 16 bits ends at 65535, and an object has the number {number}; number the labels anew")]
    Number {
        /// The number.
        number: u32,
    },
    /// The program was built without this format.
    #[error("this dvp was built without Parquet: build it with `--features parquet`, or name a file that ends in .csv")]
    NoParquet,
    /// The table could not be encoded.
    #[error("the table cannot be encoded: {0}")]
    Table(String),
    /// The pixels could not be encoded.
    #[error(transparent)]
    Png(#[from] FormatError),
    /// The picture has no pixels, or more than there are numbers.
    #[error(transparent)]
    Size(#[from] SizeError),
    /// The archive could not be encoded.
    #[error("the archive cannot be encoded: {0}")]
    Zip(#[from] std::io::Error),
    /// The text could not be encoded.
    #[error("the JSON cannot be encoded: {0}")]
    Json(#[from] serde_json::Error),
}
