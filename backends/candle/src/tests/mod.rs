//! Every operation and its gradient against the host's, in both number types; what candle gets wrong first of all.

use dvp_core::dims::Dims;
use dvp_core::real::{DType, Values};
use dvp_core::tensor::{Backend, Tensor, TensorError};

/// The same numbers for everybody, in (-1, 1), by a linear congruential generator (Knuth's MMIX).
fn numbers(len: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..len).map(|_| next()).collect()
}

/// Values of `run` and gradients of its inputs, with respect to a weighted sum of the values.
fn outcome<B: Backend>(
    extents: &[&[usize]],
    dtype: DType,
    device: &B::Device,
    run: impl Fn(&[Tensor<B>]) -> Result<Tensor<B>, TensorError>,
) -> Vec<Vec<f64>> {
    let tensor = |values: Vec<f64>, extents: &[usize]| {
        let values = Values::F64(values).cast(dtype);
        Tensor::<B>::from_values(values, &Dims::new(extents).unwrap(), device).unwrap()
    };
    let inputs: Vec<Tensor<B>> = (1..)
        .zip(extents)
        .map(|(seed, extents)| tensor(numbers(extents.iter().product(), seed), extents).parameter().unwrap())
        .collect();
    let result = run(&inputs).unwrap();
    let mut found = vec![result.to_f64().unwrap()];
    assert_eq!(result.dtype(), dtype);
    if result.is_tracked() {
        let weights = tensor(numbers(result.dims().len(), 77), result.dims().extents());
        let gradients = result.mul(&weights).unwrap().sum_all().unwrap().backward().unwrap();
        found.extend(inputs.iter().map(|input| {
            let gradient = gradients.of(input).expect("each input is used");
            assert_eq!(gradient.dims(), input.dims());
            assert!(!gradient.is_tracked());
            gradient.to_f64().unwrap()
        }));
    }
    found
}

fn assert_close(what: &str, found: &[Vec<f64>], expected: &[Vec<f64>], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{what}: tracked on one of the two only");
    for (part, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert_eq!(found.len(), expected.len(), "{what}, part {part}");
        let scale = expected.iter().fold(1.0_f64, |largest, value| largest.max(value.abs()));
        for (index, (&a, &b)) in found.iter().zip(expected).enumerate() {
            // NaN fails too.
            assert!((a - b).abs() <= tolerance * scale, "{what}, part {part} at {index}: {a}, host {b}");
        }
    }
}

/// Compares the expression on candle with the host's. f32: 40 roundings of 6e-8 in sums of up to 200 terms; f64 likewise.
macro_rules! agree {
    ($extents:expr, |$x:ident| $body:expr) => {
        for (dtype, tolerance) in [(DType::F32, 5e-6), (DType::F64, 1e-14)] {
            let host = outcome::<Host>(&$extents, dtype, &HostDevice, |$x| $body);
            let candle = outcome::<Candle>(&$extents, dtype, &CandleDevice::CPU, |$x| $body);
            assert_close(concat!(stringify!($body), " of ", stringify!($extents)), &candle, &host, tolerance);
        }
    };
}

mod defects;
mod graph;
mod operations;
