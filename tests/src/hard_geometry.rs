//! How fits of the hard scenes of `dvp::generate` are scored at 128 x 128.

#![expect(clippy::unwrap_used, reason = "a failed unwrap is a failed test with a line number")]

use dvp_core::contour::contains;
use dvp_core::metric::Ownership;
use dvp_core::render::{ContourRenderer, Renderer};
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES};
use dvp_core::{Drawing, Image, ImageSize, Scene};

const SIDE: usize = 128;
const HARMONICS: usize = 64;

fn basis() -> OutlineBasis<f32> {
    OutlineBasis::new(REFERENCE_VERTICES, HARMONICS).unwrap()
}

fn draw(scene: &Scene<f32>, basis: &OutlineBasis<f32>) -> Drawing<f32> {
    let mut drawing = Drawing::default();
    scene.draw(basis, &mut drawing).unwrap();
    drawing
}

fn size() -> ImageSize {
    ImageSize::new(SIDE, SIDE).unwrap()
}

/// Pixels whose centers the outline encloses.
fn mask(outline: &[[f32; 2]]) -> Vec<bool> {
    #[expect(clippy::cast_precision_loss, reason = "few pixels")]
    let center = |i: usize| (i as f32 + 0.5) / SIDE as f32;
    (0..SIDE * SIDE).map(|i| contains(outline, [center(i % SIDE), center(i / SIDE)])).collect()
}

/// Whether there are as many objects as in `truth`, and for each one of its own whose mask agrees to the given IoU.
#[must_use]
pub fn all_found(truth: &Scene<f32>, found: &Scene<f32>, iou: f64) -> bool {
    let basis = basis();
    let (expected, drawn) = (draw(truth, &basis), draw(found, &basis));
    if expected.object_count() != drawn.object_count() {
        return false;
    }
    let mut left: Vec<Vec<bool>> = (0..drawn.object_count()).map(|k| mask(drawn.outline(k))).collect();
    (0..expected.object_count()).all(|k| {
        let own = mask(expected.outline(k));
        let best = (0..left.len()).map(|i| (agreement(&own, &left[i]), i)).max_by(|a, b| a.0.total_cmp(&b.0));
        best.filter(|&(value, _)| value >= iou).map(|(_, i)| left.swap_remove(i)).is_some()
    })
}

#[expect(clippy::cast_precision_loss, reason = "few pixels")]
fn agreement(a: &[bool], b: &[bool]) -> f64 {
    let both = a.iter().zip(b).filter(|&(&x, &y)| x && y).count();
    let either = a.iter().zip(b).filter(|&(&x, &y)| x || y).count();
    both as f64 / either.max(1) as f64
}

/// The scene as the reference draws it, without seams.
///
/// # Panics
/// If the scene cannot be drawn.
#[must_use]
pub fn paint(scene: &Scene<f32>) -> Image<f32> {
    let mut image = Image::zeros(size());
    let drawing = draw(scene, &basis());
    ContourRenderer::new(scene.edge, scene.compositing)
        .render(&drawing, size(), &mut Default::default(), image.data_mut())
        .unwrap();
    image
}

/// The pixels each object owns.
///
/// # Panics
/// If the scene cannot be drawn.
#[must_use]
pub fn ownership(scene: &Scene<f32>) -> Ownership {
    let drawing = draw(scene, &basis());
    let mut coverage = vec![0.0; drawing.object_count() * size().pixels()];
    let mut owned = Ownership::default();
    ContourRenderer::new(scene.edge, scene.compositing)
        .object_coverage(&drawing, size(), &mut Default::default(), &mut coverage)
        .unwrap();
    owned.fill(size().pixels(), &coverage, &drawing.confidences).unwrap();
    owned
}

/// The image in steps of 1 / 255.
#[must_use]
pub fn rounded(image: &Image<f32>) -> Image<f32> {
    let mut image = image.clone();
    image.data_mut().iter_mut().for_each(|value| *value = (*value * 255.0).round() / 255.0);
    image
}
