//! Steps, threads, files; every mode's gradient against central differences.

use dvp_core::render::{EdgeProfile, PixelLoss};
use dvp_core::scene::{Object, Pose};
use dvp_core::shape::mdshr_bank;
use dvp_core::tensor::{Host, HostDevice, Parameters, Tensor};
use dvp_core::{Image, ImageSize, Real, Scene};
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

use super::{Batch, Checkpoint, Judge, Mode, Schedule, Trainer};
use crate::error::NetError;
use crate::layers::Phase;
use crate::model::{Model, ModelConfig};
use crate::scene_steps::SceneSteps;
use crate::weights::Weights;

const HARMONICS: usize = 4;

fn judge<T: Real>(mode: Mode, config: &ModelConfig) -> Judge<T> {
    // Softer than the reference's, and cut where nothing is left to cut: differences then meet no jump.
    let edge = EdgeProfile { sigma: T::of(1e-3), cut: T::of(0.03), ..EdgeProfile::reference() };
    let steps = SceneSteps::new(config.objects(), HARMONICS, edge).unwrap();
    Judge { mode, image_loss: PixelLoss::Mse, image_weight: 1.0, steps, bank: mdshr_bank(HARMONICS) }
}

fn trainer<T: Real>(mode: Mode) -> Trainer<Host, T> {
    let config = ModelConfig::tiny();
    let judge = judge(mode, &config);
    let schedule = Schedule::constant(2e-3).with_warm_up(5);
    Trainer::new(config, mdshr_bank(HARMONICS), judge, schedule, 7, HostDevice).unwrap()
}

/// Scenes of one or two objects and their images, 32 x 32.
fn batch<T: Real>(count: usize) -> Batch<T> {
    let bank = mdshr_bank::<T>(HARMONICS);
    let config = ModelConfig::tiny();
    let steps = judge::<T>(Mode::Gp, &config).steps;
    let scene = |k: usize| {
        let object = |j: usize| {
            let shift = 0.07 * ((3 * k + 5 * j) % 7) as f64;
            let pose = Pose {
                translation: [T::of(0.25 + shift), T::of(0.7 - shift)],
                scale: T::of(0.12 + 0.02 * (k % 4) as f64),
                rotation: T::of(0.4 * k as f64 + j as f64),
            };
            let (color, shape) = ([T::of(0.9 - shift), T::of(shift), T::of(0.3)], (k + j) % 3);
            let efd = bank.prototypes()[shape].clone();
            Object::of_efd(pose, color, T::one(), efd, Some(shape))
        };
        Scene { objects: (0..=k % 2).map(object).collect(), ..Scene::empty([T::of(0.2), T::of(0.5), T::of(0.8)]) }
    };
    let scenes: Vec<Scene<T>> = (0..count).map(scene).collect();
    let size = ImageSize::new(32, 32).unwrap();
    Batch::new(scenes.iter().map(|scene| steps.paint(scene, size).unwrap()).collect(), scenes)
}

fn values<T: Real>(trainer: &Trainer<Host, T>) -> Vec<f64> {
    trainer.parameters().iter().flat_map(|(_, tensor)| tensor.to_f64().unwrap()).collect()
}

#[test]
fn a_few_scenes_are_learned_by_heart() {
    let (mut trainer, batch) = (trainer::<f32>(Mode::Gp), batch(4));
    let first = trainer.step(&batch).unwrap().loss;
    for _ in 0..80 {
        trainer.step(&batch).unwrap();
    }
    let last = trainer.step(&batch).unwrap();
    assert!(last.loss < first / 4.0 && last.number == 82, "{first} -> {last:?}");
}

#[test]
fn what_is_seen_twice_is_dreamed_once_and_what_the_picture_lacks_never() {
    let Batch { images, scenes, .. } = batch::<f32>(1);
    let judge = judge(Mode::TiTp, &ModelConfig::tiny());
    let mut seen = scenes[0].clone();
    let object = seen.objects[0].clone();
    let aside = Pose { translation: [object.pose.translation[0] + 0.01, object.pose.translation[1]], ..object.pose };
    let elsewhere = Pose { translation: [0.8, 0.2], ..object.pose };
    seen.objects.push(Object { pose: aside, confidence: 0.97, ..object.clone() });
    seen.objects.push(Object { pose: elsewhere, confidence: 0.6, ..object.clone() });
    judge.dream(&mut seen, &images[0], &mut ChaCha8Rng::seed_from_u64(2)).unwrap();
    assert_eq!(seen.objects.len(), 1);
    let dreamed = &seen.objects[0];
    assert_eq!(dreamed.pose, Pose { rotation: dreamed.pose.rotation, ..object.pose });
    assert_ne!(dreamed.pose, object.pose);
    assert_eq!(dreamed.prototype().map(|k| &judge.bank.prototypes()[k]), dreamed.shape.efd());
}

#[test]
fn what_should_be_seen_is_the_clean_image() {
    let mut batch = batch::<f64>(2);
    let trainer = trainer::<f64>(Mode::GpGi);
    let plain = trainer.validate(Mode::GpGi, &batch).unwrap();
    batch.clean.clone_from(&batch.images);
    assert_eq!(trainer.validate(Mode::GpGi, &batch).unwrap(), plain);
    // The network sees the same, and should see the two the other way round: L_p stays.
    batch.clean.reverse();
    let other = trainer.validate(Mode::GpGi, &batch).unwrap();
    assert_eq!(other.parameters, plain.parameters);
    assert_ne!(other.image, plain.image);
    assert_eq!(batch.part(1, 1).targets(), &batch.clean[1..]);
    batch.clean.truncate(1);
    assert!(matches!(trainer.validate(Mode::GpGi, &batch), Err(NetError::Batch { .. })));
}

#[test]
fn features_given_change_no_step() {
    let mut batch = batch(3);
    let (mut own, mut given) = (trainer::<f64>(Mode::GpGi), trainer::<f64>(Mode::GpGi));
    given.threads = 2;
    own.threads = 2;
    let expected = own.validate(Mode::GpGi, &batch).unwrap();
    batch.features = given.features(&batch.images).unwrap();
    assert_eq!(batch.features.len(), 3);
    assert_eq!(given.validate(Mode::GpGi, &batch).unwrap(), expected);
    // Of an encoder that learns they are constants: the rest learns the same.
    given.step(&batch).unwrap();
    let encoder = |name: &str| name.starts_with("encoder.");
    for (name, tensor) in given.parameters().iter().filter(|(name, _)| encoder(name)) {
        let start = trainer::<f64>(Mode::GpGi).parameters().get(name).unwrap().to_f64().unwrap();
        assert_eq!(tensor.to_f64().unwrap(), start, "{name}");
    }
    batch.features.clear();
    own.step(&batch).unwrap();
    for (name, tensor) in given.parameters().iter().filter(|(name, _)| !encoder(name)) {
        let own = own.parameters().get(name).unwrap().to_f64().unwrap();
        let apart = tensor.to_f64().unwrap().iter().zip(own).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-9, "{name} is {apart} apart");
    }
}

#[test]
fn threads_do_not_change_a_step() {
    let (mut one, mut three, batch) = (trainer::<f64>(Mode::Gp), trainer::<f64>(Mode::Gp), batch(5));
    three.threads = 3;
    for _ in 0..3 {
        let [a, b] = [one.step(&batch).unwrap(), three.step(&batch).unwrap()];
        assert!((a.loss - b.loss).abs() < 1e-12 && (a.gradient - b.gradient).abs() < 1e-9 * a.gradient, "{a:?} {b:?}");
    }
    // Adam divides by the root of a mean square: rounding counts for more where gradients are small.
    let apart = values(&one).iter().zip(values(&three)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-8, "{apart:e}");
}

#[test]
fn a_run_goes_on_to_the_same_numbers() {
    let (mut whole, batch) = (trainer::<f32>(Mode::TiTp), batch(2));
    for _ in 0..2 {
        whole.step(&batch).unwrap();
    }
    let bytes = Checkpoint::of(&whole, true, "words").unwrap().to_bytes().unwrap();
    let expected: Vec<_> = (0..3).map(|_| whole.step(&batch).unwrap()).collect();

    let checkpoint = Checkpoint::from_bytes(&bytes).unwrap();
    assert_eq!((checkpoint.steps(), checkpoint.about()), (2, "words"));
    let mut again = trainer::<f32>(Mode::TiTp);
    checkpoint.resume(&mut again, &HostDevice).unwrap();
    let found: Vec<_> = (0..3).map(|_| again.step(&batch).unwrap()).collect();
    assert_eq!(found, expected);
    assert_eq!(values(&again), values(&whole));
}

#[test]
fn damaged_files_are_refused() {
    let checkpoint = Checkpoint::of(&trainer::<f32>(Mode::Gp), true, "").unwrap();
    let bytes = checkpoint.to_bytes().unwrap();
    assert!(Checkpoint::from_bytes(&bytes).is_ok());
    for len in [0, 7, 100, bytes.len() / 2, bytes.len() - 1] {
        assert!(Checkpoint::from_bytes(&bytes[..len]).is_err(), "cut to {len}");
    }
    let mut flipped = bytes.clone();
    let place = bytes.len() - 1000;
    flipped[place] ^= 4;
    let error = Checkpoint::from_bytes(&flipped).unwrap_err();
    assert!(error.to_string().contains("damaged"), "{error}");
    let foreign = Parameters::<Host>::new().to_safetensors().unwrap();
    assert!(Checkpoint::from_bytes(&foreign).is_err());
}

#[test]
fn files_of_other_sizes_are_refused() {
    let checkpoint = Checkpoint::of(&trainer::<f32>(Mode::Gp), false, "").unwrap();
    let config = ModelConfig { head_width: 16, ..ModelConfig::tiny() };
    let judge = judge::<f32>(Mode::Gp, &config);
    let schedule = Schedule::constant(1e-3);
    let mut other = Trainer::<Host, f32>::new(config, mdshr_bank(HARMONICS), judge, schedule, 1, HostDevice).unwrap();
    assert!(matches!(checkpoint.resume(&mut other, &HostDevice), Err(NetError::Checkpoint(_))));
}

#[test]
fn a_loss_that_is_no_number_changes_nothing() {
    let mut trainer = trainer::<f32>(Mode::Gp);
    let (before, mut batch) = (values(&trainer), batch(2));
    batch.images[1].data_mut()[5] = f32::NAN;
    assert!(trainer.step(&batch).is_err());
    assert_eq!(values(&trainer), before);
    assert_eq!(trainer.steps(), 0);
}

#[test]
fn scenes_that_are_missing_are_named() {
    let Batch { images, .. } = batch::<f32>(2);
    let pictures = Batch::new(images, Vec::new());
    for mode in Mode::ALL {
        let result = trainer::<f32>(mode).step(&pictures);
        let refused = matches!(&result, Err(NetError::Batch { .. }));
        assert_eq!(refused, matches!(mode, Mode::Gp | Mode::Gi | Mode::GpGi), "{mode}: {result:?}");
    }
    let none = Batch::<f32>::new(Vec::<Image<f32>>::new(), Vec::new());
    assert!(matches!(trainer(Mode::Ti).step(&none), Err(NetError::Batch { .. })));
}

/// The loss with weight `name`, number `at`, changed by `by`; and the gradient at that number.
fn nudged(mode: Mode, name: &str, at: usize, by: f64) -> (f64, f64) {
    let trainer = trainer::<f64>(mode);
    let mut parameters = Parameters::<Host>::new();
    for (own, tensor) in trainer.parameters().iter() {
        let mut values = tensor.to_f64().unwrap();
        if own == name {
            values[at] += by;
        }
        parameters.insert(own, &Tensor::new(values, tensor.dims().extents(), &HostDevice).unwrap()).unwrap();
    }
    let model = Model::load(trainer.config(), trainer.bank(), &Weights::new(&parameters)).unwrap();
    let judged = trainer.judge.judge(&model, &batch(2), Phase::Training, &HostDevice, 1).unwrap();
    let loss = judged.loss.number().unwrap();
    let gradients = parameters.gradients(&judged.loss.backward().unwrap());
    (loss, gradients.get(name).map_or(0.0, |gradient| gradient.to_f64().unwrap()[at]))
}

#[test]
fn gradients_are_those_of_the_loss() {
    // TP and TI-TP take what they paint for the truth, so that their gradient is not that of their value.
    for mode in [Mode::Ti, Mode::Gp, Mode::Gi, Mode::GpGi] {
        for (name, at) in [
            ("encoder.patches.weight", 11),
            ("projection.weight", 5),
            ("transformer.decoder.layers.0.fc1.weight", 3),
            ("heads.translation.layers.2.bias", 1),
            ("heads.shape.query.linear.weight", 7),
            ("heads.background.layers.1.weight", 9),
        ] {
            let (step, (_, gradient)) = (1e-5, nudged(mode, name, at, 0.0));
            let difference = (nudged(mode, name, at, step).0 - nudged(mode, name, at, -step).0) / (2.0 * step);
            let tolerance = 1e-6 + 1e-4 * gradient.abs();
            assert!((gradient - difference).abs() < tolerance, "{mode} {name}: {gradient} for {difference}");
        }
    }
}
