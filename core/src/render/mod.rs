//! Renderers: a drawing in, an image out, and gradients back.
//!
//! | module | holds |
//! |---|---|
//! | `mod.rs` | the contract: the trait [`Renderer`], errors; the settings are the scene's |
//! | [`tile`] | coverage tiles per object, the trait of coverage models, and the renderer over any of them |
//! | `composite` | one pass over the image: mixing, loss, gradients with respect to colors, confidences and coverage |
//! | [`contour`] | coverage by the scene's edge profile, without the reference's seams: the default renderer |
//! | [`exact`] | coverage by the area of pixel and object in common |
//! | [`hard`] | coverage 0 or 1: masks |
//! | [`dense`] | the default renderer again, in tensor operations alone |
//! | `even_odd` | points told inside from outside, many at a time |
//! | `render_op` | any renderer, and its fused loss, as steps of a batch: [`RenderOp`], [`RenderLossOp`] |
//! | `triangles` | coverage by the distance to triangles, the reference's; with the feature of that name |

#[expect(clippy::needless_range_loop, reason = "loops over lanes walk several arrays")]
mod composite;
pub mod contour;
pub mod dense;
mod even_odd;
pub mod exact;
pub mod hard;
mod render_op;
pub mod tile;
#[cfg(feature = "triangles")]
pub mod triangles;

pub use contour::{ContourDistance, ContourRenderer};
pub use dense::{DenseRenderer, TensorDrawing};
pub use exact::{ExactArea, ExactRenderer};
pub use hard::{HardMask, HardRenderer};
pub use render_op::{RenderLossOp, RenderOp, RenderOpScratch};
pub use tile::{CoverageModel, TileRenderer};
#[cfg(feature = "triangles")]
pub use triangles::{SoftTriangles, TriangleRenderer};

use crate::dims::ImageSize;
use crate::image::ImageView;
use crate::real::Real;
use crate::scene::{Drawing, DrawingGrad};

pub use crate::scene::{Compositing, EdgeLaw, EdgeProfile};

/// A loss that is a mean over pixels and channels, fused into the backward pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum PixelLoss {
    /// Mean of |a - b|; its derivative at 0 is taken as 0.
    #[default]
    Mae,
    /// Mean of (a - b)^2.
    Mse,
}

/// Paints drawings, as RGB on their background or as RGBA on nothing.
///
/// RGBA is planar and premultiplied, as [`RgbaImage`](crate::image::RgbaImage) is: red x alpha, green x alpha, blue x alpha,
/// alpha. Where nothing covers a pixel it is transparent, all four are 0; the background of the drawing is not looked at and
/// gets no gradient. [`RgbaImage::on`](crate::image::RgbaImage::on) a background is the RGB image on that background.
pub trait Renderer<T: Real> {
    /// Memory kept between calls; after the first call of a size nothing is allocated.
    type Scratch: Default + Send;

    /// Paints `drawing` into planar `image` (3 x height x width).
    ///
    /// *Derivative*: [`Self::render_vjp`].
    ///
    /// # Errors
    /// [`RenderError`] if a number is not finite, a slice has the wrong length or a setting is out of range.
    fn render(
        &self,
        drawing: &Drawing<T>,
        size: ImageSize,
        scratch: &mut Self::Scratch,
        image: &mut [T],
    ) -> Result<(), RenderError>;

    /// Adds to `grad` the gradient of sum(grad_image x image) with respect to the drawing. Renders again as needed: no
    /// earlier call of [`Self::render`] is assumed.
    ///
    /// # Errors
    /// As [`Self::render`].
    fn render_vjp(
        &self,
        drawing: &Drawing<T>,
        size: ImageSize,
        scratch: &mut Self::Scratch,
        grad_image: &[T],
        grad: &mut DrawingGrad<T>,
    ) -> Result<(), RenderError>;

    /// Paints `drawing` without its background into planar, premultiplied `image` (4 x height x width).
    ///
    /// *Derivative*: [`Self::render_rgba_vjp`].
    ///
    /// # Errors
    /// As [`Self::render`].
    fn render_rgba(
        &self,
        drawing: &Drawing<T>,
        size: ImageSize,
        scratch: &mut Self::Scratch,
        image: &mut [T],
    ) -> Result<(), RenderError>;

    /// Adds to `grad` the gradient of sum(grad_image x image) with respect to the drawing, image as
    /// [`Self::render_rgba`] paints it: with respect to the premultiplied values. Nothing is added for the background.
    ///
    /// # Errors
    /// As [`Self::render`].
    fn render_rgba_vjp(
        &self,
        drawing: &Drawing<T>,
        size: ImageSize,
        scratch: &mut Self::Scratch,
        grad_image: &[T],
        grad: &mut DrawingGrad<T>,
    ) -> Result<(), RenderError>;

    /// The pixel loss against `target`: an RGB image, or an RGBA image, whose four premultiplied channels are then compared
    /// with those of [`Self::render_rgba`] and count alike.
    ///
    /// *Derivative*: [`Self::loss_and_grad`].
    ///
    /// # Errors
    /// As [`Self::render`].
    fn loss<const N: usize>(
        &self,
        drawing: &Drawing<T>,
        target: ImageView<'_, T, N>,
        loss: PixelLoss,
        scratch: &mut Self::Scratch,
    ) -> Result<T, RenderError>;

    /// As [`Self::loss`]; adds the loss's gradient to `grad`.
    ///
    /// # Errors
    /// As [`Self::render`].
    fn loss_and_grad<const N: usize>(
        &self,
        drawing: &Drawing<T>,
        target: ImageView<'_, T, N>,
        loss: PixelLoss,
        scratch: &mut Self::Scratch,
        grad: &mut DrawingGrad<T>,
    ) -> Result<T, RenderError>;
}

/// Why a drawing was not painted.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RenderError {
    /// A number of the drawing is NaN or infinite.
    NotFinite {
        /// What it belongs to.
        what: &'static str,
        /// The object, if it belongs to one.
        object: Option<usize>,
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
    /// `starts` does not begin at 0 or falls.
    Starts,
    /// A place where a ring begins lies before the last one or behind all vertices.
    Breaks {
        /// Which of the `breaks`.
        index: usize,
        /// The vertex that it names.
        start: usize,
        /// Smallest that it may name: the one named before.
        least: usize,
        /// Largest that it may name: the number of vertices.
        most: usize,
    },
    /// A color ramp has no stops, or its offsets fall, or it is not where the ramps of a drawing must be: rising by object, each
    /// with the stops behind those of the ramp before.
    Ramp {
        /// The object that it is to paint.
        object: usize,
    },
    /// A setting is out of range.
    Setting {
        /// Which setting.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        must: &'static str,
    },
}

impl core::fmt::Display for RenderError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NotFinite { what, object: Some(k) } => write!(f, "{what} of object {k} is NaN or infinite"),
            Self::NotFinite { what, object: None } => write!(f, "{what} is NaN or infinite"),
            Self::Length { what, expected, len } => write!(f, "{what} has {len} values, needs {expected}"),
            Self::Starts => write!(f, "starts must begin at 0 and never fall"),
            Self::Breaks { index, start, least, most } => write!(
                f,
                "break {index} says that a ring begins at vertex {start}, needs one from {least} to {most}: breaks never fall \
                 and count the vertices of all objects; Drawing::push_rings writes them"
            ),
            Self::Ramp { object } => write!(
                f,
                "the color ramp of object {object} needs stops whose offsets never fall, one ramp per object, in the order of the \
                 objects; Drawing::paint_last writes it"
            ),
            Self::Setting { what, value, must } => write!(f, "{what} is {value}, must be {must}"),
        }
    }
}

impl core::error::Error for RenderError {}
