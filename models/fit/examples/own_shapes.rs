//! Shapes of one's own: a bank made from outlines, by which objects are then told apart, with their angles.
//!
//! `cargo run --release -p dvp-fit --example own_shapes`

#![expect(clippy::print_stdout, reason = "shows what was found")]

use core::error::Error;

use dvp_core::render::{ContourRenderer, Renderer};
use dvp_core::shape::OutlineBasis;
use dvp_core::{Drawing, Efd, Image, ImageSize, Object, Pose, Scene};
use dvp_fit::{Bank, FitOptions, fit_image};

/// Harmonics that a shape is told by.
const HARMONICS: usize = 16;

/// An arrow that points right, and an L; any polygon, or contour of a mask, will do.
const OUTLINES: [(&str, &[[f32; 2]]); 2] = [
    ("arrow", &[[-1.0, -0.3], [0.2, -0.3], [0.2, -0.8], [1.0, 0.0], [0.2, 0.8], [0.2, 0.3], [-1.0, 0.3]]),
    ("angle", &[[-0.8, -0.8], [-0.2, -0.8], [-0.2, 0.4], [0.8, 0.4], [0.8, 1.0], [-0.8, 1.0]]),
];

fn bank() -> Result<Bank<f32>, Box<dyn Error>> {
    let mut prototypes = Vec::new();
    for (name, outline) in OUTLINES {
        // Descriptors do not change with where the outline is begun, how large it is and how it is turned.
        let (efd, _center) = Efd::from_contour(outline, HARMONICS)?;
        prototypes.push((name.to_owned(), efd.normalize()?.efd));
    }
    Ok(Bank::new(prototypes))
}

fn picture(bank: &Bank<f32>) -> Result<(Scene<f32>, Image<f32>), Box<dyn Error>> {
    let mut scene = Scene::empty([0.1, 0.1, 0.2]);
    let objects = [(0, [0.3, 0.35], 0.8, [0.9, 0.8, 0.1]), (1, [0.72, 0.6], -0.5, [0.4, 0.8, 0.9])];
    for (prototype, translation, rotation, color) in objects {
        let pose = Pose { translation, scale: 0.15, rotation };
        let shape = bank.prototypes[prototype].1.clone();
        scene.objects.push(Object::of_efd(pose, color, 1.0, shape, Some(prototype)));
    }
    let mut drawing = Drawing::default();
    scene.draw(&OutlineBasis::new(64, HARMONICS)?, &mut drawing)?;
    let size = ImageSize::new(128, 128)?;
    let mut image = Image::zeros(size);
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    renderer.render(&drawing, size, &mut Default::default(), image.data_mut())?;
    Ok((scene, image))
}

fn main() -> Result<(), Box<dyn Error>> {
    let bank = bank()?;
    let (truth, image) = picture(&bank)?;
    let options = FitOptions::default().with_bank(Some(bank.clone()));
    let fit = fit_image(image.view(), &options)?;
    for object in &fit.scene.objects {
        let name = object.prototype().map_or("no shape of the bank", |index| &bank.prototypes[index].0);
        let Pose { translation: [x, y], scale, rotation } = object.pose;
        println!("{name} at ({x:.3}, {y:.3}), size {scale:.3}, turned by {rotation:.3} rad");
    }
    // Objects may come in any order.
    let is_found = |truly: &Object<f32>| {
        fit.scene.objects.iter().any(|object| {
            let apart = [0, 1].map(|k| object.pose.translation[k] - truly.pose.translation[k]);
            object.prototype() == truly.prototype() && apart[0].hypot(apart[1]) < 0.005
        })
    };
    if truth.objects.iter().all(is_found) { Ok(()) } else { Err("an object was not found as what it is".into()) }
}
