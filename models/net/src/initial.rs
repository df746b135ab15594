//! Weights of a model that has learned nothing.

use core::f64::consts::TAU;

use dvp_core::dims::Dims;
use dvp_core::real::{DType, Values};
use dvp_core::tensor::{Backend, Parameters, ParametersError, Tensor};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use crate::weights::Asked;

/// Deviation of class tokens, registers and position tables.
///
/// *Source*: the public implementation of DINOv2.
const TOKEN_DEVIATION: f64 = 0.02;

/// Weights of the names and extents in `asked`, the same for the same seed on every backend.
///
/// Uniform around 0: linear maps with the variance of Glorot and Bengio (2010), kernels with that of He et al. (2015),
/// embeddings of queries with variance 1. Biases are 0, factors of norms and running variances 1.
///
/// # Errors
/// If the framework refuses.
pub fn initial_weights<B: Backend>(
    asked: &[Asked],
    seed: u64,
    dtype: DType,
    device: &B::Device,
) -> Result<Parameters<B>, ParametersError> {
    let mut parameters = Parameters::new();
    for (k, (name, dims)) in (0..).zip(asked) {
        // A stream for each: a weight more leaves the others alone.
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(k);
        let values = match start(name, dims) {
            Start::Constant(value) => vec![value; dims.len()],
            Start::Uniform { deviation } => {
                let bound = deviation * 3.0_f64.sqrt();
                (0..dims.len()).map(|_| rng.random_range(-bound..bound)).collect()
            }
        };
        parameters.insert(name.as_str(), &Tensor::from_values(Values::F64(values).cast(dtype), dims, device)?)?;
    }
    Ok(parameters)
}

/// How a weight starts.
enum Start {
    Constant(f64),
    Uniform { deviation: f64 },
}

/// Told by what modules call their weights, and by rank.
fn start(name: &str, dims: &Dims) -> Start {
    let last = name.rsplit('.').next().unwrap_or(name);
    let sum = |extents: &[usize]| extents.iter().sum::<usize>() as f64;
    match *dims.extents() {
        [_] if matches!(last, "weight" | "running_var" | "lambda1") => Start::Constant(1.0),
        [_] => Start::Constant(0.0),
        [_, _] if name.contains("query_position_embedding") => Start::Uniform { deviation: 1.0 },
        [outputs, inputs] => Start::Uniform { deviation: (2.0 / sum(&[outputs, inputs])).sqrt() },
        [_, channels, rows, columns] => Start::Uniform { deviation: (2.0 / (channels * rows * columns) as f64).sqrt() },
        _ => Start::Uniform { deviation: TOKEN_DEVIATION },
    }
}

/// A number from the standard normal distribution.
///
/// *Source*: Box and Muller: A note on the generation of random normal deviates (1958).
pub(crate) fn normal(rng: &mut ChaCha8Rng) -> f64 {
    // In (0, 1]: the logarithm is finite.
    let radius = (-2.0 * (1.0 - rng.random_range(0.0..1.0_f64)).ln()).sqrt();
    radius * rng.random_range(0.0..TAU).cos()
}

#[cfg(test)]
mod tests {
    use dvp_core::tensor::{Host, HostDevice};

    use super::*;

    fn of(name: &str, extents: &[usize]) -> Vec<f64> {
        let asked = [(name.to_owned(), Dims::new(extents).unwrap())];
        let parameters = initial_weights::<Host>(&asked, 5, DType::F64, &HostDevice).unwrap();
        parameters.get(name).unwrap().to_f64().unwrap()
    }

    fn deviation(values: &[f64]) -> f64 {
        (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt()
    }

    #[test]
    fn spread_is_that_of_the_sources() {
        // 10^4 uniform numbers: their deviation is known to about 0.5 %.
        for (name, extents, expected) in [
            ("head.weight", &[100, 100][..], (2.0_f64 / 200.0).sqrt()),
            ("stem.weight", &[100, 4, 5, 5], (2.0_f64 / 100.0).sqrt()),
            ("query_position_embeddings.weight", &[100, 100], 1.0),
            ("embeddings.register_tokens", &[1, 100, 100], 0.02),
        ] {
            let found = deviation(&of(name, extents));
            assert!((found / expected - 1.0).abs() < 0.03, "{name}: {found} for {expected}");
        }
    }

    #[test]
    fn norms_start_as_if_absent() {
        assert_eq!(of("norm.weight", &[2]), [1.0; 2]);
        assert_eq!(of("norm.bias", &[2]), [0.0; 2]);
        assert_eq!(of("norm.running_mean", &[2]), [0.0; 2]);
        assert_eq!(of("norm.running_var", &[2]), [1.0; 2]);
    }
}
