//! Extents, places, and what is refused.

use dvp_core::real::DType;
use dvp_core::tensor::{Host, HostDevice, Parameters, Tensor};

use super::{ConvConfig, EncoderConfig};
use crate::error::NetError;
use crate::initial::initial_weights;
use crate::model::ModelConfig;
use crate::weights::{Weights, asked};

fn config() -> EncoderConfig {
    EncoderConfig::Conv(ConvConfig { patch: 4, channels: vec![3, 5], residual: 1 })
}

fn weights(config: &EncoderConfig) -> Parameters<Host> {
    let asked = asked::<Host, _>(&HostDevice, |weights| config.load(weights)).unwrap();
    initial_weights(&asked, 1, DType::F32, &HostDevice).unwrap()
}

fn images(extents: &[usize]) -> Tensor<Host> {
    Tensor::full(0.25, extents, DType::F32, &HostDevice).unwrap()
}

#[test]
fn every_stage_but_the_first_halves_the_grid() {
    let weights = weights(&config());
    let encoder = config().load(&Weights::new(&weights)).unwrap();
    let features = encoder.forward(&images(&[2, 3, 16, 24])).unwrap();
    assert_eq!(features.dims().extents(), [2, encoder.channels(), 2, 3]);
    assert_eq!(encoder.channels(), 5);
}

#[test]
fn features_of_a_flat_image_tell_their_place() {
    let weights = weights(&config());
    let encoder = config().load(&Weights::new(&weights)).unwrap();
    let features = encoder.forward(&images(&[1, 3, 64, 64])).unwrap().to_f64().unwrap();
    // Two places inside, far from the border: what the convolutions see of the image is the same.
    let differ = features.chunks(64).any(|channel| (channel[8 * 3 + 3] - channel[8 * 4 + 5]).abs() > 1e-6);
    assert!(differ);
}

#[test]
fn other_extents_are_refused() {
    let weights = weights(&config());
    let encoder = config().load(&Weights::new(&weights)).unwrap();
    for extents in [&[1, 4, 16, 16][..], &[3, 16, 16]] {
        assert!(matches!(encoder.forward(&images(extents)), Err(NetError::Input { .. })), "{extents:?}");
    }
    assert!(matches!(encoder.forward(&images(&[1, 3, 3, 16])), Err(NetError::ImageSize { patch: 4, .. })));
}

#[test]
fn sizes_of_no_encoder_are_refused() {
    for (patch, channels) in [(0, vec![3]), (4, vec![]), (4, vec![3, 0])] {
        let config = EncoderConfig::Conv(ConvConfig { patch, channels, residual: 0 });
        assert!(matches!(asked::<Host, _>(&HostDevice, |weights| config.load(weights)), Err(NetError::Config { .. })));
    }
}

#[test]
fn patches_of_the_vit_come_as_a_grid() {
    let EncoderConfig::Vit(mut config) = ModelConfig::paper().encoder else { panic!("the paper's encoder is a ViT") };
    let model = &mut config.model;
    (model.hidden_size, model.num_hidden_layers, model.num_attention_heads) = (8, 1, 2);
    (model.image_size, model.patch_size, config.side) = (12, 4, 12);
    let config = EncoderConfig::Vit(config);
    let weights = weights(&config);
    let encoder = config.load(&Weights::new(&weights)).unwrap();
    let features = encoder.forward(&images(&[2, 3, 10, 14])).unwrap();
    assert_eq!(features.dims().extents(), [2, 8, 3, 3]);
    assert!(!features.is_tracked(), "frozen");
}
