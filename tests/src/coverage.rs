//! Coverage of one object by any model, and its gradient, through the renderer.

use core::fmt::Debug;

use dvp_core::render::{Compositing, CoverageModel, RenderError, Renderer, TileRenderer};
use dvp_core::shape::Rings;
use dvp_core::{Drawing, DrawingGrad, ImageSize, Real};

/// A drawing of one red, fully confident outline on black; the outline in pixels from the upper left corner of the image.
pub fn drawing<T: Real>(outline_px: &[[T; 2]], size: ImageSize) -> Drawing<T> {
    drawing_of_rings(Rings::one(outline_px), size)
}

/// As [`drawing`], of several rings.
pub fn drawing_of_rings<T: Real>(rings_px: Rings<'_, T>, size: ImageSize) -> Drawing<T> {
    let unit = T::of_usize(size.unit_px());
    let (zero, one) = (T::zero(), T::one());
    let vertices: Vec<_> = rings_px.vertices.iter().map(|v| v.map(|x| x / unit)).collect();
    let mut drawing = Drawing::default();
    drawing.push_rings(Rings { vertices: &vertices, ..rings_px }, [one, zero, zero], one);
    drawing
}

/// Coverage of an outline, height x width; the outline in pixels from the upper left corner of the image.
///
/// # Errors
/// As the renderer's.
pub fn coverage<T: Real, C: CoverageModel<T> + Debug>(
    model: C,
    outline_px: &[[T; 2]],
    size: ImageSize,
) -> Result<Vec<T>, RenderError> {
    coverage_of_rings(model, Rings::one(outline_px), size)
}

/// As [`coverage`], of several rings.
///
/// # Errors
/// As the renderer's.
pub fn coverage_of_rings<T: Real, C: CoverageModel<T> + Debug>(
    model: C,
    rings_px: Rings<'_, T>,
    size: ImageSize,
) -> Result<Vec<T>, RenderError> {
    let renderer = TileRenderer { coverage: model, compositing: Compositing::Over };
    let mut coverage = vec![T::zero(); size.pixels()];
    let mut scratch = Default::default();
    renderer.object_coverage(&drawing_of_rings(rings_px, size), size, &mut scratch, &mut coverage)?;
    Ok(coverage)
}

/// Gradient of sum(cotangent x coverage) with respect to the vertices, per pixel of movement.
///
/// # Errors
/// As the renderer's.
pub fn coverage_vjp<C: CoverageModel<f64> + Debug>(
    model: C,
    outline_px: &[[f64; 2]],
    size: ImageSize,
    cotangent: &[f64],
) -> Result<Vec<[f64; 2]>, RenderError> {
    coverage_vjp_of_rings(model, Rings::one(outline_px), size, cotangent)
}

/// As [`coverage_vjp`], of several rings.
///
/// # Errors
/// As the renderer's.
pub fn coverage_vjp_of_rings<C: CoverageModel<f64> + Debug>(
    model: C,
    rings_px: Rings<'_, f64>,
    size: ImageSize,
    cotangent: &[f64],
) -> Result<Vec<[f64; 2]>, RenderError> {
    let renderer = TileRenderer { coverage: model, compositing: Compositing::Over };
    let drawing = drawing_of_rings(rings_px, size);
    let mut grad = DrawingGrad::default();
    grad.reset(&drawing);
    // Painted over black, the red channel is the coverage.
    let mut grad_image = cotangent.to_vec();
    grad_image.resize(3 * size.pixels(), 0.0);
    renderer.render_vjp(&drawing, size, &mut Default::default(), &grad_image, &mut grad)?;
    let unit = f64::of_usize(size.unit_px());
    Ok(grad.vertices.iter().map(|v| v.map(|g| g / unit)).collect())
}
