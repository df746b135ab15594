//! Adam and its schedule against PyTorch's; `golden_data/make_optim.py` made the numbers.

use dvp_core::Real;
use dvp_core::optim::{Plateau, PlateauSettings};
use dvp_fit::adam::{Adam, AdamSettings};
use serde::Deserialize;

#[derive(Deserialize)]
struct Golden {
    adam: AdamCase,
    plateau: PlateauCase,
}

#[derive(Deserialize)]
struct AdamCase {
    start: Vec<f64>,
    target: Vec<f64>,
    weight: Vec<f64>,
    wave: Vec<f64>,
    learning_rate: f64,
    path: Vec<Point>,
}

#[derive(Deserialize)]
struct Point {
    step: usize,
    parameters: Vec<f64>,
}

#[derive(Deserialize)]
struct PlateauCase {
    learning_rate: f64,
    losses: Vec<f64>,
    rates: Vec<f64>,
}

fn golden() -> Golden {
    serde_json::from_str(include_str!("../golden_data/optim.json")).unwrap()
}

/// The largest difference of the path to PyTorch's.
fn adam_error<T: Real>() -> f64 {
    let AdamCase { start, target, weight, wave, learning_rate, path } = golden().adam;
    let mut parameters: Vec<T> = start.iter().map(|&p| T::of(p)).collect();
    let mut adam = Adam::new(AdamSettings::default(), parameters.len());
    let mut worst = 0.0_f64;
    let mut compared = 0;
    for step in 1..=path.last().unwrap().step {
        // Of w (p - q)^2 / 2 + a cos(3 p): w (p - q) - 3 a sin(3 p).
        let gradient: Vec<T> = (0..parameters.len())
            .map(|i| {
                let p = parameters[i];
                T::of(weight[i]) * (p - T::of(target[i])) - T::of(3.0 * wave[i]) * (T::of(3.0) * p).sin()
            })
            .collect();
        adam.step(&mut parameters, &gradient, learning_rate);
        for point in path.iter().filter(|point| point.step == step) {
            for (&p, expected) in parameters.iter().zip(&point.parameters) {
                worst = worst.max((p.as_f64() - expected).abs());
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 4 * path.len());
    worst
}

#[test]
fn adam_walks_pytorchs_path() {
    let worst = adam_error::<f64>();
    assert!(worst < 1e-13, "{worst:e}");
    // The fourth gradient is a rounding error of f32 in size, so that Adam's direction is noise there: a few steps of
    // epsilon's making, 1e-6; the others differ by rounding.
    let worst = adam_error::<f32>();
    assert!(worst < 2e-5, "{worst:e}");
}

#[test]
fn plateau_cuts_when_pytorch_cuts() {
    let PlateauCase { learning_rate, losses, rates } = golden().plateau;
    let mut plateau = Plateau::new(PlateauSettings::default(), learning_rate);
    let found: Vec<f64> = losses
        .iter()
        .map(|&loss| {
            plateau.observe(loss);
            plateau.learning_rate()
        })
        .collect();
    assert_eq!(found, rates);
    assert!(rates.windows(2).filter(|pair| pair[1] < pair[0]).count() >= 4);
}
