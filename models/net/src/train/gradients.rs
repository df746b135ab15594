//! Gradients over all weights.

use alloc::collections::BTreeMap;

use dvp_core::tensor::{Backend, ParametersError, Tensor, TensorError};

use crate::error::NetError;

/// Gradients by name.
pub(super) type Gradients<B> = BTreeMap<String, Tensor<B>>;

/// Their length, over all weights.
///
/// # Errors
/// [`NetError::NotFinite`] if it, or the `loss` of this `step`, is no number.
pub(super) fn length<B: Backend>(gradients: &Gradients<B>, loss: f64, step: u64) -> Result<f64, NetError> {
    let squares = gradients.values().map(|gradient| gradient.mul(gradient)?.sum_all()?.reshape(&[1]));
    let squares: Vec<Tensor<B>> = squares.collect::<Result<_, TensorError>>()?;
    // All at once: a graphics card is waited for whenever a number is read.
    let squares = if squares.is_empty() {
        Vec::new()
    } else {
        Tensor::concat(&squares.iter().collect::<Vec<_>>(), 0)?.to_f64()?
    };
    let length = squares.iter().sum::<f64>().sqrt();
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
