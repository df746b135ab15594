//! Operations made of others.

use dvp_core::tensor::{Backend, Tensor, TensorError};
use proptest::prelude::*;

use crate::check::{Computation, TOLERANCE_F32, check, close};
use crate::input::{Domain, dims, inputs};
use crate::registry::{Outcome, Tally, Tested, for_cases, on_every_backend};

#[derive(Clone, Copy, Debug)]
enum Compose {
    Sigmoid,
    Gelu,
    Tanh,
    Softmax,
    LogSoftmax,
    LayerNorm,
}

#[derive(Clone, Copy, Debug)]
struct Along(Compose, usize);

/// Below the square of the spacing of [`Domain::Distinct`], so that it is not what the variance is made of.
const EPSILON: f64 = 1e-4;

impl Computation for Along {
    fn run<B: Backend>(&self, inputs: &[Tensor<B>]) -> Result<Tensor<B>, TensorError> {
        let Self(compose, axis) = *self;
        match compose {
            Compose::Sigmoid => inputs[0].sigmoid(),
            Compose::Gelu => inputs[0].gelu(),
            Compose::Tanh => inputs[0].tanh(),
            Compose::Softmax => inputs[0].softmax(axis),
            Compose::LogSoftmax => inputs[0].log_softmax(axis),
            Compose::LayerNorm => inputs[0].layer_norm(EPSILON),
        }
    }

    /// Where all numbers of an axis are equal (one number, or one stretched), layer norm is 0 over the root of epsilon, and
    /// so multiplies what rounding leaves of the 0.
    fn rounding(&self) -> f64 {
        if matches!(self.0, Compose::LayerNorm) { TOLERANCE_F32 / EPSILON.sqrt() } else { TOLERANCE_F32 }
    }
}

#[derive(Debug)]
struct Linear;

impl Computation for Linear {
    fn run<B: Backend>(&self, inputs: &[Tensor<B>]) -> Result<Tensor<B>, TensorError> {
        inputs[0].linear(&inputs[1], &inputs[2])
    }
}

fn composed<B: Tested>(tally: &Tally) -> Outcome {
    use Compose::{Gelu, LayerNorm, LogSoftmax, Sigmoid, Softmax, Tanh};
    for compose in [Sigmoid, Gelu, Tanh, Softmax, LogSoftmax, LayerNorm] {
        let cases = dims(1..=4).prop_flat_map(|dims| (0..dims.len(), inputs(vec![(dims, Domain::Distinct)])));
        for_cases(20, cases, |(axis, inputs)| check::<B>(&Along(compose, axis), &inputs, tally))?;
    }
    Ok(())
}

fn linear<B: Tested>(tally: &Tally) -> Outcome {
    let cases = (dims(1..=3), 1_usize..5, 1_usize..5).prop_flat_map(|(mut front, from, to)| {
        front.truncate(2);
        front.push(from);
        inputs(vec![(front, Domain::Any), (vec![from, to], Domain::Any), (vec![to], Domain::Any)])
    });
    for_cases(24, cases, |inputs| check::<B>(&Linear, &inputs, tally))
}

/// Where a naive formula overflows: powers of large numbers, sigmoids far out.
fn far_out<B: Tested>(tally: &Tally) -> Outcome {
    let x = Tensor::<B>::new(vec![1000.0, 999.0, -1000.0], &[3], &B::place())?.parameter()?;
    // softmax (1, 1/e, 0) / (1 + 1/e).
    let share = 1.0 / (1.0 + (-1.0_f64).exp());
    close(tally, "softmax", &x.softmax(0)?.to_f64()?, &[share, 1.0 - share, 0.0], 1e-14)?;
    let logarithms = x.log_softmax(0)?;
    close(tally, "log_softmax", &logarithms.to_f64()?, &[share.ln(), share.ln() - 1.0, share.ln() - 2000.0], 1e-14)?;
    // d log_softmax_2 / dx = -softmax + (0, 0, 1).
    let gradients = logarithms.slice(0, 2, 1)?.backward()?;
    close(tally, "its gradient", &gradients.of(&x).unwrap().to_f64()?, &[-share, share - 1.0, 1.0], 1e-14)?;
    let sigmoid = x.sigmoid()?;
    close(tally, "sigmoid", &sigmoid.to_f64()?, &[1.0, 1.0, 0.0], 0.0)?;
    close(tally, "its gradient", &sigmoid.sum_all()?.backward()?.of(&x).unwrap().to_f64()?, &[0.0; 3], 0.0)
}

#[test]
fn composed_everywhere() {
    on_every_backend!(composed);
}

#[test]
fn linear_everywhere() {
    on_every_backend!(linear);
}

#[test]
fn far_out_everywhere() {
    on_every_backend!(far_out);
}
