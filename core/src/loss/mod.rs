//! Losses: a number and its gradient from two images or two scenes.
//!
//! In: an [`ImagePair`], [`ScenePairs`] or outlines. Out: a scalar and, backward, its gradient with respect to the
//! first image, the predicted scenes or the outlines. All stand behind one trait, [`Loss`].
//!
//! | file | loss | backward |
//! |---|---|---|
//! | `pixel` | MAE, MSE: [`PixelLoss`](crate::render::PixelLoss), which renderers also fuse into their backward pass | `pixel_vjp` |
//! | `ssim` | 1 - structural similarity, [`Ssim`] | `ssim_vjp` |
//! | `pyramid` | an image loss over halved images, [`Pyramid`] | `pyramid_vjp` |
//! | `length` | mean length of unit outlines, [`ContourLength`] | `length_vjp` |
//! | `scene_loss` | the paper's L_p, [`SceneLoss`], a sum of `scene_terms` | `scene_loss_vjp` |
//! | `image_loss_op`, `scene_loss_op` | losses of a batch as steps: [`ImageLossOp`], [`SceneLossOp`] | same files |
//! | `scene_match`, `rotation_term` | which objects L_p compares, and how it prices a turn | |
//!
//! Shown by `tests/gradient/loss.rs` (central differences), `tests/golden/loss.rs` (the reference's terms, totals,
//! matchings and gradients) and `tests/property/loss.rs` (0 at equality, unchanged by order and by symmetric turns).

mod image_loss_op;
mod image_pair;
mod length;
mod length_vjp;
mod pixel;
mod pixel_vjp;
mod pyramid;
mod pyramid_vjp;
mod rotation_term;
mod scene_loss;
mod scene_loss_op;
mod scene_loss_vjp;
mod scene_match;
mod scene_terms;
mod ssim;
mod ssim_vjp;
#[cfg(test)]
mod tests;

use core::fmt;

pub use image_loss_op::ImageLossOp;
pub use image_pair::ImagePair;
pub use length::{ContourLength, outline_length};
pub use length_vjp::outline_length_vjp;
pub use pyramid::{Pyramid, PyramidScratch};
pub use rotation_term::RotationTerm;
pub use scene_loss::{SceneLoss, ScenePairs};
pub use scene_loss_op::SceneLossOp;
pub use scene_match::{Match, SceneLossScratch};
pub use scene_terms::SceneTerms;
pub use ssim::{SSIM_WINDOW, Ssim, SsimScratch};

use crate::dims::ImageSize;
use crate::image::ImageError;
use crate::matching::MatchingError;
use crate::real::Real;
use crate::shape::ShapeError;

/// A scalar that falls as its input gets better, and its gradient.
///
/// Nothing is allocated after the first call of a size with the same scratch.
pub trait Loss<T: Real> {
    /// What is judged, with what it is judged by.
    type Input<'a>: Copy;
    /// Holds the gradient with respect to the judged part of the input.
    type Grad: ?Sized;
    /// Memory kept between calls.
    type Scratch: Default + Send;

    /// The loss.
    ///
    /// # Errors
    /// [`LossError`] if the input does not fit the loss or leads to a number that is not finite.
    fn value(&self, input: Self::Input<'_>, scratch: &mut Self::Scratch) -> Result<T, LossError>;

    /// Adds `cotangent` times the gradient of the loss to `grad`; returns the loss. On an error `grad` may hold a part
    /// of the gradient.
    ///
    /// # Errors
    /// As [`Self::value`]; also if `grad` has the wrong extents.
    fn vjp(
        &self,
        input: Self::Input<'_>,
        cotangent: T,
        scratch: &mut Self::Scratch,
        grad: &mut Self::Grad,
    ) -> Result<T, LossError>;
}

/// Why there is no loss.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LossError {
    /// The two images differ in size.
    Sizes {
        /// Size of the judged image.
        image: ImageSize,
        /// Size of the target.
        target: ImageSize,
    },
    /// A side is smaller than the window of the loss.
    SmallerThanWindow {
        /// Size of the image, or of a level of the pyramid.
        size: ImageSize,
        /// Side of the window in pixels.
        window: usize,
    },
    /// A slice has the wrong length.
    Length {
        /// Which slice.
        what: &'static str,
        /// Expected length.
        expected: usize,
        /// What came.
        len: usize,
    },
    /// A count that must not be zero is zero.
    Zero {
        /// Which count.
        what: &'static str,
    },
    /// A number is outside its range.
    OutOfRange {
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        must: &'static str,
    },
    /// More true objects than predicted ones.
    TooFewSlots {
        /// Which pair of scenes.
        pair: usize,
        /// Visible true objects.
        objects: usize,
        /// Predicted objects.
        slots: usize,
    },
    /// A pair of scenes leads to a number that is NaN or infinite.
    NotFinite {
        /// Which pair.
        pair: usize,
    },
    /// An image was refused.
    Image(ImageError),
    /// An outline was refused.
    Shape(ShapeError),
    /// The matching was refused.
    Matching(MatchingError),
}

impl fmt::Display for LossError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sizes { image, target } => write!(
                f,
                "the images have {} x {} and {} x {} pixels; make them equal",
                image.width(),
                image.height(),
                target.width(),
                target.height()
            ),
            Self::SmallerThanWindow { size, window } => write!(
                f,
                "an image of {} x {} pixels is smaller than the window of {window}; use a larger image, fewer levels or another loss",
                size.width(),
                size.height()
            ),
            Self::Length { what, expected, len } => write!(f, "{what} has {len} values, needs {expected}"),
            Self::Zero { what } => write!(f, "{what} must be at least 1"),
            Self::OutOfRange { what, value, must } => write!(f, "{what} is {value}, must be {must}"),
            Self::TooFewSlots { pair, objects, slots } => {
                write!(f, "scene pair {pair} has {objects} true objects for {slots} predicted ones; predict more")
            }
            Self::NotFinite { pair } => {
                write!(f, "the loss of scene pair {pair} is NaN or infinite; check its parameters")
            }
            Self::Image(error) => write!(f, "{error}"),
            Self::Shape(error) => write!(f, "{error}"),
            Self::Matching(error) => write!(f, "{error}"),
        }
    }
}

impl core::error::Error for LossError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Image(error) => Some(error),
            Self::Shape(error) => Some(error),
            Self::Matching(error) => Some(error),
            _ => None,
        }
    }
}

impl From<ImageError> for LossError {
    fn from(error: ImageError) -> Self {
        Self::Image(error)
    }
}

impl From<ShapeError> for LossError {
    fn from(error: ShapeError) -> Self {
        Self::Shape(error)
    }
}

impl From<MatchingError> for LossError {
    fn from(error: MatchingError) -> Self {
        Self::Matching(error)
    }
}

/// The length of `slice` must be `expected`.
fn check_length<V>(what: &'static str, slice: &[V], expected: usize) -> Result<(), LossError> {
    if slice.len() == expected { Ok(()) } else { Err(LossError::Length { what, expected, len: slice.len() }) }
}
