//! Files written by the public implementations.

use std::path::PathBuf;

use dvp_core::tensor::{Backend, Parameters, Tensor};
use serde::de::DeserializeOwned;

/// Most by which an output may differ. Outputs are of order 1, sums of up to 588 products in f32; what is measured is
/// below 4e-6.
pub(crate) const TOLERANCE: f64 = 1e-5;

fn bytes(file: &str) -> Vec<u8> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/golden_data/models");
    std::fs::read(folder.join(file)).unwrap()
}

/// The tensors of a safetensors file.
pub(crate) fn tensors<B: Backend>(file: &str, device: &B::Device) -> Parameters<B> {
    Parameters::from_safetensors(&bytes(file), device).unwrap()
}

/// A published `config.json`.
pub(crate) fn config<C: DeserializeOwned>(file: &str) -> C {
    serde_json::from_slice(&bytes(file)).unwrap()
}

/// Fails if a tensor is not the expected one.
pub(crate) fn assert_close<B: Backend>(what: &str, found: &Tensor<B>, expected: &Tensor<B>) {
    assert_eq!(found.dims(), expected.dims(), "{}: {what}", B::NAME);
    let (found, expected) = (found.to_f64().unwrap(), expected.to_f64().unwrap());
    let differences = found.iter().zip(&expected).map(|(a, b)| (a - b).abs());
    // Written so that a NaN fails.
    let worst = differences.fold(0.0, |worst, difference| if difference <= worst { worst } else { difference });
    eprintln!("{}: {what} differs by at most {worst:.1e}", B::NAME);
    assert!(worst <= TOLERANCE, "{}: {what} differs by {worst:e}", B::NAME);
}

/// Fails unless `output` depends on every parameter but `unused`: no weight was left out.
pub(crate) fn assert_all_used<B: Backend>(output: &Tensor<B>, parameters: &Parameters<B>, unused: &[&str]) {
    let gradients = output.mul(output).unwrap().mean_all().unwrap().backward().unwrap();
    for (name, parameter) in parameters.iter() {
        assert_eq!(gradients.of(parameter).is_some(), !unused.contains(&name), "{}: gradient of {name}", B::NAME);
    }
}
