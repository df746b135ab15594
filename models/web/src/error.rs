//! Why something failed.

use dvp_core::dims::SizeError;
use dvp_core::image::ImageError;
use dvp_core::loss::LossError;
use dvp_core::shape::ShapeError;
use dvp_fit::FitError;
use dvp_formats::export::ExportError;
use dvp_formats::format::FormatError;
use wasm_bindgen::{JsError, JsValue};

/// Why something failed; JavaScript gets it as an `Error` with this text.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WebError {
    /// A picture without pixels, or with more than there are numbers.
    #[error(transparent)]
    Size(#[from] SizeError),
    /// More pixels than a browser has memory for.
    #[error("{width} x {height} pixels are more than {limit}; scale the picture down")]
    Pixels {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Most pixels.
        limit: usize,
    },
    /// Pixels that are no picture.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// A scene or a bank that cannot be read or written.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The fit refused.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// A shape that cannot be drawn.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// A scene that cannot be measured.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// Images that cannot be compared.
    #[error(transparent)]
    Compare(#[from] LossError),
    /// A result that cannot be written as JSON.
    #[error("the result cannot be written: {0}")]
    Json(#[from] serde_json::Error),
    /// A drawing of another size than the picture.
    #[error("the drawing is for {drawing:?} pixels, the picture has {picture:?}")]
    Sizes {
        /// Columns and rows that the drawing is for.
        drawing: [usize; 2],
        /// Those of the picture.
        picture: [usize; 2],
    },
    /// A scene that does not say how large its image is.
    #[error("the scene does not say how large its image is; add `width` and `height`")]
    NoSize,
    /// Covariances that do not fit the objects.
    #[error("{len} numbers of covariances, must be 25 for each of {objects} objects or none")]
    Covariance {
        /// How many numbers there are.
        len: usize,
        /// How many objects there are.
        objects: usize,
    },
}

impl From<WebError> for JsValue {
    fn from(error: WebError) -> Self {
        JsError::from(error).into()
    }
}
