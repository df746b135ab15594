//! Weights written on one backend and read on another, bit for bit.

use std::sync::Mutex;

use dvp_core::dims::Dims;
use dvp_core::real::{DType, Values};
use dvp_core::tensor::{Parameters, ParametersError, Tensor};

use crate::network::weights;
use crate::registry::{Outcome, Tally, Tested, on_every_backend};

/// Weights of a network in both types, and numbers that only their bits tell apart.
fn stored<B: Tested>() -> Result<Parameters<B>, ParametersError> {
    let mut parameters = weights::<B>(DType::F32)?;
    for (name, weight) in weights::<B>(DType::F64)?.iter() {
        parameters.insert(format!("double.{name}"), weight)?;
    }
    let odd = [0.0, -0.0, f64::MIN_POSITIVE / 8.0, f64::MAX, f64::INFINITY, -1.0 / 3.0];
    parameters.insert("odd.f64", &Tensor::new(odd.to_vec(), &[2, 3], &B::place())?)?;
    let odd = [-0.0, f32::MIN_POSITIVE / 8.0, f32::MAX, f32::NEG_INFINITY];
    parameters.insert("odd.f32", &Tensor::new(odd.to_vec(), &[4], &B::place())?)?;
    parameters.insert("odd.number", &Tensor::from_values(Values::F32(vec![0.1]), &Dims::SCALAR, &B::place())?)?;
    Ok(parameters)
}

/// Files written by all backends so far.
static FILES: Mutex<Vec<(&str, Vec<u8>)>> = Mutex::new(Vec::new());

fn write<B: Tested>(tally: &Tally) -> Outcome {
    let bytes = stored::<B>()?.to_safetensors()?;
    tally.check(!bytes.is_empty(), || "nothing written".into())?;
    FILES.lock().unwrap().push((B::NAME, bytes));
    Ok(())
}

/// Every backend reads every file and writes the same bytes again; so it does after loading it over other values.
fn read<B: Tested>(tally: &Tally) -> Outcome {
    let files = FILES.lock().unwrap();
    for (writer, bytes) in files.iter() {
        let read = Parameters::<B>::from_safetensors(bytes, &B::place())?;
        tally.check(read.to_safetensors()? == *bytes, || format!("the file of {writer} comes back changed"))?;
        let mut over = Parameters::<B>::new();
        for (name, weight) in stored::<B>()?.iter() {
            over.insert(name, &weight.affine(0.0, 1.0)?)?;
        }
        over.load_safetensors(bytes)?;
        tally.check(over.to_safetensors()? == *bytes, || format!("the file of {writer} is loaded changed"))?;
        for (name, weight) in read.iter() {
            tally.check(weight.is_tracked(), || format!("{name} is a parameter"))?;
        }
    }
    Ok(())
}

/// A file of another model is refused and changes nothing.
fn foreign<B: Tested>(tally: &Tally) -> Outcome {
    let own = weights::<B>(DType::F64)?;
    let before = own.to_safetensors()?;
    let refused = |edit: fn(&mut Parameters<B>) -> Result<(), ParametersError>| {
        let mut other = Parameters::new();
        edit(&mut other)?;
        let bytes = other.to_safetensors()?;
        let mut own = own.clone();
        let error = own.load_safetensors(&bytes).unwrap_err();
        tally.check(own.to_safetensors()? == before, || format!("changed in spite of {error}")).unwrap();
        Ok::<_, ParametersError>(error)
    };
    let missing = refused(|other| {
        for (name, weight) in weights::<B>(DType::F64)?.iter().filter(|(name, _)| *name != "norm.weight") {
            other.insert(name, weight)?;
        }
        Ok(())
    })?;
    tally.check(matches!(&missing, ParametersError::Missing { name } if name == "norm.weight"), || {
        missing.to_string()
    })?;
    let unexpected = refused(|other| {
        *other = weights::<B>(DType::F64)?;
        other.insert("norm.bias", &Tensor::full(0.0, &[1], DType::F64, &B::place())?).map_err(ParametersError::from)
    })?;
    tally.check(matches!(&unexpected, ParametersError::Unexpected { name } if name == "norm.bias"), || {
        unexpected.to_string()
    })?;
    let dims = refused(|other| {
        *other = weights::<B>(DType::F64)?;
        Ok(other.insert("norm.weight", &Tensor::full(0.0, &[1, 8], DType::F64, &B::place())?)?)
    })?;
    tally.check(matches!(&dims, ParametersError::Dims { name, .. } if name == "norm.weight"), || dims.to_string())?;
    let mut own = own.clone();
    let cut = own.load_safetensors(&before[..before.len() - 1]).unwrap_err();
    tally.check(matches!(cut, ParametersError::Format(_)), || cut.to_string())
}

#[test]
fn weights_travel_between_all_backends() {
    on_every_backend!(write);
    on_every_backend!(read);
}

#[test]
fn foreign_weights_are_refused_everywhere() {
    on_every_backend!(foreign);
}
