//! Why a model was not loaded, or refused its input.

use dvp_core::dims::Dims;
use dvp_core::image::ImageError;
use dvp_core::render::RenderError;
use dvp_core::shape::ShapeError;
use dvp_core::tensor::{ParametersError, TensorError};
use thiserror::Error;

/// Why a model was not loaded, or refused its input.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum NetError {
    /// A weight is missing or has other extents than the sizes of the model ask for.
    #[error(transparent)]
    Parameters(#[from] ParametersError),
    /// An operation on tensors was refused.
    #[error(transparent)]
    Tensor(#[from] TensorError),
    /// Sizes of which no model can be made, or a variant that is not here.
    #[error("{key} is {found} in the model's sizes, but {must}")]
    Config {
        /// The key in the file of sizes.
        key: &'static str,
        /// What it says.
        found: String,
        /// What is needed.
        must: &'static str,
    },
    /// An image that patches do not tile.
    #[error(
        "an image of {width} x {height} pixels is not tiled by patches of side {patch}: resize it to multiples of that"
    )]
    ImageSize {
        /// Width in pixels.
        width: usize,
        /// Height in pixels.
        height: usize,
        /// Side of a patch in pixels.
        patch: usize,
    },
    /// An input of the wrong rank or extents.
    #[error("{input} of extents {dims}: {must}")]
    Input {
        /// What was given.
        input: &'static str,
        /// Its extents.
        dims: Dims,
        /// What is needed.
        must: &'static str,
    },
    /// A batch that cannot be judged.
    #[error("the batch {must}")]
    Batch {
        /// What is needed.
        must: String,
    },
    /// An image with NaN or infinity.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// An outline could not be drawn.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// A scene could not be painted.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A loss that is no number: the weights are those before the step.
    #[error("step {step}: the loss is {loss}; a smaller learning rate or --clip-norm may help")]
    NotFinite {
        /// Number of the step, from 1.
        step: u64,
        /// What came out.
        loss: f64,
    },
    /// A file of weights that is not what its name says.
    #[error("{0}")]
    Checkpoint(String),
}

/// Refuses sizes unless `holds`.
pub(crate) fn require(
    holds: bool,
    key: &'static str,
    found: impl ToString,
    must: &'static str,
) -> Result<(), NetError> {
    if holds { Ok(()) } else { Err(NetError::Config { key, found: found.to_string(), must }) }
}
