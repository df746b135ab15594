//! A step of training in every mode: the same loss and the same gradient of every weight on every backend.

use dvp_core::render::{EdgeProfile, PixelLoss};
use dvp_core::shape::mdshr_bank;
use dvp_core::tensor::Host;
use dvp_core::{ImageSize, Object, Pose, Real, Scene};
use dvp_net::error::NetError;
use dvp_net::layers::Phase;
use dvp_net::model::{Model, ModelConfig};
use dvp_net::scene_steps::SceneSteps;
use dvp_net::train::{Batch, Judge, Mode, Schedule, Trainer};
use dvp_net::weights::Weights;

use crate::check::{Gradients, TOLERANCE_F64, close, close_gradients};
use crate::registry::{Outcome, Tally, Tested, on_every_backend};

/// Harmonics of the shapes.
const HARMONICS: usize = 4;
/// Most by which gradients in f32 may differ: those of a whole network and a loss, not of one operation.
const TOLERANCE_F32: f64 = 1e-5;

/// Two scenes of one and two objects, 32 x 32 pixels.
fn batch<T: Real>(judge: &Judge<T>) -> Batch<T> {
    let bank = mdshr_bank::<T>(HARMONICS);
    let object = |place: f64, shape: usize| {
        let translation = [T::of(place), T::of(0.9 - place)];
        let pose = Pose { translation, scale: T::of(0.14), rotation: T::of(2.0 * place) };
        let efd = bank.prototypes()[shape].clone();
        let color = [T::of(0.9), T::of(place), T::of(0.3)];
        Object { pose, color, confidence: T::one(), efd, prototype: Some(shape) }
    };
    let scene = |objects| Scene { objects, ..Scene::empty([0.2, 0.5, 0.8].map(T::of)) };
    let scenes = vec![scene(vec![object(0.3, 0)]), scene(vec![object(0.6, 1), object(0.25, 2)])];
    let size = ImageSize::new(32, 32).unwrap();
    Batch::new(scenes.iter().map(|scene| judge.steps.paint(scene, size).unwrap()).collect(), scenes)
}

/// The loss of a mode and the gradient of every weight that it depends on.
fn step<B: Tested, T: Real>(mode: Mode) -> Result<(f64, Gradients), NetError> {
    let config = ModelConfig::tiny();
    let bank = mdshr_bank::<T>(HARMONICS);
    let steps = SceneSteps::new(config.objects(), HARMONICS, EdgeProfile::reference())?;
    let judge = Judge { mode, image_loss: PixelLoss::Mae, image_weight: 1.0, steps, bank: bank.clone() };
    let batch = batch(&judge);
    let schedule = Schedule { learning_rate: 1e-3, warm_up: 0, end: None };
    let trainer = Trainer::<B, T>::new(config.clone(), bank.clone(), judge.clone(), schedule, 7, B::place())?;
    let parameters = trainer.parameters();
    let model = Model::load(&config, &bank, &Weights::new(parameters))?;
    let judged = judge.judge(&model, &batch, Phase::Training, &B::place(), 1)?;
    let gradients = parameters.gradients(&judged.loss.backward()?);
    let values = gradients.into_iter().map(|(name, gradient)| Ok((name, gradient.to_f64()?)));
    Ok((judged.loss.number()?, values.collect::<Result<_, NetError>>()?))
}

fn in_precision<B: Tested, T: Real>(tally: &Tally, tolerance: f64) -> Outcome {
    for mode in Mode::ALL {
        let ((own, gradients), (host, expected)) = (step::<B, T>(mode)?, step::<Host, T>(mode)?);
        close(tally, &format!("loss of {mode} in {}", T::DTYPE), &[own], &[host], tolerance)?;
        let moves = expected.iter().flat_map(|(_, gradient)| gradient).any(|gradient| gradient.abs() > 1e-6);
        tally.check(moves, || format!("{mode}: no gradient"))?;
        close_gradients(tally, &format!("{} gradient in {mode}", T::DTYPE), &gradients, &expected, tolerance)?;
    }
    Ok(())
}

fn modes<B: Tested>(tally: &Tally) -> Outcome {
    in_precision::<B, f64>(tally, TOLERANCE_F64)?;
    in_precision::<B, f32>(tally, TOLERANCE_F32)
}

#[test]
fn a_step_of_every_mode_is_the_same_everywhere() {
    on_every_backend!(modes);
}
