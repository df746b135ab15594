//! Both networks against their public PyTorch implementations, on small random weights: `tests/golden_data/models`, where
//! `make_models.py` says how the outputs were made. And the gradients of a step, the same on every backend.

mod detr;
mod dinov2;

use std::path::PathBuf;

use dvp_core::real::DType;
use dvp_core::tensor::{Host, Parameters, Tensor};
use dvp_net::error::NetError;
use dvp_tests::finite_difference::dot;
use serde::de::DeserializeOwned;

use crate::check::{Gradients, close, close_gradients};
use crate::network::numbers;
use crate::registry::{Outcome, Tally, Tested};

/// Most by which an output in f32 may differ from PyTorch's. Outputs are of order 1, sums of up to 588 products.
const TOLERANCE: f64 = 1e-5;

/// Most by which a gradient may differ from the host's, in parts of the largest number of its array: sums over all tokens
/// of both images. In arrays whose numbers are below a thousandth of the largest of all, in parts of that thousandth: a
/// softmax does not see a shift, so that gradients of the biases of keys are 0 but for rounding.
fn tolerance(dtype: DType) -> f64 {
    match dtype {
        DType::F32 => 5e-6,
        DType::F64 => 1e-12,
    }
}

/// A network of this suite, with the file names of its fixtures before `_config.json`, `.safetensors` and
/// `_io.safetensors`.
trait Published {
    const STEM: &'static str;
    /// Name of the input in the file.
    const INPUT: &'static str;
    /// Weights that no output depends on.
    const UNUSED: &'static [&'static str];

    /// The output of the network for these weights.
    fn output<B: Tested>(parameters: &Parameters<B>, input: &Tensor<B>) -> Result<Tensor<B>, NetError>;
}

fn bytes(stem: &str, rest: &str) -> Vec<u8> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("golden_data/models");
    std::fs::read(folder.join(format!("{stem}{rest}"))).unwrap()
}

/// A published `config.json`.
fn config<P: Published, C: DeserializeOwned>() -> C {
    serde_json::from_slice(&bytes(P::STEM, "_config.json")).unwrap()
}

fn weights<P: Published, B: Tested>() -> Parameters<B> {
    Parameters::from_safetensors(&bytes(P::STEM, ".safetensors"), &B::place()).unwrap()
}

/// Inputs and outputs of the public implementation.
fn io<P: Published, B: Tested>() -> Parameters<B> {
    Parameters::from_safetensors(&bytes(P::STEM, "_io.safetensors"), &B::place()).unwrap()
}

/// A tensor of the public implementation in f32; absolute.
fn published<B: Tested>(tally: &Tally, what: &str, found: &Tensor<B>, io: &Parameters<B>) -> Outcome {
    let expected = io.get(what)?;
    tally.check(found.dims() == expected.dims(), || {
        format!("{what} is {}, must be {}", found.dims(), expected.dims())
    })?;
    let (found, expected) = (found.to_f64()?, expected.to_f64()?);
    let differences = found.iter().zip(&expected).map(|(a, b)| (a - b).abs());
    // Written so that a NaN fails.
    let worst = differences.fold(0.0, |worst, difference| if difference <= worst { worst } else { difference });
    tally.check(worst <= TOLERANCE, || format!("{what} differs by {worst:e}"))
}

/// The mean square of the output, and its gradients.
fn step<P: Published, B: Tested>(parameters: &Parameters<B>, input: &Tensor<B>) -> Result<(f64, Gradients), NetError> {
    let output = P::output(parameters, input)?;
    let loss = output.mul(&output)?.mean_all()?;
    let gradients = loss.backward()?;
    let gradients = parameters.gradients(&gradients).into_iter().map(|(name, gradient)| Ok((name, gradient.to_f64()?)));
    Ok((loss.number()?, gradients.collect::<Result<_, NetError>>()?))
}

/// Weights and input in a number type.
fn cast<P: Published, B: Tested>(dtype: DType) -> Result<(Parameters<B>, Tensor<B>), NetError> {
    let mut parameters = Parameters::new();
    for (name, weight) in weights::<P, B>().iter() {
        parameters.insert(name, &weight.cast(dtype)?)?;
    }
    let input = io::<P, B>().get(P::INPUT)?.cast(dtype)?;
    Ok((parameters, input))
}

/// Loss and gradients as on the host, of every weight that is used; in f64 also along one direction as central differences
/// say.
fn gradients<P: Published, B: Tested>(tally: &Tally) -> Outcome {
    for dtype in [DType::F32, DType::F64] {
        let (parameters, input) = cast::<P, B>(dtype)?;
        let (loss, own) = step::<P, B>(&parameters, &input)?;
        let (parameters_host, input_host) = cast::<P, Host>(dtype)?;
        let (loss_host, host) = step::<P, Host>(&parameters_host, &input_host)?;
        close(tally, "loss", &[loss], &[loss_host], tolerance(dtype))?;
        let used = parameters.iter().map(|(name, _)| name).filter(|name| !P::UNUSED.contains(name));
        tally.check(used.eq(own.iter().map(|(name, _)| name)), || "weights without a gradient".into())?;
        close_gradients(tally, &format!("{dtype} gradient"), &own, &host, tolerance(dtype))?;
        if dtype == DType::F64 {
            along_a_direction::<P, B>(tally, &parameters, &input, &own)?;
        }
    }
    Ok(())
}

/// The slope of the loss along a random direction of all weights at once, by central differences.
fn along_a_direction<P: Published, B: Tested>(
    tally: &Tally,
    parameters: &Parameters<B>,
    input: &Tensor<B>,
    gradients: &Gradients,
) -> Outcome {
    /// Rounding of the loss, about 1e-15, over the step is 1e-9; few units of a ReLU change sides.
    const STEP: f64 = 1e-6;
    let directions: Vec<Vec<f64>> =
        (1..).zip(gradients).map(|(seed, (_, gradient))| numbers(seed, gradient.len())).collect();
    let moved = |step: f64| {
        let mut moved = parameters.clone();
        for ((name, _), direction) in gradients.iter().zip(&directions) {
            let weight = parameters.get(name)?.detach()?;
            let direction = weight.like(direction.clone(), weight.dims().extents())?;
            moved.set(name, &weight.add(&direction.affine(step, 0.0)?)?)?;
        }
        let output = P::output(&moved, input)?;
        Ok::<f64, NetError>(output.mul(&output)?.mean_all()?.number()?)
    };
    let slope = (moved(STEP)? - moved(-STEP)?) / (2.0 * STEP);
    let expected: f64 =
        gradients.iter().zip(&directions).map(|((_, gradient), direction)| dot(gradient, direction)).sum();
    close(tally, "slope of the loss", &[slope], &[expected], 1e-8)
}
