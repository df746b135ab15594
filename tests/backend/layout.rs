//! Operations that move numbers: bit for bit.

use dvp_core::tensor::{Backend, Tensor, TensorError};
use proptest::prelude::*;

use crate::check::{Computation, check};
use crate::input::{Domain, Input, broadcast_pair, dims, inputs};
use crate::registry::{Outcome, Tally, Tested, for_cases, on_every_backend};

#[derive(Clone, Debug)]
enum Layout {
    Reshape(Vec<usize>),
    Permute(Vec<usize>),
    Transpose,
    Expand(Vec<usize>),
    Slice { axis: usize, start: usize, len: usize },
    Concat(usize),
    Select { axis: usize, indices: Vec<usize> },
}

impl Computation for Layout {
    fn run<B: Backend>(&self, inputs: &[Tensor<B>]) -> Result<Tensor<B>, TensorError> {
        match self {
            Self::Reshape(extents) => inputs[0].reshape(extents),
            Self::Permute(axes) => inputs[0].permute(axes),
            Self::Transpose => inputs[0].transpose(),
            Self::Expand(extents) => inputs[0].expand(extents),
            Self::Slice { axis, start, len } => inputs[0].slice(*axis, *start, *len),
            Self::Concat(axis) => Tensor::concat(&inputs.iter().collect::<Vec<_>>(), *axis),
            Self::Select { axis, indices } => inputs[0].select(*axis, indices),
        }
    }
}

/// An input of the extents that `of` makes a computation of.
fn with_input<S: Strategy<Value = Layout>>(
    rank: core::ops::RangeInclusive<usize>,
    of: impl Fn(Vec<usize>) -> S,
) -> impl Strategy<Value = (Layout, Vec<Input>)> {
    dims(rank).prop_flat_map(move |dims| (of(dims.clone()), inputs(vec![(dims, Domain::Any)])))
}

fn check_all<B: Tested>(tally: &Tally, cases: impl Strategy<Value = (Layout, Vec<Input>)>) -> Outcome {
    for_cases(24, cases, |(layout, inputs)| check::<B>(&layout, &inputs, tally))
}

fn reshape<B: Tested>(tally: &Tally) -> Outcome {
    check_all::<B>(
        tally,
        with_input(0..=4, |dims| {
            let len = dims.iter().product();
            let mut reversed = dims.clone();
            reversed.reverse();
            let mut merged = dims.clone();
            if merged.len() > 1 {
                let first = merged.remove(0);
                merged[0] *= first;
            }
            let mut longer = dims;
            longer.push(1);
            longer.insert(0, 1);
            prop::sample::select(vec![vec![len], vec![1, len, 1], reversed, merged, longer]).prop_map(Layout::Reshape)
        }),
    )
}

fn permute<B: Tested>(tally: &Tally) -> Outcome {
    check_all::<B>(
        tally,
        with_input(1..=4, |dims| Just((0..dims.len()).collect::<Vec<_>>()).prop_shuffle().prop_map(Layout::Permute)),
    )?;
    check_all::<B>(tally, with_input(2..=4, |_| Just(Layout::Transpose)))
}

fn expand<B: Tested>(tally: &Tally) -> Outcome {
    // What the first of a pair that broadcasts must be stretched by to be multiplied with the second.
    let cases = broadcast_pair(1..=4).prop_flat_map(|[own, other]| {
        let rank = own.len().max(other.len());
        let at = |dims: &[usize], axis: usize| (axis + dims.len()).checked_sub(rank).map_or(1, |axis| dims[axis]);
        let both = (0..rank).map(|axis| at(&own, axis).max(at(&other, axis))).collect();
        (Just(Layout::Expand(both)), inputs(vec![(own, Domain::Any)]))
    });
    check_all::<B>(tally, cases)
}

fn slice<B: Tested>(tally: &Tally) -> Outcome {
    check_all::<B>(
        tally,
        with_input(1..=4, |dims| {
            (0..dims.len()).prop_flat_map(move |axis| {
                let extent = dims[axis];
                (0..extent).prop_flat_map(move |start| {
                    (1..=extent - start).prop_map(move |len| Layout::Slice { axis, start, len })
                })
            })
        }),
    )
}

fn select<B: Tested>(tally: &Tally) -> Outcome {
    check_all::<B>(
        tally,
        with_input(1..=4, |dims| {
            (0..dims.len()).prop_flat_map(move |axis| {
                // Up to six of at most seven: repeated ones, unordered ones, ones left out.
                prop::collection::vec(0..dims[axis], 1..=6).prop_map(move |indices| Layout::Select { axis, indices })
            })
        }),
    )
}

fn concat<B: Tested>(tally: &Tally) -> Outcome {
    let cases = dims(1..=4).prop_flat_map(|dims| {
        (0..dims.len(), prop::collection::vec(1_usize..4, 1..=4)).prop_flat_map(move |(axis, extents)| {
            let parts = extents.into_iter().map(|extent| {
                let mut dims = dims.clone();
                dims[axis] = extent;
                (dims, Domain::Any)
            });
            (Just(Layout::Concat(axis)), inputs(parts.collect()))
        })
    });
    check_all::<B>(tally, cases)
}

#[test]
fn reshape_everywhere() {
    on_every_backend!(reshape);
}

#[test]
fn permute_everywhere() {
    on_every_backend!(permute);
}

#[test]
fn expand_everywhere() {
    on_every_backend!(expand);
}

#[test]
fn slice_everywhere() {
    on_every_backend!(slice);
}

#[test]
fn select_everywhere() {
    on_every_backend!(select);
}

#[test]
fn concat_everywhere() {
    on_every_backend!(concat);
}
