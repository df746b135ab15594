//! The position table by hand, and what is refused.

use dvp_core::real::DType;
use dvp_core::tensor::{Host, HostDevice, Parameters, ParametersError, Tensor};

use super::position::resample;
use super::{Dinov2, Dinov2Config};
use crate::error::NetError;
use crate::weights::Weights;

fn config() -> Dinov2Config {
    Dinov2Config {
        hidden_size: 4,
        num_hidden_layers: 1,
        num_attention_heads: 2,
        mlp_ratio: 2,
        hidden_act: "gelu".into(),
        layer_norm_eps: 1e-6,
        image_size: 6,
        patch_size: 2,
        num_channels: 3,
        qkv_bias: true,
        use_swiglu_ffn: false,
        num_register_tokens: 2,
    }
}

/// Weights of a model of these sizes, all 1/4: extents and names matter, numbers do not.
fn parameters() -> Parameters<Host> {
    let mut parameters = Parameters::new();
    let mut add = |name: &str, extents: &[usize]| {
        parameters.insert(name, &Tensor::full(0.25, extents, DType::F32, &HostDevice).unwrap()).unwrap();
    };
    add("embeddings.cls_token", &[1, 1, 4]);
    add("embeddings.register_tokens", &[1, 2, 4]);
    add("embeddings.position_embeddings", &[1, 10, 4]);
    add("embeddings.patch_embeddings.projection.weight", &[4, 3, 2, 2]);
    add("embeddings.patch_embeddings.projection.bias", &[4]);
    for name in ["norm1", "norm2"] {
        add(&format!("encoder.layer.0.{name}.weight"), &[4]);
        add(&format!("encoder.layer.0.{name}.bias"), &[4]);
    }
    for name in ["attention.attention.query", "attention.attention.key", "attention.attention.value"] {
        add(&format!("encoder.layer.0.{name}.weight"), &[4, 4]);
        add(&format!("encoder.layer.0.{name}.bias"), &[4]);
    }
    add("encoder.layer.0.attention.output.dense.weight", &[4, 4]);
    add("encoder.layer.0.attention.output.dense.bias", &[4]);
    add("encoder.layer.0.mlp.fc1.weight", &[8, 4]);
    add("encoder.layer.0.mlp.fc1.bias", &[8]);
    add("encoder.layer.0.mlp.fc2.weight", &[4, 8]);
    add("encoder.layer.0.mlp.fc2.bias", &[4]);
    add("encoder.layer.0.layer_scale1.lambda1", &[4]);
    add("encoder.layer.0.layer_scale2.lambda1", &[4]);
    add("layernorm.weight", &[4]);
    add("layernorm.bias", &[4]);
    parameters
}

fn images(extents: &[usize]) -> Tensor<Host> {
    Tensor::full(0.5, extents, DType::F32, &HostDevice).unwrap()
}

/// All parameters but one.
fn without(name: &str) -> Parameters<Host> {
    let mut rest = Parameters::new();
    for (other, tensor) in parameters().iter().filter(|(other, _)| *other != name) {
        rest.insert(other, tensor).unwrap();
    }
    rest
}

#[test]
fn rows_and_columns_keep_their_places() {
    // 2 x 2 patches of width 1 in 1 x 2: rows are averaged, columns kept.
    let table = Tensor::<Host>::new(vec![1.0_f64, 10.0, 3.0, 30.0], &[1, 4, 1], &HostDevice).unwrap();
    let found = resample(&table, 2, 1, 2, 1).unwrap();
    assert_eq!(found.dims().extents(), [2, 1]);
    let found = found.to_f64().unwrap();
    assert!((found[0] - 2.0).abs() < 1e-14 && (found[1] - 20.0).abs() < 1e-13, "{found:?}");
}

#[test]
fn tokens_are_class_registers_and_patches() {
    let parameters = parameters();
    let model = Dinov2::load(&config(), &Weights::new(&parameters)).unwrap();
    let tokens = model.forward(&images(&[2, 3, 4, 8])).unwrap();
    assert_eq!(tokens.dims().extents(), [2, 1 + 2 + 8, 4]);
    assert_eq!(model.patches(&tokens).unwrap().dims().extents(), [2, 8, 4]);
}

#[test]
fn a_missing_weight_is_named() {
    for name in ["embeddings.register_tokens", "encoder.layer.0.mlp.fc2.bias", "layernorm.weight"] {
        let error = Dinov2::load(&config(), &Weights::new(&without(name))).unwrap_err();
        let named =
            matches!(&error, NetError::Parameters(ParametersError::Missing { name: missing }) if missing == name);
        assert!(named, "{error}");
    }
}

#[test]
fn weights_of_another_size_are_named() {
    let error = Dinov2::load(&Dinov2Config { image_size: 8, ..config() }, &Weights::new(&parameters())).unwrap_err();
    let message = error.to_string();
    assert!(message.starts_with("parameter embeddings.position_embeddings is [1, 10, 4]"), "{message}");
}

#[test]
fn images_that_patches_do_not_tile_are_refused() {
    let parameters = parameters();
    let model = Dinov2::load(&config(), &Weights::new(&parameters)).unwrap();
    for (height, width) in [(5, 4), (4, 7), (0, 4)] {
        let error = model.forward(&images(&[1, 3, height, width])).unwrap_err();
        let NetError::ImageSize { width: w, height: h, patch: 2 } = error else { panic!("{error}") };
        assert_eq!((h, w), (height, width));
    }
    for extents in [&[1, 4, 4, 4][..], &[3, 4, 4]] {
        assert!(matches!(model.forward(&images(extents)), Err(NetError::Input { .. })), "{extents:?}");
    }
}

#[test]
fn sizes_of_no_model_are_refused() {
    let key = |config: Dinov2Config| match config.validate() {
        Err(NetError::Config { key, .. }) => key,
        other => panic!("{other:?}"),
    };
    assert!(config().validate().is_ok());
    assert_eq!(key(Dinov2Config { num_attention_heads: 3, ..config() }), "num_attention_heads");
    assert_eq!(key(Dinov2Config { num_attention_heads: 0, ..config() }), "num_attention_heads");
    assert_eq!(key(Dinov2Config { patch_size: 7, ..config() }), "image_size");
    assert_eq!(key(Dinov2Config { patch_size: 0, ..config() }), "patch_size");
    assert_eq!(key(Dinov2Config { layer_norm_eps: f64::NAN, ..config() }), "layer_norm_eps");
    assert_eq!(key(Dinov2Config { hidden_act: "relu".into(), ..config() }), "hidden_act");
    assert_eq!(key(Dinov2Config { use_swiglu_ffn: true, ..config() }), "use_swiglu_ffn");
}
