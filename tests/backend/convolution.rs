//! Convolution and pooling with odd sizes, steps that leave a remainder, and padding.

use dvp_core::tensor::{Backend, Stride, Tensor, TensorError};
use proptest::prelude::*;

use crate::check::{Computation, check};
use crate::input::{Domain, Input, inputs};
use crate::registry::{Outcome, Tally, Tested, for_cases, on_every_backend};

#[derive(Debug)]
enum Windows {
    Convolution(Stride),
    MaxPool(usize, Stride),
}

impl Computation for Windows {
    fn run<B: Backend>(&self, inputs: &[Tensor<B>]) -> Result<Tensor<B>, TensorError> {
        match *self {
            Self::Convolution(stride) => inputs[0].conv2d(&inputs[1], stride),
            Self::MaxPool(side, stride) => inputs[0].max_pool2d(side, stride),
        }
    }
}

/// Batch, channels, height and width of images; kernels of another height than width; a stride. The kernel fits.
fn convolution() -> impl Strategy<Value = (Windows, Vec<Input>)> {
    let image = (1_usize..4, 1_usize..4, 1_usize..7, 1_usize..7);
    let kernel = (1_usize..4, 1_usize..5, 1_usize..5);
    let stride = (1_usize..4, 0_usize..3).prop_map(|(step, padding)| Stride { step, padding });
    (image, kernel, stride)
        .prop_filter("few values", |((batch, c, h, w), ..)| batch * c * h * w <= 90)
        .prop_filter("the kernel fits", |((_, _, h, w), (_, kh, kw), stride)| {
            stride.windows(*h, *kh) > 0 && stride.windows(*w, *kw) > 0
        })
        .prop_flat_map(|((batch, c, h, w), (o, kh, kw), stride)| {
            let operands = vec![(vec![batch, c, h, w], Domain::Any), (vec![o, c, kh, kw], Domain::Any)];
            inputs(operands).prop_map(move |inputs| (Windows::Convolution(stride), inputs))
        })
}

/// As [`convolution`]; windows are squares larger than the padding.
fn max_pool() -> impl Strategy<Value = (Windows, Vec<Input>)> {
    let image = (1_usize..4, 1_usize..3, 1_usize..7, 1_usize..7);
    (image, 1_usize..5, 1_usize..4, 0_usize..3)
        .prop_filter("few values", |((batch, c, h, w), ..)| batch * c * h * w <= 60)
        .prop_map(|(image, side, step, padding)| (image, side, Stride { step, padding: padding.min(side - 1) }))
        .prop_filter("the window fits", |((_, _, h, w), side, stride)| {
            stride.windows(*h, *side) > 0 && stride.windows(*w, *side) > 0
        })
        .prop_flat_map(|((batch, c, h, w), side, stride)| {
            inputs(vec![(vec![batch, c, h, w], Domain::Distinct)])
                .prop_map(move |inputs| (Windows::MaxPool(side, stride), inputs))
        })
}

fn convolutions<B: Tested>(tally: &Tally) -> Outcome {
    for_cases(64, convolution(), |(windows, inputs)| check::<B>(&windows, &inputs, tally))
}

fn pooling<B: Tested>(tally: &Tally) -> Outcome {
    for_cases(48, max_pool(), |(windows, inputs)| check::<B>(&windows, &inputs, tally))
}

#[test]
fn convolutions_everywhere() {
    on_every_backend!(convolutions);
}

#[test]
fn pooling_everywhere() {
    on_every_backend!(pooling);
}
