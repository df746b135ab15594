//! A second look on every backend: steps from the same weights on the same scenes, its gradients, files.

use dvp_core::real::DType;
use dvp_core::render::EdgeProfile;
use dvp_core::shape::mdshr_bank;
use dvp_core::tensor::Host;
use dvp_core::{ImageSize, Object, Pose, Real, Scene};
use dvp_net::error::NetError;
use dvp_net::look::LookConfig;
use dvp_net::scene_steps::SceneSteps;
use dvp_net::train::{Batch, LookFile, LookTrainer, Schedule};

use crate::check::{close, gradients_agree, losses_agree};
use crate::registry::{Outcome, Tally, Tested, on_every_backend};

/// Steps of a run.
const STEPS: usize = 20;

/// Three scenes of one or two objects and their images, 48 x 48.
fn batch<T: Real>() -> Batch<T> {
    let bank = mdshr_bank::<T>(4);
    let steps = SceneSteps::new(1, 4, EdgeProfile::reference()).unwrap();
    let object = |k: usize| {
        let at = [0.3 + 0.09 * k as f64, 0.7 - 0.08 * k as f64].map(T::of);
        let pose = Pose { translation: at, scale: T::of(0.2), rotation: T::of(0.5 * k as f64) };
        let color = [T::of(0.9 - 0.2 * k as f64), T::of(0.1 + 0.2 * k as f64), T::of(0.4)];
        Object::of_efd(pose, color, T::one(), bank.prototypes()[k % 3].clone(), Some(k % 3))
    };
    let scene = |k: usize| Scene { objects: (k..=2 * k).map(object).collect(), ..Scene::empty([T::of(0.8); 3]) };
    let scenes: Vec<Scene<T>> = (0..3).map(scene).collect();
    let size = ImageSize::new(48, 48).unwrap();
    Batch::new(scenes.iter().map(|scene| steps.paint(scene, size).unwrap()).collect(), scenes)
}

fn trainer<B: Tested, T: Real>() -> Result<LookTrainer<B, T>, NetError> {
    let (bank, edge, schedule) = (mdshr_bank(4), EdgeProfile::reference(), Schedule::constant(3e-3));
    LookTrainer::new(LookConfig::tiny(), bank, edge, schedule, 3, B::place())
}

fn losses<B: Tested, T: Real>() -> Vec<f64> {
    let (mut trainer, batch) = (trainer::<B, T>().unwrap(), batch::<T>());
    (0..STEPS).map(|_| trainer.step(&batch).unwrap().loss).collect()
}

fn same_steps<B: Tested>(tally: &Tally) -> Outcome {
    let pairs = [
        (DType::F64, losses::<B, f64>(), losses::<Host, f64>()),
        (DType::F32, losses::<B, f32>(), losses::<Host, f32>()),
    ];
    for (dtype, own, host) in &pairs {
        losses_agree(tally, *dtype, own, host, STEPS)?;
    }
    Ok(())
}

/// The gradient of every weight, as the host has it (which its own tests hold against central differences).
fn gradients<B: Tested>(tally: &Tally) -> Outcome {
    fn of<B: Tested>() -> Result<Vec<(String, Vec<f64>)>, NetError> {
        let gradients = trainer::<B, f64>()?.gradients(&batch())?.1;
        gradients.into_iter().map(|(name, tensor)| Ok((name, tensor.to_f64()?))).collect()
    }
    let (own, host) = (of::<B>().unwrap(), of::<Host>().unwrap());
    gradients_agree(tally, &own, &host, 12)
}

/// A file written on one backend is read on another: the host puts the same scenes right in the same way.
fn files<B: Tested>(tally: &Tally) -> Outcome {
    let (mut trainer, batch) = (trainer::<B, f32>().unwrap(), batch::<f32>());
    trainer.step(&batch).unwrap();
    let bytes = LookFile::of(&trainer, true, "words").unwrap().to_bytes().unwrap();
    let file = LookFile::from_bytes(&bytes).unwrap();
    let mut host = self::trainer::<Host, f32>().unwrap();
    file.resume(&mut host, &Host::place()).unwrap();
    tally.check(host.steps() == 1 && file.about() == "words", || format!("{} steps", host.steps()))?;
    let [own, host] = [trainer.corrected(&batch).unwrap()[1].clone(), host.corrected(&batch).unwrap()[1].clone()];
    for (own, host) in own.iter().zip(&host) {
        let [own, host] = [own, host].map(|image| image.data().iter().map(|&x| f64::from(x)).collect::<Vec<_>>());
        close(tally, "pictures", &own, &host, 1e-4)?;
    }
    Ok(())
}

#[test]
fn same_steps_everywhere() {
    on_every_backend!(same_steps);
}

#[test]
fn gradients_everywhere() {
    on_every_backend!(gradients);
}

#[test]
fn files_everywhere() {
    on_every_backend!(files);
}
