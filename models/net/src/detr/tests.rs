//! Positions by hand, and what is refused.

use dvp_core::real::DType;
use dvp_core::tensor::{Host, HostDevice, Parameters, ParametersError, Tensor};

use super::sine::{embed_grid, embed_points};
use super::{ConditionalDetr, DetrConfig};
use crate::error::NetError;
use crate::weights::Weights;

fn config() -> DetrConfig {
    DetrConfig {
        d_model: 8,
        num_queries: 3,
        encoder_layers: 0,
        encoder_attention_heads: 2,
        encoder_ffn_dim: 4,
        decoder_layers: 1,
        decoder_attention_heads: 2,
        decoder_ffn_dim: 4,
        activation_function: "relu".into(),
        position_embedding_type: "sine".into(),
    }
}

#[test]
fn points_by_hand() {
    // Width 8: per coordinate sin and cos of 2 pi u, then of 2 pi u / 10000^(2/4) = 2 pi u / 100; y first.
    let point = Tensor::<Host>::new(vec![0.25_f64, 0.5], &[1, 2], &HostDevice).unwrap();
    let found = embed_points(&point, 8).unwrap().to_f64().unwrap();
    let (slow_y, slow_x) = (core::f64::consts::PI / 100.0, core::f64::consts::PI / 200.0);
    let expected = [0.0, -1.0, slow_y.sin(), slow_y.cos(), 1.0, 0.0, slow_x.sin(), slow_x.cos()];
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() < 1e-14, "{found:?}");
    }
}

#[test]
fn cells_are_in_rows() {
    let like = Tensor::<Host>::new(vec![0.0_f64], &[1], &HostDevice).unwrap();
    let grid = embed_grid(2, 3, 8, &like).unwrap();
    assert_eq!(grid.dims().extents(), [1, 6, 8]);
    // The second cell of the first row is at x = 2/3, y = 1/2, but for the 1e-6 in the divisors.
    let point = Tensor::<Host>::new(vec![2.0_f64 / 3.0, 0.5], &[1, 1, 2], &HostDevice).unwrap();
    let expected = embed_points(&point, 8).unwrap().to_f64().unwrap();
    let found = grid.slice(1, 1, 1).unwrap().to_f64().unwrap();
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() < 4e-6, "{found:?}");
    }
}

#[test]
fn a_missing_weight_is_named() {
    let parameters = Parameters::<Host>::new();
    let weights = Weights::new(&parameters).under("model");
    let error = ConditionalDetr::load(&config(), &weights).unwrap_err();
    let first = "model.decoder.layers.0.sa_qcontent_proj.weight";
    let named = matches!(&error, NetError::Parameters(ParametersError::Missing { name }) if name == first);
    assert!(named, "{error}");
}

/// Weights of the smallest model, all 1/4.
fn parameters(queries: &str) -> Parameters<Host> {
    let mut parameters = Parameters::new();
    let mut add = |name: String, extents: &[usize]| {
        parameters.insert(name, &Tensor::full(0.25, extents, DType::F32, &HostDevice).unwrap()).unwrap();
    };
    let mut linear = |name: &str, inputs: usize, outputs: usize| {
        add(format!("{name}.weight"), &[outputs, inputs]);
        add(format!("{name}.bias"), &[outputs]);
    };
    let maps = "sa_qcontent_proj sa_qpos_proj sa_kcontent_proj sa_kpos_proj sa_v_proj self_attn.out_proj \
                ca_qcontent_proj ca_qpos_proj ca_qpos_sine_proj ca_kcontent_proj ca_kpos_proj ca_v_proj \
                encoder_attn.out_proj";
    for name in maps.split_whitespace() {
        linear(&format!("decoder.layers.0.{name}"), 8, 8);
    }
    linear("decoder.layers.0.fc1", 8, 4);
    linear("decoder.layers.0.fc2", 4, 8);
    linear("decoder.ref_point_head.layers.0", 8, 8);
    linear("decoder.ref_point_head.layers.1", 8, 2);
    linear("decoder.query_scale.layers.0", 8, 8);
    linear("decoder.query_scale.layers.1", 8, 8);
    let norms = ["self_attn_layer_norm", "encoder_attn_layer_norm", "final_layer_norm"];
    for name in norms.map(|name| format!("decoder.layers.0.{name}")).iter().chain([&"decoder.layernorm".to_owned()]) {
        add(format!("{name}.weight"), &[8]);
        add(format!("{name}.bias"), &[8]);
    }
    add(queries.to_owned(), &[3, 8]);
    parameters
}

#[test]
fn queries_are_found_under_both_names() {
    for name in ["query_position_embeddings.weight", "query_position_embedding.weight"] {
        let parameters = parameters(name);
        let model = ConditionalDetr::load(&config(), &Weights::new(&parameters)).unwrap();
        let features = Tensor::full(0.5, &[2, 8, 1, 3], DType::F32, &HostDevice).unwrap();
        let output = model.forward(&features).unwrap();
        assert_eq!(output.memory.dims().extents(), [2, 3, 8]);
        assert_eq!(output.latents.dims().extents(), [2, 3, 8]);
    }
}

#[test]
fn features_of_other_extents_are_refused() {
    let parameters = parameters("query_position_embeddings.weight");
    let model = ConditionalDetr::load(&config(), &Weights::new(&parameters)).unwrap();
    for extents in [&[1, 4, 2, 2][..], &[1, 8, 4], &[1, 8, 0, 2]] {
        let features = Tensor::full(0.5, extents, DType::F32, &HostDevice).unwrap();
        let Err(NetError::Input { dims, .. }) = model.forward(&features) else { panic!("{extents:?}") };
        assert_eq!(dims.extents(), extents);
    }
}

#[test]
fn sizes_of_no_model_are_refused() {
    let key = |config: DetrConfig| match config.validate() {
        Err(NetError::Config { key, .. }) => key,
        other => panic!("{other:?}"),
    };
    assert!(config().validate().is_ok());
    assert_eq!(key(DetrConfig { d_model: 6, ..config() }), "d_model");
    assert_eq!(key(DetrConfig { decoder_attention_heads: 3, ..config() }), "decoder_attention_heads");
    assert_eq!(key(DetrConfig { decoder_layers: 0, ..config() }), "decoder_layers");
    assert_eq!(key(DetrConfig { activation_function: "gelu".into(), ..config() }), "activation_function");
    assert_eq!(key(DetrConfig { position_embedding_type: "learned".into(), ..config() }), "position_embedding_type");
}
