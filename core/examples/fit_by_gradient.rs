//! Fits a scene to an image by gradient, without any framework: Adam on the pose and the color of a heart.
//!
//! `cargo run --release -p dvp-core --example fit_by_gradient`
//!
//! The same lines run on burn and candle: the type of the parameters is all that changes.

#![expect(clippy::print_stdout, reason = "shows how the loss falls")]

use core::error::Error;

use dvp_core::optim::AdamSettings;
use dvp_core::render::{Compositing, ContourRenderer, EdgeProfile, PixelLoss, RenderLossOp, Renderer};
use dvp_core::scene::PoseOp;
use dvp_core::shape::{EfdModel, OutlineBasis, OutlineOp, mdshr_bank};
use dvp_core::tensor::{Adam, Backend, Host, HostDevice, Parameters, Tensor};
use dvp_core::{Drawing, Image, ImageSize, Object, Pose, Scene};

const SIDE: usize = 64;
const VERTICES: usize = 64;
const HARMONICS: usize = 16;
const STEPS: usize = 400;

/// The image that is looked for, and the descriptors of its one object.
fn target() -> Result<(Image<f32>, Vec<f64>), Box<dyn Error>> {
    let heart = mdshr_bank::<f32>(HARMONICS).prototypes()[0].clone();
    let descriptors = heart.rows().as_flattened().iter().map(|&number| f64::from(number)).collect();
    let pose = Pose { translation: [0.58, 0.44], scale: 0.17, rotation: 0.5 };
    let scene = Scene {
        objects: vec![Object::of_efd(pose, [0.9, 0.2, 0.3], 1.0, heart, None)],
        ..Scene::empty([0.9, 0.9, 0.8])
    };
    let mut drawing = Drawing::default();
    scene.draw(&OutlineBasis::new(VERTICES, HARMONICS)?, &mut drawing)?;
    let mut image = Image::zeros(ImageSize::new(SIDE, SIDE)?);
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    renderer.render(&drawing, image.size(), &mut Default::default(), image.data_mut())?;
    Ok((image, descriptors))
}

/// The mean absolute error of the picture that the parameters paint; a batch of one picture with one object.
fn loss<B: Backend>(
    parameters: &Parameters<B>,
    descriptors: &[f64],
    target: &Image<f32>,
) -> Result<Tensor<B>, Box<dyn Error>> {
    let get = |name: &str| parameters.get(name);
    let heart = get("scale")?.like(descriptors.to_vec(), &[1, 1, descriptors.len()])?;
    let model = EfdModel::new(OutlineBasis::new(VERTICES, HARMONICS)?);
    let unit = Tensor::apply::<f32, _>(OutlineOp::new::<f32>(model, 1)?, &[&heart])?;
    let pose = [&unit, get("translation")?, get("scale")?, get("rotation")?];
    let outline = Tensor::apply::<f32, _>(PoseOp::new(1, VERTICES)?, &pose)?;
    let renderer = ContourRenderer::new(EdgeProfile::reference(), Compositing::Blend);
    let paint = RenderLossOp::new(renderer, PixelLoss::Mae, vec![target.clone()], 1, VERTICES)?;
    let there = unit.like(vec![1.0], &[1, 1])?;
    let drawing = [&outline, &get("color")?.sigmoid()?, &there, &get("background")?.sigmoid()?];
    Ok(Tensor::apply::<f32, _>(paint, &drawing)?.mean_all()?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let (target, descriptors) = target()?;
    let mut parameters = Parameters::<Host>::new();
    let start: [(&str, &[usize], Vec<f32>); 5] = [
        ("translation", &[1, 1, 2], vec![0.5, 0.5]),
        ("scale", &[1, 1], vec![0.12]),
        ("rotation", &[1, 1], vec![0.0]),
        // Before the sigmoid: gray, and white.
        ("color", &[1, 1, 3], vec![0.0; 3]),
        ("background", &[1, 3], vec![2.0; 3]),
    ];
    for (name, extents, values) in start {
        parameters.insert(name, &Tensor::new(values, extents, &HostDevice)?)?;
    }
    let mut adam = Adam::new(AdamSettings::default());
    let mut last = f64::INFINITY;
    for step in 0..=STEPS {
        let loss = loss(&parameters, &descriptors, &target)?;
        last = loss.number()?;
        if step % 100 == 0 {
            println!("step {step}: mean absolute error {last:.5}");
        }
        let gradients = parameters.gradients(&loss.backward()?);
        adam.step(&mut parameters, &gradients, 0.02)?;
    }
    for name in ["translation", "scale", "rotation"] {
        println!("{name}: {:.3?}", parameters.get(name)?.to_f64()?);
    }
    if last > 0.01 { Err(format!("the descent ended at {last}, far from the picture").into()) } else { Ok(()) }
}
