//! A computation on one backend against the host backend and central differences.

use core::fmt;

use dvp_core::dims::Dims;
use dvp_core::real::DType;
use dvp_core::tensor::{Backend, Host, Tensor, TensorError};
use dvp_tests::finite_difference::{compare, dot};

use crate::input::Input;
use crate::registry::{Outcome, Tally, Tested};

/// Most by which values and gradients in f64 may differ from those of the host backend, relative to the largest of an
/// array or to 1 if that is smaller (gradients that cancel are rounding alone). The backends differ in the order of sums
/// and in their exp, sin, erf.
pub(crate) const TOLERANCE_F64: f64 = 1e-10;

/// The same in f32: half of what two backends may differ by, 1e-5.
pub(crate) const TOLERANCE_F32: f64 = 5e-6;

/// Most by which gradients may differ from central differences with steps of about 1e-6, whose rounding is about 1e-9 for
/// the outputs of this suite (sums of up to 100 numbers of order 1).
const TOLERANCE_DIFFERENCES: f64 = 1e-7;

/// Something that any backend can compute.
pub(crate) trait Computation: fmt::Debug {
    /// The output for inputs of any number type.
    fn run<B: Backend>(&self, inputs: &[Tensor<B>]) -> Result<Tensor<B>, TensorError>;

    /// Whether no gradient flows through it.
    fn is_constant(&self) -> bool {
        false
    }

    /// Most by which it may differ in f32 from f64 on the same inputs.
    fn rounding(&self) -> f64 {
        TOLERANCE_F32
    }
}

/// What a computation gives: its output, and the gradient of each tracked input for a fixed cotangent.
pub(crate) struct Evaluation {
    dims: Dims,
    value: Vec<f64>,
    gradients: Vec<Vec<f64>>,
}

/// Checks one case on one backend: f64 and f32 values and gradients, accumulation, central differences.
pub(crate) fn check<B: Tested>(computation: &impl Computation, inputs: &[Input], tally: &Tally) -> Outcome {
    let reference = evaluate::<Host>(computation, inputs, DType::F64, 1)?;
    let double = evaluate::<B>(computation, inputs, DType::F64, 1)?;
    agree(tally, "f64", &double, &reference, [TOLERANCE_F64; 2])?;

    // The f32 run must not be blamed for the rounding of its inputs.
    let mut rounded = inputs.to_vec();
    for value in rounded.iter_mut().flat_map(|input| &mut input.values) {
        *value = f64::from(*value as f32);
    }
    let single = evaluate::<B>(computation, &rounded, DType::F32, 1)?;
    agree(tally, "f32", &single, &evaluate::<Host>(computation, &rounded, DType::F32, 1)?, [TOLERANCE_F32; 2])?;
    let exact = evaluate::<Host>(computation, &rounded, DType::F64, 1)?;
    agree(tally, "f32 against f64", &single, &exact, [computation.rounding(); 2])?;

    if computation.is_constant() {
        return Ok(());
    }
    let twice = evaluate::<B>(computation, inputs, DType::F64, 2)?;
    for (twice, once) in twice.gradients.iter().zip(&double.gradients) {
        let doubled: Vec<f64> = once.iter().map(|g| 2.0 * g).collect();
        close(tally, "gradient of an input used twice", twice, &doubled, TOLERANCE_F64)?;
    }
    against_differences::<B>(computation, inputs, &double, tally)
}

/// Runs a computation `uses` times on the same parameters; gradients are of the sum of all uses.
pub(crate) fn evaluate<B: Tested>(
    computation: &impl Computation,
    inputs: &[Input],
    dtype: DType,
    uses: usize,
) -> Result<Evaluation, TensorError> {
    let mut leaves = Vec::with_capacity(inputs.len());
    for input in inputs {
        let leaf = input.leaf::<B>(&input.values, dtype, &B::place())?;
        leaves.push(if input.tracked { leaf.parameter()? } else { leaf });
    }
    let mut output = output(computation, inputs, &leaves)?;
    let cotangent = output.like(cotangent(output.dims().len()), output.dims().extents())?;
    let mut gradients = Vec::new();
    assert_eq!(output.dtype(), dtype, "{computation:?} keeps the number type");
    assert_eq!(output.is_tracked(), !computation.is_constant(), "{computation:?} is tracked if a gradient flows");
    let (dims, value) = (*output.dims(), output.to_f64()?);
    if output.is_tracked() {
        let mut loss = output.mul(&cotangent)?.sum_all()?;
        for _ in 1..uses {
            output = self::output(computation, inputs, &leaves)?;
            loss = loss.add(&output.mul(&cotangent)?.sum_all()?)?;
        }
        let found = loss.backward()?;
        for (input, leaf) in inputs.iter().zip(&leaves) {
            let gradient = found.of(leaf);
            assert_eq!(gradient.is_some(), input.tracked, "{computation:?}: gradients of parameters, and only of them");
            let Some(gradient) = gradient else { continue };
            assert_eq!((gradient.dims(), gradient.dtype()), (leaf.dims(), dtype), "{computation:?}");
            assert!(!gradient.is_tracked(), "{computation:?}: gradients are constants");
            gradients.push(gradient.to_f64()?);
        }
    }
    Ok(Evaluation { dims, value, gradients })
}

fn output<B: Backend>(
    computation: &impl Computation,
    inputs: &[Input],
    leaves: &[Tensor<B>],
) -> Result<Tensor<B>, TensorError> {
    let views: Vec<Tensor<B>> =
        inputs.iter().zip(leaves).map(|(input, leaf)| input.view(leaf)).collect::<Result<_, _>>()?;
    computation.run(&views)
}

/// Numbers of both signs, none of them 0, that f32 holds exactly.
fn cotangent(len: usize) -> Vec<f64> {
    (0..len).map(|k| ((37 * k + 11) % 32) as f64 / 16.0 - 31.0 / 32.0).collect()
}

/// The same extents, and values and gradients within a tolerance each, as [`close`] says.
pub(crate) fn agree(
    tally: &Tally,
    what: &str,
    found: &Evaluation,
    reference: &Evaluation,
    tolerances: [f64; 2],
) -> Outcome {
    tally.check(found.dims == reference.dims, || format!("{what}: {} for {}", found.dims, reference.dims))?;
    let [value, gradient] = tolerances;
    close(tally, &format!("{what} value"), &found.value, &reference.value, value)?;
    tally.check(found.gradients.len() == reference.gradients.len(), || format!("{what}: gradients are missing"))?;
    for (k, (found, reference)) in found.gradients.iter().zip(&reference.gradients).enumerate() {
        close(tally, &format!("{what} gradient of tracked input {k}"), found, reference, gradient)?;
    }
    Ok(())
}

/// Every number within `tolerance`, relative to the largest of the reference or to 1 if that is smaller.
pub(crate) fn close(tally: &Tally, what: &str, found: &[f64], reference: &[f64], tolerance: f64) -> Outcome {
    let scale = reference.iter().fold(1.0_f64, |largest, x| largest.max(x.abs()));
    // Written so that a NaN fails.
    let is_close = |(a, b): (&f64, &f64)| (a - b).abs() <= tolerance * scale;
    let bad = found.iter().zip(reference).position(|pair| !is_close(pair));
    tally.check(found.len() == reference.len() && bad.is_none(), || match bad {
        Some(k) => {
            format!("{what}: number {k} is {:e}, must be {:e} ({found:?} {reference:?})", found[k], reference[k])
        }
        None => format!("{what}: {} numbers, must be {}", found.len(), reference.len()),
    })
}

/// Gradients by name.
pub(crate) type Gradients = Vec<(String, Vec<f64>)>;

/// Holds gradients of weights against those of the host: relative to the largest number of each, or to a thousandth of the
/// largest of all where that is more.
pub(crate) fn close_gradients(tally: &Tally, what: &str, own: &Gradients, host: &Gradients, tolerance: f64) -> Outcome {
    let names = |gradients: &Gradients| gradients.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    tally.check(names(own) == names(host), || format!("{what}: {:?} instead of {:?}", names(own), names(host)))?;
    let largest = |values: &[f64], least: f64| values.iter().fold(least, |largest, g| largest.max(g.abs()));
    let least = 1e-3 * host.iter().fold(0.0, |least, (_, values)| largest(values, least));
    for ((name, own), (_, host)) in own.iter().zip(host) {
        let largest = largest(host, least);
        let [own, host] = [own, host].map(|values| values.iter().map(|g| g / largest).collect::<Vec<_>>());
        close(tally, &format!("{what} of {name}"), &own, &host, tolerance)?;
    }
    Ok(())
}

/// Gradients of the backend against central differences of its own outputs, lane by lane, without tracking.
fn against_differences<B: Tested>(
    computation: &impl Computation,
    inputs: &[Input],
    evaluation: &Evaluation,
    tally: &Tally,
) -> Outcome {
    let tracked = || inputs.iter().filter(|input| input.tracked);
    let x: Vec<f64> = tracked().flat_map(|input| input.values.iter().copied()).collect();
    let gradient = evaluation.gradients.concat();
    let cotangent = cotangent(evaluation.dims.len());
    let moved = |x: &[f64]| -> Result<f64, TensorError> {
        let mut rest = x;
        let mut leaves = Vec::with_capacity(inputs.len());
        for input in inputs {
            let values = if input.tracked {
                let (head, tail) = rest.split_at(input.values.len());
                rest = tail;
                head
            } else {
                &input.values
            };
            leaves.push(input.leaf::<B>(values, DType::F64, &B::place())?);
        }
        Ok(dot(&output(computation, inputs, &leaves)?.to_f64()?, &cotangent))
    };
    let compared = compare(&x, &gradient, TOLERANCE_DIFFERENCES, |x| moved(x).unwrap());
    tally.check(compared.is_ok(), || format!("central differences: {compared:?}"))
}

/// Losses of so many steps of Adam from the same weights are those of the host.
///
/// Backends add in another order, and Adam, which divides gradients by their size, carries the rounding of small ones into the weights: in
/// f32 the losses of MONet stay 1e-7 apart for 13 steps, and then each step carries a difference on 1.3 times as large, up to 2e-2 at the
/// fiftieth, or not, as the compiler has it. So f32 is held to ten steps. In f64 all fifty are 4e-16 apart; what another processor, which sums in
/// yet another order, may make of rounding is 2e5 times as much.
pub(crate) fn losses_agree(tally: &Tally, dtype: DType, own: &[f64], host: &[f64], steps: usize) -> Outcome {
    let (compared, most) = match dtype {
        DType::F32 => (10, 5e-6),
        DType::F64 => (steps, 1e-9),
    };
    let apart: Vec<f64> = own.iter().zip(host).map(|(a, b)| (a - b).abs() / b.abs()).collect();
    let complete = own.len() == steps && host.len() == steps && own.iter().all(|loss| loss.is_finite());
    tally.check(complete && apart[..compared].iter().all(|&apart| apart <= most), || {
        format!("losses of {dtype} are {apart:?} apart: {own:?} {host:?}")
    })
}

/// The gradients of at least so many weights, by name, are those of the host.
pub(crate) fn gradients_agree(
    tally: &Tally,
    own: &[(String, Vec<f64>)],
    host: &[(String, Vec<f64>)],
    least: usize,
) -> Outcome {
    let complete = own.len() == host.len() && own.len() >= least;
    tally.check(complete, || format!("{} gradients for {}", own.len(), host.len()))?;
    for ((name, own), (expected, host)) in own.iter().zip(host) {
        tally.check(name == expected, || format!("{name} for {expected}"))?;
        close(tally, name, own, host, 1e-9)?;
    }
    Ok(())
}
