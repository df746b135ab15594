//! One image to its objects, with what the fit knows of them and what it doubts.
//!
//! `cargo run --release -p dvp-fit --example fit_picture`

#![expect(clippy::print_stdout, reason = "shows what was found")]

use core::error::Error;

use dvp_core::render::{ContourRenderer, Renderer};
use dvp_core::scene::Paint;
use dvp_core::shape::{Circle, OutlineBasis, Rectangle};
use dvp_core::{AnyShape, Drawing, Image, ImageSize, Object, Pose, Scene};
use dvp_fit::{FitOptions, fit_image};

/// A picture of a disk and a rectangle in front of it, as a camera or a file would bring it.
fn picture() -> Result<Image<f32>, Box<dyn Error>> {
    let at = |x, y, rotation| Pose { translation: [x, y], scale: 1.0, rotation };
    let object = |shape, pose, color| Object { shape, pose, paint: Paint::Flat(color), confidence: 1.0 };
    let mut scene = Scene::empty([0.95, 0.93, 0.9]);
    scene.compositing = dvp_core::render::Compositing::Over;
    scene.objects.push(object(AnyShape::Circle(Circle::new(0.2)?), at(0.35, 0.4, 0.0), [0.1, 0.5, 0.3]));
    let bar = AnyShape::Rectangle(Rectangle::new([0.5, 0.14], 0.0)?);
    scene.objects.push(object(bar, at(0.6, 0.6, 0.4), [0.8, 0.2, 0.1]));
    let mut drawing = Drawing::default();
    scene.draw(&OutlineBasis::new(64, 1)?, &mut drawing)?;
    let size = ImageSize::new(128, 128)?;
    let mut image = Image::zeros(size);
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    renderer.render(&drawing, size, &mut Default::default(), image.data_mut())?;
    Ok(image)
}

fn main() -> Result<(), Box<dyn Error>> {
    let image = picture()?;
    // For many images keep a `Fitter` and a `FitScratch`: nothing is then prepared twice.
    let fit = fit_image(image.view(), &FitOptions::default())?;
    for (k, object) in fit.scene.objects.iter().enumerate() {
        let Pose { translation: [x, y], scale, .. } = object.pose;
        // The covariance is that of (x, y, log scale, rotation, log stretch), row by row.
        let deviation = fit.covariance.get(k).map_or(f32::NAN, |covariance| covariance[0].sqrt());
        println!("object {k}: at ({x:.4} +- {deviation:.0e}, {y:.4}), size {scale:.3}, color {:.2?}", object.color());
    }
    println!("mean absolute error {:.5}, {} steps, {:?}", fit.loss, fit.steps, fit.stop);
    println!("open questions: {:?}", fit.ambiguity);
    println!("doubts: {:?}", fit.doubts());
    match fit.scene.objects.len() {
        2 => Ok(()),
        count => Err(format!("{count} objects were found, 2 were drawn").into()),
    }
}
