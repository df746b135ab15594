//! A step of training in every mode: the same loss and the same gradient of every weight on every backend, in f64. (In f32
//! gradients of the first layer, sums over all pixels that cancel, were 1.7e-5 apart in mode ti: rounding. `tests/command`
//! holds the losses in f32 together.)

use dvp_core::render::{EdgeProfile, PixelLoss};
use dvp_core::shape::mdshr_bank;
use dvp_core::tensor::Host;
use dvp_core::{ImageSize, Object, Pose, Scene};
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
/// Two scenes of one and two objects, 32 x 32 pixels.
fn batch(judge: &Judge<f64>) -> Batch<f64> {
    let bank = mdshr_bank(HARMONICS);
    let object = |place: f64, shape: usize| {
        let pose = Pose { translation: [place, 0.9 - place], scale: 0.14, rotation: 2.0 * place };
        let efd = bank.prototypes()[shape].clone();
        Object::of_efd(pose, [0.9, place, 0.3], 1.0, efd, Some(shape))
    };
    let scene = |objects| Scene { objects, ..Scene::empty([0.2, 0.5, 0.8]) };
    let scenes = vec![scene(vec![object(0.3, 0)]), scene(vec![object(0.6, 1), object(0.25, 2)])];
    let size = ImageSize::new(32, 32).unwrap();
    Batch::new(scenes.iter().map(|scene| judge.steps.paint(scene, size).unwrap()).collect(), scenes)
}

/// The loss of a mode and the gradient of every weight that it depends on.
fn step<B: Tested>(mode: Mode) -> Result<(f64, Gradients), NetError> {
    let config = ModelConfig::tiny();
    let bank = mdshr_bank::<f64>(HARMONICS);
    let steps = SceneSteps::new(config.objects(), HARMONICS, EdgeProfile::reference())?;
    let judge = Judge { mode, image_loss: PixelLoss::Mae, image_weight: 1.0, steps, bank: bank.clone() };
    let batch = batch(&judge);
    let schedule = Schedule::constant(1e-3);
    let trainer = Trainer::<B, f64>::new(config.clone(), bank.clone(), judge.clone(), schedule, 7, B::place())?;
    let parameters = trainer.parameters();
    let model = Model::load(&config, &bank, &Weights::new(parameters))?;
    let judged = judge.judge(&model, &batch, Phase::Training, &B::place(), 1)?;
    let gradients = parameters.gradients(&judged.loss.backward()?);
    let values = gradients.into_iter().map(|(name, gradient)| Ok((name, gradient.to_f64()?)));
    Ok((judged.loss.number()?, values.collect::<Result<_, NetError>>()?))
}

fn modes<B: Tested>(tally: &Tally) -> Outcome {
    for mode in Mode::ALL {
        let ((own, gradients), (host, expected)) = (step::<B>(mode)?, step::<Host>(mode)?);
        close(tally, &format!("loss of {mode}"), &[own], &[host], TOLERANCE_F64)?;
        let moves = expected.iter().flat_map(|(_, gradient)| gradient).any(|gradient| gradient.abs() > 1e-6);
        tally.check(moves, || format!("{mode}: no gradient"))?;
        close_gradients(tally, &format!("gradient in {mode}"), &gradients, &expected, TOLERANCE_F64)?;
    }
    Ok(())
}

#[test]
fn a_step_of_every_mode_is_the_same_everywhere() {
    on_every_backend!(modes);
}
