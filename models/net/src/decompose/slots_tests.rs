//! Slot Attention by hand, and by what holds for every weight.

use dvp_core::real::DType;
use dvp_core::tensor::{Host, HostDevice, Parameters};

use super::slot_attention::SlotAttention;
use super::slots::SlotsConfig;
use super::tests::{close, tensor};
use super::{Decomposer, DecomposerConfig};
use crate::initial::initial_weights;
use crate::weights::{Weights, asked};

/// Places have 3 numbers, slots 4.
fn attention(rounds: usize, edit: impl FnOnce(&mut Parameters<Host>)) -> SlotAttention<Host> {
    let load = |weights: &Weights<'_, Host>| SlotAttention::load(weights, 3, 4, 5, rounds);
    let asked = asked::<Host, _>(&HostDevice, load).unwrap();
    let mut parameters = initial_weights(&asked, 2, DType::F64, &HostDevice).unwrap();
    edit(&mut parameters);
    load(&Weights::new(&parameters)).unwrap()
}

fn filled(parameters: &mut Parameters<Host>, name: &str, values: &[f64]) {
    let extents = parameters.get(name).unwrap().dims().extents().to_vec();
    parameters.set(name, &tensor(values, &extents)).unwrap();
}

#[test]
fn slots_take_in_the_mean_of_the_places_they_win() {
    // One round, of two slots that start at (1, 0, 0, 0) and (0, 1, 0, 0). Their norms are (3, -1, -1, -1) and (-1, 3, -1, -1) over
    // sqrt 3, up to the 1e-5 in the variance; queries are the first two numbers, over 2, the root of the width. The norms of the places
    // (1, 0, -1) and (-1, 0, 1) are (a, 0, -a) and its opposite, a = sqrt(3/2); their keys (k, -k, 0, 0) and its opposite. So the two
    // logits of the first place are 2 k / sqrt 3 and its opposite: with k = ln 3 sqrt 3 / 4 it is the first slot's by 3/4, the other
    // place by 1/4. Values are a and -a: the first slot takes 3/4 a - 1/4 a = a / 2, the second -a / 2. The unit forgets the state and
    // takes in the tangent.
    let a = 1.5_f64.sqrt();
    let k = 3.0_f64.ln() * 3.0_f64.sqrt() / 4.0;
    let attention = attention(1, |parameters| {
        filled(parameters, "log_deviation", &[0.0; 4]);
        filled(parameters, "mean", &[0.0; 4]);
        let mut queries = [0.0; 16];
        (queries[0], queries[5]) = (1.0, 1.0);
        filled(parameters, "queries.weight", &queries);
        let mut keys = [0.0; 12];
        (keys[0], keys[3]) = (k / a, -k / a);
        filled(parameters, "keys.weight", &keys);
        let mut values = [0.0; 12];
        values[0] = 1.0;
        filled(parameters, "values.weight", &values);
        let mut input = [0.0; 48];
        input[4 * 8] = 1.0; // n of the first number
        filled(parameters, "gru.input.weight", &input);
        filled(parameters, "gru.state.weight", &[0.0; 48]);
        let mut bias = [0.0; 12];
        bias[4..8].fill(-100.0); // z: nothing stays
        filled(parameters, "gru.input.bias", &bias);
        filled(parameters, "perceptron.layers.1.weight", &[0.0; 20]);
    });
    let places = tensor(&[1.0, 0.0, -1.0, -1.0, 0.0, 1.0], &[1, 2, 3]);
    let noise = tensor(&[1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0], &[1, 2, 4]);
    let slots = attention.forward(&places, &noise).unwrap().to_f64().unwrap();
    close(slots[0], (a / 2.0).tanh(), 1e-4);
    close(slots[4], -(a / 2.0).tanh(), 1e-4);
    assert!(slots[1..4].iter().chain(&slots[5..]).all(|value| value.abs() < 1e-12), "{slots:?}");
}

#[test]
fn slots_can_be_exchanged_and_so_can_places() {
    let attention = attention(3, |_| ());
    let number = |k: usize| (1.7 * k as f64 + 0.3 * (k * k) as f64).sin();
    let places = tensor(&(0..15).map(number).collect::<Vec<_>>(), &[1, 5, 3]);
    let noise = tensor(&(20..32).map(number).collect::<Vec<_>>(), &[1, 3, 4]);
    let slots = attention.forward(&places, &noise).unwrap();
    let [other_places, other_noise] = [places.select(1, &[4, 2, 0, 1, 3]), noise.select(1, &[2, 0, 1])];
    let others = attention.forward(&other_places.unwrap(), &other_noise.unwrap()).unwrap();
    let expected = slots.select(1, &[2, 0, 1]).unwrap().to_f64().unwrap();
    for (found, expected) in others.to_f64().unwrap().into_iter().zip(&expected) {
        close(found, *expected, 1e-12);
    }
    let spread = |k: usize| (expected[k] - expected[4 + k]).abs();
    assert!((0..4).map(spread).fold(0.0, f64::max) > 1e-2, "slots differ: {expected:?}");
}

#[test]
fn the_loss_is_the_mean_squared_error_of_the_reconstruction() {
    let config = DecomposerConfig::Slots(SlotsConfig::tiny(16));
    let asked = asked::<Host, Decomposer<Host>>(&HostDevice, |weights| config.load(weights)).unwrap();
    let parameters = initial_weights(&asked, 4, DType::F64, &HostDevice).unwrap();
    let decomposer = config.load(&Weights::new(&parameters)).unwrap();
    let values: Vec<f64> = (0..768).map(|k| 0.5 + 0.4 * (0.11 * f64::from(k)).sin()).collect();
    let verdict = decomposer.judge(&tensor(&values, &[1, 3, 16, 16]), 6).unwrap();
    let painted = verdict.parts.of_images().unwrap()[0].reconstruction();
    let squares = painted.data().iter().zip(&values).map(|(&a, b)| (f64::from(a) - b).powi(2));
    let expected = squares.sum::<f64>() / 768.0;
    close(verdict.loss.number().unwrap(), expected, 1e-6);
    close(verdict.terms.pixels, expected, 1e-6);
    assert_eq!((verdict.terms.latents, verdict.terms.masks), (0.0, 0.0));
    // Other chance, other slots.
    let again = decomposer.judge(&tensor(&values, &[1, 3, 16, 16]), 7).unwrap().terms.pixels;
    assert!((again - verdict.terms.pixels).abs() > 1e-9);
}

#[test]
fn published_widths_are_taken() {
    let config = DecomposerConfig::Slots(SlotsConfig::published(32));
    let asked = asked::<Host, Decomposer<Host>>(&HostDevice, |weights| config.load(weights)).unwrap();
    let of = |path: &str| -> usize {
        asked.iter().filter(|(name, _)| name.starts_with(path)).map(|(_, dims)| dims.len()).sum()
    };
    // Kernels of 5 x 5 with a bias: 3 to 64, three times 64 to 64.
    assert_eq!(of("encoder."), 25 * 3 * 64 + 64 + 3 * (25 * 64 * 64 + 64));
    // Three matrices of 64 x 64; a unit of 2 x 192 x 64 and as many biases; 64 to 128 to 64; three norms; the distribution.
    let unit = 2 * (192 * 64 + 192);
    assert_eq!(of("attention."), 3 * 64 * 64 + unit + (64 * 128 + 128) + (128 * 64 + 64) + 3 * 128 + 128);
}
