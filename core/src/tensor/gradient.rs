//! Parameters and their gradients.

use super::backend::Backend;
use super::error::TensorError;
use super::handle::Tensor;

/// Gradients of one number with respect to the parameters it was computed from.
#[derive(Debug)]
pub struct Gradients<B: Backend> {
    gradients: B::Gradients,
}

impl<B: Backend> Gradients<B> {
    /// The gradient of a parameter, as a constant; none if the number did not depend on it.
    #[must_use]
    pub fn of(&self, parameter: &Tensor<B>) -> Option<Tensor<B>> {
        B::gradient(&self.gradients, parameter.array()).map(Tensor::from_array)
    }
}

impl<B: Backend> Tensor<B> {
    /// The same numbers as a parameter: gradients are kept for it, and do not flow further back.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn parameter(&self) -> Result<Self, TensorError> {
        Self::wrap("parameter", B::parameter(self.array()))
    }

    /// The same numbers as a constant.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn detach(&self) -> Result<Self, TensorError> {
        Self::wrap("detach", B::detach(self.array()))
    }

    /// Whether the tensor is a parameter or was computed from one.
    #[must_use]
    pub fn is_tracked(&self) -> bool {
        B::is_tracked(self.array())
    }

    /// Gradients of a single number with respect to every parameter it was computed from. The graph may be used up: ask
    /// once.
    ///
    /// # Errors
    /// [`TensorError::Operand`] if there is more than one number, or if it depends on no parameter.
    pub fn backward(&self) -> Result<Gradients<B>, TensorError> {
        if self.dims().len() != 1 {
            return Err(self.operand("backward", "must hold a single value; take a sum or mean first"));
        }
        if !self.is_tracked() {
            return Err(self.operand("backward", "must have been computed from a parameter"));
        }
        let gradients = B::backward(self.array()).map_err(|cause| Self::refused("backward", cause))?;
        Ok(Gradients { gradients })
    }
}
