//! How far Adam comes.

use anyhow::Result;
use dvp_core::render::contour::ContourRenderer;
use dvp_core::render::{PixelLoss, Renderer};
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES};
use dvp_core::{Drawing, Image, ImageSize, Scene};
use dvp_fit::adam::descent::{Descent, Stage};
use dvp_fit::parameters::Free;

use super::Setting;
use super::cosine::HARMONICS;

/// Steps and learning rate of the paper's optimizers.
const STEPS: usize = 100;
const LEARNING_RATE: f64 = 0.01;

/// Mean squared error of the image of `moved` against that of `truth`, before and after Adam on all but confidences; in the
/// published setting with the true shapes, on pose and color.
pub(super) fn descend(truth: &Scene<f32>, moved: &Scene<f32>, size: ImageSize, setting: Setting) -> Result<[f64; 2]> {
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
    let free = match setting {
        Setting::Ours => Free::PoseColorAndShape,
        Setting::Published => {
            let shapes = scene.objects.iter_mut().zip(&truth.objects);
            shapes.for_each(|(object, truth)| object.shape = truth.shape.clone());
            Free::PoseAndColor
        }
    };
    let before = error(&mut descent, &scene)?;
    let stage = Stage { steps: STEPS, learning_rate: LEARNING_RATE, free, loss: PixelLoss::Mse, contour_length: 0.0 };
    descent.run(image.view(), &mut scene, &stage)?;
    Ok([before, error(&mut descent, &scene)?])
}
