//! Gradients over all weights.

use alloc::collections::BTreeMap;

use dvp_core::tensor::{Backend, ParametersError, Tensor};

/// Gradients by name.
pub(super) type Gradients<B> = BTreeMap<String, Tensor<B>>;

/// Their length, over all weights.
pub(super) fn length<B: Backend>(gradients: &Gradients<B>) -> Result<f64, ParametersError> {
    let mut sum = 0.0;
    for gradient in gradients.values() {
        sum += gradient.mul(gradient)?.sum_all()?.number()?;
    }
    Ok(sum.sqrt())
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
