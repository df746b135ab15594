//! How far Adam comes.

use anyhow::Result;
use dvp_core::render::contour::ContourRenderer;
use dvp_core::render::{PixelLoss, Renderer};
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES};
use dvp_core::{Drawing, Image, ImageSize, Scene};
use dvp_fit::adam::descent::{Descent, Stage};
use dvp_fit::parameters::Free;

use super::cosine::HARMONICS;

/// Steps and learning rate of the paper's optimizers.
const STEPS: usize = 100;
const LEARNING_RATE: f64 = 0.01;

/// Mean squared error of the image of `moved` against that of `truth`, before and after Adam on all but confidences.
pub(super) fn descend(truth: &Scene<f32>, moved: &Scene<f32>, size: ImageSize) -> Result<[f64; 2]> {
    let renderer = ContourRenderer::new(truth.edge, truth.compositing);
    let mut descent = Descent::new(&renderer, REFERENCE_VERTICES, HARMONICS)?;
    let [mut image, mut painted] = [Image::zeros(size), Image::zeros(size)];
    let mut drawing = Drawing::default();
    truth.draw(&OutlineBasis::new(REFERENCE_VERTICES, HARMONICS)?, &mut drawing)?;
    renderer.render(&drawing, size, &mut Default::default(), image.data_mut())?;
    let mut error = |descent: &mut Descent<'_, f32, _>, scene: &Scene<f32>| -> Result<f64> {
        descent.paint(scene, image.view(), painted.data_mut())?;
        let squares = painted.data().iter().zip(image.data()).map(|(a, b)| f64::from(a - b).powi(2));
        Ok(squares.sum::<f64>() / painted.data().len() as f64)
    };
    let mut scene = moved.clone();
    let free =
        if std::env::var("FREE").as_deref() == Ok("pose") { Free::PoseAndColor } else { Free::PoseColorAndShape };
    let learning_rate = std::env::var("LR").map_or(LEARNING_RATE, |v| v.parse().unwrap());
    let loss = if std::env::var("LOSS").as_deref() == Ok("mae") { PixelLoss::Mae } else { PixelLoss::Mse };
    if std::env::var("CONF").is_ok() {
        scene.objects.iter_mut().zip(&truth.objects).for_each(|(a, b)| a.confidence = b.confidence);
    }
    if std::env::var("TRUESHAPE").is_ok() {
        scene.objects.iter_mut().zip(&truth.objects).for_each(|(a, b)| a.shape = b.shape.clone());
    }
    let before = error(&mut descent, &scene)?;
    let stage = Stage { steps: STEPS, learning_rate, free, loss, contour_length: 0.0 };
    descent.run(image.view(), &mut scene, &stage)?;
    Ok([before, error(&mut descent, &scene)?])
}
