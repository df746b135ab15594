//! Files of half precision, of each kind of network.

use dvp_core::render::EdgeProfile;
use dvp_core::shape::mdshr_bank;
use dvp_core::tensor::{Host, HostDevice, Parameters};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::weights_file::WeightsFile;
use super::{Checkpoint, DecomposerFile, DecomposerTrainer, LookFile, LookTrainer, Schedule};
use crate::decompose::DecomposerConfig;
use crate::decompose::monet::MonetConfig;
use crate::error::NetError;
use crate::look::LookConfig;
use crate::propose::{BUILT_IN, BUILT_IN_LOOK};

/// Holds the file of half precision of one that holds an optimizer, or not, against it. The share of bytes that are left.
fn check<C: Clone + PartialEq + Serialize + DeserializeOwned + core::fmt::Debug>(file: &WeightsFile<C>) -> f64 {
    let bytes = file.to_half_bytes().unwrap();
    let half = WeightsFile::<C>::from_bytes(&bytes).unwrap();
    assert_eq!((half.config(), half.steps(), half.about()), (file.config(), file.steps(), file.about()));
    let weights = |file: &WeightsFile<C>| -> Parameters<Host> { file.weights(&HostDevice).unwrap() };
    let (own, rounded) = (weights(file), weights(&half));
    assert_eq!(own.len(), rounded.len());
    for (name, tensor) in own.iter() {
        let found = rounded.get(name).unwrap();
        assert_eq!(found.dims(), tensor.dims(), "{name}");
        // The nearest of 11 bits, below 2^-14 in steps of 2^-24; biases and factors are as they were.
        let bound = |value: f64| {
            if tensor.dims().rank() < 2 { 0.0 } else { (value.abs() * 2.0_f64.powi(-11)).max(2.0_f64.powi(-25)) }
        };
        for (a, b) in tensor.to_f64().unwrap().into_iter().zip(found.to_f64().unwrap()) {
            assert!((a - b).abs() <= bound(a), "{name}: {b} for {a}");
        }
    }
    // Once rounded, always the same: bytes for bytes.
    assert_eq!(half.to_half_bytes().unwrap(), bytes);
    // A file whose sizes are not understood comes to the same numbers.
    let blind = WeightsFile::<serde_json::Value>::from_bytes(&file.to_bytes().unwrap()).unwrap();
    let blind = WeightsFile::<C>::from_bytes(&blind.to_half_bytes().unwrap()).unwrap();
    assert_eq!(blind.config(), file.config());
    assert!(weights(&blind).to_safetensors().unwrap() == rounded.to_safetensors().unwrap());
    // Damage is found, wherever it is.
    let mut damaged = bytes.clone();
    *damaged.last_mut().unwrap() ^= 0x10;
    assert!(matches!(WeightsFile::<C>::from_bytes(&damaged), Err(NetError::Checkpoint(_))));
    assert!(WeightsFile::<C>::from_bytes(&bytes[..bytes.len() - 1]).is_err());
    bytes.len() as f64 / file.to_bytes().unwrap().len() as f64
}

#[test]
fn a_file_of_each_kind_in_half_precision() {
    let model = Checkpoint::from_bytes(BUILT_IN).unwrap();
    check(&model);
    // Shapes are not rounded.
    let half = Checkpoint::from_bytes(&model.to_half_bytes().unwrap()).unwrap();
    assert_eq!(half.bank::<f32>().unwrap(), model.bank::<f32>().unwrap());
    check(&LookFile::from_bytes(BUILT_IN_LOOK).unwrap());

    let schedule = Schedule::constant(1e-3);
    let look = LookConfig::small();
    let look = LookTrainer::<Host, f32>::new(look, mdshr_bank(4), EdgeProfile::reference(), schedule, 7, HostDevice);
    let share = check(&LookFile::of(&look.unwrap(), false, "about a look").unwrap());
    assert!((0.5..0.52).contains(&share), "{share}");

    let config = DecomposerConfig::Monet(MonetConfig::small(32));
    let mut monet = DecomposerTrainer::<Host, f32>::new(config, schedule, 7, HostDevice).unwrap();
    monet.step(&[dvp_core::Image::zeros(dvp_core::ImageSize::new(32, 32).unwrap())]).unwrap();
    // Weights and two moments in f32, weights alone in F16: a sixth.
    let file = DecomposerFile::of(&monet, true, "about MONet").unwrap();
    let share = check(&file);
    assert!((0.16..0.2).contains(&share), "{share}");
    let half = DecomposerFile::from_bytes(&file.to_half_bytes().unwrap()).unwrap();
    let refused = half.resume(&mut monet, &HostDevice).unwrap_err().to_string();
    assert!(refused.contains("no optimizer"), "{refused}");
}

#[test]
fn a_weight_beyond_half_precision_is_named() {
    let config = DecomposerConfig::Monet(MonetConfig::tiny(16));
    let mut trainer = DecomposerTrainer::<Host, f32>::new(config, Schedule::constant(1e-3), 7, HostDevice).unwrap();
    let large = trainer.parameters().get("attention.last.weight").unwrap().affine(0.0, 1e6).unwrap();
    let mut weights = Parameters::new();
    weights.insert("attention.last.weight", &large).unwrap();
    trainer.set_weights(&weights).unwrap();
    let error = DecomposerFile::of(&trainer, false, "").unwrap().to_half_bytes().unwrap_err().to_string();
    assert!(error.starts_with("parameter model.attention.last.weight holds 1000000, F16 ends"), "{error}");
}
