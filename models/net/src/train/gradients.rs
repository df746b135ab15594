//! Gradients over all weights.

use alloc::collections::BTreeMap;

use dvp_core::tensor::{Backend, ParametersError, Tensor};

use crate::error::NetError;

/// Gradients by name.
pub(super) type Gradients<B> = BTreeMap<String, Tensor<B>>;

/// Their length, over all weights.
///
/// # Errors
/// [`NetError::NotFinite`] if it, or the `loss` of this `step`, is no number.
pub(super) fn length<B: Backend>(gradients: &Gradients<B>, loss: f64, step: u64) -> Result<f64, NetError> {
    let mut sum = 0.0;
    for gradient in gradients.values() {
        sum += gradient.mul(gradient)?.sum_all()?.number()?;
    }
    let length = sum.sqrt();
    match [loss, length].into_iter().find(|number| !number.is_finite()) {
        Some(loss) => Err(NetError::NotFinite { step, loss }),
        None => Ok(length),
    }
}

/// Those of a given `length` cut to the `longest`, if there is one and they are longer.
pub(super) fn cut<B: Backend>(
    gradients: &mut Gradients<B>,
    length: f64,
    longest: Option<f64>,
) -> Result<(), ParametersError> {
    if let Some(longest) = longest.filter(|longest| length > *longest) {
        for gradient in gradients.values_mut() {
            *gradient = gradient.affine(longest / length, 0.0)?;
        }
    }
    Ok(())
}
