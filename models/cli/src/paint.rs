//! Scenes to images with a renderer chosen by name.

use clap::ValueEnum;
use dvp_core::image::{RGBA_CHANNELS, RgbaImage};
use dvp_core::render::{
    ContourRenderer, ExactArea, ExactRenderer, HardMask, HardRenderer, RenderError, Renderer, SoftTriangles,
    TriangleRenderer,
};
use dvp_core::shape::{REFERENCE_VERTICES, ShapeError};
use dvp_core::{Drawing, Image, ImageSize, Real, Scene};
use dvp_fit::paint::drawing_of;

/// The renderers of the command.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
#[non_exhaustive]
pub enum RendererName {
    /// Coverage from the distance to the outline, by the scene's edge profile.
    #[default]
    Contour,
    /// The reference's: coverage from the distance to the outline's triangles, with faint seams.
    Triangles,
    /// Share of each pixel inside the outline; no fattening, no softness.
    Exact,
    /// Pixel centers inside the outline; no anti-aliasing.
    Hard,
}

/// How scenes are painted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Painter {
    /// The renderer.
    pub renderer: RendererName,
    /// Vertices per outline, the repeated one counted.
    pub vertices: usize,
}

impl Default for Painter {
    /// The contour renderer with the reference's 64 vertices.
    fn default() -> Self {
        Self { renderer: RendererName::default(), vertices: REFERENCE_VERTICES }
    }
}

impl From<RendererName> for Painter {
    /// The renderer, with the reference's 64 vertices.
    fn from(renderer: RendererName) -> Self {
        Self { renderer, ..Self::default() }
    }
}

/// Why a scene was not painted.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PaintError {
    /// An outline could not be drawn.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// The renderer refused.
    #[error(transparent)]
    Render(#[from] RenderError),
}

impl Painter {
    /// The scene's outlines for a picture of `size`: polygons at most 1/128 px from curves that are no descriptors.
    ///
    /// # Errors
    /// [`PaintError::Shape`] for fewer than 4 vertices.
    pub fn draw<T: Real>(&self, scene: &Scene<T>, size: ImageSize) -> Result<Drawing<T>, PaintError> {
        Ok(drawing_of(scene, size, self.vertices)?)
    }

    /// The scene's image.
    ///
    /// # Errors
    /// [`PaintError`] if a number is out of the renderer's range.
    pub fn paint<T: Real>(&self, scene: &Scene<T>, size: ImageSize) -> Result<Image<T>, PaintError> {
        let mut image = Image::zeros(size);
        self.paint_to(scene, &mut image)?;
        Ok(image)
    }

    /// The scene's image on nothing: clear where no object is.
    ///
    /// # Errors
    /// As [`Self::paint`].
    pub fn paint_rgba<T: Real>(&self, scene: &Scene<T>, size: ImageSize) -> Result<RgbaImage<T>, PaintError> {
        let mut image = RgbaImage::transparent(size);
        self.paint_to(scene, &mut image)?;
        Ok(image)
    }

    fn paint_to<T: Real, const N: usize>(&self, scene: &Scene<T>, image: &mut Image<T, N>) -> Result<(), PaintError> {
        let drawing = self.draw(scene, image.size())?;
        let compositing = scene.compositing;
        match self.renderer {
            RendererName::Contour => {
                let renderer = ContourRenderer::new(scene.edge, compositing);
                paint_with(&renderer, &drawing, image)
            }
            RendererName::Triangles => {
                let coverage = SoftTriangles { edge: scene.edge, ..SoftTriangles::default() };
                paint_with(&TriangleRenderer { coverage, compositing }, &drawing, image)
            }
            RendererName::Exact => paint_with(&ExactRenderer { coverage: ExactArea, compositing }, &drawing, image),
            RendererName::Hard => paint_with(&HardRenderer { coverage: HardMask, compositing }, &drawing, image),
        }
    }
}

/// Paints with a renderer, on the background or, into an image with alpha, on nothing.
fn paint_with<T: Real, R: Renderer<T>, const N: usize>(
    renderer: &R,
    drawing: &Drawing<T>,
    image: &mut Image<T, N>,
) -> Result<(), PaintError> {
    let (size, pixels, scratch) = (image.size(), image.data_mut(), &mut R::Scratch::default());
    if N == RGBA_CHANNELS {
        renderer.render_rgba(drawing, size, scratch, pixels)?;
    } else {
        renderer.render(drawing, size, scratch, pixels)?;
    }
    Ok(())
}
