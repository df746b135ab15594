use dvp_core::render::{EdgeProfile, PixelLoss};
use dvp_core::shape::mdshr_bank;
use dvp_core::tensor::{Host, HostDevice, Tensor};
use dvp_core::{Image, ImageSize, Object, Pose, Real, Scene};

use super::*;
use crate::error::NetError;
use crate::initial::initial_weights;
use crate::layers::Phase;
use crate::model::{Latents, Model, ModelConfig};
use crate::scene_steps::{SceneSteps, image_tensor};
use crate::weights::{Weights, asked};

const HARMONICS: usize = 8;

/// A tiny model that has learned nothing, its painter, and a picture of a heart.
fn parts<T: Real>() -> (ModelConfig, Model<Host>, SceneSteps<T>, Image<T>) {
    let (config, bank) = (ModelConfig::tiny(), mdshr_bank::<T>(HARMONICS));
    let asked = asked::<Host, _>(&HostDevice, |weights| Model::load(&config, &bank, weights)).unwrap();
    let weights = initial_weights(&asked, 3, T::DTYPE, &HostDevice).unwrap();
    let model = Model::load(&config, &bank, &Weights::new(&weights).frozen()).unwrap();
    let painter = SceneSteps::new(config.objects(), HARMONICS, EdgeProfile::reference()).unwrap();
    let pose = Pose { translation: [T::of(0.4), T::of(0.6)], scale: T::of(0.25), rotation: T::of(0.5) };
    let heart =
        Object::of_efd(pose, [T::of(0.9), T::of(0.2), T::of(0.1)], T::one(), bank.prototypes()[0].clone(), Some(0));
    let scene = Scene { objects: vec![heart], ..Scene::empty([T::of(0.2), T::of(0.3), T::of(0.4)]) };
    let image = painter.paint(&scene, ImageSize::new(32, 32).unwrap()).unwrap();
    (config, model, painter, image)
}

fn start<T: Real>(config: &ModelConfig, seed: u64) -> Latents<Host> {
    random_latents(config, seed, T::DTYPE, &HostDevice).unwrap()
}

#[test]
fn the_loss_falls_and_the_best_is_kept() {
    let (config, model, painter, image) = parts::<f32>();
    let looked = model.features(&image_tensor(core::slice::from_ref(&image), &HostDevice).unwrap()).unwrap();
    let looked = model.latents(&looked, Phase::Inference).unwrap().0;
    for start in [looked, start::<f32>(&config, 1)] {
        let settings = OptZ { steps: 30, ..OptZ::default() };
        let found = settings.run(&model, &painter, &image, &start).unwrap();
        assert_eq!((found.losses.len(), found.scene.objects.len()), (31, config.objects()));
        assert!(found.loss < 0.8 * found.losses[0], "{:?}", found.losses);
        let least = found.losses.iter().copied().fold(f64::INFINITY, f64::min);
        assert_eq!(found.loss.to_bits(), least.to_bits());
        // The scene is that of the smallest loss, not the last one.
        let painted = painter.paint(&found.scene, image.size()).unwrap();
        let mae = painted.data().iter().zip(image.data()).map(|(a, b)| f64::from((a - b).abs())).sum::<f64>();
        let mae = mae / image.data().len() as f64;
        assert!((mae - found.loss).abs() < 1e-5, "{mae}, {}", found.loss);
    }
}

#[test]
fn a_seed_gives_the_same_numbers_and_no_step_the_start() {
    let (config, model, painter, image) = parts::<f32>();
    let settings = OptZ { steps: 3, ..OptZ::default() };
    let run = |settings: OptZ, seed| settings.run(&model, &painter, &image, &start::<f32>(&config, seed)).unwrap();
    assert_eq!(run(settings, 7), run(settings, 7));
    assert_ne!(run(settings, 7).losses, run(settings, 8).losses);
    let still = run(OptZ { steps: 0, ..settings }, 7);
    assert_eq!(still.losses, run(settings, 7).losses[..1]);
}

#[test]
fn random_latents_are_standard_normal() {
    let mut config = ModelConfig::tiny();
    (config.transformer.num_queries, config.transformer.d_model) = (100, 100);
    let latents = start::<f64>(&config, 2);
    // Of 10^4 numbers the mean is known to 0.01, the variance to 0.014, the share within 1 (0.6827) to 0.005.
    let values = latents.objects.to_f64().unwrap();
    let mean = |f: &dyn Fn(f64) -> f64| values.iter().map(|&x| f(x)).sum::<f64>() / values.len() as f64;
    let inside = mean(&|x| if x.abs() < 1.0 { 1.0 } else { 0.0 });
    assert!(mean(&|x| x).abs() < 0.04 && (mean(&|x| x * x) - 1.0).abs() < 0.05 && (inside - 0.6827).abs() < 0.02);
    // That of the image is the mean of the slots': the first number of each.
    let first = values.iter().step_by(100).sum::<f64>() / 100.0;
    assert!((latents.image.to_f64().unwrap()[0] - first).abs() < 1e-12);
}

#[test]
fn the_gradient_is_that_of_the_image_loss() {
    let (config, model, painter, image) = parts::<f64>();
    let start = start::<f64>(&config, 5);
    let loss = |latents: &Latents<Host>| {
        painter.image_loss(&model.scenes::<f64>(latents).unwrap(), vec![image.clone()], PixelLoss::Mae).unwrap()
    };
    let free = Latents { objects: start.objects.parameter().unwrap(), image: start.image.parameter().unwrap() };
    let gradients = loss(&free).backward().unwrap();
    let mut largest = 0.0_f64;
    for (which, lanes) in [(0, [0, 37, 101, 255]), (1, [0, 3, 17, 31])] {
        let tensor = |latents: &Latents<Host>| [latents.objects.clone(), latents.image.clone()][which].clone();
        let gradient = gradients.of(&tensor(&free)).unwrap().to_f64().unwrap();
        let at = |lane: usize, step: f64| {
            let mut values = tensor(&start).to_f64().unwrap();
            values[lane] += step;
            let moved = Tensor::new(values, tensor(&start).dims().extents(), &HostDevice).unwrap();
            let mut latents = start.clone();
            *[&mut latents.objects, &mut latents.image][which] = moved;
            loss(&latents).number().unwrap()
        };
        for lane in lanes {
            let differences = (at(lane, 1e-6) - at(lane, -1e-6)) / 2e-6;
            let error = (gradient[lane] - differences).abs();
            assert!(error < 1e-8, "{which}, lane {lane}: {} but {differences}", gradient[lane]);
            largest = largest.max(differences.abs());
        }
    }
    assert!(largest > 1e-4, "there is a gradient: {largest}");
}

#[test]
fn a_start_that_is_no_number_is_refused() {
    let (config, model, painter, image) = parts::<f32>();
    let values = vec![f32::NAN; config.objects() * config.transformer.d_model];
    let objects = Tensor::new(values, &[1, config.objects(), config.transformer.d_model], &HostDevice).unwrap();
    let start = Latents::of_objects(objects).unwrap();
    let refused = OptZ::default().run(&model, &painter, &image, &start).unwrap_err();
    assert!(matches!(refused, NetError::Tensor(_) | NetError::NotFinite { step: 0, .. }), "{refused}");
}
