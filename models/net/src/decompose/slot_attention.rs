//! Slots that compete for places, and take in what they win.

use dvp_core::tensor::{Backend, Tensor, TensorError};

use crate::error::NetError;
use crate::layers::{Gru, LayerNorm, Linear, Mlp};
use crate::weights::Weights;

/// Added to the variance by layer norms; PyTorch's default.
const VARIANCE: f64 = 1e-5;
/// Added to what each slot gets of each place, so that a slot that gets nothing has a mean.
const LEAST: f64 = 1e-8;

/// Slots start from one normal distribution that is learned. In each of a few rounds every place is shared among the slots, by a
/// softmax of products of keys with queries; every slot takes in the mean of the values of its places with a gated recurrent unit,
/// and adds what a perceptron makes of itself. The weights are those of all rounds and slots: slots can be exchanged, and there may
/// be another number of them.
///
/// *Source*: Locatello et al.: Object-Centric Learning with Slot Attention (2020), algorithm 1.
#[derive(Clone, Debug)]
pub(super) struct SlotAttention<B: Backend> {
    /// Of places, of slots before they ask, of slots before the perceptron.
    norms: [LayerNorm<B>; 3],
    queries: Tensor<B>,
    keys: Tensor<B>,
    values: Tensor<B>,
    gru: Gru<B>,
    perceptron: Mlp<B>,
    /// Of the distribution, 1 x width: means, and logarithms of deviations.
    start: [Tensor<B>; 2],
    rounds: usize,
}

impl<B: Backend> SlotAttention<B> {
    /// Takes `mean` and `log_deviation`, `norm_inputs`, `norm_slots`, `norm_perceptron`, the matrices `queries.weight`, `keys.weight` and
    /// `values.weight`, `gru` and `perceptron`. `seen`: numbers of a place.
    ///
    /// # Errors
    /// As [`Weights::get`].
    pub(super) fn load(
        weights: &Weights<'_, B>,
        seen: usize,
        width: usize,
        hidden: usize,
        rounds: usize,
    ) -> Result<Self, NetError> {
        let norm = |name, width| LayerNorm::load(&weights.under(name), width, VARIANCE);
        // Outputs x inputs, as in files; used inputs x outputs.
        let matrix = |name, inputs| -> Result<Tensor<B>, NetError> {
            Ok(weights.under(name).get("weight", &[width, inputs])?.transpose()?)
        };
        Ok(Self {
            norms: [norm("norm_inputs", seen)?, norm("norm_slots", width)?, norm("norm_perceptron", width)?],
            queries: matrix("queries", width)?,
            keys: matrix("keys", seen)?,
            values: matrix("values", seen)?,
            gru: Gru::load(&weights.under("gru"), width)?,
            perceptron: Mlp::load(&weights.under("perceptron"), &[width, hidden, width])?,
            start: [weights.get("mean", &[1, width])?, weights.get("log_deviation", &[1, width])?],
            rounds,
        })
    }

    /// The slots after all rounds, batch x slots x width.
    ///
    /// *Dimensions*: places batch x n x seen; noise, from which slots start, batch x slots x width.
    ///
    /// # Errors
    /// As [`Tensor::matmul`].
    pub(super) fn forward(&self, places: &Tensor<B>, noise: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        let [of_places, of_slots, of_perceptron] = &self.norms;
        let places = of_places.forward(places)?;
        let [keys, values] = [places.matmul(&self.keys)?, places.matmul(&self.values)?];
        let [mean, log_deviation] = &self.start;
        let mut slots = log_deviation.exp()?.mul(noise)?.add(mean)?;
        let scale = (mean.dims().len() as f64).sqrt().recip();
        for _ in 0..self.rounds {
            let queries = of_slots.forward(&slots)?.matmul(&self.queries)?.affine(scale, 0.0)?;
            // batch x n x slots: every place is shared among the slots ..
            let shares = keys.matmul(&queries.transpose()?)?.softmax(2)?.affine(1.0, LEAST)?;
            // .. and every slot takes the mean over its places.
            let weights = shares.div(&shares.sum(1)?)?;
            let taken = weights.transpose()?.matmul(&values)?;
            slots = self.gru.forward(&taken, &slots)?;
            slots = slots.add(&self.perceptron.forward(&of_perceptron.forward(&slots)?)?)?;
        }
        Ok(slots)
    }
}

/// Numbers of every place of images, with where it is: batch x channels x h x w to batch x h w x width, by a linear map of the place that
/// is added, layer norm and a perceptron.
#[derive(Clone, Debug)]
pub(super) struct Places<B: Backend> {
    position: Linear<B>,
    norm: LayerNorm<B>,
    perceptron: Mlp<B>,
}

impl<B: Backend> Places<B> {
    /// Takes `position`, `norm` and `perceptron`.
    ///
    /// # Errors
    /// As [`Weights::get`].
    pub(super) fn load(weights: &Weights<'_, B>, channels: usize) -> Result<Self, NetError> {
        Ok(Self {
            position: Linear::load(&weights.under("position"), 2, channels)?,
            norm: LayerNorm::load(&weights.under("norm"), channels, VARIANCE)?,
            perceptron: Mlp::load(&weights.under("perceptron"), &[channels; 3])?,
        })
    }

    /// See [`Places`].
    ///
    /// # Errors
    /// [`TensorError::Operand`] for another rank.
    pub(super) fn forward(&self, features: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        let &[batch, channels, h, w] = features.dims().extents() else {
            let must = "must be batch x channels x h x w";
            return Err(TensorError::Operand { op: "places", dims: *features.dims(), must });
        };
        let places = features.like(crate::layers::places(h, w), &[1, 2, h * w])?.permute(&[0, 2, 1])?;
        let seen = features.reshape(&[batch, channels, h * w])?.permute(&[0, 2, 1])?;
        let seen = seen.add(&self.position.forward(&places)?)?;
        self.perceptron.forward(&self.norm.forward(&seen)?)
    }
}
