//! Metrics: numbers from two images or two scenes, by the rules of the reference system; for scenes and label maps of
//! anything else by what is seen ([`OwnershipRule`]).
//!
//! In: an [`ImagePair`](crate::loss::ImagePair), and for each scene the pixels that its objects own ([`Ownership`]).
//! Out: MAE, MSE, SSIM, IoU, ARI and counts, for one image or, through [`Tally`], for a data set.
//!
//! | file | does |
//! |---|---|
//! | `ownership.rs` | coverage and confidence, or a label map, to the union mask and the index of objects |
//! | `overlap.rs` | IoU of union masks, pooled over images |
//! | `rand_index.rs` | the adjusted Rand index of two labelings |
//! | `tally.rs` | all metrics of a data set |
//!
//! Shown by `tests/golden/metric.rs` (the reference's masks, indices and scores) and `tests/property/metric.rs`.

mod overlap;
mod ownership;
mod rand_index;
mod tally;
#[cfg(test)]
mod tests;

use core::fmt;

pub use overlap::MaskOverlap;
pub use ownership::{Ownership, OwnershipRule, visible_object_count};
pub use rand_index::{RandIndexScratch, adjusted_rand_index};
pub use tally::{Scores, Tally};

use crate::loss::LossError;
use crate::render::RenderError;

/// Why there is no metric.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MetricError {
    /// A slice has the wrong length.
    Length {
        /// Which slice.
        what: &'static str,
        /// Expected length.
        expected: usize,
        /// What came.
        len: usize,
    },
    /// Objects could not be drawn.
    Render(RenderError),
    /// A metric of the images was refused.
    Image(LossError),
}

impl fmt::Display for MetricError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { what, expected, len } => write!(f, "{what} has {len} values, needs {expected}"),
            Self::Render(error) => write!(f, "{error}"),
            Self::Image(error) => write!(f, "{error}"),
        }
    }
}

impl core::error::Error for MetricError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Length { .. } => None,
            Self::Render(error) => Some(error),
            Self::Image(error) => Some(error),
        }
    }
}

impl From<LossError> for MetricError {
    fn from(error: LossError) -> Self {
        Self::Image(error)
    }
}

impl From<RenderError> for MetricError {
    fn from(error: RenderError) -> Self {
        Self::Render(error)
    }
}
