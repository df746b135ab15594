//! Gated recurrent units.

use dvp_core::tensor::{Backend, Tensor, TensorError};

use super::linear::Linear;
use crate::error::NetError;
use crate::weights::Weights;

/// A state that takes in an input: gates say how much of the old state is forgotten, and how much of it stays.
///
/// r = s(W_r x + U_r h), z = s(W_z x + U_z h), n = tanh(W_n x + r U_n h), each with two biases; the new state is (1 - z) n + z h.
///
/// *Source*: Cho et al.: Learning Phrase Representations using RNN Encoder-Decoder (2014), with the reset gate after the product,
/// as PyTorch has it.
#[derive(Clone, Debug)]
pub(crate) struct Gru<B: Backend> {
    input: Linear<B>,
    state: Linear<B>,
    width: usize,
}

impl<B: Backend> Gru<B> {
    /// Takes `input` and `state`, each a `weight`, 3 width x width, and a `bias`; rows in the order r, z, n.
    ///
    /// # Errors
    /// As [`Weights::get`].
    pub(crate) fn load(weights: &Weights<'_, B>, width: usize) -> Result<Self, NetError> {
        let linear = |name| Linear::load(&weights.under(name), width, 3 * width);
        Ok(Self { input: linear("input")?, state: linear("state")?, width })
    }

    /// .. x width and .. x width, of equal extents, to the new state.
    ///
    /// # Errors
    /// As [`Tensor::linear`].
    pub(crate) fn forward(&self, input: &Tensor<B>, state: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        let last = state.dims().rank().saturating_sub(1);
        let [from_input, from_state] = [self.input.forward(input)?, self.state.forward(state)?];
        let part = |all: &Tensor<B>, k: usize| all.slice(last, k * self.width, self.width);
        let gate = |k| part(&from_input, k)?.add(&part(&from_state, k)?)?.sigmoid();
        let [forgetting, staying] = [gate(0)?, gate(1)?];
        let new = part(&from_input, 2)?.add(&forgetting.mul(&part(&from_state, 2)?)?)?.tanh()?;
        new.add(&staying.mul(&state.sub(&new)?)?)
    }
}
