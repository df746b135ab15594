//! Scenes to images with the contour renderer: what a fit compares with a picture, and what is shown of it.

use dvp_core::image::{RGBA_CHANNELS, RgbaImage};
use dvp_core::render::{ContourRenderer, RenderError, Renderer};
use dvp_core::shape::{Flattening, OUTLINE_TOLERANCE, OutlineBasis, REFERENCE_VERTICES, ShapeError};
use dvp_core::{Drawing, Image, ImageSize, Real, Scene};

use crate::FitError;

/// How far painted polygons stray at most from curves, pixels: the edges of pixels have steps of 1/256.
const TOLERANCE_PX: f64 = 1.0 / 128.0;

/// The scene's outlines for a picture of `size`: descriptors with so many `vertices`, the repeated one counted; polygons at most
/// 1/128 px from all other curves.
///
/// # Errors
/// [`ShapeError`] for fewer than 4 vertices, or if the numbers of an object describe no shape.
pub fn drawing_of<T: Real>(scene: &Scene<T>, size: ImageSize, vertices: usize) -> Result<Drawing<T>, ShapeError> {
    // No coarser in large pictures.
    let tolerance = OUTLINE_TOLERANCE.min(TOLERANCE_PX / f64::of_usize(size.unit_px()));
    let mut drawing = Drawing::default();
    let basis = OutlineBasis::new(vertices, scene.harmonic_count().max(1))?;
    scene.draw(Flattening::new(&basis, T::of(tolerance)), &mut drawing)?;
    Ok(drawing)
}

/// An image to paint on, kept from scene to scene.
#[derive(Debug, Default)]
pub struct Canvas<T: Real> {
    image: Option<Image<T>>,
    scratch: <ContourRenderer<T> as Renderer<T>>::Scratch,
}

impl<T: Real> Canvas<T> {
    /// The image of a scene, by its own edge profile, with the drawing that was painted.
    ///
    /// # Errors
    /// [`FitError::Shape`] and [`FitError::Render`] if a number of the scene is out of range.
    #[inline(never)]
    pub fn paint(&mut self, scene: &Scene<T>, size: ImageSize) -> Result<(&Image<T>, Drawing<T>), FitError> {
        let drawing = drawing_of(scene, size, REFERENCE_VERTICES)?;
        let mut image = self.image.take().filter(|image| image.size() == size).unwrap_or_else(|| Image::zeros(size));
        self.paint_to(scene, &drawing, &mut image)?;
        Ok((self.image.insert(image), drawing))
    }

    /// Paints a drawing of the scene: on its background, or, into an image with alpha, on nothing.
    ///
    /// # Errors
    /// [`RenderError`] if a number is out of the renderer's range.
    #[inline(never)]
    pub fn paint_to<const N: usize>(
        &mut self,
        scene: &Scene<T>,
        drawing: &Drawing<T>,
        image: &mut Image<T, N>,
    ) -> Result<(), RenderError> {
        let renderer = ContourRenderer::new(scene.edge, scene.compositing);
        let (size, pixels) = (image.size(), image.data_mut());
        if N == RGBA_CHANNELS {
            renderer.render_rgba(drawing, size, &mut self.scratch, pixels)
        } else {
            renderer.render(drawing, size, &mut self.scratch, pixels)
        }
    }

    /// The image of a scene on nothing: clear where no object is.
    ///
    /// # Errors
    /// As [`Self::paint`].
    pub fn paint_rgba(&mut self, scene: &Scene<T>, size: ImageSize) -> Result<RgbaImage<T>, FitError> {
        let mut image = RgbaImage::transparent(size);
        self.paint_to(scene, &drawing_of(scene, size, REFERENCE_VERTICES)?, &mut image)?;
        Ok(image)
    }
}
