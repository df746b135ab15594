//! Paints a scene, as a program does that embeds the renderer: no framework, no files. Shows it in the terminal.
//!
//! `cargo run --release -p dvp-core --example paint_scene`

#![expect(clippy::print_stdout, reason = "shows the picture")]

use core::error::Error;

use dvp_core::render::{ContourRenderer, Renderer};
use dvp_core::scene::Paint;
use dvp_core::shape::{Circle, OutlineBasis, Star, mdshr_bank};
use dvp_core::{AnyShape, Drawing, Image, ImageSize, Object, Pose, Scene};

/// From light to dark.
const INKS: &[u8] = b" .:-=+*#%@";

fn main() -> Result<(), Box<dyn Error>> {
    // The shorter side of a picture is 1; x goes right, y down.
    let mut scene = Scene::empty([1.0, 1.0, 1.0]);
    let place = |x, y, scale, rotation| Pose { translation: [x, y], scale, rotation };
    let object = |shape, pose, color| Object { shape, pose, paint: Paint::Flat(color), confidence: 1.0 };
    scene.objects.push(object(AnyShape::Circle(Circle::new(0.22)?), place(0.3, 0.3, 1.0, 0.0), [0.7, 0.7, 0.2]));
    scene.objects.push(object(AnyShape::Star(Star::new(5, 0.25, 0.1)?), place(0.7, 0.62, 1.0, 0.3), [0.1, 0.2, 0.5]));
    // Elliptic Fourier descriptors: any closed outline in a few numbers. This one is a heart.
    let heart = mdshr_bank(16).prototypes()[0].clone();
    scene.objects.push(Object::of_efd(place(0.3, 0.72, 0.12, 0.0), [0.8, 0.3, 0.3], 1.0, heart, None));

    // Shapes become polygons once; a renderer paints polygons. Memory is the caller's, and kept from picture to picture.
    let basis = OutlineBasis::<f32>::new(64, scene.harmonic_count())?;
    let mut drawing = Drawing::default();
    scene.draw(&basis, &mut drawing)?;
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    let size = ImageSize::new(64, 64)?;
    let mut image = Image::zeros(size);
    renderer.render(&drawing, size, &mut Default::default(), image.data_mut())?;

    // Images are planar: all of red, then green, then blue. Letters are twice as high as wide.
    let [red, green, blue] = [0, 1, 2].map(|channel| &image.data()[channel * size.pixels()..][..size.pixels()]);
    for row in (0..size.height()).step_by(2) {
        let ink = |column: usize| {
            let pixel = row * size.width() + column;
            let darkness = 1.0 - (red[pixel] + green[pixel] + blue[pixel]) / 3.0;
            let steps = INKS.iter().enumerate().take_while(|(step, _)| *step as f32 <= darkness * INKS.len() as f32);
            char::from(steps.last().map_or(b' ', |(_, ink)| *ink))
        };
        println!("{}", (0..size.width()).map(ink).collect::<String>());
    }
    Ok(())
}
