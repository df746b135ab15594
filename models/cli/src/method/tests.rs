use alloc::sync::Arc;

use dvp_core::{ImageSize, Scene};
use dvp_fit::FitOptions;

use super::*;
use crate::format::mdshr_bank;
use crate::generate::{SceneSettings, sample_scene};
use crate::paint::Painter;

/// Steps that keep the test short.
const STEPS: usize = 5;

fn truth(size: ImageSize) -> Scene<f32> {
    sample_scene(&SceneSettings::mds_hr(), &mdshr_bank(), size, 7, 0)
}

#[test]
fn every_method_finds_a_scene_in_every_precision_that_it_knows() {
    let size = ImageSize::new(64, 64).unwrap();
    let truth = truth(size);
    let image = Painter::default().paint(&truth, size).unwrap();
    let tools = Tools {
        options: FitOptions::default().with_bank(Some(mdshr_bank())),
        network: Some(Arc::new(load_network(None).unwrap())),
    };
    let mut memory = Memory::default();
    for &method in Method::all() {
        for precision in [Precision::F32, Precision::F64] {
            let runner = Runner::new(method, Setting { steps: STEPS, precision }, &tools);
            assert_eq!(runner.is_ok(), method.knows(precision), "{}", method.name());
            let Ok(runner) = runner else { continue };
            let task = Task { truth: Some(&truth), seed: 3, ..Task::of(image.view()) };
            let found = runner.run(&task, &mut memory).unwrap();
            let again = runner.run(&task, &mut memory).unwrap();
            assert_eq!(found.fit.scene, again.fit.scene, "{}", method.name());
            assert!(found.there.objects.iter().all(|object| object.confidence > 0.5), "{}", method.name());
            if method.start() == Start::Image {
                assert!(!found.there.objects.is_empty(), "{}", method.name());
                let blind = runner.run(&Task { start: None, truth: None, ..task }, &mut memory).unwrap();
                assert_eq!(found.fit.scene, blind.fit.scene, "{} looks at the truth", method.name());
            }
        }
    }
}

#[test]
fn a_start_that_is_given_is_gone_on_from() {
    let size = ImageSize::new(64, 64).unwrap();
    let truth = truth(size);
    let image = Painter::default().paint(&truth, size).unwrap();
    let task = Task { start: Some(&truth), ..Task::of(image.view()) };
    for method in [Method::OptP, Method::Lm, Method::LmContinuation, Method::RandOptP] {
        let runner = Runner::new(method, Setting { steps: 0, ..method.default_setting() }, &Tools::default()).unwrap();
        let found = runner.run(&task, &mut Memory::default()).unwrap();
        let apart = |k: usize| {
            let [a, b] = [&truth, &found.there].map(|scene| scene.objects[k].pose.translation);
            (a[0] - b[0]).hypot(a[1] - b[1])
        };
        assert!((0..truth.objects.len()).all(|k| apart(k) < 1e-6), "{}", method.name());
    }
}

#[test]
fn what_is_missing_is_said() {
    let size = ImageSize::new(64, 64).unwrap();
    let image = Painter::default().paint(&truth(size), size).unwrap();
    let task = Task::of(image.view());
    let new = |method: Method| Runner::new(method, method.default_setting(), &Tools::default());
    for (method, word) in [(Method::SegmentBank, "bank"), (Method::NetLm, "network"), (Method::RandOptZ, "network")] {
        assert!(new(method).unwrap_err().to_string().contains(word));
    }
    for (method, word) in [(Method::OptP, "start"), (Method::RandOptP, "how many objects")] {
        let refused = new(method).unwrap().run(&task, &mut Memory::default()).unwrap_err();
        assert!(refused.to_string().contains(word), "{refused}");
    }
}
