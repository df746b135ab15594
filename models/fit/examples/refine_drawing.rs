//! A drawing that is nearly right, moved to where it explains a picture best: every number of every shape, pose and color.
//!
//! `cargo run --release -p dvp-fit --example refine_drawing`

#![expect(clippy::print_stdout, reason = "shows what was moved")]

use core::error::Error;

use dvp_core::render::{Compositing, ContourRenderer, Renderer};
use dvp_core::scene::Paint;
use dvp_core::shape::{OutlineBasis, RegularPolygon, Star};
use dvp_core::{AnyShape, Drawing, Image, ImageSize, Object, Pose, Scene};
use dvp_fit::scene_refine::SceneRefine;

/// A hexagon and a star: their places, radii and colors.
fn drawing(places: [[f32; 2]; 2], radii: [f32; 3], colors: [[f32; 3]; 2]) -> Result<Scene<f32>, Box<dyn Error>> {
    let shapes = [
        AnyShape::RegularPolygon(RegularPolygon::new(6, radii[0])?),
        AnyShape::Star(Star::new(5, radii[1], radii[2])?),
    ];
    let objects = shapes.into_iter().zip(places).zip(colors).map(|((shape, translation), color)| Object {
        shape,
        pose: Pose { translation, scale: 1.0, rotation: 0.2 },
        paint: Paint::Flat(color),
        confidence: 1.0,
    });
    let objects = objects.collect();
    Ok(Scene { objects, compositing: Compositing::Over, ..Scene::empty([1.0; 3]) })
}

fn paint(scene: &Scene<f32>, size: ImageSize) -> Result<Image<f32>, Box<dyn Error>> {
    let mut drawing = Drawing::default();
    scene.draw(&OutlineBasis::new(64, 1)?, &mut drawing)?;
    let mut image = Image::zeros(size);
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    renderer.render(&drawing, size, &mut Default::default(), image.data_mut())?;
    Ok(image)
}

fn main() -> Result<(), Box<dyn Error>> {
    let truth = drawing([[0.35, 0.4], [0.65, 0.6]], [0.2, 0.22, 0.1], [[0.2, 0.4, 0.7], [0.9, 0.6, 0.1]])?;
    let near = drawing([[0.355, 0.395], [0.645, 0.607]], [0.205, 0.21, 0.107], [[0.25, 0.4, 0.7], [0.9, 0.5, 0.1]])?;
    let image = paint(&truth, ImageSize::new(128, 128)?)?;
    let refined = SceneRefine::default().fit(image.view(), &near)?;
    println!(
        "{} numbers, {} steps: mean squared error {:.1e} -> {:.1e}",
        refined.number_count, refined.steps, refined.start_loss, refined.loss
    );
    for (found, truly) in refined.scene.objects.iter().zip(&truth.objects) {
        println!(
            "{:?} at {:.4?}, drawn {:?} at {:?}",
            found.shape, found.pose.translation, truly.shape, truly.pose.translation
        );
    }
    if refined.loss < 0.01 * refined.start_loss {
        Ok(())
    } else {
        Err("the drawing is not nearer to the picture".into())
    }
}
