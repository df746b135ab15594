//! Why nothing was found in a picture.

use dvp_core::image::ImageError;
use dvp_core::loss::LossError;
use dvp_core::shape::ShapeError;
use dvp_fit::masks::LabelMapError;

use crate::format::FormatError;
use crate::method::MethodError;
use crate::paint::PaintError;

/// Why nothing was found in a picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// A method and a start that do not go together.
    #[error("{0}")]
    Usage(&'static str),
    /// The scene to start from could not be read.
    #[error(transparent)]
    Start(#[from] FormatError),
    /// The method refused its options, the picture or the start.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// What was found could not be painted.
    #[error(transparent)]
    Paint(#[from] PaintError),
    /// What was painted could not be compared with the picture.
    #[error(transparent)]
    Compare(#[from] LossError),
    /// The outline of an object could not be drawn or cut.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// There is not one label per pixel.
    #[error(transparent)]
    Labels(#[from] LabelMapError),
    /// The pixels are no picture.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// A label map of another size than the picture that its objects are on.
    #[error("the label map has {} x {} pixels, its picture has {} x {}; bring them to one size", masks[0], masks[1], picture[0], picture[1])]
    Size {
        /// Columns and rows of the label map.
        masks: [usize; 2],
        /// Columns and rows of the picture.
        picture: [usize; 2],
    },
    /// The fit panicked.
    #[error("the fit failed on this picture, which is a defect of dvp; please report it with the picture")]
    Defect,
}
