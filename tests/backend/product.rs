//! Products of matrices in all their broadcasting forms.

use dvp_core::tensor::{Backend, Tensor, TensorError};
use proptest::prelude::*;

use crate::check::{Computation, check};
use crate::input::{Domain, inputs};
use crate::registry::{Outcome, Tally, Tested, for_cases, on_every_backend};

#[derive(Debug)]
struct Matmul;

impl Computation for Matmul {
    fn run<B: Backend>(&self, inputs: &[Tensor<B>]) -> Result<Tensor<B>, TensorError> {
        inputs[0].matmul(&inputs[1])
    }
}

/// Axes in front of the two matrices: none, one, two, stretched on either side or on both.
const FRONTS: [[&[usize]; 2]; 9] = [
    [&[], &[]],
    [&[3], &[]],
    [&[2, 3], &[]],
    [&[], &[3]],
    [&[3], &[3]],
    [&[2, 3], &[2, 3]],
    [&[2, 1], &[1, 3]],
    [&[2, 3], &[3]],
    [&[1], &[2, 3]],
];

fn products<B: Tested>(tally: &Tally) -> Outcome {
    for fronts in FRONTS {
        let cases = prop::array::uniform3(1_usize..5).prop_flat_map(move |[m, k, n]| {
            let operand = |front: &[usize], matrix: [usize; 2]| ([front, &matrix].concat(), Domain::Any);
            inputs(vec![operand(fronts[0], [m, k]), operand(fronts[1], [k, n])])
        });
        for_cases(12, cases, |inputs| check::<B>(&Matmul, &inputs, tally))?;
    }
    Ok(())
}

#[test]
fn products_everywhere() {
    on_every_backend!(products);
}
