//! Scenes to images with a renderer chosen by name.

use clap::ValueEnum;
use dvp_core::image::{RGBA_CHANNELS, RgbaImage};
use dvp_core::render::{
    ContourRenderer, ExactArea, ExactRenderer, HardMask, HardRenderer, RenderError, Renderer, SoftTriangles,
    TriangleRenderer,
};
use dvp_core::shape::{Flattening, OUTLINE_TOLERANCE, OutlineBasis, REFERENCE_VERTICES, ShapeError};
use dvp_core::{Drawing, Image, ImageSize, Real, Scene};

/// How far painted polygons stray at most from curves, pixels: the edges of pixels have steps of 1/256.
const TOLERANCE_PX: f64 = 1.0 / 128.0;

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

/// Memory of [`Painter::paint_in`], kept between images.
#[derive(Debug, Default)]
pub struct PaintScratch<T: Real> {
    image: Option<Image<T>>,
    contour: <ContourRenderer<T> as Renderer<T>>::Scratch,
    triangles: <TriangleRenderer<T> as Renderer<T>>::Scratch,
    exact: <ExactRenderer as Renderer<T>>::Scratch,
    hard: <HardRenderer as Renderer<T>>::Scratch,
}

impl Painter {
    /// The scene's outlines for a picture of `size`: polygons at most 1/128 px from curves that are no descriptors.
    ///
    /// # Errors
    /// [`PaintError::Shape`] for fewer than 4 vertices.
    pub fn draw<T: Real>(&self, scene: &Scene<T>, size: ImageSize) -> Result<Drawing<T>, PaintError> {
        // No coarser in large pictures.
        let tolerance = OUTLINE_TOLERANCE.min(TOLERANCE_PX / f64::of_usize(size.unit_px()));
        let mut drawing = Drawing::default();
        let basis = OutlineBasis::new(self.vertices, scene.harmonic_count().max(1))?;
        scene.draw(Flattening::new(&basis, T::of(tolerance)), &mut drawing)?;
        Ok(drawing)
    }

    /// The scene's image.
    ///
    /// # Errors
    /// [`PaintError`] if a number is out of the renderer's range.
    pub fn paint<T: Real>(&self, scene: &Scene<T>, size: ImageSize) -> Result<Image<T>, PaintError> {
        let mut image = Image::zeros(size);
        self.paint_to(scene, &mut image, &mut PaintScratch::default())?;
        Ok(image)
    }

    /// The scene's image, in the memory of the images before.
    ///
    /// # Errors
    /// As [`Self::paint`].
    pub fn paint_in<'a, T: Real>(
        &self,
        scene: &Scene<T>,
        size: ImageSize,
        scratch: &'a mut PaintScratch<T>,
    ) -> Result<&'a Image<T>, PaintError> {
        let last = scratch.image.take().filter(|image| image.size() == size);
        let mut image = last.unwrap_or_else(|| Image::zeros(size));
        self.paint_to(scene, &mut image, scratch)?;
        Ok(scratch.image.insert(image))
    }

    /// The scene's image on nothing: clear where no object is.
    ///
    /// # Errors
    /// As [`Self::paint`].
    pub fn paint_rgba<T: Real>(&self, scene: &Scene<T>, size: ImageSize) -> Result<RgbaImage<T>, PaintError> {
        let mut image = RgbaImage::transparent(size);
        self.paint_to(scene, &mut image, &mut PaintScratch::default())?;
        Ok(image)
    }

    fn paint_to<T: Real, const N: usize>(
        &self,
        scene: &Scene<T>,
        image: &mut Image<T, N>,
        scratch: &mut PaintScratch<T>,
    ) -> Result<(), PaintError> {
        let drawing = self.draw(scene, image.size())?;
        let compositing = scene.compositing;
        match self.renderer {
            RendererName::Contour => {
                let renderer = ContourRenderer::new(scene.edge, compositing);
                paint_with(&renderer, &drawing, image, &mut scratch.contour)
            }
            RendererName::Triangles => {
                let coverage = SoftTriangles { edge: scene.edge, ..SoftTriangles::default() };
                paint_with(&TriangleRenderer { coverage, compositing }, &drawing, image, &mut scratch.triangles)
            }
            RendererName::Exact => {
                paint_with(&ExactRenderer { coverage: ExactArea, compositing }, &drawing, image, &mut scratch.exact)
            }
            RendererName::Hard => {
                paint_with(&HardRenderer { coverage: HardMask, compositing }, &drawing, image, &mut scratch.hard)
            }
        }
    }
}

/// Paints with a renderer, on the background or, into an image with alpha, on nothing.
fn paint_with<T: Real, R: Renderer<T>, const N: usize>(
    renderer: &R,
    drawing: &Drawing<T>,
    image: &mut Image<T, N>,
    scratch: &mut R::Scratch,
) -> Result<(), PaintError> {
    let (size, pixels) = (image.size(), image.data_mut());
    if N == RGBA_CHANNELS {
        renderer.render_rgba(drawing, size, scratch, pixels)?;
    } else {
        renderer.render(drawing, size, scratch, pixels)?;
    }
    Ok(())
}
