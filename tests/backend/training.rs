//! 50 steps of Adam from the same weights on the same data, and replicas on threads.

use alloc::collections::BTreeMap;
use std::thread;

use dvp_core::optim::AdamSettings;
use dvp_core::real::DType;
use dvp_core::tensor::{Adam, Host, Parameters, ParametersError, Tensor};

use crate::check::close;
use crate::network::{Data, loss, weights};
use crate::registry::{Outcome, Tally, Tested, on_every_backend};

/// Steps of a run.
const STEPS: usize = 50;

/// Most by which the losses of any step may differ between two runs; half of it from the host's, so that it holds for any
/// two backends. f32: 50 steps of the rounding of sums of a few hundred numbers.
fn tolerance(dtype: DType) -> f64 {
    match dtype {
        DType::F32 => 1e-4,
        DType::F64 => 1e-12,
    }
}

/// Holds the losses of a run against those of the host, absolutely, and asks for progress.
pub(crate) fn same_losses(tally: &Tally, dtype: DType, own: &[f64], host: &[f64]) -> Outcome {
    let apart = own.iter().zip(host).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let finite = own.iter().all(|loss| loss.is_finite());
    tally.check(finite && own.len() == STEPS && apart <= tolerance(dtype) / 2.0, || {
        format!("losses of {dtype} are {apart:e} apart: {own:?} {host:?}")
    })?;
    tally.check(own[STEPS - 1] < own[0] / 2.0, || format!("no progress: {own:?}"))
}

fn losses<B: Tested>(dtype: DType) -> Result<Vec<f64>, ParametersError> {
    let (mut parameters, data) = (weights::<B>(dtype)?, Data::new(8, dtype)?);
    let mut adam = Adam::new(AdamSettings::default());
    (0..STEPS)
        .map(|_| {
            let loss = loss(&parameters, &data)?;
            let gradients = parameters.gradients(&loss.backward()?);
            adam.step(&mut parameters, &gradients, 0.02)?;
            Ok(loss.number()?)
        })
        .collect()
}

fn network<B: Tested>(tally: &Tally) -> Outcome {
    for dtype in [DType::F64, DType::F32] {
        same_losses(tally, dtype, &losses::<B>(dtype)?, &losses::<Host>(dtype)?)?;
    }
    Ok(())
}

/// Gradients by name.
type Gradients<B> = BTreeMap<String, Tensor<B>>;

/// Gradients of the loss of images `start..start + len`, computed on a thread of its own with weights of its own.
fn of_part<B: Tested>(
    parameters: &Parameters<B>,
    data: &Data<B>,
    start: usize,
    len: usize,
) -> Result<Gradients<B>, ParametersError> {
    let mut replica = Parameters::new();
    for (name, weight) in parameters.iter() {
        replica.insert(name, &weight.detach()?)?;
    }
    let loss = loss(&replica, &data.part(start, len)?)?;
    Ok(replica.gradients(&loss.backward()?))
}

/// A replica per thread on parts of a batch, their gradients averaged by the images of each, is a step on the batch.
fn data_parallel<B: Tested>(tally: &Tally) -> Outcome {
    let parts = [(0, 3), (3, 3), (6, 2)];
    let (mut whole, data) = (weights::<B>(DType::F64)?, Data::new(8, DType::F64)?);
    let mut shared = whole.clone();
    let (mut adam_whole, mut adam_shared) = (Adam::new(AdamSettings::default()), Adam::new(AdamSettings::default()));
    for _ in 0..5 {
        let gradients = whole.gradients(&loss(&whole, &data)?.backward()?);
        let by_part: Vec<_> = thread::scope(|scope| {
            let (shared, data) = (&shared, &data);
            let threads = parts.map(|(start, len)| scope.spawn(move || of_part(shared, data, start, len)));
            threads.into_iter().map(|thread| thread.join().unwrap()).collect::<Result<_, _>>()
        })?;
        let mut average = Gradients::<B>::new();
        for (gradients, (_, len)) in by_part.iter().zip(parts) {
            for (name, gradient) in gradients {
                let share = gradient.affine(len as f64 / 8.0, 0.0)?;
                let sum = average.get(name).map_or_else(|| Ok(share.clone()), |sum| sum.add(&share))?;
                average.insert(name.clone(), sum);
            }
        }
        tally.check(average.len() == shared.len(), || format!("{} gradients", average.len()))?;
        for (name, gradient) in &gradients {
            // The order of sums over 8 images.
            close(tally, name, &average[name].to_f64()?, &gradient.to_f64()?, 1e-12)?;
        }
        adam_whole.step(&mut whole, &gradients, 0.02)?;
        adam_shared.step(&mut shared, &average, 0.02)?;
        for (name, weight) in whole.iter() {
            // Adam divides by the root of a mean square: where gradients are small their rounding counts for more.
            close(tally, name, &shared.get(name)?.to_f64()?, &weight.to_f64()?, 1e-10)?;
        }
    }
    Ok(())
}

#[test]
fn network_everywhere() {
    on_every_backend!(network);
}

#[test]
fn data_parallel_everywhere() {
    on_every_backend!(data_parallel);
}
