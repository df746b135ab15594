//! Layers by hand.

use dvp_core::tensor::{Host, HostDevice, Parameters, Tensor};

use super::{Gru, InstanceNorm, Mlp, attend, halved, join_heads, places, repeated};
use crate::weights::Weights;

fn tensor(values: &[f64], extents: &[usize]) -> Tensor<Host> {
    Tensor::new(values.to_vec(), extents, &HostDevice).unwrap()
}

#[test]
fn attention_by_hand() {
    // Width 4, 2 heads of width 2. Head 0: query (sqrt 2 ln 3, 0), keys (1, 0) and (0, 0): scores ln 3 and 0, weights
    // 3/4 and 1/4. Head 1: query 0: weights 1/2. Values have width 2, one number per head.
    let query = tensor(&[2.0_f64.sqrt() * 3.0_f64.ln(), 0.0, 0.0, 0.0], &[1, 1, 4]);
    let keys = tensor(&[1.0, 0.0, 5.0, 7.0, 0.0, 0.0, -3.0, 2.0], &[1, 2, 4]);
    let values = tensor(&[4.0, 10.0, 8.0, 20.0, 0.0, 0.0, 4.0, 2.0], &[2, 2, 2]);
    let mixed = attend(&query, &keys, &values, 2).unwrap();
    assert_eq!(mixed.dims().extents(), [2, 1, 2], "queries and keys are stretched to the batch of the values");
    for (found, expected) in mixed.to_f64().unwrap().iter().zip([5.0, 15.0, 1.0, 1.0]) {
        assert!((found - expected).abs() < 1e-14, "{found} for {expected}");
    }
}

#[test]
fn a_gated_recurrent_unit_by_hand() {
    // Width 1, h = 2, x = 1. r = s(ln 3) = 3/4: weight ln 3 of x. z = s(-ln 4) = 1/5: biases -ln 2 each. n = tanh(1 + r (2 + 2)) with
    // weight 1 of x, weight 1 of h and a bias of 2 that the gate r holds back: tanh(4). (1 - z) n + z h.
    let ln = |x: f64| x.ln();
    let mut parameters = Parameters::new();
    for (name, values, extents) in [
        ("input.weight", [ln(3.0), 0.0, 1.0], &[3, 1][..]),
        ("input.bias", [0.0, -ln(2.0), 0.0], &[3]),
        ("state.weight", [0.0, 0.0, 1.0], &[3, 1]),
        ("state.bias", [0.0, -ln(2.0), 2.0], &[3]),
    ] {
        parameters.insert(name, &tensor(&values, extents)).unwrap();
    }
    let gru = Gru::load(&Weights::new(&parameters), 1).unwrap();
    let state = gru.forward(&tensor(&[1.0], &[1, 1, 1]), &tensor(&[2.0], &[1, 1, 1])).unwrap();
    let (found, expected) = (state.to_f64().unwrap()[0], 0.8 * 4.0_f64.tanh() + 0.2 * 2.0);
    assert!((found - expected).abs() < 1e-14, "{found} for {expected}");
}

#[test]
fn heads_are_joined_part_by_part() {
    let (a, b) = (tensor(&[1.0, 2.0, 3.0, 4.0], &[1, 1, 4]), tensor(&[5.0, 6.0, 7.0, 8.0], &[1, 1, 4]));
    let joined = join_heads(&a, &b, 2).unwrap();
    assert_eq!(joined.to_f64().unwrap(), [1.0, 2.0, 5.0, 6.0, 3.0, 4.0, 7.0, 8.0]);
}

#[test]
fn heads_that_do_not_divide_are_refused() {
    let x = tensor(&[0.0; 4], &[1, 1, 4]);
    for heads in [0, 3] {
        let error = attend(&x, &x, &x, heads).unwrap_err();
        assert!(error.to_string().contains("the heads must divide"), "{error}");
    }
    let flat = tensor(&[0.0; 4], &[1, 4]);
    assert!(attend(&flat, &x, &x, 2).is_err());
}

#[test]
fn a_perceptron_by_hand() {
    // relu(x (1, -1) + (0, 1)) = (2, 0) at x = 2 and (0, 4) at x = -3; then 3 a + 5 b - 1.
    let mut parameters = Parameters::new();
    parameters.insert("layers.0.weight", &tensor(&[1.0, -1.0], &[2, 1])).unwrap();
    parameters.insert("layers.0.bias", &tensor(&[0.0, 1.0], &[2])).unwrap();
    parameters.insert("layers.1.weight", &tensor(&[3.0, 5.0], &[1, 2])).unwrap();
    parameters.insert("layers.1.bias", &tensor(&[-1.0], &[1])).unwrap();
    let mlp = Mlp::load(&Weights::new(&parameters), &[1, 2, 1]).unwrap();
    let found = mlp.forward(&tensor(&[2.0, -3.0], &[2, 1])).unwrap();
    assert_eq!(found.to_f64().unwrap(), [5.0, 19.0]);
}

#[test]
fn an_instance_norm_by_hand() {
    // Two channels of 17 x 1 pixels: 8 x 1, 1 x 0 and 8 x -1 in the first, whose mean is 0 and variance 16 / 17; the same number
    // everywhere in the second.
    let mut parameters = Parameters::new();
    parameters.insert("weight", &tensor(&[3.0, 7.0], &[2])).unwrap();
    parameters.insert("bias", &tensor(&[0.5, -2.0], &[2])).unwrap();
    let norm = InstanceNorm::load(&Weights::new(&parameters), 2).unwrap();
    let first = (0..17).map(|k| f64::from((8_i32 - k).signum()));
    let image: Vec<f64> = first.chain([4.0; 17]).collect();
    let found = norm.forward(&tensor(&image, &[1, 2, 17, 1])).unwrap();
    assert_eq!(found.dims().extents(), [1, 2, 17, 1]);
    let found = found.to_f64().unwrap();
    let expected = 3.0 / (16.0_f64 / 17.0 + 1e-5).sqrt();
    assert!((found[0] - 0.5 - expected).abs() < 1e-12 && (found[16] - 0.5 + expected).abs() < 1e-12, "{found:?}");
    assert!((found[8] - 0.5).abs() < 1e-12 && found[17..].iter().all(|x| (x + 2.0).abs() < 1e-12), "{found:?}");
    assert!(norm.forward(&tensor(&[0.0; 4], &[2, 2])).is_err());
}

#[test]
fn images_are_halved_and_repeated() {
    let image = tensor(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0], &[1, 1, 2, 4]);
    assert_eq!(halved(&image).unwrap().to_f64().unwrap(), [1.0, 3.0]);
    assert!(halved(&tensor(&[0.0; 3], &[1, 1, 1, 3])).is_err(), "odd sides");
    let small = tensor(&[1.0, 2.0, 3.0, 4.0], &[2, 1, 1, 2]);
    let found = repeated(&small, 2).unwrap();
    assert_eq!(found.dims().extents(), [2, 1, 2, 4]);
    assert_eq!(found.to_f64().unwrap()[..8], [1.0, 1.0, 2.0, 2.0, 1.0, 1.0, 2.0, 2.0]);
    assert_eq!(halved(&found).unwrap().to_f64().unwrap(), small.to_f64().unwrap());
}

#[test]
fn places_run_from_border_to_border() {
    assert_eq!(places(1, 2), [-0.5, 0.5, 0.0, 0.0], "columns, then rows");
}
