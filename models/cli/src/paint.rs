//! Scenes to images with a renderer chosen by name.

use clap::ValueEnum;
use dvp_core::render::{
    ContourRenderer, ExactArea, ExactRenderer, HardMask, HardRenderer, RenderError, Renderer, SoftTriangles,
    TriangleRenderer,
};
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES, ShapeError};
use dvp_core::{Drawing, Image, ImageSize, Real, Scene};

/// The renderers of the command.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
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
    /// The scene's outlines.
    ///
    /// # Errors
    /// [`PaintError::Shape`] for fewer than 4 vertices.
    pub fn draw<T: Real>(&self, scene: &Scene<T>) -> Result<Drawing<T>, PaintError> {
        let mut drawing = Drawing::default();
        scene.draw(&OutlineBasis::new(self.vertices, scene.harmonic_count().max(1))?, &mut drawing)?;
        Ok(drawing)
    }

    /// The scene's image.
    ///
    /// # Errors
    /// [`PaintError`] if a number is out of the renderer's range.
    pub fn paint<T: Real>(&self, scene: &Scene<T>, size: ImageSize) -> Result<Image<T>, PaintError> {
        let drawing = self.draw(scene)?;
        let compositing = scene.compositing;
        match self.renderer {
            RendererName::Contour => paint_with(&ContourRenderer::new(scene.edge, compositing), &drawing, size),
            RendererName::Triangles => {
                let coverage = SoftTriangles { edge: scene.edge, ..SoftTriangles::default() };
                paint_with(&TriangleRenderer { coverage, compositing }, &drawing, size)
            }
            RendererName::Exact => paint_with(&ExactRenderer { coverage: ExactArea, compositing }, &drawing, size),
            RendererName::Hard => paint_with(&HardRenderer { coverage: HardMask, compositing }, &drawing, size),
        }
    }
}

fn paint_with<T: Real, R: Renderer<T>>(
    renderer: &R,
    drawing: &Drawing<T>,
    size: ImageSize,
) -> Result<Image<T>, PaintError> {
    let mut image = Image::zeros(size);
    renderer.render(drawing, size, &mut R::Scratch::default(), image.data_mut())?;
    Ok(image)
}
