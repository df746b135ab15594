//! Parameters, and the way back.

use candle_core::Tensor;
use candle_core::Var;
use candle_core::backprop::GradStore;

/// A leaf of the graph with the same numbers, copied.
pub(crate) fn parameter(array: &Tensor) -> candle_core::Result<Tensor> {
    // Detached, because a variable would be returned as it is and share its gradient.
    Ok(Var::from_tensor(&array.detach())?.into_inner())
}

/// candle keeps gradients of constants that it met on the way, too, and leaves gradients in the graph of what they were
/// computed with: detached, they are constants.
pub(crate) fn gradient(gradients: &GradStore, parameter: &Tensor) -> Option<Tensor> {
    if parameter.is_variable() { gradients.get(parameter).map(Tensor::detach) } else { None }
}
