use dvp_core::render::{EdgeProfile, PixelLoss};
use dvp_core::shape::{Efd, mdshr_bank};
use dvp_core::tensor::HostDevice;
use dvp_core::{Image, ImageSize, Object, Pose, Real, Scene};

use super::*;
use crate::square::Square;
use crate::train::{Judge, Mode, Schedule, Trainer};

/// A tiny model that has learned nothing, trained in `T`.
fn checkpoint<T: Real>() -> Checkpoint {
    let (config, bank) = (ModelConfig::tiny(), mdshr_bank::<T>(16));
    let steps = SceneSteps::new(config.objects(), 16, EdgeProfile::reference()).unwrap();
    let judge = Judge { mode: Mode::Gp, image_loss: PixelLoss::Mae, image_weight: 1.0, steps, bank: bank.clone() };
    let schedule = Schedule::constant(1e-3);
    let trainer = Trainer::<Host, T>::new(config, bank, judge, schedule, 4, HostDevice).unwrap();
    Checkpoint::of(&trainer, false, "").unwrap()
}

fn size(width: usize, height: usize) -> ImageSize {
    ImageSize::new(width, height).unwrap()
}

fn object(translation: [f32; 2], scale: f32, color: [f32; 3], confidence: f32) -> Object<f32> {
    let pose = Pose { translation, scale, rotation: 0.3 };
    Object::of_efd(pose, color, confidence, Efd::new(vec![[1.0, 0.0, 0.0, -1.0]]), None)
}

/// Of disks.
fn painter() -> SceneSteps<f32> {
    SceneSteps::new(1, 1, EdgeProfile::reference()).unwrap()
}

fn painted(scene: &Scene<f32>, size: ImageSize) -> Image<f32> {
    painter().paint(scene, size).unwrap()
}

#[test]
fn squares_of_the_trained_side_are_seen_as_they_are() {
    let scene = Scene { objects: vec![object([0.4, 0.6], 0.2, [0.9; 3], 1.0)], ..Scene::empty([0.1, 0.2, 0.3]) };
    let image = painted(&scene, size(128, 128));
    let (square, target) = Square::of(image.view(), 128).unwrap();
    assert_eq!(target, image);
    assert_eq!(square.to_picture(scene.clone()), scene);
}

#[test]
fn what_is_found_on_the_square_stands_where_it_is_in_the_picture() {
    // On a square of 256 x 256 px the picture begins 64 px from above; its unit is 128 px. The disk at (1.5, 0.5), 0.2
    // lies at (1.5 128, 0.5 128 + 64) / 256 = (0.75, 0.5), its radius is 0.2 128 / 256 = 0.1.
    let background = [0.1, 0.2, 0.3];
    let disk = object([1.5, 0.5], 0.2, [0.9, 0.8, 0.7], 1.0);
    for (size, disk) in [
        (size(256, 128), disk.clone()),
        (size(128, 256), object([0.5, 1.5], 0.2, disk.color(), 1.0)),
        (size(64, 32), disk.clone()),
    ] {
        let truth = Scene { objects: vec![disk], ..Scene::empty(background) };
        let (square, target) = Square::of(painted(&truth, size).view(), 128).unwrap();
        let mut sums = [0.0_f64; 3];
        for (k, &value) in target.view().channel(0).iter().enumerate() {
            let there = f64::from((value - 0.1) / 0.8);
            for (sum, weight) in sums.iter_mut().zip([(k % 128) as f64 + 0.5, (k / 128) as f64 + 0.5, 1.0]) {
                *sum += weight * there;
            }
        }
        let center = [0, 1].map(|axis| f32::of(sums[axis] / sums[2] / 128.0));
        let found = Scene { objects: vec![object(center, 0.1, [0.9; 3], 1.0)], ..Scene::empty(background) };
        let found = square.to_picture(found).objects.remove(0).pose;
        let truth = truth.objects[0].pose;
        for axis in 0..2 {
            let off = found.translation[axis] - truth.translation[axis];
            assert!(off.abs() < 2e-3, "{size:?}: {:?} for {:?}", found.translation, truth.translation);
        }
        assert!((found.scale - truth.scale).abs() < 1e-6);
        // The area of a disk of 0.1 of 128 px, and the 1.43 px by which it is fattened at 128 px per unit, half as many
        // px on the square where the unit is 64 px.
        let radius = (sums[2] / core::f64::consts::PI).sqrt();
        assert!((radius - 12.8 - 0.715).abs() < 0.25, "{size:?}: {radius}");
        // The border is that of the picture.
        assert!((0..3).all(|c| (target.view().channel(c)[0] - background[c]).abs() < 1e-6));
    }
}

#[test]
fn pictures_of_any_size_are_read_and_flat_ones_stay_flat() {
    let proposer = Proposer::new(&checkpoint::<f32>()).unwrap();
    for size in [size(1, 1), size(1, 300), size(257, 129), size(500, 3)] {
        let image = Image::from_planar(size, vec![0.25; 3 * size.pixels()]).unwrap();
        let target = Square::of(image.view(), 128).unwrap().1;
        assert!(target.data().iter().all(|value| (value - 0.25).abs() < 1e-6), "{size:?}");
        let scene = proposer.propose(image.view()).unwrap();
        assert_eq!(scene.objects.len(), proposer.config().objects());
        assert!(scene.objects.iter().all(|object| object.pose.translation.iter().all(|place| place.is_finite())));
    }
}

#[test]
fn no_numbers_are_refused() {
    let proposer = Proposer::new(&checkpoint::<f32>()).unwrap();
    let mut image = Image::zeros(size(40, 30));
    image.data_mut()[17] = f32::NAN;
    assert!(matches!(proposer.propose(image.view()), Err(NetError::Image(_))));
    assert!(matches!(proposer.opt_z(image.view(), &OptZ::default()), Err(NetError::Image(_))));
}

#[test]
fn models_trained_in_f64_look_alike() {
    let image = Image::from_planar(size(128, 128), vec![0.5; 3 * 128 * 128]).unwrap();
    let [single, double] = [checkpoint::<f32>(), checkpoint::<f64>()].map(|checkpoint| {
        Proposer::from_bytes(&checkpoint.to_bytes().unwrap()).unwrap().propose(image.view()).unwrap()
    });
    let scales = single.objects.iter().zip(&double.objects).map(|(a, b)| (a.pose.scale - b.pose.scale).abs());
    assert!(scales.fold(0.0, f32::max) < 1e-6);
}

#[test]
fn latents_move_toward_pictures_that_are_no_squares() {
    let proposer = Proposer::new(&checkpoint::<f32>()).unwrap();
    let scene = Scene { objects: vec![object([0.9, 0.4], 0.3, [0.9, 0.1, 0.1], 1.0)], ..Scene::empty([0.1, 0.2, 0.9]) };
    let image = painted(&scene, size(96, 64));
    let settings = OptZ { steps: 5, ..OptZ::default() };
    for found in [proposer.opt_z(image.view(), &settings), proposer.rand_opt_z(image.view(), &settings, 3)] {
        let found = found.unwrap();
        assert!(found.loss < found.losses[0], "{:?}", found.losses);
    }
    // Without a step it is what is there, as the model sees it.
    let none = proposer.opt_z(image.view(), &OptZ { steps: 0, ..settings }).unwrap().scene;
    let seen = proposer.propose(image.view()).unwrap();
    assert!(!none.objects.is_empty() && none.objects.iter().all(|object| seen.objects.contains(object)));
    assert_eq!(Scene { objects: Vec::new(), ..none }, Scene { objects: Vec::new(), ..seen });
}

#[test]
fn one_thing_is_one_object() {
    let red = [0.8, 0.2, 0.1];
    let objects = vec![
        object([0.50, 0.5], 0.20, red, 0.7),
        // The same thing: 0.02 beside, a fifth larger, hardly another color; more confident.
        object([0.52, 0.5], 0.24, [0.8, 0.25, 0.1], 0.97),
        // A half of it, and one beside it that it overlaps.
        object([0.52, 0.4], 0.10, red, 0.96),
        object([0.22, 0.5], 0.20, red, 0.96),
        // Not the same: farther off, of another color.
        object([0.20, 0.5], 0.20, red, 0.96),
        object([0.52, 0.5], 0.24, [0.8, 0.5, 0.1], 0.96),
        // Hardly there.
        object([0.1, 0.1], 0.2, red, 0.04),
    ];
    let scene = Scene { objects, ..Scene::empty([0.0; 3]) };
    // The model is sure: the picture is not asked.
    assert_eq!(there(&scene, &Image::zeros(size(64, 64)), &painter()).unwrap(), [1, 4, 5]);
}

#[test]
fn what_is_in_doubt_is_there_if_the_picture_shows_it() {
    let (shown, hidden) =
        (object([0.3, 0.3], 0.15, [0.9, 0.2, 0.1], 1.0), object([0.7, 0.6], 0.2, [0.1, 0.9, 0.4], 1.0));
    let truth = Scene { objects: vec![shown.clone()], ..Scene::empty([0.2, 0.2, 0.7]) };
    let target = painted(&truth, size(64, 64));
    for (of_shown, of_hidden) in [(0.9, 0.9), (0.1, 0.1), (0.1, 0.9), (0.94, 0.06)] {
        let mut scene = truth.clone();
        scene.objects =
            vec![Object { confidence: of_hidden, ..hidden.clone() }, Object { confidence: of_shown, ..shown.clone() }];
        assert_eq!(there(&scene, &target, &painter()).unwrap(), [1], "{of_shown} {of_hidden}");
    }
}

#[test]
fn objects_have_shapes_of_the_bank() {
    let proposer = Proposer::from_bytes(BUILT_IN).unwrap();
    let heart = proposer.bank().prototypes()[0].clone();
    let there = Object { shape: heart.clone().into(), ..object([0.4, 0.5], 0.25, [0.9, 0.8, 0.1], 1.0) };
    let painter = SceneSteps::new(1, 16, EdgeProfile::reference()).unwrap();
    let image =
        painter.paint(&Scene { objects: vec![there], ..Scene::empty([0.1, 0.2, 0.4]) }, size(128, 128)).unwrap();
    let found = proposer.objects(image.view()).unwrap();
    assert_eq!(found.objects.len(), 1);
    assert_eq!((found.objects[0].shape.efd(), found.objects[0].confidence), (Some(&heart), 1.0));
}

#[test]
fn second_looks_see_objects_where_they_are() {
    let heart = mdshr_bank::<f32>(16).prototypes()[0].clone();
    let there = Object { shape: heart.clone().into(), ..object([0.4, 0.5], 0.25, [0.9, 0.8, 0.1], 1.0) };
    let painter = SceneSteps::new(1, 16, EdgeProfile::reference()).unwrap();
    let image = painter
        .paint(&Scene { objects: vec![there.clone()], ..Scene::empty([0.1, 0.2, 0.4]) }, size(128, 128))
        .unwrap();
    let found = Proposer::built_in().unwrap().objects(image.view()).unwrap();
    assert_eq!(found.objects.len(), 1);
    let object = &found.objects[0];
    assert_eq!((object.shape.efd(), object.confidence), (Some(&heart), 1.0));
    let (a, b) = (object.pose, there.pose);
    let off = [a.translation[0] - b.translation[0], a.translation[1] - b.translation[1], a.scale - b.scale];
    // A pixel is 0.008.
    assert!(off.iter().all(|off| off.abs() < 0.004) && (a.rotation - b.rotation).sin().abs() < 0.05, "{a:?}");
}

#[test]
fn noise_is_taken_off_before_the_network_looks() {
    let heart = mdshr_bank::<f32>(16).prototypes()[0].clone();
    let shown = Object { shape: heart.into(), ..object([0.4, 0.5], 0.25, [0.8, 0.7, 0.2], 1.0) };
    let painter = SceneSteps::new(1, 16, EdgeProfile::reference()).unwrap();
    let scene = Scene { objects: vec![shown], ..Scene::empty([0.2, 0.3, 0.5]) };
    let clean = painter.paint(&scene, size(128, 128)).unwrap();
    assert_eq!(cleared(clean.clone()), clean);
    let (mut noisy, mut state) = (clean.clone(), 1_u64);
    for value in noisy.data_mut() {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        *value = (*value + 0.15 * ((state >> 40) as f32 / (1 << 23) as f32 - 1.0)).clamp(0.0, 1.0);
    }
    let off = |image: &Image<f32>| image.data().iter().zip(clean.data()).map(|(a, b)| (a - b).powi(2)).sum::<f32>();
    assert!(off(&cleared(noisy.clone())) < 0.1 * off(&noisy));
    let proposer = Proposer::built_in().unwrap();
    let [plain, found] = [&clean, &noisy].map(|image| proposer.objects(image.view()).unwrap());
    assert_eq!((plain.objects.len(), found.objects.len()), (1, 1));
    let [a, b] = [&plain, &found].map(|scene| scene.objects[0].pose);
    assert!((a.scale - b.scale).abs() < 0.01 && (a.translation[0] - b.translation[0]).abs() < 0.01, "{a:?} {b:?}");
}

#[test]
fn looks_at_other_shapes_are_refused() {
    let look = LookFile::from_bytes(BUILT_IN_LOOK).unwrap();
    let config = ModelConfig::tiny();
    let steps = SceneSteps::new(config.objects(), 4, EdgeProfile::reference()).unwrap();
    let judge = Judge { mode: Mode::Gp, image_loss: PixelLoss::Mae, image_weight: 1.0, steps, bank: mdshr_bank(4) };
    let schedule = Schedule::constant(1e-3);
    let trainer = Trainer::<Host, f32>::new(config, mdshr_bank(4), judge, schedule, 4, HostDevice).unwrap();
    let proposer = Proposer::new(&Checkpoint::of(&trainer, false, "").unwrap()).unwrap();
    let error = proposer.with_look(&look, 1).unwrap_err();
    assert!(error.to_string().contains("other shapes"), "{error}");
}

#[test]
fn built_in_weights_are_a_model() {
    let proposer = Proposer::from_bytes(BUILT_IN).unwrap();
    assert_eq!(
        *proposer.config(),
        ModelConfig { transformer: proposer.config().transformer.clone(), ..ModelConfig::cells() }
    );
}
