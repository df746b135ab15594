//! Functions of one number and of pairs.

use dvp_core::real::DType;
use dvp_core::tensor::{Backend, Binary, Tensor, TensorError, Unary};
use proptest::prelude::*;

use crate::check::{Computation, check, close};
use crate::input::{Domain, broadcast_pair, dims, inputs};
use crate::registry::{Outcome, Tally, Tested, for_cases, on_every_backend};

#[derive(Clone, Copy, Debug)]
enum Elementwise {
    Unary(Unary),
    Affine(f64, f64),
    Binary(Binary),
    Greater,
}

impl Computation for Elementwise {
    fn run<B: Backend>(&self, inputs: &[Tensor<B>]) -> Result<Tensor<B>, TensorError> {
        match *self {
            Self::Unary(function) => inputs[0].unary(function),
            Self::Affine(scale, offset) => inputs[0].affine(scale, offset),
            Self::Binary(function) => inputs[0].binary(function, &inputs[1]),
            Self::Greater => inputs[0].greater(&inputs[1]),
        }
    }

    fn is_constant(&self) -> bool {
        matches!(self, Self::Greater)
    }
}

fn unary_functions<B: Tested>(tally: &Tally) -> Outcome {
    for function in Unary::ALL {
        let domain = match function {
            Unary::Abs | Unary::Relu => Domain::AwayFromZero,
            Unary::Log | Unary::Sqrt => Domain::POSITIVE,
            _ => Domain::Any,
        };
        let cases = dims(0..=4).prop_flat_map(move |dims| inputs(vec![(dims, domain)]));
        for_cases(16, cases, |inputs| check::<B>(&Elementwise::Unary(function), &inputs, tally))?;
    }
    Ok(())
}

fn affine<B: Tested>(tally: &Tally) -> Outcome {
    // Multiples of 1/8, that f32 holds.
    let number = || (-40_i8..40).prop_map(|x| f64::from(x) / 8.0);
    let cases = (number(), number(), dims(0..=4).prop_flat_map(|dims| inputs(vec![(dims, Domain::Any)])));
    for_cases(24, cases, |(scale, offset, inputs)| check::<B>(&Elementwise::Affine(scale, offset), &inputs, tally))
}

fn binary_functions<B: Tested>(tally: &Tally) -> Outcome {
    for function in Binary::ALL {
        let divisor = if function == Binary::Div { Domain::AwayFromZero } else { Domain::Any };
        let cases = broadcast_pair(0..=4).prop_flat_map(move |[a, b]| inputs(vec![(a, Domain::Any), (b, divisor)]));
        for_cases(24, cases, |inputs| check::<B>(&Elementwise::Binary(function), &inputs, tally))?;
    }
    Ok(())
}

fn greater<B: Tested>(tally: &Tally) -> Outcome {
    let cases = broadcast_pair(0..=4).prop_flat_map(|[a, b]| inputs(vec![(a, Domain::Any), (b, Domain::Any)]));
    for_cases(24, cases, |inputs| check::<B>(&Elementwise::Greater, &inputs, tally))?;
    for dtype in [DType::F32, DType::F64] {
        let x = Tensor::<B>::new(vec![0.0, -0.0, 1.0, 1.0, -2.0], &[5], &B::place())?.cast(dtype)?;
        let y = Tensor::<B>::new(vec![-0.0, 0.0, 1.0, 0.5, -1.0], &[5], &B::place())?.cast(dtype)?;
        close(tally, "greater among equals", &x.greater(&y)?.to_f64()?, &[0.0, 0.0, 0.0, 1.0, 0.0], 0.0)?;
    }
    Ok(())
}

/// f32 numbers are f64 numbers; f64 numbers are rounded to the nearest, halves to even. Casts are constants.
fn casts<B: Tested>(tally: &Tally) -> Outcome {
    let cases = dims(0..=4).prop_flat_map(|dims| {
        let len: usize = dims.iter().product();
        (Just(dims), prop::collection::vec(-1e3..1e3, len))
    });
    for_cases(24, cases, |(dims, values): (Vec<usize>, Vec<f64>)| {
        let double = Tensor::<B>::new(values.clone(), &dims, &B::place())?.parameter()?;
        let single = double.cast(DType::F32)?;
        tally.check(!single.is_tracked() && single.dtype() == DType::F32, || "a constant of f32".into())?;
        let rounded: Vec<f64> = values.iter().map(|&x| f64::from(x as f32)).collect();
        close(tally, "rounded", &single.to_f64()?, &rounded, 0.0)?;
        let back = single.cast(DType::F64)?;
        tally.check(back.dtype() == DType::F64 && back.dims() == double.dims(), || "f64 again".into())?;
        close(tally, "exact", &back.to_f64()?, &rounded, 0.0)
    })
}

/// Far out, where powers overflow and tanh and erf are flat.
fn extreme_numbers<B: Tested>(tally: &Tally) -> Outcome {
    let far = [
        (Unary::Exp, 1e4, f64::INFINITY),
        (Unary::Exp, -1e4, 0.0),
        (Unary::Log, 0.0, f64::NEG_INFINITY),
        (Unary::Tanh, 50.0, 1.0),
        (Unary::Tanh, -50.0, -1.0),
        (Unary::Erf, 8.0, 1.0),
        (Unary::Erf, -8.0, -1.0),
        (Unary::Sqrt, 0.0, 0.0),
        (Unary::Abs, -0.0, 0.0),
        (Unary::Relu, -1e30, 0.0),
    ];
    for dtype in [DType::F32, DType::F64] {
        for (function, x, y) in far {
            let found = Tensor::<B>::full(x, &[3], dtype, &B::place())?.unary(function)?.to_f64()?;
            tally.check(found == [y; 3], || format!("{function:?} of {x:e} in {dtype}: {found:?}, must be {y}"))?;
        }
    }
    Ok(())
}

#[test]
fn unary_functions_everywhere() {
    on_every_backend!(unary_functions);
}

#[test]
fn affine_everywhere() {
    on_every_backend!(affine);
}

#[test]
fn binary_functions_everywhere() {
    on_every_backend!(binary_functions);
}

#[test]
fn greater_everywhere() {
    on_every_backend!(greater);
}

#[test]
fn casts_everywhere() {
    on_every_backend!(casts);
}

#[test]
fn extreme_numbers_everywhere() {
    on_every_backend!(extreme_numbers);
}
