//! Sums, means, largest numbers.

use dvp_core::tensor::{Backend, Tensor, TensorError};
use proptest::prelude::*;

use crate::check::{Computation, check};
use crate::input::{Domain, dims, inputs};
use crate::registry::{Outcome, Tally, Tested, for_cases, on_every_backend};

#[derive(Clone, Copy, Debug)]
enum Reduce {
    Sum,
    Mean,
    Max,
    MaxDetached,
    SumAll,
    MeanAll,
}

#[derive(Clone, Copy, Debug)]
struct Along(Reduce, usize);

impl Computation for Along {
    fn run<B: Backend>(&self, inputs: &[Tensor<B>]) -> Result<Tensor<B>, TensorError> {
        let Self(reduce, axis) = *self;
        match reduce {
            Reduce::Sum => inputs[0].sum(axis),
            Reduce::Mean => inputs[0].mean(axis),
            Reduce::Max => inputs[0].max(axis),
            Reduce::MaxDetached => inputs[0].max_detached(axis),
            Reduce::SumAll => inputs[0].sum_all(),
            Reduce::MeanAll => inputs[0].mean_all(),
        }
    }

    fn is_constant(&self) -> bool {
        matches!(self.0, Reduce::MaxDetached)
    }
}

fn reductions<B: Tested>(tally: &Tally) -> Outcome {
    for reduce in [Reduce::Sum, Reduce::Mean, Reduce::Max, Reduce::MaxDetached, Reduce::SumAll, Reduce::MeanAll] {
        let cases = dims(1..=4).prop_flat_map(|dims| (0..dims.len(), inputs(vec![(dims, Domain::Distinct)])));
        for_cases(24, cases, |(axis, inputs)| check::<B>(&Along(reduce, axis), &inputs, tally))?;
    }
    Ok(())
}

#[test]
fn reductions_everywhere() {
    on_every_backend!(reductions);
}
