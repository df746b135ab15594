//! Extents and ranges of predictions, and sizes.

use dvp_core::real::DType;
use dvp_core::render::EdgeProfile;
use dvp_core::shape::{PrototypeBank, mdshr_bank};
use dvp_core::tensor::{Host, HostDevice, Parameters, Tensor};

use super::{Model, ModelConfig, ShapeHead};
use crate::error::NetError;
use crate::initial::initial_weights;
use crate::layers::Phase;
use crate::weights::{Weights, asked};

fn weights(config: &ModelConfig, bank: &PrototypeBank<f64>) -> Parameters<Host> {
    let asked = asked::<Host, _>(&HostDevice, |weights| Model::load(config, bank, weights)).unwrap();
    initial_weights(&asked, 3, DType::F64, &HostDevice).unwrap()
}

fn images(batch: usize) -> Tensor<Host> {
    let values: Vec<f64> = (0..batch * 3 * 32 * 32).map(|k| (k % 17) as f64 / 16.0).collect();
    Tensor::new(values, &[batch, 3, 32, 32], &HostDevice).unwrap()
}

#[test]
fn predictions_have_the_extents_and_ranges_of_scenes() {
    let bank = mdshr_bank::<f64>(8);
    for (shape, harmonics) in [(ShapeHead::Prototypes, 8), (ShapeHead::Direct { harmonics: 5 }, 5)] {
        let config = ModelConfig { shape, ..ModelConfig::tiny() };
        let weights = weights(&config, &bank);
        let model = Model::load(&config, &bank, &Weights::new(&weights)).unwrap();
        let found = model.predict::<f64>(&images(2)).unwrap();
        let extents = found.parts().map(|part| part.dims().extents().to_vec());
        let expected: [&[usize]; 7] =
            [&[2, 8, 2], &[2, 8], &[2, 8], &[2, 8, 3], &[2, 8], &[2, 8, harmonics, 4], &[2, 3]];
        assert_eq!(extents.each_ref().map(Vec::as_slice), expected);
        for k in [0, 1, 3, 4, 6] {
            assert!(found.parts()[k].to_f64().unwrap().iter().all(|x| (0.0..=1.0).contains(x)), "part {k}");
        }
        for row in found.descriptors.to_f64().unwrap().chunks(4 * harmonics) {
            assert!((row[0] - 1.0).abs() < 1e-3 && row[1] == 0.0 && row[2] == 0.0, "no normal form: {row:?}");
        }
        let scenes = found.scenes::<f64>(EdgeProfile::reference()).unwrap();
        assert_eq!(scenes.iter().map(|scene| scene.objects.len()).collect::<Vec<_>>(), [8, 8]);
        assert!(
            scenes[0].objects.iter().all(|object| object.prototype().is_some() == (shape == ShapeHead::Prototypes))
        );
    }
}

#[test]
fn names_are_asked_once_and_sizes_are_those_told() {
    let bank = mdshr_bank::<f64>(16);
    for (config, about) in
        [(ModelConfig::tiny(), 0.06e6), (ModelConfig::cells(), 0.39e6), (ModelConfig::small(), 1.4e6)]
    {
        let asked = asked::<Host, _>(&HostDevice, |weights| Model::load(&config, &bank, weights)).unwrap();
        let mut names: Vec<&str> = asked.iter().map(|(name, _)| name.as_str()).collect();
        let count: usize = asked.iter().map(|(_, dims)| dims.len()).sum();
        assert!((count as f64 / about - 1.0).abs() < 0.1, "{count}");
        names.sort_unstable();
        assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{names:?}");
    }
}

#[test]
fn a_model_without_shapes_is_refused() {
    let config = ModelConfig::tiny();
    let load = |weights: &Weights<'_, Host>| Model::load(&config, &PrototypeBank::<f64>::new(Vec::new()), weights);
    assert!(matches!(asked(&HostDevice, load), Err(NetError::Config { key: "shape", .. })));
}

#[test]
fn norms_follow_batches_in_training_alone() {
    let bank = mdshr_bank::<f64>(4);
    let config = ModelConfig { batch_norm: true, ..ModelConfig::tiny() };
    let weights = weights(&config, &bank);
    let model = Model::load(&config, &bank, &Weights::new(&weights)).unwrap();
    let features = model.features(&images(2)).unwrap();
    let names = |phase| {
        let (_, running) = model.latents(&features, phase).unwrap();
        running.into_iter().map(|(name, tensor)| (name, tensor.dims().extents().to_vec())).collect::<Vec<_>>()
    };
    assert!(names(Phase::Inference).is_empty());
    let channels = vec![32];
    let expected = ["norm.running_mean", "norm.running_var"].map(|name| (name.to_owned(), channels.clone()));
    assert_eq!(names(Phase::Training), expected);
}
