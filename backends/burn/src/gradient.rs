//! Parameters and their gradients, by burn's tape.

use core::fmt;
use core::panic::AssertUnwindSafe;
use std::panic::catch_unwind;

use burn::backend::ops::FloatTensorOps;
use burn::backend::{AutodiffBackend, Dispatch};
use dvp_core::tensor::BackendError;

use crate::values::{BurnArray, framework};

/// Gradients of a number with respect to its parameters.
pub struct BurnGradients(<Dispatch as AutodiffBackend>::Gradients);

impl BurnGradients {
    /// The gradient of a parameter, as a constant; none if the number did not depend on it.
    pub(crate) fn of(&self, parameter: &BurnArray) -> Option<BurnArray> {
        let gradient = parameter.is_tracked().then(|| Dispatch::grad(&parameter.tensor(), &self.0))?;
        Some(BurnArray::new(gradient?).ok()?.of_rank(&parameter.dims()))
    }
}

impl fmt::Debug for BurnGradients {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("BurnGradients").finish_non_exhaustive()
    }
}

/// The same numbers as a leaf of the tape.
pub(crate) fn parameter(array: &BurnArray) -> Result<BurnArray, BackendError> {
    let leaf = Dispatch::float_set_require_grad(Dispatch::from_inner(array.constant()), true);
    Ok(BurnArray::new(leaf)?.of_rank(&array.dims()))
}

/// Gradients of a tracked number. Burn panics if the tape, or a part of it, was used up by a former call; that is an error
/// here.
pub(crate) fn backward(number: &BurnArray) -> Result<BurnGradients, BackendError> {
    let tensor = number.tensor();
    catch_unwind(AssertUnwindSafe(|| BurnGradients(Dispatch::backward(tensor)))).map_err(|payload| {
        let said = payload.downcast_ref::<String>().map(String::as_str);
        let said = said.or_else(|| payload.downcast_ref::<&str>().copied());
        framework(&said.unwrap_or("the tape could not be walked back"))
    })
}
